//! Locates a point: a start nearby, then a visibility walk (see `delaunay::plane::walk`).

use delone_predicates::{Point2, Sign, orient2d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::live::rows::NONE;
use crate::live::store::Place;
use crate::locate::squared;
use crate::mesh::plane::{half_edge, next, prev, triangle};

/// How far a walk goes from the last triangle, in lengths of its edge, squared, before a starting
/// point is looked up.
const REACH: f64 = 100.0;

/// Vertices per node of the tree of starting points.
const SHARE: usize = 8;

/// Vertices beside that of a node that are tried, too.
const BESIDE: usize = 2;

/// How much work for each vertex a tree lasts.
const LASTING: usize = 4;

impl Mesh {
    /// Where `q` is, by a walk from the last triangle or from one that is nearer.
    #[inline]
    pub fn place(&mut self, q: Point2, watch: &Watch) -> Result<Place> {
        let t = self.find(q, watch)?;
        let here = self.corners(t).into_iter().find(|&v| self.at(v) == q);
        Ok(here.map_or(Place::In(t), Place::At))
    }

    /// The triangle whose closed area contains `q`, or a ghost with `q` strictly outside its hull
    /// edge.
    #[inline]
    pub fn find(&mut self, q: Point2, watch: &Watch) -> Result<u32> {
        let [u, v, w] = self.corners(self.last);
        let edge = if u == INFINITE {
            [v, w]
        } else if v == INFINITE {
            [w, u]
        } else {
            [u, v]
        };
        let [a, b] = [self.at(edge[0]), self.at(edge[1])];
        let far = squared(q, a) > REACH * squared(a, b);
        let from = if far { self.jump(q, watch)? } else { self.last };
        let before = self.work;
        self.last = self.walk(from, q);
        if far && self.jump.is_none() {
            self.strolled += (self.work - before) as isize;
        }
        Ok(self.last)
    }

    /// A triangle near `q`, by a tree of starting points, which is built when long walks have cost as
    /// much.
    fn jump(&mut self, q: Point2, watch: &Watch) -> Result<u32> {
        let is_due = self.strolled >= ((self.sites.len() - 1) / SHARE) as isize;
        let Some(i) = self.near(q, is_due, LASTING, watch)? else {
            return Ok(self.last);
        };
        // The vertex may have been removed, and another one may have its number. Most of the
        // vertices beside it have been near it on the curve since the triangulation was built.
        let sites = &self.sites.items()[1..];
        let beside = &sites[i.saturating_sub(BESIDE)..sites.len().min(i + BESIDE + 1)];
        let mut best = (self.last, f64::INFINITY);
        for site in beside.iter().filter(|site| site.near != NONE) {
            let distance = squared(q, site.at);
            if distance < best.1 {
                best = (triangle(site.near), distance);
            }
        }
        Ok(best.0)
    }

    /// The same by a visibility walk from triangle `from`. Among segments such a walk may run in a
    /// circle: there its order of edges changes, and in the end all triangles are searched.
    #[inline]
    fn walk(&mut self, from: u32, q: Point2) -> u32 {
        let beyond = |mesh: &Self, e: u32| {
            let [a, b] = [mesh.at(mesh.vertex(next(e))), mesh.at(mesh.vertex(prev(e)))];
            orient2d(a, b, q) == Sign::Negative
        };
        let mut e = half_edge(from, 0);
        if let Some(k) = self.corners(from).iter().position(|&v| v == INFINITE) {
            let outer = half_edge(from, k as u32);
            let [a, b] = [next(outer), prev(outer)].map(|c| self.at(self.vertex(c)));
            if orient2d(a, b, q) == Sign::Positive {
                return from;
            }
            e = self.opposite(outer);
        }
        if beyond(self, e) {
            e = self.opposite(e);
            if self.vertex(e) == INFINITE {
                return triangle(e);
            }
        }
        let mut steps = 1;
        let patience = if self.has_segments {
            4 * self.records.len()
        } else {
            usize::MAX
        };
        let [mut a, mut b] = [next(e), prev(e)].map(|c| self.at(self.vertex(c)));
        let found = loop {
            //       c          The walk came across e = a b; two edges are left to test, and only
            //     /   \        the corner c is new.
            //    a --- b
            let c = self.at(self.vertex(e));
            let is_beyond = |p: Point2, r: Point2| orient2d(p, r, q) == Sign::Negative;
            let (over_bc, over_ca) = if self.has_segments && is_odd(steps) {
                let over_ca = is_beyond(c, a);
                (!over_ca && is_beyond(b, c), over_ca)
            } else {
                let over_bc = is_beyond(b, c);
                (over_bc, !over_bc && is_beyond(c, a))
            };
            e = if over_bc {
                a = c;
                self.opposite(next(e))
            } else if over_ca {
                b = c;
                self.opposite(prev(e))
            } else {
                break triangle(e);
            };
            if self.vertex(e) == INFINITE {
                break triangle(e);
            }
            steps += 1;
            if steps > patience {
                break self.search(q);
            }
        };
        self.work += steps;
        found
    }

    /// The same by a search of all triangles.
    fn search(&self, q: Point2) -> u32 {
        let holds = |&t: &u32| {
            let edges = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
                let corners = self.corners(t);
                [corners[i], corners[j]]
            });
            let side = |[u, v]: [u32; 2]| orient2d(self.at(u), self.at(v), q);
            match edges.iter().find(|edge| !edge.contains(&INFINITE)) {
                Some(&edge) if self.corners(t).contains(&INFINITE) => side(edge) == Sign::Positive,
                _ => edges.into_iter().all(|edge| side(edge) != Sign::Negative),
            }
        };
        let mut all = (0..self.records.len() as u32).filter(|&t| self.is_live(t));
        all.find(holds).unwrap_or(self.last)
    }
}

/// A bit that looks random.
fn is_odd(step: usize) -> bool {
    (step as u32).wrapping_mul(0x9e37_79b9) >> 31 == 1
}
