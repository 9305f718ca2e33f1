//! From the mesh to rows, with a check of all guarantees.

use std::collections::BTreeSet;

use delone_predicates::{Sign, lexicographic, orient3d};

use super::mesh::{Corners, NONE, ascending, internal, number as rank};
use super::task::{Counts, Recovered, Task};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};

/// The rows of the input.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    /// Of each vertex.
    pub points: &'a [u32],
    /// Of each face.
    pub faces: &'a [u32],
}

impl Rows<'_> {
    /// The result where no point fits between faces, which are given by their numbers.
    pub fn crowded(self, counts: Counts, faces: Vec<u32>) -> Recovered {
        let row = |f: u32| self.faces[f as usize];
        Recovered {
            points: Vec::new(),
            tetrahedra: Vec::new(),
            neighbors: Vec::new(),
            walls: Vec::new(),
            counts,
            crowded: faces.into_iter().map(row).collect(),
        }
    }
}

impl Work<'_> {
    /// The face of the input of which each face of the mesh is a part, [`NONE`] if there is none.
    pub fn walls(&mut self) -> Result<Vec<[u32; 4]>> {
        let mut walls = filled(self.mesh.corners.len(), [NONE; 4])?;
        for t in 0..self.mesh.corners.len() as u32 {
            self.pace.spend(1)?;
            if !self.mesh.is_there(t) {
                continue;
            }
            for k in 0..4 {
                let u = self.mesh.across[t as usize][k];
                // From one side for both.
                if u != NONE && u < t {
                    continue;
                }
                if let Some(f) = self.locked_faces.get(ascending(self.mesh.face(t, k))) {
                    walls[t as usize][k] = f;
                    if let Some(i) = self.mesh.back(t, k) {
                        walls[u as usize][i] = f;
                    }
                }
            }
        }
        Ok(walls)
    }

    /// The tetrahedra that the far vertices reach without crossing a face of the input.
    pub fn outside(&self, walls: &[[u32; 4]]) -> Result<Vec<bool>> {
        let mut out = filled(self.mesh.corners.len(), false)?;
        let mut open = vec![self.mesh.at[self.far as usize]];
        out[open[0] as usize] = true;
        while let Some(t) = open.pop() {
            for (&u, &wall) in self.mesh.across[t as usize].iter().zip(&walls[t as usize]) {
                if u != NONE && wall == NONE && !out[u as usize] {
                    out[u as usize] = true;
                    push(&mut open, u)?;
                }
            }
        }
        Ok(out)
    }

    /// Checks that each tetrahedron is positive or has a point of wide coordinates outside, that
    /// faces pair up, and that each face of the input is present.
    ///
    /// Positive tetrahedra that are linked in pairs across each face, from both sides of it, cover
    /// the points off their faces equally often: a path from one point to another changes one
    /// tetrahedron for one other at a time. Where only the faces of the far tetrahedron have no
    /// second side, that is once. So nothing overlaps, and no face has more than two sides.
    pub fn verify(&mut self, walls: &[[u32; 4]], out: &[bool]) -> Result<()> {
        let mut there = filled(self.faces.len(), false)?;
        let mut outer = Vec::new();
        for t in 0..self.mesh.corners.len() as u32 {
            self.pace.spend(1)?;
            let v = self.mesh.corners[t as usize];
            if v[0] == NONE {
                continue;
            }
            // Positive with the exact points, and inside also with the doubles in their place.
            if !self.mesh.points.positive(v) {
                return Err(internal("a tetrahedron is not positive"));
            }
            let plain = v.iter().all(|&v| self.mesh.points.is_double(v));
            if !plain && !out[t as usize] {
                let [a, b, c, d] = v.map(|v| self.mesh.points.near(v));
                if orient3d(a, b, c, d) != Sign::Positive {
                    return Err(internal("a tetrahedron of doubles is not positive"));
                }
            }
            // Faces are linked from both sides, and the given faces are present.
            for (k, &f) in walls[t as usize].iter().enumerate() {
                if self.mesh.across[t as usize][k] == NONE {
                    push(&mut outer, ascending(self.mesh.face(t, k)))?;
                } else if !self.is_linked(t, k) {
                    return Err(internal("two sides of a face do not match"));
                }
                if f != NONE && self.faces[f as usize] == ascending(self.mesh.face(t, k)) {
                    there[f as usize] = true;
                }
            }
        }
        outer.sort_unstable();
        let expected =
            [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].map(|f| f.map(|i| self.far + i));
        if outer != expected {
            return Err(internal("a face has no other side"));
        }
        if there.contains(&false) {
            return Err(internal("a face of the input is not in the mesh"));
        }
        Ok(())
    }

    /// Whether the tetrahedron behind a face links back, and has the same face from the other side.
    fn is_linked(&self, t: u32, k: usize) -> bool {
        let u = self.mesh.across[t as usize][k];
        let face = self.mesh.face(t, k);
        let back = (0..4).find(|&i| !face.contains(&self.mesh.corners[u as usize][i]));
        back.is_some_and(|i| {
            let other = self.mesh.face(u, i);
            self.mesh.across[u as usize][i] == t
                && ascending(other) == ascending(face)
                && odd(other) != odd(face)
        })
    }

    /// The result in rows, without the outside.
    pub fn export(
        self,
        task: Task,
        rows: Rows,
        walls: &[[u32; 4]],
        out: &[bool],
    ) -> Result<Recovered> {
        let mesh = &self.mesh;
        let inside = |t: &u32| mesh.is_there(*t) && !out[*t as usize];
        let kept = (0..mesh.corners.len() as u32).filter(inside);
        let mut order: Vec<(u128, u32)> = with_room(mesh.corners.len())?;
        let mut added = BTreeSet::new();
        for t in kept {
            let v = mesh.corners[t as usize];
            added.extend(v.into_iter().filter(|&v| v >= self.given));
            order.push((0, t));
        }
        let mut added: Vec<u32> = added.into_iter().collect();
        added.sort_unstable_by(|&p, &q| lexicographic(mesh.points.near(p), mesh.points.near(q)));
        // The number of each vertex in sorted order, and its row.
        let mut place = filled(mesh.points.len(), NONE)?;
        let sorted: Vec<u32> = (0..self.far).chain(added.iter().copied()).collect();
        for (i, &v) in (0..).zip(&sorted) {
            place[v as usize] = i;
        }
        let n = self.far;
        let row = |i: u32| if i < n { rows.points[i as usize] } else { i };
        for (key, t) in &mut order {
            *key = rank(rotated(
                mesh.corners[*t as usize].map(|v| place[v as usize]),
            ));
        }
        order.sort_unstable();
        let mut number = filled(mesh.corners.len() + 1, -1)?;
        for (i, (_, t)) in (0..).zip(&order) {
            number[*t as usize] = i;
        }
        let mut points = with_room(task.points.len() + added.len())?;
        points.extend_from_slice(task.points);
        points.extend(added.iter().map(|&v| mesh.points.near(v)));
        let mut made = Recovered {
            points,
            tetrahedra: with_room(order.len())?,
            neighbors: with_room(order.len())?,
            walls: with_room(order.len())?,
            counts: self.counts,
            crowded: Vec::new(),
        };
        for (key, t) in &order {
            let v = [key >> 96, key >> 64, key >> 32, *key].map(|i| i as u32);
            made.tetrahedra.push(v.map(|i| row(i) as i32));
            let corner = v.map(|i| mesh.corner(*t, sorted[i as usize]).unwrap_or(0));
            made.neighbors
                .push(corner.map(|k| match mesh.across[*t as usize][k] {
                    NONE => -1,
                    u => number[u as usize],
                }));
            made.walls.push(corner.map(|k| match walls[*t as usize][k] {
                NONE => -1,
                f => rows.faces[f as usize] as i32,
            }));
        }
        Ok(made)
    }
}

/// Whether three vertices are an odd permutation of their ascending order.
fn odd([a, b, c]: [u32; 3]) -> bool {
    (a > b) ^ (b > c) ^ (a > c)
}

/// The even permutation of corners with the smallest vertex first and the next one second.
fn rotated(v: Corners) -> Corners {
    let mut order = v;
    order.sort_unstable();
    let [a, b, c, d] = order;
    let swaps = (0..4).flat_map(|j| (0..j).map(move |i| (i, j)));
    if swaps.filter(|&(i, j)| v[i] > v[j]).count() % 2 == 0 {
        [a, b, c, d]
    } else {
        [a, b, d, c]
    }
}
