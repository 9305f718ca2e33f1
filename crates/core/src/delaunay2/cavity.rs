//! The kernel: one point goes into the mesh by carving its cavity and filling it with a star.
//!
//! A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional
//! Delaunay tessellation", both The Computer Journal 24 (1981).
//!
//! ```text
//!       x-----x                x-----x
//!      / \   / \              /   .   \        The triangles whose circle holds p go; what is
//!     x---\-/---x    ->      x . . p . x       left is a star-shaped hole, whose edges, seen
//!      \   x p /              \  .  . /        from p, become triangles.
//!       \ / \ /                x-----x
//!        x---x
//! ```
//!
//! No old vertex lies inside a cavity (each stays a vertex), so its triangles form a tree from the
//! seed outwards. A depth-first walk of that tree, always to the right first, meets the edges of
//! the hole in counter-clockwise order: no marks, no hash map. It ends because the tree does.
//! A record is free once its two outer edges are on the stack; a cavity of k triangles
//! gives its k records and two fresh ones to the k + 2 triangles of the star.

use delone_predicates::{Point2, Sign, incircle_exact, lexicographic, orient2d, tie_flips};

use crate::mesh2::{Code, Patch, next, prev, triangle};
use crate::points::Extent;

/// Relative bound of the in-circle filter, 16 units of rounding.
///
/// With e = 2^-53, d = q - p has a relative error e in each coordinate, a lift |d|^2 4 e (rounded
/// differences twice, product, sum), a cross product 4 e (|ax by| + |ay bx|), which Cauchy and the
/// inequality of means bound by 4 e (|a|^2 + |b|^2) / 2. A term lift * cross then errs by 9 e, and
/// two sums add 2 e, of (la lb + lb lc + lc la) in all, to first order. That sum itself is computed
/// to 10 e. 16 e leaves room for all terms of second order.
const INCIRCLE_BOUND: f64 = 16.0 * (f64::EPSILON / 2.0);

/// What underflow may add, for differences up to 1: less than 2^6 products each err by at most
/// 2^-1075 and are multiplied by at most 2 M^2 for differences up to M.
const UNDERFLOW: f64 = f64::from_bits(1 << 14);

/// A vertex as seen from the new point.
#[derive(Clone, Copy)]
struct Ray {
    vertex: u32,
    d: Point2,
    lift: f64,
}

/// An edge of the hole so far, from the end of the one before to `end`.
#[derive(Clone, Copy)]
struct Rim {
    across: Code,
    end: Ray,
    /// The cross product of its two ends.
    cross: f64,
}

#[inline]
fn cross(a: Point2, b: Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// A mesh that grows by one point at a time.
pub struct Kernel<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    ghost: u32,
    carved: usize,
    rim: Vec<Rim>,
    free: Vec<u32>,
    underflow: f64,
}

impl<'a> Kernel<'a> {
    /// A kernel on an empty `mesh` over `points`, which lie in `extent` and end with a NaN point
    /// for infinity, that starts from the counter-clockwise triangle `first`.
    pub fn start(
        points: &'a [Point2],
        extent: &Extent,
        mut mesh: Patch<'a>,
        first: [u32; 3],
    ) -> Self {
        let ghost = triangle(mesh.triangle(first));
        // An infinite side makes the bound infinite: then every test is exact.
        let side = extent.side();
        let underflow = UNDERFLOW * (side * side).max(1.0);
        Self {
            points,
            mesh,
            ghost,
            carved: 0,
            rim: Vec::new(),
            free: Vec::new(),
            underflow,
        }
    }

    /// The mesh so far.
    pub fn mesh(&self) -> &Patch<'a> {
        &self.mesh
    }

    /// The triangles that the last insertion took away.
    pub fn carved(&self) -> usize {
        self.carved
    }

    /// The infinite corner of some ghost.
    pub fn ghost(&self) -> Code {
        let k = self
            .mesh
            .corners(self.ghost)
            .iter()
            .position(|&v| v == self.mesh.infinite());
        8 * self.ghost + k.unwrap_or(0) as u32
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

    /// Inserts vertex `p`, which lies in the closed triangle `seed`, or strictly beyond the hull
    /// edge of the ghost `seed`, and is no vertex yet. Returns the new triangle that points
    /// towards `aim`.
    pub fn insert(&mut self, p: u32, seed: u32, aim: Point2) -> u32 {
        let origin = self.points[p as usize];
        let aim = [aim[0] - origin[0], aim[1] - origin[1]];
        let [a, b, c] = self.mesh.corners(seed).map(|v| self.ray(v, origin));
        let [across_a, across_b, across_c] = self.mesh.opposites(seed);
        self.rim.clear();
        self.free.clear();
        self.free.push(seed);
        self.carved = 1;
        self.rim.push(Rim {
            across: across_b,
            end: a,
            cross: cross(c.d, a.d),
        });
        self.rim.push(Rim {
            across: across_a,
            end: c,
            cross: cross(b.d, c.d),
        });
        let mut edge = Rim {
            across: across_c,
            end: b,
            cross: cross(a.d, b.d),
        };
        let mut from = a;
        let mut side = cross(a.d, aim);
        let (mut first, mut last, mut hint) = (u32::MAX, u32::MAX, u32::MAX);
        loop {
            //        w            Seen from p the edge runs from u to v. If the triangle
            //      /   \          beyond it is in conflict, its edges u w and w v take
            //     v ---- u        the place of u v.
            //         p
            let apex = self.ray(self.mesh.vertex(edge.across), origin);
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
                self.carved += 1;
                let beyond_left = self.mesh.opposite(prev(e));
                self.rim.push(Rim {
                    across: beyond_left,
                    end: edge.end,
                    cross: left,
                });
                edge = Rim {
                    across: self.mesh.opposite(next(e)),
                    end: apex,
                    cross: right,
                };
                continue;
            }
            let t = self.spoke([p, from.vertex, edge.end.vertex], edge.across);
            if last == u32::MAX {
                first = t;
            } else {
                self.mesh.link(8 * last + 1, 8 * t + 2);
            }
            last = t;
            if edge.end.vertex == self.mesh.infinite() {
                // Who takes a ghost away makes two: the last one made is there.
                self.ghost = t;
            }
            let ahead = cross(edge.end.d, aim);
            // A side of NaN is at infinity and counts as past the aim.
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
        self.mesh.link(8 * last + 1, 8 * first + 2);
        if hint == u32::MAX { last } else { hint }
    }

    /// Writes a triangle of the star in a free record and links its outer edge.
    #[inline]
    fn spoke(&mut self, corners: [u32; 3], across: Code) -> u32 {
        let t = match self.free.pop() {
            Some(t) => t,
            None => self.mesh.fresh(),
        };
        self.mesh.set(t, corners);
        self.mesh.link(across, 8 * t);
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
                return match incircle_exact(at(v), at(u), at(w), at(p)) {
                    Sign::Positive => true,
                    Sign::Negative => false,
                    Sign::Zero => tie_flips(at(u), at(v), at(p), at(w)),
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
