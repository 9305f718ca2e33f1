//! The convex hull in space by insertion.
//!
//! K. L. Clarkson and P. W. Shor, "Applications of random sampling in computational geometry, II"
//! (1989): points come in random order; the facets that a point *sees*, being strictly beyond their
//! planes, go, and a cone of new ones comes, from the point to their rim. In place of lists of conflicts
//! there is a walk: seen from an inner point o, the facets tile the sphere, and a point that is outside
//! sees the facet towards which it lies. `surface` says in which order they come.
//!
//! # Points in the planes of facets
//!
//! No point is moved. The facets that p sees are the union of whole sides of the polytope, and so a
//! disc, whose rim is one cycle. A new triangle is never flat: were p in line with an edge of the rim,
//! then in the planes of both facets there, and would see neither. New triangles may be coplanar with
//! old ones, and vertices may come to lie in the middle of a side or an edge; `faces` takes them out.
//!
//! # The walk
//!
//! From a facet to the one across an edge, where p lies beyond the plane through o and the edge. Of the
//! planes of facets that of the next one is met later on the way from o to p, or at the same place where
//! both are coplanar; so a walk comes back to no side of the polytope, and within one it may turn in
//! circles: it has a budget, and then all facets are asked. It may end at any facet that p sees.

use delone_predicates::{Point3, Sign, orient2d, orient3d};

use super::inner::Inner;
use crate::error::{Error, Result};
use crate::memory::filled;
use crate::watch::Watch;

/// Insertions between two looks at the watch.
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
    /// Whether it is still there.
    pub alive: bool,
}

/// Whether three points lie on one line: all projections do.
pub fn in_line(a: Point3, b: Point3, c: Point3) -> bool {
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]) == Sign::Zero)
}

/// The hull so far.
pub struct Hull<'a> {
    points: &'a [Point3],
    pub facets: Vec<Facet>,
    /// A point strictly inside.
    pub inner: Inner,
    /// Where the next walk begins: a facet that is there.
    near: u32,
    /// Facets that may be used again.
    free: Vec<u32>,
    /// For each vertex of the rim the new facet whose edge begins there.
    spoke: Vec<u32>,
    seen: Vec<u32>,
    rim: Vec<(u32, u32, u32)>,
}

/// Where a point is.
pub enum Towards {
    /// Outside, strictly beyond this facet.
    Beyond(u32),
    /// In the hull, on the way from the inner point to this facet.
    Before(u32),
}

impl<'a> Hull<'a> {
    /// The surface of a tetrahedron, positively oriented.
    pub fn start(points: &'a [Point3], [a, b, c, d]: [u32; 4]) -> Result<Self> {
        // Opposite a, b, c and d, counter-clockwise seen from outside.
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

    /// Inserts points, one after the other.
    pub fn insert_all(&mut self, rows: &[u32], watch: &Watch) -> Result<()> {
        for (done, &p) in rows.iter().enumerate() {
            if done % WATCH_EVERY == 0 {
                watch.check()?;
            }
            match self.towards(self.at(p), self.near) {
                Towards::Before(facet) => self.near = facet,
                Towards::Beyond(facet) => {
                    self.look(p, facet);
                    self.raise_cone(p)?;
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

    /// The side of a facet on which `p` is; positive is beyond.
    #[inline]
    pub fn side(&self, p: Point3, facet: u32) -> Sign {
        let [a, b, c] = self.corners(facet);
        orient3d(a, b, c, p)
    }

    /// A facet that is there.
    pub fn near(&self) -> u32 {
        self.near
    }

    /// How far from a point the hull reaches along an axis, and the largest coordinate.
    pub fn reach(&self, o: Point3) -> (f64, f64) {
        let alive = (0u32..).zip(&self.facets).filter(|(_, f)| f.alive);
        let corners = alive.flat_map(|(i, _)| self.corners(i));
        corners.fold((0.0, 0.0), |(far, most), p| {
            let away = (0..3).fold(far, |far: f64, k| far.max((p[k] - o[k]).abs()));
            (away, p.iter().fold(most, |most: f64, x| most.max(x.abs())))
        })
    }

    /// Where `p` is, by a walk from a facet.
    pub fn towards(&self, p: Point3, near: u32) -> Towards {
        let mut facet = near;
        let mut from = NONE;
        // Far more than walks have between neighbours on the curve, but where thin facets stand side by
        // side; and fewer than asking all facets is worth.
        for step in 0..64 + self.facets.len() / 8 {
            if self.side(p, facet) == Sign::Positive {
                return Towards::Beyond(facet);
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
                None => return Towards::Before(facet),
            }
        }
        let alive = (0..self.facets.len() as u32).filter(|&f| self.facets[f as usize].alive);
        let seen = alive
            .into_iter()
            .find(|&f| self.side(p, f) == Sign::Positive);
        seen.map_or(Towards::Before(near), Towards::Beyond)
    }

    /// Finds the facets that `p` sees, which go, and the edges of their rim with what is beyond.
    fn look(&mut self, p: u32, seed: u32) {
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

    /// Joins `p` to the rim.
    fn raise_cone(&mut self, p: u32) -> Result<()> {
        self.free.append(&mut self.seen);
        for i in 0..self.rim.len() {
            let (u, v, beyond) = self.rim[i];
            let facet = self.fresh();
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
        // Once round, from edge to edge.
        let broken = || Error::Internal("the rim of a cone is no cycle".into());
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

    fn fresh(&mut self) -> u32 {
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
