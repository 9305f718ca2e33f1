//! The queue of bad triangles, those with the shortest edges first.
//!
//! A vertex inserted for them is close to them and often makes vertices for larger triangles
//! unnecessary (A. Üngör, "Off-centers: a new type of Steiner points for computing size-optimal
//! quality-guaranteed Delaunay triangulations", LATIN 2004).
//!
//! Buckets of lengths grow by a factor of 2^(1/4). Within a bucket, the queue is last in, first
//! out, so that work stays local.

use crate::base::error::Result;
use crate::base::memory::push;

/// log2 of the buckets per factor of two of the squared length: the top bits of its fraction.
const FINE: u32 = 1;
const BUCKETS: usize = 2048 << FINE;
const WORDS: usize = BUCKETS / 64;

/// A triangle at the time when it was judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bad {
    /// Its record.
    pub triangle: u32,
    /// Its corners; if they have changed, the triangle no longer exists.
    pub corners: [u32; 3],
}

/// The buckets, and a bit for each that is not empty.
#[derive(Debug)]
pub struct Queue {
    buckets: Vec<Vec<Bad>>,
    filled: [u64; WORDS],
}

impl Default for Queue {
    fn default() -> Self {
        Self {
            buckets: vec![Vec::new(); BUCKETS],
            filled: [0; WORDS],
        }
    }
}

impl Queue {
    /// Adds a triangle whose shortest edge has the squared length `key`.
    pub fn push(&mut self, bad: Bad, key: f64) -> Result<()> {
        let bucket = (key.to_bits() >> (52 - FINE)) as usize % BUCKETS;
        push(&mut self.buckets[bucket], bad)?;
        self.filled[bucket / 64] |= 1 << (bucket % 64);
        Ok(())
    }

    /// Removes the next triangle.
    pub fn pop(&mut self) -> Option<Bad> {
        let word = self.filled.iter().position(|w| *w != 0)?;
        let bucket = 64 * word + self.filled[word].trailing_zeros() as usize;
        let bad = self.buckets[bucket].pop();
        if self.buckets[bucket].is_empty() {
            self.filled[word] &= !(1 << (bucket % 64));
        }
        bad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shorter_edges_come_first() {
        let mut queue = Queue::default();
        let bad = |triangle| Bad {
            triangle,
            corners: [0; 3],
        };
        for (t, key) in [
            (1, 1e-300),
            (4, 1e9),
            (0, 5e-324),
            (3, 7.0),
            (2, 1.0),
            (5, 1e300),
        ] {
            queue.push(bad(t), key).unwrap();
        }
        for t in 0..6 {
            assert_eq!(queue.pop(), Some(bad(t)));
        }
        assert_eq!(queue.pop(), None);
    }
}
