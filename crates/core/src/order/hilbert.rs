//! Hilbert curve keys of 2-D cells (D. Hilbert, 1891), four levels per table lookup.
//!
//! A level transforms the frame of the square: the state is whether the axes are swapped and
//! whether both are reversed. The two commute, so four states suffice, and a table indexed by
//! state, four bits of x and four of y gives eight bits of the key and the next state.

/// Bits of x, and of y, in a key.
pub const BITS: u32 = 16;

const TABLE: [u16; 1024] = table();

const fn table() -> [u16; 1024] {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < 1024 {
        let (mut swapped, mut reversed) = ((i >> 9) & 1, (i >> 8) & 1);
        let (xs, ys) = ((i >> 4) & 15, i & 15);
        let mut digits = 0;
        let mut level = 4;
        while level > 0 {
            level -= 1;
            let (x, y) = ((xs >> level) & 1, (ys >> level) & 1);
            let (x, y) = if swapped == 1 { (y, x) } else { (x, y) };
            let (x, y) = (x ^ reversed, y ^ reversed);
            // The curve visits the quarters (0,0), (0,1), (1,1), (1,0); it is transposed in the
            // first and transposed and reversed in the last.
            digits = digits << 2 | (3 * x) ^ y;
            if y == 0 {
                reversed ^= x;
                swapped ^= 1;
            }
        }
        table[i] = (digits | swapped << 9 | reversed << 8) as u16;
        i += 1;
    }
    table
}

/// The position of cell `(x, y)`, of 65536 by 65536, along the curve.
#[inline]
pub fn key(x: u16, y: u16) -> u32 {
    let (x, y) = (usize::from(x), usize::from(y));
    let mut key = 0;
    let mut state = 0;
    for shift in [12, 8, 4, 0] {
        let entry = TABLE[state | ((x >> shift) & 15) << 4 | (y >> shift) & 15];
        key = key << 8 | u32::from(entry & 255);
        state = usize::from(entry & 0x300);
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_keys_are_adjacent_cells() {
        // The first 2^16 keys fill the 256 x 256 square at the origin.
        let mut cell_of = vec![None; 1 << 16];
        for x in 0..256u16 {
            for y in 0..256u16 {
                let k = key(x, y) as usize;
                assert!(cell_of[k].replace((i32::from(x), i32::from(y))).is_none());
            }
        }
        let cells: Vec<_> = cell_of.into_iter().map(Option::unwrap).collect();
        for pair in cells.windows(2) {
            let step = (pair[0].0 - pair[1].0).abs() + (pair[0].1 - pair[1].1).abs();
            assert_eq!(step, 1, "{pair:?}");
        }
    }

    #[test]
    fn the_far_corner_of_the_first_axis_is_last() {
        assert_eq!(key(0, 0), 0);
        assert_eq!(key(65535, 0), u32::MAX);
    }
}
