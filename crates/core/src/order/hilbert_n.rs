//! The Hilbert curve in any number of dimensions.
//!
//! J. Skilling, "Programming the Hilbert curve" (2004).

/// The place of a cell along the curve.
pub fn key<const D: usize>(mut x: [u32; D], bits: u32) -> u64 {
    // Undo the reflections and exchanges of axes from the coarsest level down.
    let mut level = 1u32 << (bits - 1);
    while level > 1 {
        let below = level - 1;
        for i in 0..D {
            if x[i] & level != 0 {
                x[0] ^= below;
            } else {
                let change = (x[0] ^ x[i]) & below;
                x[0] ^= change;
                x[i] ^= change;
            }
        }
        level >>= 1;
    }
    // Gray code.
    for i in 1..D {
        x[i] ^= x[i - 1];
    }
    let mut flips = 0;
    let mut level = 1u32 << (bits - 1);
    while level > 1 {
        if x[D - 1] & level != 0 {
            flips ^= level - 1;
        }
        level >>= 1;
    }
    // One bit of each coordinate after the other.
    (0..bits).rev().fold(0, |key, bit| {
        x.iter()
            .fold(key, |key, v| key << 1 | u64::from((v ^ flips) >> bit & 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_each_cell_once_in_steps_of_one() {
        let mut at = vec![[u32::MAX; 3]; 512];
        for i in 0..512u32 {
            let cell = [i >> 6, i >> 3 & 7, i & 7];
            at[key(cell, 3) as usize] = cell;
        }
        for pair in at.windows(2) {
            let steps: u32 = (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).sum();
            assert_eq!(steps, 1);
        }
    }
}
