//! The Bowyer-Watson kernel: a point is inserted by emptying its cavity and filling it with a star.
//!
//! A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional
//! Delaunay tessellation", both The Computer Journal 24 (1981).
//!
//! ```text
//!       x-----x                x-----x
//!      / \   / \              /   .   \        The triangles whose circumcircle contains p are
//!     x---\-/---x    ->      x . . p . x       removed. This leaves a star-shaped cavity; each
//!      \   x p /              \  .  . /        boundary edge and p form a new triangle.
//!       \ / \ /                x-----x
//!        x---x
//! ```
//!
//! No old vertex lies inside a cavity (each stays a vertex), so its triangles form a tree, rooted
//! at the seed. A depth-first traversal of that tree, right child first, visits the boundary edges
//! in counterclockwise order: no marks and no hash map are needed. It terminates because the tree
//! is finite. A record is free once its two outer edges are on the stack; the k records of a cavity
//! of k triangles and two new ones hold the k + 2 triangles of the star.

use delone_predicates::{Point2, Sign, incircle_exact, lexicographic, orient2d, tie_flips};

use super::walk::walk;

use crate::base::points::Extent;
use crate::base::vector::cross2 as cross;
use crate::mesh::plane::{Code, Patch, half_edge, next, prev, triangle};

/// Relative bound of the in-circle filter, 16 units of rounding.
///
/// With e = 2^-53, d = q - p has a relative error e in each coordinate, a lift |d|^2 4 e (rounded
/// differences twice, product, sum), a cross product 4 e (|ax by| + |ay bx|), which Cauchy and the
/// inequality of means bound by 4 e (|a|^2 + |b|^2) / 2. A term lift * cross then errs by 9 e, and
/// two sums add 2 e, of (la lb + lb lc + lc la) in all, to first order. That sum itself is computed
/// to 10 e. 16 e leaves room for all terms of second order.
const INCIRCLE_BOUND: f64 = 16.0 * (f64::EPSILON / 2.0);

/// Relative bound of a cross product against the sum of the lifts: 4 units, halved by the
/// inequality of means; twice that leaves room.
const TURN_BOUND: f64 = 4.0 * (f64::EPSILON / 2.0);

/// What underflow may add, for differences up to 1: less than 2^6 products each err by at most
/// 2^-1075 and are multiplied by at most 2 M^2 for differences up to M. Far more than that, since
/// a subnormal number would be slow on some processors.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// A vertex as seen from the new point.
#[derive(Clone, Copy)]
struct Ray {
    vertex: u32,
    d: Point2,
    lift: f64,
}

/// An edge of the boundary so far, from the end of the previous one to `end`.
#[derive(Clone, Copy)]
struct Rim {
    across: Code,
    end: Ray,
    /// The cross product of its two ends.
    cross: f64,
    /// The apex beyond the edge. It is looked up when the edge is found and used when it is popped,
    /// so that the loads have time to complete: 5 % of the total.
    apex: Ray,
}

/// A triangle in conflict, relative to the new point.
struct Seed {
    /// The half-edge opposite the first corner.
    e: Code,
    corners: [Ray; 3],
    /// Cross products of the two corners of each edge, by opposite corner.
    crosses: [f64; 3],
}

/// A mesh into which points are inserted one at a time.
pub struct Kernel<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    ghost: u32,
    work: usize,
    rim: Vec<Rim>,
    free: Vec<u32>,
    underflow: f64,
}

impl<'a> Kernel<'a> {
    /// A kernel on an empty `mesh` over `points`, which lie in `extent` and end with a NaN point
    /// for infinity. It starts from the counterclockwise triangle `first`.
    pub fn start(
        points: &'a [Point2],
        extent: &Extent,
        mut mesh: Patch<'a>,
        first: [u32; 3],
    ) -> Self {
        let ghost = triangle(mesh.triangle(first));
        // If the side is infinite, so is the bound, and every test is exact.
        let side = extent.side();
        let underflow = UNDERFLOW * (side * side).max(1.0);
        Self {
            points,
            mesh,
            ghost,
            work: 0,
            rim: Vec::new(),
            free: Vec::new(),
            underflow,
        }
    }

    /// Triangles visited so far, in walks and cavities.
    pub fn work(&self) -> usize {
        self.work
    }

    /// The infinite corner of some ghost.
    pub fn ghost(&self) -> Code {
        let k = self
            .mesh
            .corners(self.ghost)
            .iter()
            .position(|&v| v == self.mesh.infinite());
        half_edge(self.ghost, k.unwrap_or(0) as u32)
    }

    #[inline]
    fn ray(&self, vertex: u32, origin: Point2) -> Ray {
        let p = self.points[vertex as usize];
        let d = [p[0] - origin[0], p[1] - origin[1]];
        Ray {
            vertex,
            d,
            lift: d[0] * d[0] + d[1] * d[1],
        }
    }

    #[inline]
    fn rim(&self, across: Code, end: Ray, cross: f64, origin: Point2) -> Rim {
        let apex = self.ray(self.mesh.vertex(across), origin);
        Rim {
            across,
            end,
            cross,
            apex,
        }
    }

    /// Inserts vertex `p`, which is not in the mesh yet; the search starts at triangle `near`.
    /// Returns the new triangle that points toward `aim`.
    pub fn insert(&mut self, p: u32, near: u32, aim: Point2) -> u32 {
        let origin = self.points[p as usize];
        let aim = [aim[0] - origin[0], aim[1] - origin[1]];
        let Seed {
            e,
            corners: [a, b, c],
            crosses: [bc, ca, ab],
        } = self.seed(p, near);
        self.rim.clear();
        self.free.clear();
        let spare = [self.mesh.fresh(), self.mesh.fresh()];
        self.free.extend_from_slice(&spare);
        self.free.push(triangle(e));
        self.work += 1;
        let last_edge = self.rim(self.mesh.opposite(next(e)), a, ca, origin);
        self.rim.push(last_edge);
        let middle = self.rim(self.mesh.opposite(e), c, bc, origin);
        self.rim.push(middle);
        let mut edge = self.rim(self.mesh.opposite(prev(e)), b, ab, origin);
        let mut from = a;
        let mut side = cross(a.d, aim);
        let (mut first, mut last, mut hint) = (u32::MAX, u32::MAX, u32::MAX);
        loop {
            //        w            Seen from p the edge runs from u to v. If the triangle
            //      /   \          beyond it is in conflict, its edges u w and w v replace
            //     v ---- u        u v.
            //         p
            let apex = edge.apex;
            let right = cross(from.d, apex.d);
            let left = cross(apex.d, edge.end.d);
            let (u, v, w) = (from.lift, edge.end.lift, apex.lift);
            let det = v * right + u * left - w * edge.cross;
            let bound = INCIRCLE_BOUND * (u * v + w * (u + v)) + self.underflow;
            let conflict = if det.abs() > bound {
                det > 0.0
            } else {
                self.conflicts_exactly(from.vertex, edge.end.vertex, apex.vertex, p)
            };
            if conflict {
                let e = edge.across;
                self.free.push(triangle(e));
                self.work += 1;
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
            let ahead = cross(edge.end.d, aim);
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
        if hint == u32::MAX { last } else { hint }
    }

    /// A triangle in conflict with vertex `p`: walks from `near` across edges that have p on their
    /// other side to the first triangle whose circumcircle contains p. Such a walk terminates (see
    /// `walk`).
    #[inline]
    fn seed(&mut self, p: u32, near: u32) -> Seed {
        let origin = self.points[p as usize];
        let mut e = half_edge(near, 0);
        let [mut a, mut b, mut c] = self.mesh.corners(near).map(|v| self.ray(v, origin));
        loop {
            //        c               The cross products tell on which side of its edges p
            //      /   \             lies; with the lifts they tell whether its circle contains p.
            //     a --- b
            let [bc, ca, ab] = [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)];
            let det = a.lift * bc + b.lift * ca + c.lift * ab;
            let sum = a.lift + b.lift;
            let bound = INCIRCLE_BOUND * (a.lift * b.lift + c.lift * sum) + self.underflow;
            if det > bound {
                return Seed {
                    e,
                    corners: [a, b, c],
                    crosses: [bc, ca, ab],
                };
            }
            let certain = -(TURN_BOUND * (sum + c.lift) + self.underflow);
            // If a corner is infinite, all of this is NaN and nothing is certain.
            if det < -bound && bc < certain {
                (b, c) = (c, b);
            } else if det < -bound && ca < certain {
                e = next(e);
                (b, c) = (a, c);
            } else if det < -bound && ab < certain {
                e = prev(e);
                (b, c) = (b, a);
            } else {
                return self.seed_exactly(p, triangle(e));
            }
            self.work += 1;
            e = self.mesh.opposite(e);
            a = self.ray(self.mesh.vertex(e), origin);
        }
    }

    /// The same, by a walk with exact predicates to the triangle that contains p.
    #[cold]
    #[inline(never)]
    fn seed_exactly(&mut self, p: u32, near: u32) -> Seed {
        let origin = self.points[p as usize];
        let (seed, steps) = walk(&self.mesh, self.points, near, origin);
        self.work += steps;
        let [a, b, c] = self.mesh.corners(seed).map(|v| self.ray(v, origin));
        let crosses = [cross(b.d, c.d), cross(c.d, a.d), cross(a.d, b.d)];
        Seed {
            e: half_edge(seed, 0),
            corners: [a, b, c],
            crosses,
        }
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

    /// Whether the triangle `v u w`, beyond the edge u v from p, is in conflict with p; exact, for
    /// ghosts, too.
    #[cold]
    #[inline(never)]
    fn conflicts_exactly(&self, u: u32, v: u32, w: u32, p: u32) -> bool {
        let at = |i: u32| self.points[i as usize];
        let inf = self.mesh.infinite();
        let (a, b) = match (u == inf, v == inf, w == inf) {
            (false, false, false) => {
                // The triangle beyond is not degenerate and p is not a corner of it, so a tie means four
                // distinct points on a circle.
                return match incircle_exact(at(v), at(u), at(w), at(p)) {
                    Sign::Zero => tie_flips(at(u), at(v), at(w), at(p)),
                    sign => sign == Sign::Positive,
                };
            }
            (true, ..) => (w, v),
            (_, true, _) => (u, w),
            _ => (v, u),
        };
        // A ghost: the outer side of the hull lies left of a -> b.
        match orient2d(at(a), at(b), at(p)) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => lexicographic(at(a), at(p)) == lexicographic(at(p), at(b)),
        }
    }
}
