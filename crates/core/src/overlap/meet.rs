//! The area that two cells with arcs of great circles share.

use std::sync::OnceLock;

use delone_predicates::Point3;
use delone_predicates::sphere::leveled;

use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Pace;
use crate::locate::boxes::Boxes;

use super::cell::{Cell, Corner, dotted};
use super::convex::Pieces;
use super::outline::{Met, Outline, Sum, Work, cross_at, meet};
use super::pairs::{
    Pair3, Spot, Turn, base, chart_of, cross, cross_of, dot, factor, heads, quotient, raised, spot,
    toward, unit,
};
use super::sides::{MANY, meeting};
use super::signs::{Moved, Side, left, side};

impl Outline<3> for Cell {
    fn count(&self) -> usize {
        self.corners.len()
    }

    #[inline]
    fn next(&self, k: u32) -> u32 {
        self.corners[k as usize].next
    }

    fn later_rings(&self) -> &[u32] {
        &self.later
    }

    fn convex(&self) -> bool {
        self.convex
    }

    /// That of its corners and, as the sphere bulges, the square of the radius over two.
    ///
    /// A direction p of the cell is y / |y| for a y in the hull of the corners, with |y| at least
    /// the cosine of the cap, 1 - radius^2 / 2.
    fn extent(&self) -> Extent<3> {
        let bulge = self.radius * self.radius * 0.5 + 1e-12;
        wider(
            Extent::of(self.corners.iter().map(|c| heads(&c.unit))),
            bulge,
        )
    }

    fn reach(&self, k: u32) -> Extent<3> {
        let (a, b) = ends(self, k);
        over(heads(&a.unit), heads(&b.unit))
    }

    fn kept(&self) -> &OnceLock<Boxes<3>> {
        &self.kept
    }

    #[inline]
    fn sign(&self, k: u32, other: &Self, corner: u32, moved: Moved) -> i8 {
        let v = other.corners[corner as usize].v;
        side(self.side(k as usize), v, moved) as i8
    }

    #[inline]
    fn left(&self, k: u32, other: &Self, moved: Moved) -> u32 {
        left(
            self.side(k as usize),
            other.corners.iter().map(|c| c.v),
            moved,
        )
    }

    /// The parity of sides that cross an arc from the corner to a direction outside, which belongs to
    /// the other cell and moves with it.
    fn holds(
        &self,
        other: &Self,
        corner: u32,
        moved: Moved,
        found: &mut Vec<u32>,
        pace: &mut Pace,
    ) -> Result<bool> {
        let q = &other.corners[corner as usize];
        let Some(r) = self.outside(q.v) else {
            return Ok(false);
        };
        let n = cross_of(q.v, r);
        let arc = Side {
            a: q.v,
            b: r,
            n: &n,
        };
        if self.corners.len() <= MANY {
            return Ok(self.crossed(0..self.corners.len(), arc, moved));
        }
        found.clear();
        for extent in along(heads(&q.unit), &n) {
            meeting(self, &extent, found, pace.watch())?;
        }
        found.sort_unstable();
        found.dedup();
        pace.spend(found.len())?;
        Ok(self.crossed(found.iter().map(|&k| k as usize), arc, moved))
    }
}

/// The sum as one product.
struct Product<'a> {
    p: &'a Cell,
    q: &'a Cell,
    axis: usize,
    turn: Turn,
    /// The side of the first cell, and where it is measured from.
    e: u32,
    from: Spot,
}

impl Pieces for Product<'_> {
    type Spot = Spot;

    fn corner(&self, second: bool, k: u32) -> Spot {
        let cell = if second { self.q } else { self.p };
        spot(self.axis, &cell.corners[k as usize].unit)
    }

    fn place(&self, e: u32, f: u32, leaves: bool) -> Spot {
        crossing(self.axis, (self.p, e), (self.q, f), leaves)
    }

    fn piece(&mut self, from: &Spot, to: &Spot) {
        self.turn.mul(factor(from, to), false);
    }
}

impl Sum for Product<'_> {
    fn side(&mut self, e: u32) {
        let (a, b) = ends(self.p, e);
        (self.e, self.from) = (e, base(self.axis, &a.unit, &b.unit));
    }

    fn first(&mut self) {
        let end = spot(self.axis, &ends(self.p, self.e).1.unit);
        self.turn.mul(factor(&self.from, &end), false);
    }

    fn crossing(&mut self, f: u32, leaves: bool) {
        let x = self.place(self.e, f, leaves);
        self.turn.mul(factor(&self.from, &x), !leaves);
        let (c, d) = ends(self.q, f);
        let from = base(self.axis, &c.unit, &d.unit);
        self.turn.mul(factor(&from, &x), leaves);
    }

    fn second(&mut self, f: u32) {
        let (c, d) = ends(self.q, f);
        let from = base(self.axis, &c.unit, &d.unit);
        self.turn
            .mul(factor(&from, &spot(self.axis, &d.unit)), false);
    }
}

/// The area that cells share; the second one has moved.
pub fn shared(p: &Cell, q: &Cell, work: &mut Work, pace: &mut Pace) -> Result<f64> {
    // What both share is within the hemisphere around the smaller one.
    let axis = chart_of(if p.radius < q.radius { p } else { q }.center);
    let mut sum = Product {
        p,
        q,
        axis,
        turn: Turn::new(),
        e: 0,
        from: spot(axis, &p.corners[0].unit),
    };
    Ok(match meet(p, q, work, pace, &mut sum)? {
        Met::Nothing => 0.0,
        Met::First => p.area,
        Met::Second => q.area,
        Met::Part => sum.turn.area(),
    })
}

fn wider(extent: Extent<3>, by: f64) -> Extent<3> {
    Extent {
        min: extent.min.map(|x| x - by),
        max: extent.max.map(|x| x + by),
    }
}

/// A box that holds an arc of less than half a circle: each place of it is above one of the chord, in the
/// direction of the middle, by at most the height of that.
fn over(p: Point3, q: Point3) -> Extent<3> {
    let middle = [0, 1, 2].map(|i| 0.5 * (p[i] + q[i]));
    // The distance of the chord from the center of the sphere.
    let low = dotted(&middle, &middle).sqrt();
    if low < 0.1 {
        return wider(Extent::of([p, q]), 1.0);
    }
    let rise = middle.map(|x| x * ((1.0 - low).max(0.0) / low));
    let moved = [p, q].map(|v| [0, 1, 2].map(|i| v[i] + rise[i]));
    wider(Extent::of([p, q].into_iter().chain(moved)), 1e-12)
}

fn ends(cell: &Cell, k: u32) -> (&Corner, &Corner) {
    let a = &cell.corners[k as usize];
    (a, &cell.corners[a.next as usize])
}

impl Cell {
    /// A direction outside that is neither a corner of another cell nor opposite to it: opposite to
    /// the center, or a little beside that.
    fn outside(&self, q: Point3) -> Option<Point3> {
        let c = self.center;
        // Toward the axis that is farthest from the center, which is not in its direction.
        let axis = (1..3).fold(
            0,
            |low: usize, k| {
                if c[k].abs() < c[low].abs() { k } else { low }
            },
        );
        [0.0, 1e-7, -1e-7]
            .into_iter()
            .map(|shift| {
                let mut r = c.map(|x| -x);
                r[axis] += shift;
                leveled(r)
            })
            .find(|&r| heads(&cross_of(q, r)) != [0.0; 3])
    }

    /// Whether an odd number of sides cross an arc; `moved` tells whether that is with a corner, or the
    /// sides have moved.
    fn crossed(&self, sides: impl Iterator<Item = usize>, arc: Side, moved: Moved) -> bool {
        let other = match moved {
            Moved::Corner => Moved::Side,
            _ => Moved::Corner,
        };
        let mut odd = false;
        for k in sides {
            let own = self.side(k);
            let of = [arc.a, arc.b].map(|v| side(own, v, moved) as i8);
            if of[0] == of[1] {
                continue;
            }
            let at = [own.a, own.b].map(|v| side(arc, v, other) as i8);
            odd ^= cross_at(at, of);
        }
        odd
    }
}

/// Pieces of a half circle whose boxes are small.
const PIECES: usize = 32;

/// Boxes that hold the half of a circle which starts at a direction, with a normal. The normal has 101
/// bits; if that is not enough to know its direction, everything.
fn along(p: Point3, n: &Pair3) -> impl Iterator<Item = Extent<3>> {
    let n = heads(n);
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = n.map(|x| x / length);
    // A quarter turn on.
    let t = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| n[i] * p[j] - n[j] * p[i]);
    let at = move |k: usize| {
        let (s, c) = (k as f64 * (std::f64::consts::PI / PIECES as f64)).sin_cos();
        [0, 1, 2].map(|i| c * p[i] + s * t[i])
    };
    let known = length > 1e-18;
    let pieces = if known { PIECES } else { 1 };
    (0..pieces).map(move |k| {
        if known {
            over(at(k), at(k + 1))
        } else {
            Extent::EVERYWHERE
        }
    })
}

/// Where a side of the first cell crosses one of the second, in a chart.
///
/// On nearly equal circles the error of n x m points in any direction. Removing the component off
/// the first circle leaves an error along both, which is harmless. On circles that are equal but
/// for roundings, any point of both arcs serves: an end of one that is on the other.
fn crossing(axis: usize, (p, e): (&Cell, u32), (q, f): (&Cell, u32), leaves: bool) -> Spot {
    let ((a, _), (c, _)) = (ends(p, e), ends(q, f));
    let (n, m) = (&a.n, &c.n);
    // The first side leaves to the right of the second one: it is m x n there.
    let x = if leaves { cross(n, m) } else { cross(m, n) };
    let size = x.iter().fold(0.0, |top: f64, v| top.max(v.hi.abs()));
    let length = |v: &Pair3| v.iter().map(|x| x.hi.abs()).sum::<f64>();
    let scale = length(n) * length(m);
    if size > 1e-5 * scale {
        return toward(axis, &x);
    }
    if size > 1e-26 * scale {
        let x = unit(&x);
        let n = &raised(n);
        let k = quotient(dot(n, &x), dot(n, n));
        return toward(axis, &[0, 1, 2].map(|j| x[j] - n[j] * k));
    }
    spot(axis, &nearest((p, e), (q, f)))
}

/// Of the ends of two sides on one circle, the one that is most on the other side.
#[cold]
fn nearest((p, e): (&Cell, u32), (q, f): (&Cell, u32)) -> Pair3 {
    let ((a, b), (c, d)) = (ends(p, e), ends(q, f));
    let (n, m) = (&a.n, &c.n);
    // How far an end is from the middle of the other side, over half the length of that: at most 1
    // on it.
    let between = |u: &Pair3, x: &Pair3, y: &Pair3, normal: &Pair3| {
        let [u, x, y, n] = [u, x, y, normal].map(heads);
        let middle = if x[0] * y[0] + x[1] * y[1] + x[2] * y[2] < 0.0 {
            // The sum of the ends cancels.
            let d = [0, 1, 2].map(|k| x[k] - y[k]);
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| n[i] * d[j] - n[j] * d[i])
        } else {
            [0, 1, 2].map(|k| x[k] + y[k])
        };
        let length = middle.iter().map(|x| x * x).sum::<f64>().sqrt();
        let distance = |v: Point3| {
            (0..3)
                .map(|k| (v[k] - middle[k] / length).powi(2))
                .sum::<f64>()
        };
        distance(u) / distance(x).max(distance(y))
    };
    let ends = [
        (between(&a.unit, &c.unit, &d.unit, m), a.unit),
        (between(&b.unit, &c.unit, &d.unit, m), b.unit),
        (between(&c.unit, &a.unit, &b.unit, n), c.unit),
        (between(&d.unit, &a.unit, &b.unit, n), d.unit),
    ];
    let mut best = ends[0];
    for end in &ends[1..] {
        if end.0 < best.0 {
            best = *end;
        }
    }
    best.1
}
