//! Least-significant-digit radix sort of `key << 32 | payload` by the key.
//!
//! It is stable, so payloads in ascending order stay so within a key.

use crate::base::error::Result;
use crate::base::memory::clear_with_room;
use crate::base::watch::Watch;

const DIGIT: u32 = 8;
const BUCKETS: usize = 1 << DIGIT;
/// Below this length a comparison sort is faster than four histograms of 256.
const SHORT: usize = 256;
/// Items between two checks for interruption.
const LOT: usize = 1 << 18;

/// Sorts `items` by their upper 32 bits, of which those below `low_bit` must be zero. `other` is a
/// buffer of the same size.
pub fn sort(items: &mut Vec<u64>, other: &mut Vec<u64>, low_bit: u32, watch: &Watch) -> Result<()> {
    if items.len() <= SHORT {
        items.sort_unstable();
        return Ok(());
    }
    clear_with_room(other, items.len())?;
    other.resize(items.len(), 0);
    for shift in (32 + low_bit..64).step_by(DIGIT as usize) {
        if scatter(items, other, shift, watch)? {
            std::mem::swap(items, other);
        }
    }
    Ok(())
}

/// One pass; `false` if all items share the digit and nothing was moved.
fn scatter(from: &[u64], to: &mut [u64], shift: u32, watch: &Watch) -> Result<bool> {
    let digit = |item: u64| (item >> shift) as usize & (BUCKETS - 1);
    let mut start = [0usize; BUCKETS];
    for lot in from.chunks(LOT) {
        watch.check()?;
        for &item in lot {
            start[digit(item)] += 1;
        }
    }
    if start[digit(from[0])] == from.len() {
        return Ok(false);
    }
    let mut sum = 0;
    for s in &mut start {
        sum += std::mem::replace(s, sum);
    }
    for lot in from.chunks(LOT) {
        watch.check()?;
        for &item in lot {
            let place = &mut start[digit(item)];
            to[*place] = item;
            *place += 1;
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorts_by_key_and_keeps_payloads_in_order() {
        let mut x = 1u64;
        let mut items: Vec<u64> = (0..5000)
            .map(|i| {
                x = x
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                (x >> 50) << 48 | i
            })
            .collect();
        let mut expected = items.clone();
        expected.sort();
        sort(&mut items, &mut Vec::new(), 16, &Watch::idle()).unwrap();
        assert_eq!(items, expected);
    }
}
