//! Marks on edges: parts of segments, which remain edges.
//!
//! The last word of a record has two bits for each edge, the same on both of its sides: whether a
//! segment runs along it, and whether one does that is not straight (see `segments::Crossed`).

use delone_predicates::{Sign, lexicographic, orient2d};

use super::mesh::{INFINITE, Mesh};
use super::shift::FLIP;
use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::mesh::plane::{Code, next, prev, triangle};

/// The bits of an edge that is part of a segment.
pub const STRAIGHT: u32 = 1;
/// The bits of an edge that is part of a segment that is not straight.
pub const CROSSED: u32 = 1 | 1 << 3;

/// Flips for each edge that a segment crosses, squared, before its insertion is given up.
const PATIENCE: usize = 64;

/// How far the insertion of a segment came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// To this vertex: the next one on the segment.
    Vertex(u32),
    /// A marked edge crosses it.
    Blocked,
}

/// What comes first on the way from a vertex to another.
enum Way {
    /// A vertex, the other one at last.
    Vertex(u32),
    /// A marked edge.
    Marked(Code),
}

impl Mesh {
    /// The mark of an edge: 0, [`STRAIGHT`] or [`CROSSED`].
    #[inline]
    pub fn mark(&self, e: Code) -> u32 {
        self.records[triangle(e) as usize][7] >> (e & 3) & CROSSED
    }

    /// Sets the mark on one side of an edge.
    #[inline]
    pub fn set_side(&mut self, e: Code, mark: u32) {
        let k = e & 3;
        let old = self.records[triangle(e) as usize][7];
        let new = old & !(CROSSED << k) | mark << k;
        if new != old {
            self.records.get_mut(triangle(e) as usize)[7] = new;
        }
    }

    /// Sets the mark of an edge.
    pub fn set_mark(&mut self, e: Code, mark: u32) {
        let o = self.opposite(e);
        self.set_side(e, mark);
        self.set_side(o, mark);
    }

    /// The edge from `u` to `v`, if there is one.
    pub fn edge(&self, u: u32, v: u32) -> Option<Code> {
        let first = self.sites[u as usize].near;
        let mut corner = first;
        loop {
            if self.vertex(next(corner)) == v {
                return Some(prev(corner));
            }
            corner = self.turn(corner);
            if corner == first {
                return None;
            }
        }
    }

    /// Marks the edge from `u` to `v`, which exists.
    pub fn add_mark(&mut self, u: u32, v: u32, mark: u32) -> Result<()> {
        let e = self.edge(u, v).ok_or_else(|| missing(u, v))?;
        self.room(2)?;
        let old = self.mark(e);
        self.set_mark(e, old | mark);
        Ok(())
    }

    /// Removes the mark of the edge from `u` to `v`, which exists, and flips.
    pub fn remove_mark(&mut self, u: u32, v: u32) -> Result<()> {
        let e = self.edge(u, v).ok_or_else(|| missing(u, v))?;
        self.room(2)?;
        self.set_mark(e, 0);
        self.stack.clear();
        push(&mut self.stack, (e, 0))?;
        self.legalize()?;
        Ok(())
    }

    /// The marked edges at `v`: the other end of each, and its mark.
    pub fn marked_at(&self, v: u32) -> Result<Vec<(u32, u32)>> {
        let mut found = Vec::new();
        let first = self.sites[v as usize].near;
        let mut corner = first;
        loop {
            let mark = self.mark(prev(corner));
            if mark != 0 {
                push(&mut found, (self.vertex(next(corner)), mark))?;
            }
            corner = self.turn(corner);
            if corner == first {
                return Ok(found);
            }
        }
    }

    /// Makes the segment from `a` to `b`, as far as the next vertex on it, an edge.
    pub fn reach(&mut self, a: u32, b: u32) -> Result<Reach> {
        let mut crossed = Vec::new();
        let end = match self.crossed(a, b, &mut crossed)? {
            Way::Vertex(end) => end,
            Way::Marked(_) => return Ok(Reach::Blocked),
        };
        self.stack.clear();
        let budget = PATIENCE * (1 + crossed.len() * crossed.len());
        let mut steps = 0;
        // Each edge that crosses is flipped as soon as its quadrilateral is convex.
        let mut first = 0;
        let mut flipped = Vec::new();
        while first < crossed.len() {
            steps += 1;
            if steps > budget {
                let message = format!("no flips make an edge of {a} {end}");
                return Err(Error::Internal(message));
            }
            let [u, w] = crossed[first];
            first += 1;
            let e = self.edge(u, w).ok_or_else(|| missing(u, w))?;
            let [p, q] = [self.vertex(e), self.vertex(self.opposite(e))];
            let [c, d, r, s] = [p, q, u, w].map(|v| self.at(v));
            let convex = orient2d(c, r, d) == Sign::Positive && orient2d(d, s, c) == Sign::Positive;
            if !convex {
                push(&mut crossed, [u, w])?;
                continue;
            }
            self.room(FLIP)?;
            self.flip(e);
            let [from, to] = [self.at(a), self.at(end)];
            let [left, right] = [p, q].map(|v| orient2d(from, to, self.at(v)));
            let crosses = left != right && !left.is_zero() && !right.is_zero();
            push(if crosses { &mut crossed } else { &mut flipped }, [p, q])?;
        }
        for [u, v] in flipped {
            let is_segment = [u, v] == [a, end] || [v, u] == [a, end];
            if let Some(e) = self.edge(u, v).filter(|_| !is_segment) {
                push(&mut self.stack, (e, 0))?;
            }
        }
        self.add_mark(a, end, STRAIGHT)?;
        self.legalize()?;
        Ok(Reach::Vertex(end))
    }

    /// The first marked edge that the segment from `a` to `b` crosses.
    pub fn blocker(&self, mut a: u32, b: u32) -> Result<Option<Code>> {
        let mut crossed = Vec::new();
        while a != b {
            match self.crossed(a, b, &mut crossed)? {
                Way::Vertex(next) => a = next,
                Way::Marked(e) => return Ok(Some(e)),
            }
            crossed.clear();
        }
        Ok(None)
    }

    /// Lists the edges that the segment from `a` to `b` crosses, up to the next vertex on it or the
    /// first marked edge.
    fn crossed(&self, a: u32, b: u32, crossed: &mut Vec<[u32; 2]>) -> Result<Way> {
        let [p, q] = [self.at(a), self.at(b)];
        let mut corner = self.sites[a as usize].near;
        let first = corner;
        let mut e = loop {
            let [u, w] = self.ends(corner);
            if u == b {
                return Ok(Way::Vertex(b));
            }
            if u != INFINITE {
                let side = orient2d(p, q, self.at(u));
                // On the ray toward b, and not behind a.
                if side.is_zero() && lexicographic(p, self.at(u)) == lexicographic(p, q) {
                    return Ok(Way::Vertex(u));
                }
                if side == Sign::Negative
                    && w != INFINITE
                    && w != b
                    && orient2d(p, q, self.at(w)) == Sign::Positive
                {
                    break corner;
                }
            }
            corner = self.turn(corner);
            if corner == first {
                return Err(Error::Internal(format!("no triangle of {a} faces {b}")));
            }
        };
        loop {
            if self.mark(e) != 0 {
                return Ok(Way::Marked(e));
            }
            push(crossed, self.ends(e))?;
            let o = self.opposite(e);
            let x = self.vertex(o);
            if x == b {
                return Ok(Way::Vertex(b));
            }
            // Beyond e = u w, with u on the right, the edges are u x and x w.
            e = match orient2d(p, q, self.at(x)) {
                Sign::Zero => return Ok(Way::Vertex(x)),
                Sign::Positive => next(o),
                Sign::Negative => prev(o),
            };
        }
    }
}

fn missing(u: u32, v: u32) -> Error {
    Error::Internal(format!("no edge joins {u} and {v}"))
}
