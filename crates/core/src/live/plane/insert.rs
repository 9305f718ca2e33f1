//! Insertion: the cavity of a point is emptied and filled with a star (see `delaunay::plane::cavity`).

use delone_predicates::Point2;

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::mesh::plane::{half_edge, next, prev, triangle};

impl Mesh {
    /// Inserts vertex `v`, whose place is in triangle or ghost `seed`. If memory is refused, nothing
    /// has changed.
    pub fn insert(&mut self, v: u32, seed: u32) -> Result<()> {
        let p = self.at(v);
        self.reserve_two()?;
        let lost = self.empty(p, seed)?;
        for _ in 0..2 {
            let t = self.take_record()?;
            self.dead.push(t); // `empty` has made room.
        }
        self.fill_star(v);
        let gained = 2 * u32::from(self.rim.iter().any(|&(_, u)| u == INFINITE));
        self.counts.simplices = self.counts.simplices + 2 + lost - gained;
        self.counts.vertices += 1;
        Ok(())
    }

    /// Lists the triangles that conflict with `p` in `dead`, and the edges around them,
    /// counter-clockwise, in `rim`. Returns the number of ghosts among the triangles.
    fn empty(&mut self, p: Point2, seed: u32) -> Result<u32> {
        self.rim.clear();
        self.stack.clear();
        self.dead.clear();
        let mut ghosts = 0;
        let mut add = |mesh: &mut Self, t: u32| {
            ghosts += u32::from(mesh.corners(t).contains(&INFINITE));
            push(&mut mesh.dead, t)
        };
        add(self, seed)?;
        let [a, b, c] = self.corners(seed);
        let e = half_edge(seed, 0);
        for (edge, start) in [(e + 1, c), (e, b), (e + 2, a)] {
            let beyond = self.opposite(edge);
            push(&mut self.stack, (beyond, start))?;
        }
        while let Some((across, start)) = self.stack.pop() {
            let is_hidden = self.has_segments && self.mark(across) != 0;
            if is_hidden || !self.conflicts(triangle(across), p) {
                push(&mut self.rim, (across, start))?;
                continue;
            }
            //        w            Seen from p the edge runs from u to v. If the triangle
            //      /   \          beyond it is in conflict, its edges u w and w v replace
            //     v ---- u        u v.
            //         p
            add(self, triangle(across))?;
            let w = self.vertex(across);
            let [wv, uw] = [self.opposite(prev(across)), self.opposite(next(across))];
            push(&mut self.stack, (wv, w))?;
            push(&mut self.stack, (uw, start))?;
        }
        self.work += self.dead.len();
        // For each edge around the cavity a triangle, what is beyond, and a vertex.
        self.room(3 * self.rim.len())?;
        crate::base::memory::make_room(&mut self.dead, 2)?;
        Ok(ghosts)
    }

    /// Fills the cavity with the star of `v`; there are as many dead records as edges around it.
    fn fill_star(&mut self, v: u32) {
        let count = self.rim.len();
        for i in 0..count {
            let (after, before) = ((i + 1) % count, (i + count - 1) % count);
            let t = self.dead[i];
            let ((across, from), to) = (self.rim[i], self.rim[after].1);
            let [left, right] = [
                half_edge(self.dead[after], 2),
                half_edge(self.dead[before], 1),
            ];
            *self.records.get_mut(t as usize) = [v, from, to, 0, across, left, right, 0];
            if self.has_segments {
                let mark = self.mark(across);
                self.set_side(half_edge(t, 0), mark);
            }
            self.set_opposite(across, half_edge(t, 0));
            self.touch(from, half_edge(t, 1));
        }
        self.last = self.dead[0];
        self.touch(v, half_edge(self.last, 0));
    }
}
