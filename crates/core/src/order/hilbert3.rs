//! Hilbert curve keys of 3-D cells, two levels per table lookup.
//!
//! A level of the curve visits the eight octants in Gray code order, from an entry corner along a
//! direction; each octant contains the curve of the next level, mirrored and rotated. The state is
//! the entry and the direction, 24 states in total. The formulas are those of C. Hamilton, "Compact
//! Hilbert indices" (2006), section 2.

/// Bits of each coordinate in a key.
pub const BITS: u32 = 10;

/// Indexed by state and two bits of each coordinate: six bits of the key, and the next state above
/// them.
const TABLE: [u16; STATES * 64] = table();

const STATES: usize = 24;

/// Three bits rotated to the left by `by`.
const fn rotated(bits: usize, by: usize) -> usize {
    let by = by % 3;
    (bits << by | bits >> (3 - by)) & 7
}

const fn gray(i: usize) -> usize {
    i ^ i >> 1
}

/// One level: the digit of an octant in a state (entry + 8 direction), and the next state.
const fn level(state: usize, octant: usize) -> (usize, usize) {
    let (entry, direction) = (state & 7, state >> 3);
    let inner = rotated(octant ^ entry, 3 - (direction + 1) % 3);
    let mut digit = 0;
    while gray(digit) != inner {
        digit += 1;
    }
    let corner = if digit == 0 {
        0
    } else {
        gray(2 * ((digit - 1) / 2))
    };
    let along = if digit == 0 {
        0
    } else if digit % 2 == 0 {
        (digit - 1).trailing_ones() as usize % 3
    } else {
        digit.trailing_ones() as usize % 3
    };
    let next = (entry ^ rotated(corner, direction + 1)) | ((direction + along + 1) % 3) << 3;
    (digit, next)
}

const fn table() -> [u16; STATES * 64] {
    let mut table = [0; STATES * 64];
    let mut i = 0;
    while i < STATES * 64 {
        let (state, x, y, z) = (i >> 6, i >> 4 & 3, i >> 2 & 3, i & 3);
        let (high, middle) = level(state, (x >> 1) << 2 | (y >> 1) << 1 | z >> 1);
        let (low, next) = level(middle, (x & 1) << 2 | (y & 1) << 1 | z & 1);
        table[i] = (high << 3 | low | next << 6) as u16;
        i += 1;
    }
    table
}

/// The position of cell `(x, y, z)`, of 1024 each, along the curve: 30 bits.
#[inline]
pub fn key([x, y, z]: [u32; 3]) -> u32 {
    let (mut key, mut state) = (0, 0);
    for shift in [8, 6, 4, 2, 0] {
        let digits = (x >> shift & 3) << 4 | (y >> shift & 3) << 2 | z >> shift & 3;
        let entry = TABLE[state | digits as usize & 63];
        key = key << 6 | u32::from(entry & 63);
        state = usize::from(entry & !63);
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_keys_are_adjacent_cells() {
        // The first 2^15 keys fill a cube of 32^3 cells at the corner where the curve enters.
        let mut cells = vec![None; 1 << 15];
        for i in 0..1 << 15 {
            let cell = [i >> 10, i >> 5 & 31, i & 31];
            assert!(cells[key(cell) as usize].replace(cell).is_none());
        }
        let cells: Vec<[u32; 3]> = cells.into_iter().map(Option::unwrap).collect();
        for pair in cells.windows(2) {
            let step: u32 = (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).sum();
            assert_eq!(step, 1, "{pair:?}");
        }
    }
}
