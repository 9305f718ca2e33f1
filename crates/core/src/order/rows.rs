//! Sorts the rows of points along the Hilbert curve, without building anything else.

use super::cells::{CROWD, Cells, fine_bits, order_runs, row};
use super::radix;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};

/// The fewest points that are worth a thread.
const SHARE: usize = 1 << 14;

/// Points between two checks for interruption.
const LOT: usize = 1 << 18;

/// The rows of the finite points along the curve, in consecutive parts. The order of points in the
/// same cell is unspecified.
pub fn order_of<const D: usize>(
    points: &[[f64; D]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Vec<u32>>> {
    let share = points.len().div_ceil(workers.max(1)).max(SHARE);
    let shares = || points.chunks(share).collect::<Vec<_>>();
    let extents = parallel::map_watched(workers, shares(), watch, |share| {
        Ok(Extent::of(share.iter().copied().filter(is_finite)))
    })?;
    let extent = Extent::of(
        extents
            .iter()
            .flat_map(|e| [e.min, e.max])
            .filter(is_finite),
    );
    let cells = Cells::of(&extent);
    let low_bit = 32 - fine_bits(points.len());
    let mask = u64::MAX << (32 + low_bit);
    let tasks = (0u64..).step_by(share).zip(shares()).collect();
    let sorted = parallel::map_watched(workers, tasks, watch, |(first, share)| {
        let mut items = with_room(share.len())?;
        let lots = (first..).step_by(LOT).zip(share.chunks(LOT));
        for (first, lot) in lots {
            watch.check()?;
            let rows = (first..).zip(lot).filter(|(_, p)| is_finite(p));
            items.extend(rows.map(|(i, &p)| cells.key(p) & mask | i));
        }
        radix::sort(&mut items, &mut Vec::new(), low_bit, watch)?;
        Ok(items)
    })?;
    let tasks = if sorted.len() > 1 {
        4 * workers as u64
    } else {
        1
    };
    let cut = |part: u64| ((u128::from(part) << 64) / u128::from(tasks)) as u64;
    parallel::map_watched(workers, (0..tasks).collect(), watch, |part| {
        let within = |items: &[u64]| {
            let place = |cut| items.partition_point(|&item| item < cut);
            let end = if part + 1 < tasks {
                place(cut(part + 1))
            } else {
                items.len()
            };
            place(cut(part))..end
        };
        let mut items = with_room(sorted.iter().map(|s| within(s).len()).sum())?;
        for share in &sorted {
            items.extend_from_slice(&share[within(share)]);
        }
        if sorted.len() > 1 {
            // The sort merges the few ascending runs.
            items.sort();
        }
        order_crowds(points, &mut items, watch)?;
        let mut rows = with_room(items.len())?;
        for lot in items.chunks(LOT) {
            watch.check()?;
            rows.extend(lot.iter().map(|&item| row(item) as u32));
        }
        Ok(rows)
    })
}

fn is_finite<const D: usize>(p: &[f64; D]) -> bool {
    p.iter().all(|x| x.is_finite())
}

/// Sorts the items of each cell that holds many points.
fn order_crowds<const D: usize>(
    points: &[[f64; D]],
    items: &mut [u64],
    watch: &Watch,
) -> Result<()> {
    let mut pace = Pace::new(watch, LOT);
    for run in items.chunk_by_mut(|i, j| i >> 32 == j >> 32) {
        pace.spend(run.len())?;
        if run.len() > CROWD {
            order_runs(points, run, watch)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_finite_row_occurs_once() {
        let points: Vec<[f64; 3]> = (0..40_000)
            .map(|i| {
                [
                    f64::from(i % 10),
                    f64::from(i / 10 % 10),
                    f64::from(i / 100),
                ]
            })
            .chain([[f64::NAN, 0.0, 0.0], [f64::MAX, f64::MIN, 0.0]])
            .collect();
        for workers in [1, 3] {
            let mut rows = order_of(&points, workers, &Watch::idle()).unwrap().concat();
            rows.sort_unstable();
            assert!(rows.into_iter().eq((0..40_000).chain([40_001])));
        }
        assert_eq!(
            order_of(&[[2.0; 3]; 3], 1, &Watch::idle()).unwrap(),
            [[0, 1, 2]]
        );
        assert!(
            order_of::<2>(&[], 2, &Watch::idle())
                .unwrap()
                .concat()
                .is_empty()
        );
    }

    #[test]
    fn neighbors_in_the_order_are_near() {
        // A grid of 32 by 32 by 32 cells: the curve goes from cell to cell.
        let points: Vec<[f64; 3]> = (0..1 << 15)
            .map(|i| [i >> 10, i >> 5 & 31, i & 31].map(f64::from))
            .collect();
        let rows = order_of(&points, 1, &Watch::idle()).unwrap().concat();
        for pair in rows.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|row| points[row as usize]);
            let step: f64 = (0..3).map(|k| (p[k] - q[k]).abs()).sum();
            assert_eq!(step, 1.0);
        }
    }
}
