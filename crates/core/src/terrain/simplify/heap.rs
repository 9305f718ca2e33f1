//! The worst points of triangles, largest error first.
//!
//! Entries are in buckets of nearly equal errors, without order. Those of the highest bucket are in a heap with
//! four children each. A triangle that changes leaves its old entry behind; most of these are removed
//! when their bucket becomes the highest one, so they are never sorted, and the others when they come first.

use super::points::Points;
use crate::base::error::Result;
use crate::base::memory::{make_room, push};

/// Children of an entry, which share a cache line.
const CHILDREN: usize = 4;
/// So many old entries are never removed.
const FEW: usize = 1 << 10;
/// The bits of an error that number its bucket: the exponent, and 32 buckets for each.
const SHIFT: u32 = 52 - 5;
const BUCKETS: usize = 1 << (63 - SHIFT);

/// The worst point of a triangle at some time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Its error, positive.
    pub error: f64,
    /// Its number.
    pub point: u32,
    /// The triangle.
    pub triangle: u32,
}

impl Worst {
    /// The bucket, higher for larger errors.
    fn bucket(&self) -> usize {
        (self.error.to_bits() >> SHIFT) as usize % BUCKETS
    }
}

/// Whether one entry comes before another: by error, and of equal ones by the coordinates.
#[inline]
fn before(points: &impl Points, a: Worst, b: Worst) -> bool {
    a.error > b.error || (a.error == b.error && points.is_smaller(a.point, b.point))
}

/// The entries.
#[derive(Debug, Default)]
pub struct Heap {
    /// Those of the bucket `open` and of all above it, as a heap.
    entries: Vec<Worst>,
    open: usize,
    /// The others.
    buckets: Vec<Vec<Worst>>,
    /// The number of all.
    count: usize,
}

impl Heap {
    /// The first entry that is still that of its triangle.
    pub fn first(
        &mut self,
        is_live: impl Fn(&Worst) -> bool,
        points: &impl Points,
    ) -> Option<Worst> {
        loop {
            while let Some(&top) = self.entries.first() {
                if is_live(&top) {
                    return Some(top);
                }
                self.remove_first(points);
            }
            // The next bucket below. Each step is to a lower one.
            let next = (0..self.open.min(self.buckets.len()))
                .rev()
                .find(|&k| !self.buckets[k].is_empty())?;
            self.open = next;
            self.entries = std::mem::take(&mut self.buckets[next]);
            self.count -= self.entries.len();
            self.entries.retain(&is_live);
            self.count += self.entries.len();
            self.sort(points);
        }
    }

    /// Adds an entry.
    pub fn add(&mut self, worst: Worst, points: &impl Points) -> Result<()> {
        let bucket = worst.bucket();
        self.count += 1;
        if bucket < self.open {
            return push(&mut self.buckets[bucket], worst);
        }
        if self.buckets.is_empty() {
            make_room(&mut self.buckets, BUCKETS)?;
            self.buckets.resize_with(BUCKETS, Vec::new);
            self.open = BUCKETS;
            return push(&mut self.buckets[bucket], worst);
        }
        push(&mut self.entries, worst)?;
        let mut k = self.entries.len() - 1;
        while k > 0 {
            let parent = (k - 1) / CHILDREN;
            if !before(points, worst, self.entries[parent]) {
                break;
            }
            self.entries[k] = self.entries[parent];
            k = parent;
        }
        self.entries[k] = worst;
        Ok(())
    }

    /// Removes the first entry.
    fn remove_first(&mut self, points: &impl Points) {
        if let Some(last) = self.entries.pop() {
            self.count -= 1;
            if !self.entries.is_empty() {
                self.entries[0] = last;
                self.sink(0, points);
            }
        }
    }

    /// Makes the entries a heap.
    fn sort(&mut self, points: &impl Points) {
        for k in (0..self.entries.len().div_ceil(CHILDREN)).rev() {
            self.sink(k, points);
        }
    }

    /// Moves an entry down to where none below it comes before it.
    fn sink(&mut self, mut k: usize, points: &impl Points) {
        let own = self.entries[k];
        loop {
            let first = CHILDREN * k + 1;
            let end = (first + CHILDREN).min(self.entries.len());
            let children = first.min(end)..end;
            let best = children.reduce(|best, c| {
                if before(points, self.entries[c], self.entries[best]) {
                    c
                } else {
                    best
                }
            });
            match best {
                Some(best) if before(points, self.entries[best], own) => {
                    self.entries[k] = self.entries[best];
                    k = best;
                }
                _ => break,
            }
        }
        self.entries[k] = own;
    }

    /// Removes old entries if they are the majority; `live` is the number of current ones.
    pub fn tidy(&mut self, live: usize, is_live: impl Fn(&Worst) -> bool, points: &impl Points) {
        if self.count < 2 * live + FEW {
            return;
        }
        self.entries.retain(&is_live);
        self.count = self.entries.len();
        for bucket in &mut self.buckets {
            bucket.retain(&is_live);
            self.count += bucket.len();
        }
        self.sort(points);
    }
}
