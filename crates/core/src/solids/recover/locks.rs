//! Which edges and faces of the mesh are parts of the input, and must be kept.
//!
//! Nearly all of them are whole segments and faces of the input, which are found among those with
//! the same first vertex. Most queries are for others: a bit that no row has set answers these in a
//! fifth of the time. The few parts with added vertices are in a hash table.

use std::collections::HashMap;

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};

/// How many rows of a vertex are searched one by one.
const FEW: usize = 16;

/// Bits for each row, most of which stay unset.
const BITS: usize = 16;

/// What is locked among edges (`N` = 2) or faces (`N` = 3); keys are ascending vertices.
pub struct Locks<const N: usize> {
    /// Segments or faces of the input, sorted.
    rows: Vec<[u32; N]>,
    /// Where the rows of each first vertex begin, and the end of all.
    start: Vec<u32>,
    /// The bit of each row is set.
    bits: Vec<u64>,
    /// Whether each row is locked.
    whole: Vec<bool>,
    /// The row of each other locked part.
    parts: HashMap<[u32; N], u32>,
}

impl<const N: usize> Locks<N> {
    /// Nothing is locked. `rows` are sorted and distinct, of vertices below `vertices`.
    pub fn new(rows: &[[u32; N]], vertices: usize) -> Result<Self> {
        let mut start = filled(vertices + 1, 0)?;
        for row in rows {
            start[row[0] as usize + 1] += 1;
        }
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        let mut own = with_room(rows.len())?;
        own.extend_from_slice(rows);
        let words = (rows.len() * BITS).div_ceil(64).next_power_of_two();
        let mut bits = filled(words, 0)?;
        for &row in rows {
            let (word, bit) = place(row, words);
            bits[word] |= bit;
        }
        Ok(Self {
            rows: own,
            start,
            bits,
            whole: filled(rows.len(), false)?,
            parts: HashMap::new(),
        })
    }

    /// The segment or face of the input with these vertices.
    #[inline]
    pub fn row(&self, key: [u32; N]) -> Option<u32> {
        let (word, bit) = place(key, self.bits.len());
        if self.bits[word] & bit == 0 {
            return None;
        }
        let first = key[0] as usize;
        let (from, to) = (*self.start.get(first)?, *self.start.get(first + 1)?);
        let rows = &self.rows[from as usize..to as usize];
        let at = if rows.len() <= FEW {
            rows.iter().position(|row| *row == key)
        } else {
            rows.binary_search(&key).ok()
        };
        Some(from + at? as u32)
    }

    /// The segment or face of which a part is locked, `None` if it is not.
    #[inline]
    pub fn get(&self, key: [u32; N]) -> Option<u32> {
        match self.row(key) {
            Some(row) if self.whole[row as usize] => Some(row),
            _ if self.parts.is_empty() => None,
            _ => self.parts.get(&key).copied(),
        }
    }

    /// Whether a part is locked.
    #[inline]
    pub fn has(&self, key: [u32; N]) -> bool {
        self.get(key).is_some()
    }

    /// Locks a part of a segment or face; returns whether it was locked.
    pub fn insert(&mut self, key: [u32; N], of: u32) -> bool {
        match self.row(key) {
            Some(row) if row == of => std::mem::replace(&mut self.whole[row as usize], true),
            _ => self.parts.insert(key, of).is_some(),
        }
    }

    /// Unlocks a part.
    pub fn remove(&mut self, key: [u32; N]) {
        if let Some(row) = self.row(key) {
            self.whole[row as usize] = false;
        }
        self.parts.remove(&key);
    }
}

/// The word and the bit of a key, in a power of two of words.
#[inline]
fn place<const N: usize>(key: [u32; N], words: usize) -> (usize, u64) {
    // 2^64 divided by the golden ratio: neighboring numbers end far apart.
    let mixed = |h: u64, v: &u32| (h ^ u64::from(*v)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let h = key.iter().fold(0, mixed);
    let at = (h ^ h >> 32) as usize;
    ((at >> 6) & (words - 1), 1 << (at & 63))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_found_by_their_vertices() {
        // Vertex 0 has more rows than are searched one by one.
        let mut rows: Vec<[u32; 3]> = (1..40).map(|v| [0, v, v + 1]).collect();
        rows.push([3, 5, 9]);
        let mut locks = Locks::new(&rows, 41).unwrap();
        for (of, &row) in (0..).zip(&rows) {
            assert_eq!(locks.row(row), Some(of));
            assert_eq!(locks.get(row), None);
            assert!(!locks.insert(row, of));
            assert!(locks.insert(row, of));
            assert_eq!(locks.get(row), Some(of));
        }
        assert_eq!(locks.row([0, 1, 3]), None);
        // A part with an added vertex, and one whose vertices are all of the input.
        for part in [[0, 3, 77], [3, 5, 8], [90, 91, 92]] {
            assert!(!locks.has(part));
            assert!(!locks.insert(part, 7));
            assert_eq!(locks.get(part), Some(7));
            locks.remove(part);
            assert!(!locks.has(part));
        }
        locks.remove(rows[20]);
        assert!(!locks.has(rows[20]) && locks.has(rows[19]) && locks.has(rows[21]));
    }
}
