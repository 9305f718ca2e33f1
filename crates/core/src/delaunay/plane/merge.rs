//! Merges two separated triangulations: the merge step of divide and conquer.
//!
//! L. Guibas and J. Stolfi, "Primitives for the manipulation of general subdivisions and the
//! computation of Voronoi diagrams", ACM Transactions on Graphics 4 (1985); on triangles with
//! ghosts as in J. R. Shewchuk, "Triangle" (1996). Linear time: every step adds a triangle between
//! the two or removes one that never returns.
//!
//! # The frame of the bridge
//!
//! All tests of a step have two points in common, the ends l and r of the bridge. For a point p let
//! s = (r - l) x (p - l), positive above the bridge, and t = (p - l) . (p - r). Then t / s is the
//! cotangent of the angle at which p sees the bridge, and expanding both sides shows that
//! incircle(l, r, p, q) = t(p) s(q) - t(q) s(p): a candidate costs ten operations, and a comparison
//! of two of them three.
//!
//! # The bounds of the filter
//!
//! Let u = 2^-53 and W the longer side of the box of both parts, so that no difference of
//! coordinates is larger. A rounded difference errs by u W, and a product of two by 3 u W^2 to
//! first order. s and t, sums of two of those, each at most 2 W^2 in size, err by 2 * 3 u W^2 + 2 u
//! W^2 = 8 u W^2. A product of s and t errs by 2 * 2 W^2 * 8 u W^2 + 4 u W^4 = 36 u W^4, and the
//! difference of two, at most 8 W^4, by 2 * 36 u W^4 + 8 u W^4 = 80 u W^4. [`TURN`] and [`CIRCLE`]
//! leave at least a fifth for terms of second order and the roundings of W and of the bounds. The
//! bounds are used only for W between 2^-200 and 2^250: there nothing overflows, and underflow adds
//! less than 2^-1070 (1 + W^2), no more than a term of second order. Other parts are merged by the
//! exact predicates alone, which also decide what the bounds leave open. The infinite vertex is
//! NaN, above no bridge and in no circle.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use super::part::{Corner, Part};
use crate::mesh::plane::{Code, OPPOSITE, Patch, half_edge, triangle};
use crate::order::blocks::Axis;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Bound of s for parts of side 1.
const TURN: f64 = 10.0 * U;
/// Bound of the in-circle test for parts of side 1.
const CIRCLE: f64 = 96.0 * U;
/// So much larger than t for parts of side 1 that its product with a certain s is certain, too.
const FAR: f64 = 16.0;

/// Rounding bounds for points in a box.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The square of the longer side.
    pub square: f64,
    /// Whether it is far enough from the ends of the range of doubles for the bounds to hold.
    pub hold: bool,
}

impl Bounds {
    /// The bounds for points in a box of the longer side `side`, rounded.
    #[inline]
    pub fn within(side: f64) -> Self {
        let (least, most) = (1.0 / (1u128 << 100) as f64, (1u128 << 125) as f64);
        Self {
            square: side * side,
            hold: side > least * least && side < most * most,
        }
    }
}

/// Joins two triangulations in `mesh`, each given by one of its ghosts, using the two free records
/// `spare`. All points of `left` precede all of `right` along `axis`. Returns a ghost.
pub fn merge(
    mesh: &mut Patch,
    points: &[Point2],
    ghosts: [Code; 2],
    axis: Axis,
    [bottom, top]: [u32; 2],
) -> Code {
    let [left, right] = ghosts.map(|g| Part::with_hull(mesh, points, g));
    let bounds = Bounds::within(Part::side(points, [&left, &right]));
    let free = Free {
        bottom,
        top,
        idle: top,
    };
    join(mesh, points, [&left, &right], axis, bounds, free).ghost()
}

/// Records that a merge may use.
#[derive(Debug, Clone, Copy)]
pub struct Free {
    /// For the ghost below.
    pub bottom: u32,
    /// For the ghost above.
    pub top: u32,
    /// Needed during the merge if a part is a single vertex.
    pub idle: u32,
}

/// Joins two parts of the points, not both single. Returns the joined part.
pub fn join(
    mesh: &mut Patch,
    points: &[Point2],
    [left, right]: [&Part; 2],
    axis: Axis,
    bounds: Bounds,
    Free { bottom, top, idle }: Free,
) -> Part {
    let inf = mesh.infinite();
    // From the two vertices that face each other, down to the lower tangent.
    let (l, r) = (left.last(axis), right.first(axis));
    let (mut l_in, mut r_in) = (l.ghost(), r.ghost());
    if left.single || right.single {
        // Instead of ghosts, use one record with infinite corners that is its own neighbor.
        mesh.set(idle, [inf; 3]);
        mesh.link(half_edge(idle, 0), half_edge(idle, 0));
        mesh.link(half_edge(idle, 1), half_edge(idle, 2));
        l_in = if left.single { idle } else { l_in };
        r_in = if right.single { idle } else { r_in };
    }
    let ends = [l.vertex(), r.vertex()];
    let ([l, r], [l_in, r_in]) = lower_tangent(mesh, points, bounds, ends, [l_in, r_in]);
    let (l_out, r_out) = (after(mesh, l_in), after(mesh, r_in));
    //     left       right      A ghost below the first bridge from l to r. The bridge rises;
    //   l_out \     / r_in      triangles are added below it, and the region above it is bounded
    //          l---r            by the ghosts l_out, which begins at l, and r_in, which ends at r.
    //    l_in /     \ r_out
    mesh.set(bottom, [inf, r, l]);
    mesh.link(half_edge(bottom, 1), half_edge(l_in, 2));
    mesh.link(half_edge(bottom, 2), half_edge(r_out, 1));
    let lower = Corner::new(r, bottom);
    let mut bridge = Bridge {
        l,
        r,
        below: half_edge(bottom, 0),
        l_out,
        r_in,
    };
    bridge.rise(mesh, points, bounds);
    // The bridge is the upper tangent now: a ghost above it closes the hull.
    mesh.set(top, [inf, bridge.l, bridge.r]);
    mesh.link(half_edge(top, 0), bridge.below);
    mesh.link(half_edge(top, 2), half_edge(bridge.l_out, 1));
    mesh.link(half_edge(top, 1), half_edge(bridge.r_in, 2));
    // A single vertex has no hull edge between the ghosts above and below it.
    if left.single {
        mesh.link(half_edge(bottom, 1), half_edge(top, 2));
    }
    if right.single {
        mesh.link(half_edge(bottom, 2), half_edge(top, 1));
    }
    let upper = Corner::new(bridge.l, top);
    Part::merged(points, left, right, upper, lower)
}

/// The ghost after ghost `g`, by records; the infinite corner of the ghosts is the first.
#[inline]
fn after(mesh: &Patch, g: u32) -> u32 {
    triangle(mesh.record(g)[OPPOSITE + 2])
}

/// The ghost before ghost `g`.
#[inline]
fn before(mesh: &Patch, g: u32) -> u32 {
    triangle(mesh.record(g)[OPPOSITE + 1])
}

/// The lower tangent: moves from vertices on the two hulls, given with the ghosts that end there,
/// to those such that neither hull has a vertex below the line through them. Of collinear vertices
/// on it, the nearest two are returned. Each step advances around a hull.
#[inline]
fn lower_tangent(
    mesh: &Patch,
    points: &[Point2],
    bounds: Bounds,
    [mut l, mut r]: [u32; 2],
    [mut l_in, mut r_in]: [u32; 2],
) -> ([u32; 2], [u32; 2]) {
    let at = |v: u32| points[v as usize];
    let bound = if bounds.hold {
        TURN * bounds.square
    } else {
        f64::INFINITY
    };
    let below = |l: u32, r: u32, v: u32| {
        let s = Frame::of(at(l), at(r)).see(at(v)).s;
        if s.abs() > bound {
            return s < 0.0;
        }
        v != mesh.infinite() && orient2d(at(l), at(r), at(v)) == Sign::Negative
    };
    loop {
        let tail = mesh.record(l_in)[2];
        if below(l, r, tail) {
            (l, l_in) = (tail, before(mesh, l_in));
            continue;
        }
        let r_out = after(mesh, r_in);
        let head = mesh.record(r_out)[1];
        if !below(l, r, head) {
            return ([l, r], [l_in, r_in]);
        }
        (r, r_in) = (head, r_out);
    }
}

/// The bridge as the base of candidate triangles.
struct Frame {
    l: Point2,
    r: Point2,
    d: Point2,
}

/// How a point lies relative to the bridge; see the head of the file.
#[derive(Clone, Copy)]
struct Sight {
    s: f64,
    t: f64,
}

impl Frame {
    #[inline]
    fn of(l: Point2, r: Point2) -> Self {
        let d = [r[0] - l[0], r[1] - l[1]];
        Self { l, r, d }
    }

    #[inline(always)]
    fn see(&self, p: Point2) -> Sight {
        let from_l = [p[0] - self.l[0], p[1] - self.l[1]];
        let from_r = [p[0] - self.r[0], p[1] - self.r[1]];
        Sight {
            s: self.d[0] * from_l[1] - self.d[1] * from_l[0],
            t: from_l[0] * from_r[0] + from_l[1] * from_r[1],
        }
    }

    /// The vertex beyond the hull edge of ghost `g`.
    #[inline(always)]
    fn behind(&self, mesh: &Patch, points: &[Point2], g: u32) -> (u32, Sight) {
        let x = mesh.vertex(mesh.record(g)[OPPOSITE]);
        (x, self.see(points[x as usize]))
    }
}

impl Sight {
    /// Positive if `other` lies in the circle through the bridge and this point.
    #[inline(always)]
    fn holds(self, other: Self) -> f64 {
        self.t * other.s - other.t * self.s
    }
}

/// Whether the circle through the bridge l r and `v` above it contains `x`, with ties as in the
/// whole mesh.
#[cold]
#[inline(never)]
fn holds(points: &[Point2], vertices: [u32; 4]) -> bool {
    let [l, r, v, x] = vertices.map(|v| points[v as usize]);
    incircle_canonical(l, r, v, x) == Sign::Positive
}

/// The smaller, without a branch; the second if one is NaN.
#[inline]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger, without a branch; the second if one is NaN.
#[inline]
fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The edge that rises between the two parts.
#[derive(Clone, Copy)]
struct Bridge {
    l: u32,
    r: u32,
    /// The bridge as an edge of what lies below it.
    below: Code,
    l_out: u32,
    r_in: u32,
}

impl Bridge {
    /// Adds triangles up to the upper tangent.
    #[inline]
    fn rise(&mut self, mesh: &mut Patch, points: &[Point2], bounds: Bounds) {
        let mut more = true;
        while more && !bounds.hold {
            more = self.step_exactly(mesh, points);
        }
        // A copy whose address is never taken stays in registers.
        let mut bridge = *self;
        while more {
            more = bridge.step(mesh, points, bounds.square).unwrap_or_else(|| {
                let mut exact = bridge;
                let more = exact.step_exactly(mesh, points);
                bridge = exact;
                more
            });
        }
        *self = bridge;
    }

    /// Adds the triangle on the bridge; false if the bridge is the upper tangent, `None` if the
    /// bounds do not decide what lies above the bridge.
    #[inline(always)]
    fn step(&mut self, mesh: &mut Patch, points: &[Point2], square: f64) -> Option<bool> {
        let at = |v: u32| points[v as usize];
        let (turn, circle) = (TURN * square, CIRCLE * (square * square));
        // The candidates: the next vertex of the hull on each side, as seen from the bridge.
        let (l, r) = (self.l, self.r);
        let frame = Frame::of(at(l), at(r));
        let mut left = mesh.record(self.l_out)[1];
        let mut right = mesh.record(self.r_in)[2];
        let (mut on_left, mut on_right) = (frame.see(at(left)), frame.see(at(right)));
        if on_left.s.abs() <= turn || on_right.s.abs() <= turn {
            return None;
        }
        // Load both first: neither waits for the branches of the other.
        let mut behind_left = frame.behind(mesh, points, self.l_out);
        let mut behind_right = frame.behind(mesh, points, self.r_in);
        let goes = |v: u32, on: Sight, (x, beyond): (u32, Sight)| {
            let held = on.holds(beyond);
            // One test for above the bridge and in the circle; the exact test only if it is above.
            least(on.s - turn, held - circle) > 0.0
                || most(turn - on.s, held.abs() - circle) <= 0.0 && holds(points, [l, r, v, x])
        };
        // On each side, triangles go whose circles the candidate empties: terminates, since each removes
        // one.
        while goes(left, on_left, behind_left) {
            self.l_out = mesh.peel(self.l_out);
            (left, on_left) = behind_left;
            if on_left.s <= turn {
                return None; // It may be above the bridge: left to the exact step.
            }
            behind_left = frame.behind(mesh, points, self.l_out);
        }
        while goes(right, on_right, behind_right) {
            self.peel_right(mesh);
            (right, on_right) = behind_right;
            if on_right.s <= turn {
                return None; // It may be above the bridge: left to the exact step.
            }
            behind_right = frame.behind(mesh, points, self.r_in);
        }
        // A point not above the bridge is moved far away on its line, so the other is taken.
        let far = |on: Sight| Sight {
            s: most(on.s, 0.0),
            t: if on.s > turn { on.t } else { FAR * square },
        };
        let (on_left, on_right) = (far(on_left), far(on_right));
        // None above: this is the tangent. Else the one whose circle does not contain the other.
        if on_left.s + on_right.s == 0.0 {
            return Some(false);
        }
        let mut held = on_left.holds(on_right);
        if held.abs() <= circle {
            held = f64::from(i8::from(holds(points, [l, r, left, right])));
        }
        if held > 0.0 {
            self.take_right(mesh, right);
        } else {
            self.take_left(mesh, left);
        }
        Some(true)
    }

    /// The same by exact predicates, if it is uncertain what lies above the bridge.
    #[cold]
    #[inline(never)]
    fn step_exactly(&mut self, mesh: &mut Patch, points: &[Point2]) -> bool {
        let inf = mesh.infinite();
        let at = |v: u32| points[v as usize];
        let (l, r) = (self.l, self.r);
        let above = |v: u32| v != inf && orient2d(at(l), at(r), at(v)) == Sign::Positive;
        let holds = |v: u32, x: u32| x != inf && holds(points, [l, r, v, x]);
        let inner = |mesh: &Patch, g: u32| mesh.vertex(mesh.record(g)[OPPOSITE]);
        let left = above(mesh.record(self.l_out)[1]);
        while left && holds(mesh.record(self.l_out)[1], inner(mesh, self.l_out)) {
            self.l_out = mesh.peel(self.l_out);
        }
        let right = above(mesh.record(self.r_in)[2]);
        while right && holds(mesh.record(self.r_in)[2], inner(mesh, self.r_in)) {
            self.peel_right(mesh);
        }
        let (left_vertex, right_vertex) = (mesh.record(self.l_out)[1], mesh.record(self.r_in)[2]);
        match (left, right) {
            (false, false) => return false,
            (true, true) if holds(left_vertex, right_vertex) => self.take_right(mesh, right_vertex),
            (true, _) => self.take_left(mesh, left_vertex),
            (false, true) => self.take_right(mesh, right_vertex),
        }
        true
    }

    /// Removes the triangle beyond the ghost on the right: that ghost stays the last before r.
    #[inline]
    fn peel_right(&mut self, mesh: &mut Patch) {
        let before = mesh.record(self.r_in)[OPPOSITE + 1];
        let other = mesh.peel(self.r_in);
        mesh.link(half_edge(other, 1), before);
    }

    /// Turns the ghost on the left into a triangle: its infinite corner becomes r.
    #[inline]
    fn take_left(&mut self, mesh: &mut Patch, head: u32) {
        let g = self.l_out;
        self.l_out = after(mesh, g);
        let record = mesh.record_mut(g);
        [record[0], record[OPPOSITE + 1]] = [self.r, self.below];
        mesh.set_opposite(self.below, half_edge(g, 1));
        (self.l, self.below) = (head, half_edge(g, 2));
    }

    /// Turns the ghost on the right into a triangle: its infinite corner becomes l.
    #[inline]
    fn take_right(&mut self, mesh: &mut Patch, tail: u32) {
        let g = self.r_in;
        self.r_in = before(mesh, g);
        let record = mesh.record_mut(g);
        [record[0], record[OPPOSITE + 2]] = [self.l, self.below];
        mesh.set_opposite(self.below, half_edge(g, 2));
        (self.r, self.below) = (tail, half_edge(g, 1));
    }
}
