//! Records of simplices with ghosts during insertion, common to 2-D and 3-D.

use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};

/// The vertex at infinity.
pub const GHOST: u32 = u32::MAX;
/// No simplex.
pub const NONE: u32 = u32::MAX;

/// The simplices that a site removes, and the sides of their cavity: each as a removed simplex and
/// the corner opposite the side.
pub type Hole = (Vec<u32>, Vec<(u32, usize)>);

/// Simplices with `N` corners. All corners of free records are ghosts.
pub struct Records<const N: usize> {
    /// The vertices of each.
    pub vertices: Vec<[u32; N]>,
    /// The simplex opposite each corner.
    pub neighbors: Vec<[u32; N]>,
    /// Where the next walk starts.
    pub last: u32,
    free: Vec<u32>,
    /// The insertion in which a simplex was last tested, and whether it was in conflict.
    seen: Vec<(u32, bool)>,
    stamp: u32,
}

impl<const N: usize> Records<N> {
    /// No simplices yet, with capacity for some.
    pub fn with_room(n: usize) -> Result<Self> {
        Ok(Self {
            vertices: with_room(n)?,
            neighbors: with_room(n)?,
            last: 0,
            free: Vec::new(),
            seen: with_room(n)?,
            stamp: 0,
        })
    }

    /// Adds a record.
    pub fn push(&mut self, vertices: [u32; N], neighbors: [u32; N]) -> u32 {
        self.vertices.push(vertices);
        self.neighbors.push(neighbors);
        self.seen.push((0, false));
        self.vertices.len() as u32 - 1
    }

    /// A free record, or a new one.
    pub fn take(&mut self) -> u32 {
        match self.free.pop() {
            Some(t) => {
                self.seen[t as usize] = (0, false);
                t
            }
            None => self.push([GHOST; N], [NONE; N]),
        }
    }

    /// Frees the records of simplices.
    pub fn release(&mut self, hole: &[u32]) {
        self.free.extend_from_slice(hole);
    }

    /// Clears the records of a cavity that were not reused, so that they do not look like
    /// simplices.
    pub fn empty(&mut self, hole: &[u32]) {
        let from = self.free.len().saturating_sub(hole.len());
        for &t in &self.free[from..] {
            self.vertices[t as usize] = [GHOST; N];
        }
    }

    /// The simplex that contains site `p`, boundary included, or a ghost outside the hull;
    /// `is_beyond` tells whether `p` is strictly beyond the side opposite a corner.
    #[inline]
    pub fn locate(&self, p: u32, is_beyond: impl Fn([u32; N], usize) -> bool) -> Result<u32> {
        let (mut t, mut from) = (self.last, NONE);
        // A walk in a regular triangulation visits no simplex twice, which limits its steps.
        for _ in 0..=self.vertices.len() {
            let (corners, around) = (self.vertices[t as usize], self.neighbors[t as usize]);
            let step = (0..N).find(|&k| around[k] != from && is_beyond(corners, k));
            let Some(k) = step else { return Ok(t) };
            (t, from) = (around[k], t);
            if self.vertices[t as usize].contains(&GHOST) {
                return Ok(t);
            }
        }
        Err(Error::Internal(format!(
            "the walk to site {p} does not terminate"
        )))
    }

    /// The simplices in conflict that are connected with `start`; `None` if `start` is not in
    /// conflict.
    #[inline]
    pub fn hole(&mut self, start: u32, conflicts: impl Fn(&Self, u32) -> bool) -> Option<Hole> {
        self.stamp += 1;
        if !conflicts(self, start) {
            return None;
        }
        self.seen[start as usize] = (self.stamp, true);
        let mut stack = vec![start];
        let (mut hole, mut rim) = (Vec::new(), Vec::new());
        // Each simplex is tested once per insertion, so it is pushed at most once.
        while let Some(t) = stack.pop() {
            hole.push(t);
            for k in 0..N {
                let other = self.neighbors[t as usize][k];
                let (stamp, mut goes) = self.seen[other as usize];
                if stamp != self.stamp {
                    goes = conflicts(self, other);
                    self.seen[other as usize] = (self.stamp, goes);
                    if goes {
                        stack.push(other);
                    }
                }
                if !goes {
                    rim.push((t, k));
                }
            }
        }
        Some((hole, rim))
    }

    /// The simplices that are not ghosts, in order.
    pub fn export(self) -> Result<Arrays<N>> {
        let mut number = filled(self.vertices.len(), -1)?;
        let mut count = 0;
        for (corners, number) in self.vertices.iter().zip(&mut number) {
            if !corners.contains(&GHOST) {
                *number = count;
                count += 1;
            }
        }
        let mut out = Arrays {
            simplices: with_room(count as usize)?,
            neighbors: with_room(count as usize)?,
        };
        let all = self.vertices.iter().zip(&self.neighbors).zip(&number);
        for ((corners, around), _) in all.filter(|(_, number)| **number >= 0) {
            out.simplices.push(corners.map(|v| v as i32));
            let around = around.map(|other| number[other as usize]);
            out.neighbors.push(around);
        }
        Ok(out)
    }
}
