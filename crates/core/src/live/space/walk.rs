//! Locates a point: a start nearby, then a visibility walk (see `delaunay::space::cavity`).
//!
//! A walk starts where the last one ended. If that is far away, vertices are sampled, as many as balance
//! the walk from the nearest of them (E. P. Mücke, I. Saias and B. Zhu, "Fast randomized point location
//! without preprocessing in two- and three-dimensional Delaunay triangulations", 1996): n^(1/4) of n.
//! When long walks have cost as much, a tree of starting points takes their place.

use delone_predicates::{Point3, Sign, orient3d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::watch::{Pace, Watch};
use crate::live::rows::NONE;
use crate::live::store::Place;
use crate::locate::squared;
use crate::mesh::space::{FACETS, corner, tetrahedron};
use crate::order::random;

/// How far a walk goes from the last tetrahedron, in lengths of its edge, squared, before vertices are
/// sampled.
const REACH: f64 = 400.0;

/// Vertices per step of long walks that are worth a tree.
const SHARE: usize = 32;

/// How much work for each vertex a tree lasts.
const LASTING: usize = 8;

/// Steps of a walk between two checks for interruption.
const LOT: usize = 1 << 14;

impl Mesh {
    /// Where `q` is.
    pub fn place(&mut self, q: Point3, watch: &Watch) -> Result<Place> {
        let t = self.find(q, watch)?;
        let here = self.corners(t).into_iter().find(|&v| self.at(v) == q);
        Ok(here.map_or(Place::In(t), Place::At))
    }

    /// The tetrahedron that contains `q`, or a ghost with `q` strictly outside its hull facet.
    pub fn find(&mut self, q: Point3, watch: &Watch) -> Result<u32> {
        let corners = self.corners(self.last);
        let first = usize::from(corners[0] == INFINITE);
        let second = 3 - usize::from(corners[3] == INFINITE);
        let [a, b] = [corners[first], corners[second]].map(|v| self.at(v));
        let far = squared(q, a) > REACH * squared(a, b);
        let from = if far { self.jump(q, watch)? } else { self.last };
        let before = self.work;
        self.last = self.walk(from, q, &mut Pace::new(watch, LOT))?;
        if far && self.jump.is_none() {
            self.strolled += (self.work - before) as isize;
        }
        Ok(self.last)
    }

    /// A tetrahedron or ghost near `q`.
    fn jump(&mut self, q: Point3, watch: &Watch) -> Result<u32> {
        let is_due = self.strolled > ((self.sites.len() - 1) / SHARE) as isize;
        let Some(i) = self.near(q, is_due, LASTING, watch)? else {
            return Ok(self.sampled(q));
        };
        let near = self.sites.items().get(i + 1).map_or(NONE, |site| site.near);
        Ok(if near == NONE { self.last } else { near })
    }

    /// A tetrahedron or ghost at the nearest of a few vertices.
    fn sampled(&mut self, q: Point3) -> u32 {
        let Self { store, samples, .. } = self;
        let sites = store.sites.items();
        let (mut best, mut least) = (store.last, f64::INFINITY);
        for _ in 0..sites.len().isqrt().isqrt() {
            *samples = samples.wrapping_add(1);
            let v = (random(*samples) % sites.len() as u64) as usize;
            let distance = squared(q, sites[v].at);
            if distance < least && sites[v].near != NONE {
                (best, least) = (sites[v].near, distance);
            }
        }
        best
    }

    /// A visibility walk from tetrahedron or ghost `from`.
    fn walk(&mut self, from: u32, q: Point3, pace: &mut Pace) -> Result<u32> {
        let mut t = from;
        // The corner opposite the facet across which the walk came.
        let mut came = 4;
        if let Some(k) = self.infinite_corner(from) {
            let [a, b, c] = self.facet(4 * from + k as u32).map(|v| self.at(v));
            if orient3d(a, b, c, q) == Sign::Positive {
                return Ok(from);
            }
            let inner = self.opposites(from)[k];
            (t, came) = (tetrahedron(inner), corner(inner));
        }
        loop {
            pace.spend(1)?;
            self.work += 1;
            let corners = self.corners(t).map(|v| self.at(v));
            let beyond = (0..4).find(|&k| {
                let [a, b, c] = FACETS[k].map(|i| corners[i]);
                k != came && orient3d(a, b, c, q) == Sign::Negative
            });
            let Some(k) = beyond else {
                return Ok(t);
            };
            let across = self.opposites(t)[k];
            (t, came) = (tetrahedron(across), corner(across));
            if self.corners(t)[came] == INFINITE {
                return Ok(t);
            }
        }
    }
}
