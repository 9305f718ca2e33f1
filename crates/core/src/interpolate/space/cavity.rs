//! The cavity of a 3-D query: the Delaunay tetrahedra whose circumspheres contain it, and their
//! boundary.
//!
//! These are the tetrahedra that its insertion would remove (A. Bowyer and D. F. Watson, both
//! 1981); the boundary is called the *rim*.
//!
//! Only points strictly inside count. That suffices on any Delaunay triangulation, however
//! cospherical sites are divided into tetrahedra: those left out because of a tie would contribute
//! no volume. The query sees each face of the rim from strictly inside, except for faces of the
//! hull: a query in the plane of another face would be in the sphere beyond, too.

use std::collections::HashMap;

use delone_predicates::{Point3, Sign, insphere, orient3d};

use crate::base::arrays::{OUTWARD, Tetrahedra};
use crate::base::error::{Error, Result};
use crate::base::watch::Pace;

/// Up to this length a list is searched linearly; longer ones use a table.
const FEW: usize = 64;

/// Consecutive numbers for keys, in the order of insertion.
#[derive(Debug, Default)]
pub struct Numbers {
    keys: Vec<i32>,
    table: HashMap<i32, u32>,
}

impl Numbers {
    fn clear(&mut self) {
        self.keys.clear();
        self.table.clear();
    }

    /// The keys.
    pub fn keys(&self) -> &[i32] {
        &self.keys
    }

    /// The number of a key.
    fn find(&self, key: i32) -> Option<u32> {
        if self.keys.len() > FEW {
            return self.table.get(&key).copied();
        }
        let place = self.keys.iter().position(|&k| k == key);
        place.map(|i| i as u32)
    }

    /// The number of a key, a new one if it has none.
    fn number(&mut self, key: i32) -> u32 {
        self.find(key).unwrap_or_else(|| self.add(key))
    }

    fn add(&mut self, key: i32) -> u32 {
        let number = self.keys.len() as u32;
        self.keys.push(key);
        if self.keys.len() == FEW + 1 {
            self.table.extend(self.keys.iter().copied().zip(0..));
        } else if self.keys.len() > FEW {
            self.table.insert(key, number);
        }
        number
    }
}

/// A face of the rim.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    /// Numbers of its corners, counterclockwise as seen from outside.
    pub corners: [u32; 3],
    /// Whether it is a hull face whose plane contains the query.
    pub flat: bool,
}

/// A cavity, reused from query to query.
#[derive(Debug, Default)]
pub struct Cavity {
    /// The vertices of the rim: the natural neighbors.
    pub vertices: Numbers,
    /// The rim.
    pub rim: Vec<Face>,
    inside: Numbers,
    outside: Numbers,
}

impl Cavity {
    /// Finds the cavity of `q`, which is in the closed tetrahedron `seed` and not at a vertex; `on`
    /// tells whether it is on a face of the seed. Tetrahedra count as work.
    pub fn find(
        &mut self,
        given: &Tetrahedra,
        seed: usize,
        on: bool,
        q: Point3,
        pace: &mut Pace,
    ) -> Result<()> {
        self.vertices.clear();
        self.rim.clear();
        self.inside.clear();
        self.outside.clear();
        self.inside.add(seed as i32);
        let mut next = 0;
        // Each tetrahedron is added once.
        while next < self.inside.keys.len() {
            pace.spend(1)?;
            let t = self.inside.keys[next] as usize;
            next += 1;
            for (k, face) in OUTWARD.into_iter().enumerate() {
                let other = given.neighbors[t][k];
                if other >= 0 && self.takes(given, other, q) {
                    continue;
                }
                let face = face.map(|i| given.simplices[t][i]);
                let [a, b, c] = face.map(|v| given.point(v));
                let flat = other < 0 && on && orient3d(a, b, c, q) == Sign::Zero;
                let corners = face.map(|v| self.vertices.number(v));
                self.rim.push(Face { corners, flat });
            }
            if self.inside.keys.len() > given.simplices.len() {
                return Err(Error::Internal(
                    "natural neighbors need a Delaunay triangulation".into(),
                ));
            }
        }
        Ok(())
    }

    /// Whether a tetrahedron is in the cavity; if so, it is added.
    fn takes(&mut self, given: &Tetrahedra, t: i32, q: Point3) -> bool {
        if self.inside.find(t).is_some() {
            return true;
        }
        if self.outside.find(t).is_some() {
            return false;
        }
        let [a, b, c, d] = given.corners(t as usize);
        let inside = insphere(a, b, c, d, q) == Sign::Positive;
        if inside {
            self.inside.add(t);
        } else {
            self.outside.add(t);
        }
        inside
    }
}
