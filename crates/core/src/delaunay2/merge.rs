//! Two triangulations side by side become one: the merge of divide and conquer.
//!
//! L. Guibas and J. Stolfi, "Primitives for the manipulation of general subdivisions and the
//! computation of Voronoi diagrams", ACM Transactions on Graphics 4 (1985); on triangles with
//! ghosts as in J. R. Shewchuk, "Triangle" (1996). Linear: every step adds a triangle between the
//! two or takes one away that never comes back.
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
//! Let u = 2^-53 and W the longer side of the box of both parts, so that no difference of coordinates
//! is larger. A rounded difference errs by u W, a product of two by 3 u W^2 to first order, s and t,
//! sums of two of those at most 2 W^2 in size, by 2 * 3 u W^2 + 2 u W^2 = 8 u W^2. A product of s and t
//! errs by 2 * 2 W^2 * 8 u W^2 + 4 u W^4 = 36 u W^4, and the difference of two, at most 8 W^4, by
//! 2 * 36 u W^4 + 8 u W^4 = 80 u W^4. [`TURN`] and [`CIRCLE`] leave a fifth and more for terms of
//! second order and the roundings of W and of the bounds. The bounds are used for W between 2^-200 and
//! 2^250 only: there nothing overflows, and what underflow adds, less than 2^-1070 (1 + W^2), is no
//! more than a term of second order. Other parts are merged by the exact predicates alone, and what
//! the bounds leave open goes to them. The infinite vertex is NaN, above no bridge and in no circle.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use super::part::{Corner, Part};
use crate::mesh2::{Code, OPPOSITE, Patch, triangle};
use crate::order::blocks::Axis;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Bound of s for parts of side 1.
const TURN: f64 = 10.0 * U;
/// Bound of the in-circle test for parts of side 1.
const CIRCLE: f64 = 96.0 * U;
/// More than the size of t for parts of side 1, so much that its product with an s that is certain
/// is certain, too.
const FAR: f64 = 16.0;

/// What rounding may do within a box.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The square of the longer side.
    pub square: f64,
    /// Whether it is so far from the ends of the range of doubles that bounds hold.
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

/// Joins two triangulations in `mesh`, all of `left` before all of `right` along `axis`, each given
/// by one of its ghosts, with the two free records `spare`. Returns a ghost.
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
    /// For the time of the merge, where a part is a single vertex.
    pub idle: u32,
}

/// Joins two parts of the points, not both single. Returns the whole.
pub fn join(
    mesh: &mut Patch,
    points: &[Point2],
    [left, right]: [&Part; 2],
    axis: Axis,
    bounds: Bounds,
    Free { bottom, top, idle }: Free,
) -> Part {
    let inf = mesh.infinite();
    let (l, r) = (left.last(axis), right.first(axis));
    let (mut l_in, mut r_in) = (l.ghost(), r.ghost());
    if left.single || right.single {
        // In place of ghosts one of infinite corners that is its own neighbour.
        mesh.set(idle, [inf; 3]);
        mesh.link(8 * idle, 8 * idle);
        mesh.link(8 * idle + 1, 8 * idle + 2);
        l_in = if left.single { idle } else { l_in };
        r_in = if right.single { idle } else { r_in };
    }
    let ends = [l.vertex(), r.vertex()];
    let ([l, r], [l_in, r_in]) = lower_tangent(mesh, points, bounds, ends, [l_in, r_in]);
    let (l_out, r_out) = (after(mesh, l_in), after(mesh, r_in));
    //     left       right      A ghost below the first bridge from l to r. The bridge rises;
    //   l_out \     / r_in      what it has passed is triangulated, and what is above is bounded
    //          l---r            by the ghosts l_out, which begins at l, and r_in, which ends at r.
    //    l_in /     \ r_out
    mesh.set(bottom, [inf, r, l]);
    mesh.link(8 * bottom + 1, 8 * l_in + 2);
    mesh.link(8 * bottom + 2, 8 * r_out + 1);
    let lower = Corner::new(r, bottom);
    let mut bridge = Bridge {
        l,
        r,
        below: 8 * bottom,
        l_out,
        r_in,
    };
    bridge.rise(mesh, points, bounds);
    mesh.set(top, [inf, bridge.l, bridge.r]);
    mesh.link(8 * top, bridge.below);
    mesh.link(8 * top + 2, 8 * bridge.l_out + 1);
    mesh.link(8 * top + 1, 8 * bridge.r_in + 2);
    // A single vertex has no hull edge between the ghosts above and below.
    if left.single {
        mesh.link(8 * bottom + 1, 8 * top + 2);
    }
    if right.single {
        mesh.link(8 * bottom + 2, 8 * top + 1);
    }
    let upper = Corner::new(bridge.l, top);
    Part::merged(points, left, right, upper, lower)
}

/// The ghost after ghost `g`, by records, of ghosts whose infinite corner is the first.
#[inline]
fn after(mesh: &Patch, g: u32) -> u32 {
    triangle(mesh.record(g)[OPPOSITE + 2])
}

/// The ghost before ghost `g`.
#[inline]
fn before(mesh: &Patch, g: u32) -> u32 {
    triangle(mesh.record(g)[OPPOSITE + 1])
}

/// From vertices on the two hulls, and the ghosts that end there, down to those of which neither
/// hull has a vertex below the line through them. Of collinear vertices on it the nearest two
/// remain. Each step goes on round a hull.
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

/// The bridge as the base of triangles.
struct Frame {
    l: Point2,
    r: Point2,
    d: Point2,
}

/// A point above the bridge or not; see the head of the file.
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

    /// The vertex behind the hull edge of ghost `g`.
    #[inline(always)]
    fn behind(&self, mesh: &Patch, points: &[Point2], g: u32) -> (u32, Sight) {
        let x = mesh.vertex(mesh.record(g)[OPPOSITE]);
        (x, self.see(points[x as usize]))
    }
}

impl Sight {
    /// Positive where `other` lies in the circle through the bridge and this point.
    #[inline(always)]
    fn holds(self, other: Self) -> f64 {
        self.t * other.s - other.t * self.s
    }
}

/// Whether the circle through the bridge l r and `v` above it holds `x`, ties as in the whole mesh.
#[cold]
#[inline(never)]
fn holds(points: &[Point2], vertices: [u32; 4]) -> bool {
    let [l, r, v, x] = vertices.map(|v| points[v as usize]);
    incircle_canonical(l, r, v, x) == Sign::Positive
}

/// The smaller, without a branch; the second where one is NaN.
#[inline]
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger, without a branch; the second where one is NaN.
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
        // A copy, whose address no call takes, stays in registers.
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

    /// Adds the triangle on the bridge; false where it has reached the upper tangent, nothing where
    /// the bounds leave open what lies above the bridge.
    #[inline(always)]
    fn step(&mut self, mesh: &mut Patch, points: &[Point2], square: f64) -> Option<bool> {
        let at = |v: u32| points[v as usize];
        let (turn, circle) = (TURN * square, CIRCLE * (square * square));
        let (l, r) = (self.l, self.r);
        let frame = Frame::of(at(l), at(r));
        let mut left = mesh.record(self.l_out)[1];
        let mut right = mesh.record(self.r_in)[2];
        let (mut on_left, mut on_right) = (frame.see(at(left)), frame.see(at(right)));
        if on_left.s.abs() <= turn || on_right.s.abs() <= turn {
            return None;
        }
        // Both at once: neither waits for the branches of the other.
        let mut behind_left = frame.behind(mesh, points, self.l_out);
        let mut behind_right = frame.behind(mesh, points, self.r_in);
        let goes = |v: u32, on: Sight, (x, beyond): (u32, Sight)| {
            let held = on.holds(beyond);
            // Above the bridge and in the circle, in one test; or certainly above it, and then exactly.
            least(on.s - turn, held - circle) > 0.0
                || most(turn - on.s, held.abs() - circle) <= 0.0 && holds(points, [l, r, v, x])
        };
        while goes(left, on_left, behind_left) {
            self.l_out = mesh.peel(self.l_out);
            (left, on_left) = behind_left;
            if on_left.s <= turn {
                return None; // It is above the bridge, but by how much?
            }
            behind_left = frame.behind(mesh, points, self.l_out);
        }
        while goes(right, on_right, behind_right) {
            self.peel_right(mesh);
            (right, on_right) = behind_right;
            if on_right.s <= turn {
                return None; // It is above the bridge, but by how much?
            }
            behind_right = frame.behind(mesh, points, self.r_in);
        }
        // What is not above the bridge goes to its line far away, and the other is taken.
        let far = |on: Sight| Sight {
            s: most(on.s, 0.0),
            t: if on.s > turn { on.t } else { FAR * square },
        };
        let (on_left, on_right) = (far(on_left), far(on_right));
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

    /// The same by exact predicates, where even what lies above the bridge is uncertain.
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

    /// Takes the triangle behind the ghost on the right away: that ghost stays the last before r.
    #[inline]
    fn peel_right(&mut self, mesh: &mut Patch) {
        let before = mesh.record(self.r_in)[OPPOSITE + 1];
        let other = mesh.peel(self.r_in);
        mesh.link(8 * other + 1, before);
    }

    /// The ghost on the left becomes a triangle: its infinite corner becomes r.
    #[inline]
    fn take_left(&mut self, mesh: &mut Patch, head: u32) {
        let g = self.l_out;
        self.l_out = after(mesh, g);
        let record = mesh.record_mut(g);
        [record[0], record[OPPOSITE + 1]] = [self.r, self.below];
        mesh.set_opposite(self.below, 8 * g + 1);
        (self.l, self.below) = (head, 8 * g + 2);
    }

    /// The ghost on the right becomes a triangle: its infinite corner becomes l.
    #[inline]
    fn take_right(&mut self, mesh: &mut Patch, tail: u32) {
        let g = self.r_in;
        self.r_in = before(mesh, g);
        let record = mesh.record_mut(g);
        [record[0], record[OPPOSITE + 2]] = [self.l, self.below];
        mesh.set_opposite(self.below, 8 * g + 2);
        (self.r, self.below) = (tail, 8 * g + 1);
    }
}
