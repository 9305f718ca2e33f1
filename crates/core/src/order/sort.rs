//! Sorts that can be interrupted.

use std::cmp::Ordering;

use crate::base::error::Result;
use crate::base::parallel;
use crate::base::watch::Watch;

/// Items sorted without a check for interruption.
const LOT: usize = 1 << 18;
/// Items per task.
const PART: usize = 1 << 16;

/// Sorts items by a total order, unstably. Larger sets are split at their medians, which takes
/// linear time per split.
pub fn sort_by<T>(
    items: &mut [T],
    watch: &Watch,
    compare: impl Fn(&T, &T) -> Ordering + Copy,
) -> Result<()> {
    watch.check()?;
    if items.len() <= LOT {
        items.sort_unstable_by(compare);
        return Ok(());
    }
    let middle = items.len() / 2;
    let (before, _, after) = items.select_nth_unstable_by(middle, compare);
    sort_by(before, watch, compare)?;
    sort_by(after, watch, compare)
}

/// The same with threads: medians split until the parts are small.
pub fn sort_shared<T: Send>(
    items: &mut [T],
    workers: usize,
    watch: &Watch,
    compare: impl Fn(&T, &T) -> Ordering + Copy + Sync,
) -> Result<()> {
    let mut parts = vec![items];
    while workers > 1 && parts.len() < 4 * workers && parts[0].len() > PART {
        let halves = parallel::map_watched(workers, parts, watch, |part| {
            let middle = part.len() / 2;
            part.select_nth_unstable_by(middle, compare);
            let (before, after) = part.split_at_mut(middle);
            Ok([before, after])
        })?;
        parts = halves.into_iter().flatten().collect();
    }
    parallel::map_watched(workers, parts, watch, |part| sort_by(part, watch, compare))?;
    Ok(())
}

/// Sorts items by their natural order.
pub fn sort<T: Ord>(items: &mut [T], watch: &Watch) -> Result<()> {
    sort_by(items, watch, T::cmp)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn large_sets_are_sorted_and_can_be_interrupted() {
        let items: Vec<u64> = (0..4 * LOT as u64 + 7)
            .map(|i| i * 0x9e37_79b9 % 1_000_003)
            .collect();
        let mut expected = items.clone();
        expected.sort_unstable();
        let asked = AtomicUsize::new(0);
        let stop = |after: usize| asked.fetch_add(1, Ordering::Relaxed) >= after;
        let mut sorted = items.clone();
        sort(&mut sorted, &Watch::new(&|| stop(usize::MAX))).unwrap();
        assert!(sorted == expected);
        let all = asked.swap(0, Ordering::Relaxed);
        for after in 0..all {
            asked.store(0, Ordering::Relaxed);
            assert!(sort(&mut items.clone(), &Watch::new(&|| stop(after))).is_err());
        }
        assert!(all > 8);
    }
}
