//! A second point where no double sees all faces around a point.
//!
//! The faces around a free point whose coordinates are not doubles are divided between it and a new
//! point in doubles. The new point takes over tetrahedra whose outer faces it sees. Fewer faces are
//! left to the first point, which then often fits doubles. All tests are exact, so the mesh is
//! valid at each step; changes that do not help are undone.

use delone_predicates::Point3;

use super::coordinates::{Wide, triple};
use super::mesh::{Corners, ascending};
use super::place::Near;
use super::work::{Origin, Work};
use crate::base::error::Result;

/// The number of places that are tried, first with few doubles for the point itself, then with
/// many.
const TRIES: [(usize, Near); 2] = [(800, Near::One), (1200, Near::Many)];

/// The most faces around all places of one call.
const FACES: usize = 100_000;

/// Steps of places that are spread evenly: the powers of 1/x for the root x > 1 of x^4 = x + 1.
const STEPS: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_3,
    0.549_700_477_901_970_3,
];

/// The i-th place in a tetrahedron: the weights of the corners of its outer face, and the part of the way
/// from there to the point. If `close`, most are next to the point: a point close to a narrow gap
/// sees much of the other side.
fn place(i: usize, close: bool) -> ([f64; 3], f64) {
    let [x, y, z] = STEPS.map(|step| (i as f64 * step).fract());
    // The upper triangle of the square is folded onto the lower one.
    let [x, y] = if x + y > 1.0 {
        [1.0 - x, 1.0 - y]
    } else {
        [x, y]
    };
    let part = if close { 1.0 - (-30.0 * z).exp2() } else { z };
    ([x, y, 1.0 - x - y], part)
}

impl Work<'_> {
    /// Moves a free point to doubles, with another point beside it. Returns false, without a
    /// change, if no place is found.
    pub fn divide(&mut self, v: u32) -> Result<bool> {
        let star = self.mesh.star(v, usize::MAX);
        // Large tetrahedra have the most room. Undoing an attempt changes slots, but not faces.
        let mut sized = Vec::with_capacity(star.len());
        for t in star {
            if let Some(k) = self.mesh.corner(t, v) {
                sized.push((self.volume(t), ascending(self.mesh.face(t, k))));
            }
        }
        sized.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut faces = 0;
        for (tries, near) in TRIES {
            for i in 1..=tries {
                faces += sized.len();
                let (_, face) = sized[i % sized.len()];
                if faces > FACES {
                    return Ok(false);
                }
                if self.divided_at(v, face, place(i, i / sized.len() % 2 == 1), near)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Tries a new point at a place in the tetrahedron of `v` over a face.
    fn divided_at(
        &mut self,
        v: u32,
        face: [u32; 3],
        (weights, part): ([f64; 3], f64),
        near: Near,
    ) -> Result<bool> {
        let star = self.mesh.star(v, usize::MAX);
        self.pace.spend(star.len())?;
        let over = |&t: &u32| {
            let k = self.mesh.corner(t, v);
            k.is_some_and(|k| ascending(self.mesh.face(t, k)) == face)
        };
        let Some(t) = star.iter().copied().find(over) else {
            return Ok(false);
        };
        let at = self.inside(t, v, weights, part);
        if at.iter().any(|x| !x.is_finite()) {
            return Ok(false);
        }
        let q = self.add(Wide::of(at), Origin::Free)?;
        let own = [0, 1, 2, 3].map(|k| self.mesh.face(t, k));
        let cells = if self.sees(&own, q) {
            self.taken_over(q, v, t, &star)?
        } else {
            Vec::new()
        };
        if cells.is_empty() {
            self.drop_last();
            return Ok(false);
        }
        let old: Vec<Corners> = cells
            .iter()
            .map(|&t| self.mesh.corners[t as usize])
            .collect();
        let faces = self.mesh.outer_faces(&cells);
        self.mesh.fan(&cells, &faces, q)?;
        if self.center_free(v, near)
            || (self.center_free(q, Near::One) && self.center_free(v, near))
        {
            return Ok(true);
        }
        let star = self.mesh.star(q, usize::MAX);
        self.mesh.replace(&star, &old)?;
        self.drop_last();
        Ok(false)
    }

    /// The tetrahedra of `v` around one of them whose outer faces the point `q` in it sees.
    fn taken_over(&mut self, q: u32, v: u32, t: u32, star: &[u32]) -> Result<Vec<u32>> {
        // First all with an outer face of the star that it sees ...
        let mut cells = star.to_vec();
        cells.retain(|&u| {
            let k = self.mesh.corner(u, v);
            k.is_some_and(|k| self.sees(&[self.mesh.face(u, k)], q))
        });
        // ... then without those that have another outer face which it does not see. Each round but the
        // last removes one or more.
        loop {
            self.pace.spend(cells.len())?;
            let count = cells.len();
            let present = cells.clone();
            cells.retain(|&u| {
                (0..4).all(|k| {
                    present.contains(&self.mesh.across[u as usize][k])
                        || self.sees(&[self.mesh.face(u, k)], q)
                })
            });
            if cells.len() == count {
                break;
            }
        }
        // What is joined to the tetrahedron of the point.
        let mut joined: Vec<u32> = cells.iter().copied().filter(|&u| u == t).collect();
        let mut next = 0;
        while next < joined.len() {
            for u in self.mesh.across[joined[next] as usize] {
                if cells.contains(&u) && !joined.contains(&u) {
                    joined.push(u);
                }
            }
            next += 1;
        }
        Ok(joined)
    }

    /// A place in a tetrahedron of `v`, in doubles.
    fn inside(&self, t: u32, v: u32, weights: [f64; 3], part: f64) -> Point3 {
        let near = self.mesh.points.near(v);
        let k = self.mesh.corner(t, v).unwrap_or(0);
        let corners = self.mesh.face(t, k).map(|w| self.mesh.points.near(w));
        [0, 1, 2].map(|i| {
            let on_face: f64 = (0..3).map(|j| weights[j] * corners[j][i]).sum();
            on_face + part * (near[i] - on_face)
        })
    }

    /// About the volume of a tetrahedron, for the order in which places are tried.
    fn volume(&self, t: u32) -> f64 {
        let [a, b, c, d] = self.mesh.corners[t as usize].map(|v| self.mesh.points.near(v));
        triple([b, c, d].map(|p| [0, 1, 2].map(|i| p[i] - a[i]))).abs()
    }
}
