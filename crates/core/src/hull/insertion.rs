//! The 3-D convex hull by insertion.
//!
//! K. L. Clarkson and P. W. Shor, "Applications of random sampling in computational geometry, II"
//! (1989): points are inserted in random order. The facets that a point *sees*, because it is
//! strictly beyond their planes, are removed, and replaced by a cone of new ones from the point to
//! the horizon. Instead of conflict lists there is a walk: seen from an inner point o, the facets
//! tile the sphere, and a point outside the hull sees the facet in its direction. `surface` decides
//! the order of the points.
//!
//! # Points in the planes of facets
//!
//! No point is moved. The facets that p sees are a union of whole sides of the polytope, hence a
//! disk, whose horizon is one cycle. A new triangle is never degenerate: if p were collinear with
//! an edge of the horizon, it would be in the planes of both facets there, and see neither. New
//! triangles may be coplanar with old ones, and vertices may end up in the interior of a side or an
//! edge; `faces` removes them.
//!
//! # The walk
//!
//! The walk goes from a facet across an edge if p lies beyond the plane through o and the edge. On
//! the way from o to p, the plane of the next facet is met later than that of the current one, or
//! at the same point if both are coplanar. So a walk never returns to a side of the polytope, but
//! it may cycle within one: it has a budget, and if that is spent, all facets are tested. It may
//! end at any facet that p sees.

use delone_predicates::{Point3, Sign, orient2d, orient3d};

use super::inner::Inner;
use crate::base::error::{Error, Result};
use crate::base::memory::filled;
use crate::base::watch::Watch;

/// Insertions between two checks for interruption.
const WATCH_EVERY: usize = 1024;
/// No facet.
const NONE: u32 = u32::MAX;

/// A triangle of the surface.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// Its vertices.
    pub corners: [u32; 3],
    /// The facet across the edge opposite each.
    pub beyond: [u32; 3],
    /// Whether it is still on the surface.
    pub alive: bool,
}

/// Whether three points are collinear: all projections are.
pub fn in_line(a: Point3, b: Point3, c: Point3) -> bool {
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]) == Sign::Zero)
}

/// The hull of the points so far.
pub struct Hull<'a> {
    points: &'a [Point3],
    pub facets: Vec<Facet>,
    /// A point strictly inside.
    pub inner: Inner,
    /// Where the next walk begins: a live facet.
    near: u32,
    /// Records of facets that may be reused.
    free: Vec<u32>,
    /// For each vertex of the horizon, the new facet whose edge begins there.
    spoke: Vec<u32>,
    seen: Vec<u32>,
    rim: Vec<(u32, u32, u32)>,
}

/// The result of a walk.
pub enum Toward {
    /// Outside, strictly beyond this facet.
    Beyond(u32),
    /// In the hull, on the ray from the inner point to this facet.
    Before(u32),
}

impl<'a> Hull<'a> {
    /// The surface of a tetrahedron, positively oriented.
    pub fn start(points: &'a [Point3], [a, b, c, d]: [u32; 4]) -> Result<Self> {
        // Opposite a, b, c and d, counterclockwise seen from outside.
        let corners = [[b, c, d], [a, d, c], [a, b, d], [a, c, b]];
        let beyond = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        let facets = [0, 1, 2, 3].map(|i| Facet {
            corners: corners[i],
            beyond: beyond[i],
            alive: true,
        });
        Ok(Self {
            points,
            facets: facets.to_vec(),
            inner: Inner::of([a, b, c, d].map(|v| points[v as usize])),
            near: 0,
            free: Vec::new(),
            spoke: filled(points.len(), NONE)?,
            seen: Vec::new(),
            rim: Vec::new(),
        })
    }

    /// Inserts points, one at a time.
    pub fn insert_all(&mut self, rows: &[u32], watch: &Watch) -> Result<()> {
        for (done, &p) in rows.iter().enumerate() {
            if done % WATCH_EVERY == 0 {
                watch.check()?;
            }
            match self.toward(self.at(p), self.near) {
                Toward::Before(facet) => self.near = facet,
                Toward::Beyond(facet) => {
                    self.find_horizon(p, facet);
                    self.build_cone(p)?;
                }
            }
        }
        Ok(())
    }

    fn at(&self, v: u32) -> Point3 {
        self.points[v as usize]
    }

    /// The corners of a facet.
    pub fn corners(&self, facet: u32) -> [Point3; 3] {
        self.facets[facet as usize].corners.map(|v| self.at(v))
    }

    /// The side of a facet on which `p` is; positive is outside.
    #[inline]
    pub fn side(&self, p: Point3, facet: u32) -> Sign {
        let [a, b, c] = self.corners(facet);
        orient3d(a, b, c, p)
    }

    /// A live facet.
    pub fn near(&self) -> u32 {
        self.near
    }

    /// How far the hull extends from a point along an axis, and the largest coordinate.
    pub fn reach(&self, o: Point3) -> (f64, f64) {
        let alive = (0u32..).zip(&self.facets).filter(|(_, f)| f.alive);
        let corners = alive.flat_map(|(i, _)| self.corners(i));
        corners.fold((0.0, 0.0), |(far, most), p| {
            let away = (0..3).fold(far, |far: f64, k| far.max((p[k] - o[k]).abs()));
            (away, p.iter().fold(most, |most: f64, x| most.max(x.abs())))
        })
    }

    /// Locates `p` by a walk from a facet.
    pub fn toward(&self, p: Point3, near: u32) -> Toward {
        let mut facet = near;
        let mut from = NONE;
        // Far more steps than walks between consecutive points on the curve need, except across
        // thin facets side by side; and fewer than testing all facets is worth.
        for step in 0..64 + self.facets.len() / 8 {
            if self.side(p, facet) == Sign::Positive {
                return Toward::Beyond(facet);
            }
            let beyond = self.facets[facet as usize].beyond;
            let corners = self.corners(facet);
            let turned = [0, 1, 2].map(|k| (k + step) % 3);
            let leaves = |&k: &usize| {
                let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                beyond[k] != from && self.inner.side(u, v, p) == Sign::Negative
            };
            match turned.iter().find(|k| leaves(k)) {
                Some(&k) => (from, facet) = (facet, beyond[k]),
                None => return Toward::Before(facet),
            }
        }
        let alive = (0..self.facets.len() as u32).filter(|&f| self.facets[f as usize].alive);
        let seen = alive
            .into_iter()
            .find(|&f| self.side(p, f) == Sign::Positive);
        seen.map_or(Toward::Before(near), Toward::Beyond)
    }

    /// Finds the facets that `p` sees, marks them as removed, and collects the horizon with the
    /// facets beyond.
    fn find_horizon(&mut self, p: u32, seed: u32) {
        let point = self.at(p);
        self.seen.clear();
        self.rim.clear();
        self.facets[seed as usize].alive = false;
        self.seen.push(seed);
        let mut i = 0;
        while i < self.seen.len() {
            let Facet {
                corners, beyond, ..
            } = self.facets[self.seen[i] as usize];
            for k in 0..3 {
                let facet = beyond[k];
                if !self.facets[facet as usize].alive {
                    continue;
                }
                if self.side(point, facet) == Sign::Positive {
                    self.facets[facet as usize].alive = false;
                    self.seen.push(facet);
                } else {
                    self.rim
                        .push((corners[(k + 1) % 3], corners[(k + 2) % 3], facet));
                }
            }
            i += 1;
        }
    }

    /// Joins `p` to the horizon.
    fn build_cone(&mut self, p: u32) -> Result<()> {
        self.free.append(&mut self.seen);
        for i in 0..self.rim.len() {
            let (u, v, beyond) = self.rim[i];
            let facet = self.new_facet();
            self.facets[facet as usize] = Facet {
                corners: [p, u, v],
                beyond: [beyond, NONE, NONE],
                alive: true,
            };
            let there = &mut self.facets[beyond as usize];
            let k = there.corners.iter().position(|&c| c != u && c != v);
            there.beyond[k.unwrap_or(0)] = facet;
            self.spoke[u as usize] = facet;
            self.near = facet;
        }
        // Once around, from edge to edge.
        let broken = || Error::Internal("the horizon is not a cycle".into());
        let (start, ..) = self.rim[0];
        let mut u = start;
        for count in 1.. {
            let facet = self.spoke[u as usize];
            let v = self.facets[facet as usize].corners[2];
            let after = self.spoke[v as usize];
            if after == NONE || count > self.rim.len() {
                return Err(broken());
            }
            self.facets[facet as usize].beyond[1] = after;
            self.facets[after as usize].beyond[2] = facet;
            u = v;
            if u == start {
                return if count == self.rim.len() {
                    Ok(())
                } else {
                    Err(broken())
                };
            }
        }
        Ok(())
    }

    fn new_facet(&mut self) -> u32 {
        if let Some(facet) = self.free.pop() {
            return facet;
        }
        let dead = Facet {
            corners: [NONE; 3],
            beyond: [NONE; 3],
            alive: false,
        };
        self.facets.push(dead);
        self.facets.len() as u32 - 1
    }
}
