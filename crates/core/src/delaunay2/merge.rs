//! Two triangulations side by side become one: the merge of divide and conquer.
//!
//! L. Guibas and J. Stolfi, "Primitives for the manipulation of general subdivisions and the
//! computation of Voronoi diagrams", ACM Transactions on Graphics 4 (1985); on triangles with
//! ghosts as in J. R. Shewchuk, "Triangle" (1996). Linear: every step adds a triangle between the
//! two or takes one away that never comes back.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use crate::mesh2::{Code, Patch, next, prev};
use crate::order::blocks::Axis;

/// Joins two triangulations in `mesh`, all of `left` before all of `right` along `axis`, each given
/// by one of its ghosts, with the two free records `spare`. Returns a ghost.
pub fn merge(
    mesh: &mut Patch,
    points: &[Point2],
    [left, right]: [Code; 2],
    axis: Axis,
    [bottom, top]: [u32; 2],
) -> Code {
    let (mut l_in, mut r_in) = extremes(mesh, points, left, right, axis);
    lower_tangent(mesh, points, &mut l_in, &mut r_in);
    let (l, r) = (mesh.head(l_in), mesh.head(r_in));
    let inf = mesh.infinite();
    let (l_out, r_out) = (mesh.after(l_in), mesh.after(r_in));
    //     left       right      A ghost below the first bridge from l to r. The bridge rises;
    //   l_out \     / r_in      what it has passed is triangulated, and what is above is bounded
    //          l---r            by the ghosts l_out, which begins at l, and r_in, which ends at r.
    //    l_in /     \ r_out
    mesh.set(bottom, [inf, r, l]);
    mesh.link(8 * bottom + 1, prev(l_in));
    mesh.link(8 * bottom + 2, next(r_out));
    let mut bridge = Bridge {
        points,
        l,
        r,
        below: 8 * bottom,
        l_out,
        r_in,
    };
    while bridge.rise(mesh) {}
    mesh.set(top, [inf, bridge.l, bridge.r]);
    mesh.link(8 * top, bridge.below);
    mesh.link(8 * top + 2, next(bridge.l_out));
    mesh.link(8 * top + 1, prev(bridge.r_in));
    8 * top
}

/// The ghosts that end at the last vertex of the left and at the first of the right.
fn extremes(mesh: &Patch, points: &[Point2], left: Code, right: Code, axis: Axis) -> (Code, Code) {
    let at = |g: Code| points[mesh.head(g) as usize];
    let best = |start: Code, better: &dyn Fn(Point2, Point2) -> bool| {
        let (mut best, mut g) = (start, mesh.after(start));
        while g != start {
            if better(at(g), at(best)) {
                best = g;
            }
            g = mesh.after(g);
        }
        best
    };
    let last = best(left, &|p, q| axis.before(q, p));
    let first = best(right, &|p, q| axis.before(p, q));
    (last, first)
}

/// Moves both ghosts down their hulls until neither has a vertex below the line through their
/// heads. Of collinear vertices on it the nearest two remain. Each step goes on round a hull.
fn lower_tangent(mesh: &Patch, points: &[Point2], l_in: &mut Code, r_in: &mut Code) {
    let below = |l: u32, r: u32, v: u32| {
        let [l, r, v] = [l, r, v].map(|v| points[v as usize]);
        orient2d(l, r, v) == Sign::Negative
    };
    loop {
        let (l, r) = (mesh.head(*l_in), mesh.head(*r_in));
        if below(l, r, mesh.tail(*l_in)) {
            *l_in = mesh.before(*l_in);
        } else if below(l, r, mesh.head(mesh.after(*r_in))) {
            *r_in = mesh.after(*r_in);
        } else {
            return;
        }
    }
}

/// The edge that rises between the two parts.
struct Bridge<'a> {
    points: &'a [Point2],
    l: u32,
    r: u32,
    /// The bridge as an edge of what lies below it.
    below: Code,
    l_out: Code,
    r_in: Code,
}

impl Bridge<'_> {
    fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    /// Whether `v` lies above the bridge.
    fn above(&self, v: u32) -> bool {
        orient2d(self.at(self.l), self.at(self.r), self.at(v)) == Sign::Positive
    }

    /// Whether `x` lies in the circle through the bridge and `v`, ties as in the whole mesh.
    fn holds(&self, v: u32, x: u32) -> bool {
        let [l, r, v, x] = [self.l, self.r, v, x].map(|v| self.at(v));
        incircle_canonical(l, r, v, x) == Sign::Positive
    }

    /// Adds the triangle on the bridge; false where it has reached the upper tangent.
    fn rise(&mut self, mesh: &mut Patch) -> bool {
        let inf = mesh.infinite();
        let left = self.above(mesh.head(self.l_out));
        if left {
            loop {
                let x = mesh.vertex(mesh.opposite(self.l_out));
                if x == inf || !self.holds(mesh.head(self.l_out), x) {
                    break;
                }
                self.l_out = mesh.peel(self.l_out);
            }
        }
        let right = self.above(mesh.tail(self.r_in));
        if right {
            loop {
                let x = mesh.vertex(mesh.opposite(self.r_in));
                if x == inf || !self.holds(mesh.tail(self.r_in), x) {
                    break;
                }
                mesh.peel(self.r_in);
            }
        }
        match (left, right) {
            (false, false) => return false,
            (true, true) if self.holds(mesh.head(self.l_out), mesh.tail(self.r_in)) => {
                self.take_right(mesh);
            }
            (true, _) => self.take_left(mesh),
            (false, true) => self.take_right(mesh),
        }
        true
    }

    /// The ghost on the left becomes a triangle: its infinite corner becomes r.
    fn take_left(&mut self, mesh: &mut Patch) {
        let g = self.l_out;
        let (head, after) = (mesh.head(g), mesh.after(g));
        mesh.set_vertex(g, self.r);
        mesh.link(next(g), self.below);
        (self.l, self.below, self.l_out) = (head, prev(g), after);
    }

    /// The ghost on the right becomes a triangle: its infinite corner becomes l.
    fn take_right(&mut self, mesh: &mut Patch) {
        let g = self.r_in;
        let (tail, before) = (mesh.tail(g), mesh.before(g));
        mesh.set_vertex(g, self.l);
        mesh.link(prev(g), self.below);
        (self.r, self.below, self.r_in) = (tail, next(g), before);
    }
}
