//! Face removal: removes the faces between two vertices; the inverse of edge removal.
//!
//! ```text
//!            a                      a
//!          / | \                  / | \        Faces that both a and b see are removed, with the
//!        u---+---v     ->       u   |   v      two tetrahedra at each; the new edge ab is joined
//!          \ | /                  \ | /        to each edge around them: 2-3, 4-4, 6-5 and so on.
//!            b                      b
//! ```
//!
//! Which faces around the first one are removed is decided on the way, as in J. R. Shewchuk, "Two
//! discrete optimization algorithms for the topological improvement of tetrahedral meshes" (2002):
//! beyond each edge, either the tetrahedron of this edge and ab is better, or the next face is
//! removed, too. Linear in the number of faces removed.

use super::edge::Plan;
use super::measure::quality;
use super::store::{Corners, FACES, Store};

/// The most faces removed at once.
const MOST: usize = 12;

/// The search from one face.
struct Search<'a> {
    store: &'a Store,
    /// The vertex above the faces, and the one below.
    ends: [u32; 2],
    above: f64,
    plan: Plan,
}

/// The best removal of the face opposite a corner and of faces around it, if it is better than
/// `above`.
pub fn remove(store: &Store, (t, k): (u32, usize), above: f64) -> Option<Plan> {
    let below = store.beyond(t, k)?;
    let a = store.corners[t as usize][k];
    let b = beyond(store, t, k, below);
    let mut search = Search {
        store,
        ends: [a, b],
        above,
        plan: Plan {
            old: vec![t, below],
            least: f64::INFINITY,
            ..Plan::default()
        },
    };
    let [u, v, w] = FACES[k].map(|i| store.corners[t as usize][i]);
    for (p, q) in [(u, v), (v, w), (w, u)] {
        search.close(t, below, p, q)?;
    }
    Some(search.plan)
}

/// The corner of the tetrahedron below that is not on the face opposite corner `k`.
fn beyond(store: &Store, t: u32, k: usize, below: u32) -> u32 {
    let all = |t: u32| store.corners[t as usize].into_iter().fold(0, |s, v| s ^ v);
    all(t) ^ all(below) ^ store.corners[t as usize][k]
}

impl Search<'_> {
    /// Finds the best option at the edge `p`, `q` of the face between the tetrahedra `upper` and
    /// `lower`; `None` if nothing is above the bound.
    fn close(&mut self, upper: u32, lower: u32, p: u32, q: u32) -> Option<()> {
        let [a, b] = self.ends;
        let tetrahedron = [b, a, p, q];
        let own = quality(self.store.places_of(tetrahedron));
        let length = (self.plan.old.len(), self.plan.new.len());
        let least = self.plan.least;
        if let Some((upper, lower, r)) = self.next(upper, lower, p, q) {
            // The face beyond is p, r, q, seen from above like this one.
            self.plan.old.extend([upper, lower]);
            let both = self
                .close(upper, lower, p, r)
                .and_then(|()| self.close(upper, lower, r, q));
            if both.is_some() && self.plan.least.min(least) > own.min(least) {
                return Some(());
            }
            self.plan.old.truncate(length.0);
            self.plan.new.truncate(length.1);
            self.plan.least = least;
        }
        if own <= self.above {
            return None;
        }
        self.plan.new.push(tetrahedron);
        self.plan.least = least.min(own);
        Some(())
    }

    /// The face beyond an edge that both ends see: its two tetrahedra and its third vertex.
    fn next(&self, upper: u32, lower: u32, p: u32, q: u32) -> Option<(u32, u32, u32)> {
        let store = self.store;
        if self.plan.old.len() >= 2 * MOST {
            return None;
        }
        let third = |t: u32, end: u32| -> Corners {
            let v = store.corners[t as usize];
            let s = v.into_iter().fold(0, |s, v| s ^ v);
            [s ^ end ^ p ^ q, end, p, q]
        };
        let [a, b] = self.ends;
        let (up, down) = (third(upper, a)[0], third(lower, b)[0]);
        let above = store.beyond(upper, store.corner(upper, up)?)?;
        let below = store.beyond(lower, store.corner(lower, down)?)?;
        let (r, s) = (third(above, a)[0], third(below, b)[0]);
        let joined = store.beyond(above, store.corner(above, a)?)? == below;
        let fresh = !self.plan.old.contains(&above) && !self.plan.old.contains(&below);
        (r == s && joined && fresh && above != below).then_some((above, below, r))
    }
}
