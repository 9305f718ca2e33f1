//! The worst points of triangles, largest error first.
//!
//! A heap of small entries with four children each: a triangle that changes leaves its old entry
//! behind, which is removed when it comes first, or with all others when they are the majority.

use delone_predicates::lexicographic;

use super::plane::{Place, below};
use crate::base::error::Result;
use crate::base::memory::push;

/// Children of an entry, which share a cache line.
const CHILDREN: usize = 4;
/// So many old entries are never removed.
const FEW: usize = 1 << 10;

/// The worst point of a triangle at some time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Its error.
    pub error: f64,
    /// Its number.
    pub point: u32,
    /// The triangle.
    pub triangle: u32,
}

/// Whether one entry comes before another: by error, and of equal ones by the coordinates.
#[inline]
fn before(places: &[Place], a: Worst, b: Worst) -> bool {
    let at = |worst: Worst| below(places[worst.point as usize].raised);
    a.error > b.error || (a.error == b.error && lexicographic(at(a), at(b)).is_lt())
}

/// The entries.
#[derive(Debug, Default)]
pub struct Heap {
    entries: Vec<Worst>,
}

impl Heap {
    /// The first entry.
    pub fn first(&self) -> Option<Worst> {
        self.entries.first().copied()
    }

    /// Adds an entry.
    pub fn add(&mut self, worst: Worst, places: &[Place]) -> Result<()> {
        push(&mut self.entries, worst)?;
        let mut k = self.entries.len() - 1;
        while k > 0 {
            let parent = (k - 1) / CHILDREN;
            if !before(places, worst, self.entries[parent]) {
                break;
            }
            self.entries[k] = self.entries[parent];
            k = parent;
        }
        self.entries[k] = worst;
        Ok(())
    }

    /// Removes the first entry.
    pub fn remove_first(&mut self, places: &[Place]) {
        if let Some(last) = self.entries.pop()
            && !self.entries.is_empty()
        {
            self.entries[0] = last;
            self.sink(0, places);
        }
    }

    /// Moves an entry down to where none below it comes before it.
    fn sink(&mut self, mut k: usize, places: &[Place]) {
        let own = self.entries[k];
        loop {
            let first = CHILDREN * k + 1;
            let end = (first + CHILDREN).min(self.entries.len());
            let children = first.min(end)..end;
            let best = children.reduce(|best, c| {
                if before(places, self.entries[c], self.entries[best]) {
                    c
                } else {
                    best
                }
            });
            match best {
                Some(best) if before(places, self.entries[best], own) => {
                    self.entries[k] = self.entries[best];
                    k = best;
                }
                _ => break,
            }
        }
        self.entries[k] = own;
    }

    /// Removes old entries if they are the majority; `live` is the number of current ones.
    pub fn tidy(&mut self, live: usize, is_live: impl Fn(&Worst) -> bool, places: &[Place]) {
        if self.entries.len() < 2 * live + FEW {
            return;
        }
        self.entries.retain(is_live);
        for k in (0..self.entries.len().div_ceil(CHILDREN)).rev() {
            self.sink(k, places);
        }
    }
}
