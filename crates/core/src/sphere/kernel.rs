//! Insertion of a direction: its cavity is emptied and filled with a star, as in 2-D.
//!
//! A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional
//! Delaunay tessellation", both The Computer Journal 24 (1981). The structure, and why the
//! triangles of a cavity form a tree, are those of `delaunay::plane::cavity`; `close` has the one
//! insertion where they do not.
//!
//! # Bounds of the filters
//!
//! They use the rounded directions alone. Let u = 2^-53, P = a - p for the new direction p,
//! computed from the heads, and s its 1-norm, at most 2 sqrt 3; likewise Q with t and R with w. A
//! tail is at most u / 2, so an entry errs by u of itself and 1.01 u. In the determinant [P, Q, R],
//! a monomial goes through three differences, two products, a difference and two sums: 9 u of the
//! permanent, with room, and the permanent is at most s t w. An error of 1.01 u in one entry is
//! multiplied by a minor of the other rows, which gives 1.01 u (s t + t w + w s) in total. Products
//! of two such errors are at most 2.1 u^2 (s + t + w), of three 6.2 u^3. If the determinant exceeds
//! 3 u (s t + t w + w s), then so does s t w, and each of s, t, w is above 3 u. Then products of
//! two errors are below 0.7 u and those of three below 0.3 u times that sum. In total, these are
//! 2.1 u times the sum, for which [`CIRCLE_BOUND`] takes 3 u, in addition to 10 u s t w.
//!
//! The determinant [P, Q, p] errs by 8 u of its permanent, at most s t, by 0.5 u s t for the tail
//! of p, and by 1.01 u 1.74 (s + t) for the other tails. Products of two of these are at most 3.6
//! u^2. If the determinant exceeds 3 u (s + t), then s and t are above 3 u, so this is at most 0.6
//! u (s + t). In total, these are 2.4 u (s + t), for which [`TURN_BOUND`] takes 3 u, in addition to
//! 10 u s t.
//!
//! The coordinates of the infinite vertex are NaN: no filter is certain there, so exact tests
//! handle ghosts.

use std::ops::Range;

use delone_predicates::{Point3, Sign};

use super::directions::Directions;
use super::walk::walk;
use crate::base::error::Result;
use crate::base::memory::push;
pub(super) use crate::base::vector::{cross, dot};
use crate::base::watch::{Pace, Watch};
use crate::mesh::plane::{Code, Patch, half_edge, next, prev, triangle};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Bound of the determinant of three differences, for tails.
const CIRCLE_BOUND: f64 = 3.0 * U;
/// Bound of the determinant of two differences and a direction, for tails.
const TURN_BOUND: f64 = 3.0 * U;
/// Bound of both determinants, for the arithmetic.
const ROUNDING: f64 = 10.0 * U;

/// Units of work between two checks for interruption; a triangle counts as one.
const WATCH_EVERY: usize = 1 << 14;
/// The units of work of an exact test, which takes 10 ns to 300 us.
const EXACT: usize = 256;

/// A vertex as seen from the new direction.
#[derive(Clone, Copy)]
struct Ray {
    vertex: u32,
    d: Point3,
    size: f64,
}

/// An edge of the boundary so far, from the end of the previous one to `end`.
#[derive(Clone, Copy)]
struct Rim {
    across: Code,
    end: Ray,
    /// The cross product of its two ends.
    cross: Point3,
    /// The apex beyond the edge.
    apex: Ray,
}

/// A triangle in conflict, relative to the new direction.
struct Seed {
    /// The half-edge opposite the first corner.
    e: Code,
    corners: [Ray; 3],
    /// Cross products of the two corners of each edge, by opposite corner.
    crosses: [Point3; 3],
}

#[inline]
pub(super) fn circle_bound(s: f64, t: f64, w: f64) -> f64 {
    let product = s * t;
    CIRCLE_BOUND * (product + w * (s + t)) + ROUNDING * (product * w)
}

#[inline]
pub(super) fn turn_bound(s: f64, t: f64) -> f64 {
    TURN_BOUND * (s + t) + ROUNDING * (s * t)
}

/// A mesh into which directions are inserted one at a time.
pub struct Kernel<'a> {
    directions: &'a Directions,
    pub(super) mesh: Patch<'a>,
    /// Whether the sphere is covered: no ghosts are left.
    pub(super) is_closed: bool,
    ghost: u32,
    pace: Pace<'a>,
    rim: Vec<Rim>,
    free: Vec<u32>,
    /// Directions that are the same as that of a vertex, with that vertex.
    pub repeats: Vec<[u32; 2]>,
}

impl<'a> Kernel<'a> {
    /// A kernel on an empty `mesh` that starts from the counterclockwise triangle `first`.
    pub fn start(
        directions: &'a Directions,
        mut mesh: Patch<'a>,
        first: [u32; 3],
        watch: &'a Watch<'a>,
    ) -> Self {
        let ghost = triangle(mesh.triangle(first));
        Self {
            directions,
            mesh,
            is_closed: false,
            ghost,
            pace: Pace::new(watch, WATCH_EVERY),
            rim: Vec::new(),
            free: Vec::new(),
            repeats: Vec::new(),
        }
    }

    /// The infinite corner of some ghost; `None` if the sphere is covered.
    pub fn ghost(&self) -> Option<Code> {
        (!self.is_closed).then(|| self.infinite_corner(self.ghost))
    }

    /// The number of records in use.
    pub fn taken(&self) -> Range<u32> {
        self.mesh.taken()
    }

    /// The infinite corner of ghost `t`.
    pub(super) fn infinite_corner(&self, t: u32) -> Code {
        let inf = self.mesh.infinite();
        let k = self.mesh.corners(t).iter().position(|&v| v == inf);
        half_edge(t, k.unwrap_or(0) as u32)
    }

    #[inline]
    fn ray(&self, vertex: u32, origin: Point3) -> Ray {
        let p = self.directions.heads[vertex as usize];
        let d = [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
        Ray {
            vertex,
            d,
            size: d[0].abs() + d[1].abs() + d[2].abs(),
        }
    }

    #[inline]
    fn rim(&self, across: Code, end: Ray, cross: Point3, origin: Point3) -> Rim {
        let apex = self.ray(self.mesh.vertex(across), origin);
        Rim {
            across,
            end,
            cross,
            apex,
        }
    }

    /// Inserts direction `p`, or notes that it is already present; the search starts at triangle
    /// `near`. Returns a triangle at `p`, the one that points toward direction `aim` if that is
    /// known.
    pub fn insert(&mut self, p: u32, near: u32, aim: u32) -> Result<u32> {
        let origin = self.directions.heads[p as usize];
        let seed = match self.seed(p, near)? {
            Found::Conflict(seed) => seed,
            Found::Vertex(t) => return Ok(t),
            Found::Closes(ghost) => return self.close(p, ghost),
        };
        self.pace.spend(1)?;
        let aim = cross(self.ray(aim, origin).d, origin);
        let Seed {
            e,
            corners: [a, b, c],
            crosses: [bc, ca, ab],
        } = seed;
        self.rim.clear();
        self.free.clear();
        let spare = [self.mesh.fresh(), self.mesh.fresh()];
        self.free.extend_from_slice(&spare);
        self.free.push(triangle(e));
        let last_edge = self.rim(self.mesh.opposite(next(e)), a, ca, origin);
        self.rim.push(last_edge);
        let middle = self.rim(self.mesh.opposite(e), c, bc, origin);
        self.rim.push(middle);
        let mut edge = self.rim(self.mesh.opposite(prev(e)), b, ab, origin);
        let mut from = a;
        let mut side = dot(a.d, aim);
        let (mut first, mut last, mut hint) = (u32::MAX, u32::MAX, u32::MAX);
        loop {
            //        w            Seen from p, the edge runs from u to v. If the triangle
            //      /   \          beyond it is in conflict, its edges u w and w v replace
            //     v ---- u        u v.
            //         p
            let apex = edge.apex;
            let det = dot(edge.cross, apex.d);
            let conflict = if det.abs() > circle_bound(from.size, edge.end.size, apex.size) {
                det > 0.0
            } else {
                self.conflicts(triangle(edge.across), p)?
            };
            if conflict {
                let e = edge.across;
                self.free.push(triangle(e));
                let right = cross(from.d, apex.d);
                let left = cross(apex.d, edge.end.d);
                let beyond = [self.mesh.opposite(prev(e)), self.mesh.opposite(next(e))];
                let second = self.rim(beyond[0], edge.end, left, origin);
                self.rim.push(second);
                edge = self.rim(beyond[1], apex, right, origin);
                continue;
            }
            let t = self.spoke([p, from.vertex, edge.end.vertex], edge.across);
            if last == u32::MAX {
                first = t;
            } else {
                self.mesh.link(half_edge(last, 1), half_edge(t, 2));
            }
            last = t;
            if edge.end.vertex == self.mesh.infinite() {
                // An insertion that removes a ghost makes two new ones; remember the last one.
                self.ghost = t;
            }
            let ahead = dot(edge.end.d, aim);
            // A NaN side is at infinity and counts as beyond the aim.
            hint = if side >= 0.0 && (ahead < 0.0 || ahead.is_nan()) {
                t
            } else {
                hint
            };
            (from, side) = (edge.end, ahead);
            match self.rim.pop() {
                Some(rim) => edge = rim,
                None => break,
            }
        }
        self.mesh.link(half_edge(last, 1), half_edge(first, 2));
        Ok(if hint == u32::MAX { last } else { hint })
    }

    /// Where to insert `p`: walks from `near` across edges that have p on their other side. While
    /// there are ghosts, the walk ends only at the triangle that contains p, to tell whether p is
    /// outside.
    #[inline]
    fn seed(&mut self, p: u32, near: u32) -> Result<Found> {
        let origin = self.directions.heads[p as usize];
        let mut e = half_edge(near, 0);
        let [mut a, mut b, mut c] = self.mesh.corners(near).map(|v| self.ray(v, origin));
        loop {
            //        c               The cross products tell on which side of its edges p
            //      /   \             lies, and whether its circle contains p.
            //     a --- b
            let [bc, ca, ab] = [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)];
            if self.is_closed && -dot(a.d, bc) > circle_bound(a.size, b.size, c.size) {
                return Ok(Found::Conflict(Seed {
                    e,
                    corners: [a, b, c],
                    crosses: [bc, ca, ab],
                }));
            }
            let turns = [dot(bc, origin), dot(ca, origin), dot(ab, origin)];
            let bounds = [[b, c], [c, a], [a, b]].map(|[x, y]| turn_bound(x.size, y.size));
            if turns[0] < -bounds[0] {
                (b, c) = (c, b);
            } else if turns[1] < -bounds[1] {
                e = next(e);
                (b, c) = (a, c);
            } else if turns[2] < -bounds[2] {
                e = prev(e);
                (b, c) = (b, a);
            } else if turns[0] > bounds[0] && turns[1] > bounds[1] && turns[2] > bounds[2] {
                return Ok(Found::Conflict(Seed {
                    e,
                    corners: [a, b, c],
                    crosses: [bc, ca, ab],
                }));
            } else {
                // If a corner is infinite, all of this is NaN and nothing is certain.
                return self.seed_exactly(p, triangle(e));
            }
            self.pace.spend(1)?;
            e = self.mesh.opposite(e);
            a = self.ray(self.mesh.vertex(e), origin);
        }
    }

    /// The same as `seed`, by a walk with exact predicates to the triangle that contains p.
    #[cold]
    #[inline(never)]
    fn seed_exactly(&mut self, p: u32, near: u32) -> Result<Found> {
        let origin = self.directions.heads[p as usize];
        let (seed, steps) = walk(&self.mesh, self.directions, near, p);
        self.pace.spend(steps)?;
        let corners = self.mesh.corners(seed);
        let inf = self.mesh.infinite();
        if corners.contains(&inf) {
            if self.closes(p, seed)? {
                return Ok(Found::Closes(seed));
            }
        } else if let Some(v) = corners.into_iter().find(|&v| self.directions.same(v, p)) {
            push(&mut self.repeats, [p, v])?;
            return Ok(Found::Vertex(seed));
        }
        let [a, b, c] = corners.map(|v| self.ray(v, origin));
        Ok(Found::Conflict(Seed {
            e: half_edge(seed, 0),
            corners: [a, b, c],
            crosses: [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)],
        }))
    }

    /// Writes a triangle of the star to a free record and links its outer edge.
    #[inline]
    fn spoke(&mut self, corners: [u32; 3], across: Code) -> u32 {
        // The two new records are at the bottom of the stack, so it never runs empty.
        let t = self.free.pop().unwrap_or_default();
        self.mesh.set(t, corners);
        self.mesh.link(across, half_edge(t, 0));
        t
    }

    /// Whether triangle `t`, possibly a ghost, is in conflict with `p`; exact.
    #[cold]
    #[inline(never)]
    pub(super) fn conflicts(&mut self, t: u32, p: u32) -> Result<bool> {
        self.pace.spend(EXACT)?;
        let [a, b, c] = self.mesh.corners(t);
        let inf = self.mesh.infinite();
        let (from, to) = if a == inf {
            (b, c)
        } else if b == inf {
            (c, a)
        } else if c == inf {
            (a, b)
        } else {
            return Ok(self.directions.in_circle([a, b, c, p]));
        };
        // A ghost: the outer side of the hull lies left of its finite edge.
        Ok(match self.directions.orient([from, to, p]) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => self.directions.between(from, p, to),
        })
    }
}

/// Where a direction belongs.
enum Found {
    /// A triangle in conflict with it.
    Conflict(Seed),
    /// A triangle with a corner in the same direction.
    Vertex(u32),
    /// A ghost; all ghosts are in conflict.
    Closes(u32),
}
