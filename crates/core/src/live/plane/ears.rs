//! Fills the hole that a vertex leaves among segments: first with any triangles, then by flips.
//!
//! Segments may hide corners of the hole from its edges, so the perturbed circles of all corners do not
//! decide (compare `remove`). The hole is filled with triangles that are cut off at its corners, which
//! is possible because all of it is visible from the removed vertex, and flips make them canonical.
//!
//! A corner b between a and c is cut off if it is convex and the removed vertex v is on the left of
//! a c or on it: the rest is visible from v again. There is one as long as there are more than
//! three corners: the angles at the corners of a polygon with k of them add up to (k - 2) pi, and
//! those at v to 2 pi. At the hull all of the hole is on one side of v, so only convexity is
//! required; where no corner is convex any more, the chain is the new hull.

use delone_predicates::{Point2, Sign, orient2d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::mesh::plane::{Code, half_edge, half_edges, next, prev};

impl Mesh {
    /// Fills the hole in `rim`, which a vertex at `p` has left, with records in `dead`, two of which
    /// are left over at its end. Returns the number of ghosts.
    pub fn fill_with_ears(&mut self, p: Point2) -> Result<u32> {
        let mut ring = std::mem::take(&mut self.rim);
        let made = self.cut_ears(&mut ring, p);
        self.rim = ring;
        let (made, ghosts) = made?;
        self.last = self.dead[0];
        self.stack.clear();
        for i in 0..made {
            let t = self.dead[i];
            for e in half_edges(t) {
                push(&mut self.stack, (e, 0))?;
            }
        }
        self.legalize()?;
        Ok(ghosts)
    }

    /// Cuts off corners until there are none. Returns how many records are used, and how many of them
    /// are ghosts.
    fn cut_ears(&mut self, ring: &mut Vec<(Code, u32)>, p: Point2) -> Result<(usize, u32)> {
        let is_open = ring.last().is_some_and(|&(_, v)| v == INFINITE);
        let outer = if is_open { ring.pop() } else { None };
        let mut made = 0;
        let mut i = usize::from(is_open);
        let mut idle = 0;
        // Where the hole is open, the last corner of the chain is not an ear, and its edge leads outward.
        while ring.len() > if is_open { 2 } else { 3 } {
            let n = ring.len();
            if is_open && i + 1 >= n {
                break;
            }
            // Corner i is an ear if it turns left and the triangle does not cover the removed
            // vertex.
            let (h, j) = ((i + n - 1) % n, (i + 1) % n);
            let [a, b, c] = [h, i, j].map(|k| self.at(ring[k].1));
            let is_ear = orient2d(a, b, c) == Sign::Positive
                && (is_open || orient2d(a, c, p) != Sign::Negative);
            if !is_ear {
                idle += 1;
                if !is_open && idle > n {
                    return Err(Error::Internal("a hole has no ear".into()));
                }
                i = if is_open { i + 1 } else { j };
                continue;
            }
            idle = 0;
            // The ear becomes a triangle, whose third edge takes the place of the corner in the ring.
            let t = self.dead[made];
            made += 1;
            let [(ab, u), (bc, v), (_, w)] = [ring[h], ring[i], ring[j]];
            self.put(t, [u, v, w], [(half_edge(t, 2), ab), (half_edge(t, 0), bc)]);
            ring[h].0 = half_edge(t, 1);
            ring.remove(i);
            // The corner before may be one now.
            i = match (is_open, i) {
                (true, 1) => 1,
                (true, _) => i - 1,
                (false, _) => (i + n - 2) % (n - 1),
            };
        }
        let Some((last, _)) = outer else {
            let t = self.dead[made];
            let [(ab, u), (bc, v), (ca, w)] = [ring[0], ring[1], ring[2]];
            self.put(t, [u, v, w], [(half_edge(t, 2), ab), (half_edge(t, 0), bc)]);
            self.join_edge(half_edge(t, 1), ca);
            return Ok((made + 1, 0));
        };
        // Each edge of the chain gets a ghost u v infinite; they are joined in a row.
        let edges = ring.len() - 1;
        let mut before = last;
        for k in 0..edges {
            let t = self.dead[made];
            made += 1;
            let [(uv, u), (_, v)] = [ring[k], ring[k + 1]];
            self.put(
                t,
                [u, v, INFINITE],
                [(half_edge(t, 2), uv), (half_edge(t, 1), before)],
            );
            before = half_edge(t, 0);
        }
        self.join_edge(before, ring[edges].0);
        Ok((made, edges as u32))
    }

    /// Makes `t` the triangle of three vertices, and joins edges of it, with the marks beyond them.
    fn put(&mut self, t: u32, corners: [u32; 3], edges: [(Code, Code); 2]) {
        let [a, b, c] = corners;
        *self.records.get_mut(t as usize) = [a, b, c, 0, 0, 0, 0, 0];
        for (e, beyond) in edges {
            self.join_edge(e, beyond);
        }
        for (e, v) in (half_edge(t, 0)..).zip(corners) {
            self.touch(v, e);
        }
    }

    /// Makes `e` and `f` the two sides of one edge, with the mark of `f`.
    fn join_edge(&mut self, e: Code, f: Code) {
        let mark = self.mark(f);
        self.link(e, f);
        self.set_side(e, mark);
    }

    /// The two vertices of an edge, from the end of which its triangle is on the left.
    pub fn ends(&self, e: Code) -> [u32; 2] {
        [self.vertex(next(e)), self.vertex(prev(e))]
    }
}
