//! Movement: a vertex is moved in its star, and flips repair what is not canonical.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::{clear_with_room, push};
use crate::mesh::plane::{Code, half_edges, next, prev, triangle};

/// Records and vertices that a flip changes, with some to spare.
pub const FLIP: usize = 16;

impl Mesh {
    /// Moves vertex `v`, which is in the mesh, to `p` if its star keeps its orientation, and flips until
    /// the triangulation is canonical. Otherwise, or at the hull, nothing changes.
    pub fn shift(&mut self, v: u32, p: Point2) -> Result<bool> {
        self.gather(v)?;
        let k = self.rim.len();
        for i in 0..k {
            let [a, b] = [self.rim[i].1, self.rim[(i + 1) % k].1];
            // At the vertex at infinity the orientation is zero.
            if orient2d(p, self.at(a), self.at(b)) != Sign::Positive {
                return Ok(false);
            }
        }
        clear_with_room(&mut self.stack, 8 * k)?;
        self.room(1)?;
        self.sites.get_mut(v as usize).at = p;
        for i in 0..k {
            // The edge around the star, and the one to its end, by their codes in the star.
            let e = self.opposite(self.rim[i].0);
            self.stack.push((e, 0));
            self.stack.push((next(e), 0));
        }
        self.work += k;
        self.legalize()?;
        Ok(true)
    }

    /// Flips edges, starting from those on the stack, until none must be flipped. Where memory for
    /// the stack is refused, all edges are searched instead. Fails only in edits that may be
    /// undone.
    pub fn legalize(&mut self) -> Result<()> {
        let mut is_missing = false;
        while let Some((e, _)) = self.stack.pop() {
            if self.must_flip(e) {
                self.room(FLIP)?;
                let other = self.flip(e);
                for outer in [e, prev(e), other, next(other)] {
                    is_missing |= push(&mut self.stack, (outer, 0)).is_err();
                }
            }
        }
        while is_missing {
            is_missing = false;
            for t in 0..self.records.len() as u32 {
                for e in half_edges(t) {
                    if self.is_live(t) && self.must_flip(e) {
                        self.room(FLIP)?;
                        self.flip(e);
                        is_missing = true;
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether the perturbed circle of the triangle of `e`, which is not marked, contains the corner
    /// beyond it.
    fn must_flip(&self, e: Code) -> bool {
        if self.mark(e) != 0 {
            return false;
        }
        let o = self.opposite(e);
        let [u, v] = [self.vertex(next(e)), self.vertex(prev(e))];
        let [p, q] = [self.vertex(e), self.vertex(o)];
        if p == INFINITE || q == INFINITE || u == INFINITE || v == INFINITE {
            return false;
        }
        let [a, b, c, d] = [self.at(u), self.at(v), self.at(p), self.at(q)];
        incircle_canonical(a, b, c, d) == Sign::Positive
    }

    /// Flips the edge `e` (see `mesh::plane::flip`), which is not marked.
    pub fn flip(&mut self, e: Code) -> Code {
        let o = self.opposite(e);
        let (p, q) = (self.vertex(e), self.vertex(o));
        let (beyond_uq, beyond_vp) = (self.opposite(next(o)), self.opposite(next(e)));
        for (corner, v) in [(prev(e), q), (prev(o), p)] {
            self.records.get_mut(triangle(corner) as usize)[(corner & 3) as usize] = v;
        }
        self.link(e, beyond_uq);
        self.link(o, beyond_vp);
        self.link(next(e), next(o));
        if self.has_segments {
            let marks = [(e, self.mark(beyond_uq)), (o, self.mark(beyond_vp))];
            for (e, mark) in marks.into_iter().chain([(next(e), 0), (next(o), 0)]) {
                self.set_side(e, mark);
            }
        }
        for corner in [e, next(e), prev(e), o, next(o), prev(o)] {
            let v = self.vertex(corner);
            self.touch(v, corner);
        }
        self.work += 1;
        prev(o)
    }
}
