//! The insertion that covers the rest of the sphere: a direction beyond all edges of the hull.
//!
//! The cavity then holds all ghosts, with their infinite vertex inside, and is not a tree: it is found by
//! marks, and its k boundary edges take the records of its k triangles. This happens once.

use super::kernel::Kernel;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push};
use crate::mesh::plane::{Code, half_edge, next, prev, triangle};

impl Kernel<'_> {
    /// Whether `p`, in conflict with the ghost `seed`, is in conflict with all of them. The ghosts
    /// visited are those that its insertion removes, and one more.
    pub(super) fn closes(&mut self, p: u32, seed: u32) -> Result<bool> {
        let start = self.infinite_corner(seed);
        let mut g = self.mesh.after(start);
        while g != start {
            if !self.conflicts(triangle(g), p)? {
                return Ok(false);
            }
            g = self.mesh.after(g);
        }
        Ok(true)
    }

    /// Inserts `p`, which is in conflict with all ghosts, one of which is `seed`. Returns a new
    /// triangle.
    pub(super) fn close(&mut self, p: u32, seed: u32) -> Result<u32> {
        let (cavity, rim) = self.cavity(p, seed)?;
        let broken = || Error::Internal("the hull on the sphere does not close".into());
        if cavity.len() != rim.len() || rim.is_empty() {
            return Err(broken());
        }
        let mut ends: Vec<(u32, u32)> = Vec::new();
        for (&t, &across) in cavity.iter().zip(&rim) {
            // Seen from p, the edge has the opposite direction of that in the triangle beyond.
            let (from, to) = (
                self.mesh.vertex(prev(across)),
                self.mesh.vertex(next(across)),
            );
            self.mesh.set(t, [p, from, to]);
            self.mesh.link(across, half_edge(t, 0));
            push(&mut ends, (from, t))?;
        }
        ends.sort_unstable();
        for &t in &cavity {
            let to = self.mesh.vertex(half_edge(t, 2));
            let at = ends
                .binary_search_by_key(&to, |end| end.0)
                .map_err(|_| broken())?;
            self.mesh.link(half_edge(t, 1), half_edge(ends[at].1, 2));
        }
        self.is_closed = true;
        Ok(cavity[0])
    }

    /// The triangles in conflict with `p`, and the half-edges beyond their boundary.
    fn cavity(&mut self, p: u32, seed: u32) -> Result<(Vec<u32>, Vec<Code>)> {
        let mut seen = filled(self.mesh.taken().end as usize, false)?;
        let (mut cavity, mut rim, mut next) = (Vec::new(), Vec::new(), 0);
        seen[seed as usize] = true;
        push(&mut cavity, seed)?;
        // Each triangle enters the cavity once.
        while let Some(&t) = cavity.get(next) {
            next += 1;
            for across in self.mesh.opposites(t) {
                let beyond = triangle(across);
                if seen[beyond as usize] {
                    continue;
                }
                if self.conflicts(beyond, p)? {
                    seen[beyond as usize] = true;
                    push(&mut cavity, beyond)?;
                } else {
                    push(&mut rim, across)?;
                }
            }
        }
        Ok((cavity, rim))
    }
}
