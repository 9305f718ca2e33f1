//! From the mesh to rows, with a check of everything that is promised.

use std::collections::BTreeSet;

use delone_predicates::{Sign, lexicographic, orient3d};

use super::mesh::{Corners, FACES, NONE, ascending, internal, number};
use super::task::{Recovered, Task};
use super::work::Work;
use crate::error::Result;
use crate::memory::{filled, push, with_room};

impl Work<'_> {
    /// The tetrahedra that the far vertices reach without crossing a face of the input.
    pub fn outside(&mut self) -> Result<Vec<bool>> {
        let mut out = filled(self.mesh.corners.len(), false)?;
        let mut open = vec![self.mesh.at[self.far as usize]];
        out[open[0] as usize] = true;
        while let Some(t) = open.pop() {
            for k in 0..4 {
                let u = self.mesh.across[t as usize][k];
                if u == NONE || out[u as usize] {
                    continue;
                }
                if !self
                    .locked_faces
                    .contains_key(&ascending(self.mesh.face(t, k)))
                {
                    out[u as usize] = true;
                    push(&mut open, u)?;
                }
            }
        }
        Ok(out)
    }

    /// Checks that each tetrahedron is positive or has a point of wide coordinates outside, that
    /// faces pair up, and that each face of the input is there.
    pub fn verify(&mut self, out: &[bool]) -> Result<()> {
        let mut sides: Vec<u128> = with_room(4 * self.mesh.corners.len())?;
        for (&v, &is_out) in self.mesh.corners.iter().zip(out) {
            self.pace.spend(1)?;
            if v[0] == NONE {
                continue;
            }
            if !self.mesh.points.positive(v) {
                return Err(internal("a tetrahedron is not positive"));
            }
            if !is_out {
                let [a, b, c, d] = v.map(|v| self.mesh.points.near(v));
                if orient3d(a, b, c, d) != Sign::Positive {
                    return Err(internal("a tetrahedron of doubles is not positive"));
                }
            }
            for f in FACES {
                let face = f.map(|i| v[i]);
                sides.push(number(ascending(face)) << 1 | u128::from(odd(face)));
            }
        }
        sides.sort_unstable();
        let far = FACES.map(|f| number(ascending(f.map(|i| self.far + i as u32))));
        let mut rest = sides.as_slice();
        let mut all: Vec<u128> = with_room(sides.len() / 2 + 4)?;
        while let Some((&side, others)) = rest.split_first() {
            all.push(side >> 1);
            match others.first() {
                Some(&other) if other == side ^ 1 => rest = &others[1..],
                _ if far.contains(&(side >> 1)) => rest = others,
                _ => return Err(internal("a face has no other side")),
            }
        }
        if all.windows(2).any(|w| w[0] == w[1]) {
            return Err(internal("a face has more than two sides"));
        }
        let there = |&f: &[u32; 3]| all.binary_search(&number(f)).is_ok();
        if !self.faces.iter().all(there) {
            return Err(internal("a face of the input is not in the mesh"));
        }
        Ok(())
    }

    /// The result in rows, without the outside.
    pub fn export(self, task: Task, rows: &[u32], out: &[bool]) -> Result<Recovered> {
        let mesh = &self.mesh;
        let inside = |t: &u32| mesh.is_there(*t) && !out[*t as usize];
        let kept = (0..mesh.corners.len() as u32).filter(inside);
        let mut order: Vec<(Corners, u32)> = with_room(mesh.corners.len())?;
        let mut added = BTreeSet::new();
        for t in kept {
            let v = mesh.corners[t as usize];
            added.extend(v.into_iter().filter(|&v| v >= self.given));
            order.push((v, t));
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
        let row = |i: u32| if i < n { rows[i as usize] } else { i };
        for entry in &mut order {
            entry.0 = rotated(entry.0.map(|v| place[v as usize]));
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
            counts: self.counts,
            crowded: Vec::new(),
        };
        for (v, t) in &order {
            made.tetrahedra.push(v.map(|i| row(i) as i32));
            let across = v.map(|i| {
                let k = mesh.corner(*t, sorted[i as usize]).unwrap_or(0);
                match mesh.across[*t as usize][k] {
                    NONE => -1,
                    u => number[u as usize],
                }
            });
            made.neighbors.push(across);
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
