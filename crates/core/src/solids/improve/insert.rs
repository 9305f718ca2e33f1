//! Vertex insertion: the tetrahedra of a cavity around a bad one are replaced by those that join a
//! new vertex to the boundary of the cavity.
//!
//! As in B. M. Klingner and J. R. Shewchuk, "Aggressive tetrahedral mesh improvement", 16th
//! International Meshing Roundtable (2007), but with another search: the cavity grows across the
//! boundary face whose new tetrahedron is worst, and after each growth the vertex moves uphill
//! again. So position and cavity are found together.
//!
//! # Why a cavity with positive tetrahedra is covered once
//!
//! The new tetrahedra, as a chain, have the boundary of the cavity as their boundary, since the
//! faces at the new vertex cancel in pairs. Two chains of tetrahedra in space with the same
//! boundary are equal, so the number of positive tetrahedra that cover a point of the cavity is one
//! more than that of negative ones: it is one if all are positive. Nothing else is required of the
//! shape of the cavity.

use delone_predicates::Point3;

use super::edge::Plan;
use super::smooth::Star;
use super::store::{FACES, Store};
use crate::base::error::Result;
use crate::base::memory::push;

/// The most tetrahedra in a cavity; most successful ones have fewer than 20.
const LARGEST: usize = 40;
/// The steps of an ascent after each growth of a cavity; more steps take longer and do not lead to
/// a better mesh.
const STEPS: usize = 2;
/// A cavity stops growing after this many steps without a better result.
const PATIENCE: usize = 8;

/// Buffers of the search, reused between calls.
#[derive(Debug, Default)]
pub struct Search {
    star: Star,
    cavity: Vec<u32>,
    faces: Vec<(u32, usize)>,
    vertices: Vec<u32>,
}

/// A replacement with the position of its new vertex.
pub struct Insertion {
    pub plan: Plan,
    pub place: Point3,
}

impl Search {
    /// The best insertion of a vertex at a tetrahedron, if its quality is above `above`. A start
    /// that reaches `enough` is the last one.
    ///
    /// The search starts in the middle of the tetrahedron, then of each of its edges inside the
    /// mesh.
    pub fn best(
        &mut self,
        store: &Store,
        t: u32,
        above: f64,
        enough: f64,
    ) -> Result<Option<Insertion>> {
        const EDGES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let corners = store.corners[t as usize];
        let mut best = None;
        let mut value = above;
        self.cavity.clear();
        push(&mut self.cavity, t)?;
        self.grow(store, middle(store, &corners), &mut value, &mut best)?;
        for (i, j) in EDGES {
            if value >= enough {
                break;
            }
            let edge = [corners[i], corners[j]];
            if self.surround(store, t, edge)? {
                self.grow(store, middle(store, &edge), &mut value, &mut best)?;
            }
        }
        Ok(best)
    }

    /// Starts a cavity with the tetrahedra around an edge; false if the edge is on a wall, or if
    /// there are too many.
    fn surround(&mut self, store: &Store, t: u32, edge: [u32; 2]) -> Result<bool> {
        self.cavity.clear();
        push(&mut self.cavity, t)?;
        let mut next = 0;
        while let Some(&t) = self.cavity.get(next) {
            next += 1;
            for k in 0..4 {
                if edge.contains(&store.corners[t as usize][k]) {
                    continue;
                }
                let Some(u) = store.beyond(t, k) else {
                    return Ok(false);
                };
                if !self.cavity.contains(&u) {
                    push(&mut self.cavity, u)?;
                }
            }
            if self.cavity.len() > LARGEST {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Grows the cavity from a position, and keeps the best insertion found on the way.
    fn grow(
        &mut self,
        store: &Store,
        mut place: Point3,
        value: &mut f64,
        best: &mut Option<Insertion>,
    ) -> Result<()> {
        let mut idle = 0;
        while self.cavity.len() <= LARGEST && idle < PATIENCE {
            // The vertex moves to where the worst of the new tetrahedra is best.
            self.open(store)?;
            let mut worst = self.star.worst(place, 0.0);
            if let Some((there, better)) = self.star.ascend(place, STEPS, None) {
                (place, worst) = (there, better);
            }
            idle += 1;
            if worst > *value && self.keeps_all(store)? {
                *value = worst;
                *best = Some(self.insertion(store, place, worst));
                idle = 0;
            }
            // The cavity grows across the face with the worst new tetrahedron that is not a wall.
            let Some(next) = self.bottleneck(store, place) else {
                break;
            };
            push(&mut self.cavity, next)?;
        }
        Ok(())
    }

    /// Collects the boundary faces of the cavity.
    fn open(&mut self, store: &Store) -> Result<()> {
        self.faces.clear();
        self.star.clear();
        for &t in &self.cavity {
            for (k, face) in FACES.iter().enumerate() {
                let beyond = store.beyond(t, k);
                if beyond.is_some_and(|u| self.cavity.contains(&u)) {
                    continue;
                }
                push(&mut self.faces, (t, k))?;
                let corners = face.map(|i| store.corners[t as usize][i]);
                self.star.push(corners.map(|v| store.points[v as usize]));
            }
        }
        Ok(())
    }

    /// The tetrahedron behind the face, of those that are not walls, whose new tetrahedron is
    /// worst.
    fn bottleneck(&self, store: &Store, place: Point3) -> Option<u32> {
        let mut found = None;
        let mut least = f64::INFINITY;
        for &(t, k) in &self.faces {
            let Some(beyond) = store.beyond(t, k) else {
                continue;
            };
            let [p, q, r] = FACES[k].map(|i| store.points[store.corners[t as usize][i] as usize]);
            let quality = super::measure::quality([p, q, r, place]);
            if quality < least {
                (least, found) = (quality, Some(beyond));
            }
        }
        found
    }

    /// Whether every vertex of the cavity is on its boundary, so that none is lost.
    fn keeps_all(&mut self, store: &Store) -> Result<bool> {
        self.vertices.clear();
        for &(t, k) in &self.faces {
            for i in FACES[k] {
                push(&mut self.vertices, store.corners[t as usize][i])?;
            }
        }
        let all = self.cavity.iter().flat_map(|&t| store.corners[t as usize]);
        Ok(all.into_iter().all(|v| self.vertices.contains(&v)))
    }

    fn insertion(&self, store: &Store, place: Point3, least: f64) -> Insertion {
        let new = store.points.len() as u32;
        let tetrahedron = |&(t, k): &(u32, usize)| {
            let [p, q, r] = FACES[k].map(|i: usize| store.corners[t as usize][i]);
            [p, q, r, new]
        };
        Insertion {
            plan: Plan {
                old: self.cavity.clone(),
                new: self.faces.iter().map(tetrahedron).collect(),
                least,
                turning: false,
            },
            place,
        }
    }
}

/// The mean of vertices.
fn middle(store: &Store, vertices: &[u32]) -> Point3 {
    let share = 1.0 / vertices.len() as f64;
    let parts = vertices.iter().map(|&v| store.points[v as usize]);
    parts.fold([0.0; 3], |sum, p| super::measure::plus(sum, share, p))
}
