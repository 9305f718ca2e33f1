//! Removal: the star of a vertex is emptied, and the hole is filled from edge to edge.
//!
//! The triangle at an edge of the hole is spanned by the corner whose perturbed circle through the edge
//! contains no other corner; if no corner is on the inner side, the edge is on the hull (see the head of
//! `live`). This takes O(k^2) tests for k neighbors, six on average. Where k is so large that this
//! exceeds a rebuild, the caller rebuilds: all degrees add up to less than 6 n.

use delone_predicates::{Sign, incircle_canonical, orient2d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::{Error, Result};
use crate::base::memory::{make_room, push};
use crate::live::rows::NONE;
use crate::live::store::Removed;
use crate::mesh::plane::{Code, half_edge, next, triangle};

/// Tests for each vertex of the mesh that cost as much as a rebuild, and how many are always
/// allowed.
const HUB: usize = 16;
const HUB_LEAST: usize = 1 << 16;

/// A part of a hole that waits: its range in `rim`, its first edge, and the code beyond its second.
#[derive(Clone, Copy)]
struct Part {
    start: usize,
    end: usize,
    head: (Code, u32),
    second: Code,
}

impl Mesh {
    /// Removes vertex `v`, where no segment is, from the mesh; its site stays. If memory is refused,
    /// nothing has changed unless there are segments.
    /// With `always`, high degrees are not a reason to refuse.
    pub fn unlink(&mut self, v: u32, always: bool) -> Result<Removed> {
        self.gather(v)?;
        let k = self.rim.len();
        if !always && k * k > HUB * self.counts.vertices as usize + HUB_LEAST {
            return Ok(Removed::Hub);
        }
        let lost = match self.rim.last() {
            Some(&(_, INFINITE)) => 2,
            _ => 0,
        };
        if lost > 0 && k as u32 - 2 == self.counts.simplices && self.is_line() {
            return Ok(Removed::Flat);
        }
        // For each edge of the hole a triangle, what is beyond, and a vertex.
        self.room(3 * k)?;
        let gained = if self.has_segments {
            self.fill_with_ears(self.at(v))?
        } else {
            let mut parts = Vec::new();
            make_room(&mut parts, if k > 3 { k } else { 0 })?;
            self.fill_hole(&mut parts)?
        };
        for t in [self.dead.pop(), self.dead.pop()].into_iter().flatten() {
            self.free_record(t);
        }
        self.sites.get_mut(v as usize).near = NONE;
        self.counts.simplices = self.counts.simplices + lost - gained - 2;
        self.counts.vertices -= 1;
        self.work += k;
        Ok(Removed::Done)
    }

    /// Lists the triangles around `v` in `dead`, and the edges around them, counter-clockwise, in
    /// `rim`; if there is one from the vertex at infinity, it is the last.
    pub fn gather(&mut self, v: u32) -> Result<()> {
        self.rim.clear();
        self.dead.clear();
        let first = self.sites[v as usize].near;
        let mut corner = first;
        let mut infinite = None;
        loop {
            let start = self.vertex(next(corner));
            if start == INFINITE {
                infinite = Some(self.rim.len());
            }
            let beyond = self.opposite(corner);
            push(&mut self.rim, (beyond, start))?;
            push(&mut self.dead, triangle(corner))?;
            corner = self.turn(corner);
            if corner == first {
                break;
            }
        }
        if let Some(i) = infinite {
            self.rim.rotate_left(i + 1);
        }
        Ok(())
    }

    /// Whether the finite corners of the hole are on one line.
    fn is_line(&self) -> bool {
        let [(_, a), .., (_, b), _] = self.rim[..] else {
            return true;
        };
        let [a, b] = [a, b].map(|v| self.at(v));
        let finite = &self.rim[..self.rim.len() - 1];
        finite
            .iter()
            .all(|&(_, v)| orient2d(a, b, self.at(v)).is_zero())
    }

    /// Fills the hole in `rim` with records in `dead`, two of which are left over at its end. Returns
    /// the number of ghosts.
    fn fill_hole(&mut self, parts: &mut Vec<Part>) -> Result<u32> {
        let mut ghosts = 0;
        let mut made = 0;
        let (mut start, mut end) = (0, self.rim.len());
        loop {
            //          c              The triangle at the first edge a b splits the rest: b .. c
            //       /     \           with the edge c b, and a c .. with what is left.
            //      a ----- b
            let i = self.apex(start, end)?;
            let t = self.dead[made];
            made += 1;
            let [(ab, a), (bc, b), (_, c)] = [self.rim[start], self.rim[start + 1], self.rim[i]];
            ghosts += u32::from(c == INFINITE);
            *self.records.get_mut(t as usize) = [a, b, c, 0, 0, 0, 0, 0];
            self.link(half_edge(t, 2), ab);
            for (e, v) in (half_edge(t, 0)..).zip([a, b, c]) {
                self.touch(v, e);
            }
            if i + 1 == end {
                let ca = self.rim[i].0;
                self.link(half_edge(t, 1), ca);
            } else {
                parts.push(Part {
                    start: i - 1,
                    end,
                    head: (half_edge(t, 1), a),
                    second: self.rim[i].0,
                });
            }
            if i > start + 2 {
                self.rim[i].0 = half_edge(t, 0);
                (start, end) = (start + 1, i + 1);
                continue;
            }
            self.link(half_edge(t, 0), bc);
            let Some(part) = parts.pop() else {
                break;
            };
            (start, end) = (part.start, part.end);
            self.rim[start] = part.head;
            self.rim[start + 1].0 = part.second;
        }
        self.last = self.dead[0];
        Ok(ghosts)
    }

    /// The corner of the triangle at the first edge of a part of the hole.
    fn apex(&self, start: usize, end: usize) -> Result<usize> {
        if end == start + 3 {
            return Ok(start + 2);
        }
        let [a, b] = [self.at(self.rim[start].1), self.at(self.rim[start + 1].1)];
        let mut best = None;
        for i in start + 2..end {
            let v = self.rim[i].1;
            let p = self.at(v);
            if v == INFINITE || orient2d(a, b, p) != Sign::Positive {
                continue;
            }
            let lower = |&(_, c)| incircle_canonical(a, b, c, p) == Sign::Positive;
            if best.as_ref().is_none_or(lower) {
                best = Some((i, p));
            }
        }
        match best {
            Some((i, _)) => Ok(i),
            None if self.rim[end - 1].1 == INFINITE => Ok(end - 1),
            None => Err(Error::Internal("an edge of a hole sees no corner".into())),
        }
    }
}
