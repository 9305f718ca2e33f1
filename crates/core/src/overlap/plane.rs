//! Cells in the plane, and the area that two of them share.
//!
//! Signs are those of orientation tests. Where one is zero, the second cell of a pair has moved by
//! (h, k) with 0 < k << h << 1: to first order the test of a, b and a moved corner q changes by k
//! (b - a)_x - h (b - a)_y, which is not zero, since a and b differ. So all signs are those of one
//! pair of cells without ties.
//!
//! # Errors
//!
//! Let s be the extent of the smaller cell. Terms are computed as pairs of doubles relative to a corner
//! of that cell, and all places of which there are terms are within some s of it: ends of sides in both
//! cells, and crossings. Of two sides that cross, one is a side of the smaller cell, so the shorter one
//! is no longer than s; the crossing is a share of it. The share is s / (s - t), with the tests of the
//! ends at the other side; they have opposite signs, so the share is as right as they are. A side
//! longer than [`LONG`] s is tested with integers, and its terms are the products of its distance from
//! the corner and of positions along it, which need no other place of it. So all errors are below
//! 2^-90 of s^2, whatever the length of sides. On lines that are nearly parallel, a crossing errs
//! along both, which changes the two terms alike; parallel lines do not cross, as one of them has
//! moved.

use std::cmp::Ordering;
use std::sync::OnceLock;

use delone_predicates::arithmetic::Pair;
use delone_predicates::{Point2, Sign, orient2d};

use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Pace;
use crate::locate::boxes::Boxes;

use super::convex::Pieces;
use super::exact::Big;
use super::outline::{
    Fault, Lie, Met, Outline, Prepared, Sum, Work, distinct, meet, start_at_smallest,
};
use super::pairs::{ONE, ZERO, quotient, scaled};
use super::sides::{MANY, meeting};
use super::signs::Moved;

/// Cells with smaller areas, over the square of their extent, are empty.
const LEAST: f64 = 1e-28;
/// Smaller parts, over the square of the extent of the smaller cell, cannot be distinguished from
/// cells that only touch.
const TINY: f64 = 1e-24;

/// Sides that are longer than this many times the smaller cell need integers: with pairs, a place on
/// one errs by 2^-103 of its length.
const LONG: f64 = 1024.0;

/// A corner and the side that starts there.
#[derive(Clone, Copy)]
struct Corner {
    v: Point2,
    /// The end of the side.
    next: u32,
}

/// A cell: what is to the left of its rings, which start at their smallest corners.
pub struct Region {
    /// All corners, ring by ring.
    corners: Vec<Corner>,
    /// Where rings after the first one start.
    later: Vec<u32>,
    area: f64,
    extent: Extent<2>,
    convex: bool,
    turned: bool,
    repeated: usize,
    /// Whether it has an area.
    usable: bool,
    /// Sides by their boxes.
    kept: OnceLock<Boxes<2>>,
}

fn compare(a: &Point2, b: &Point2) -> Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
}

/// Twice the area of the triangle of the origin and two places, relative to it.
fn cross(a: &[Pair; 2], b: &[Pair; 2]) -> Pair {
    a[0] * b[1] - a[1] * b[0]
}

fn from(origin: Point2, v: Point2) -> [Pair; 2] {
    [0, 1].map(|k| Pair::difference(v[k], origin[k]))
}

/// Twice the area to the left of a ring.
fn doubled(origin: Point2, ring: &[Point2]) -> Pair {
    let mut sum = ZERO;
    let mut last = from(origin, ring[ring.len() - 1]);
    for &v in ring {
        let next = from(origin, v);
        sum = sum + cross(&last, &next);
        last = next;
    }
    sum
}

impl Prepared<2> for Region {
    fn of(rings: &mut dyn Iterator<Item = (bool, &[Point2])>) -> (Option<Self>, Option<Fault>) {
        let mut region = Self {
            corners: Vec::new(),
            later: Vec::new(),
            area: 0.0,
            extent: Extent::of([]),
            convex: false,
            turned: false,
            repeated: 0,
            usable: false,
            kept: OnceLock::new(),
        };
        let mut sum = ZERO;
        let mut origin = None;
        for (hole, ring) in rings {
            // Adding 0 removes the sign of a negative zero.
            let mut kept = distinct(
                ring.iter().map(|v| v.map(|x| x + 0.0)),
                |a, b| a == b,
                compare,
            );
            region.repeated += ring.len() - kept.len();
            if kept.len() < 3 {
                continue;
            }
            let origin = *origin.get_or_insert(kept[0]);
            if (doubled(origin, &kept).hi < 0.0) != hole {
                kept.reverse();
                region.turned |= !hole;
            }
            start_at_smallest(&mut kept, compare);
            // Now the order of terms is independent of that of the input.
            sum = sum + doubled(kept[0], &kept);
            let first = region.corners.len();
            if first > 0 {
                region.later.push(first as u32);
            }
            for (k, &v) in kept.iter().enumerate() {
                let next = if k + 1 == kept.len() { 0 } else { k + 1 };
                region.corners.push(Corner {
                    v,
                    next: (first + next) as u32,
                });
            }
        }
        region.extent = Extent::of(region.corners.iter().map(|c| c.v));
        region.area = sum.hi / 2.0;
        let side = region.extent.side();
        // Also if there are no corners, or the area is beyond the range of doubles.
        if !(region.area > LEAST * side * side && region.area < f64::INFINITY) {
            return (Some(region), Some(Fault::Empty));
        }
        region.usable = true;
        region.convex = region.corners.len() <= MANY && region.is_convex();
        (Some(region), None)
    }

    fn area(&self) -> f64 {
        self.area
    }

    fn turned(&self) -> bool {
        self.turned
    }

    fn repeated(&self) -> usize {
        self.repeated
    }

    fn lie(&self, e: u32, f: u32) -> Lie {
        let ([a, b], [c, d]) = (self.ends(e), self.ends(f));
        let [s, t] = [c, d].map(|v| orient2d(a, b, v) as i8);
        if s == 0 && t == 0 {
            return lie_along(self.ends(e), self.ends(f), self.usable);
        }
        if s * t > 0 || (s * t == 0 && self.follow(e, f)) {
            return Lie::Apart;
        }
        match orient2d(c, d, a) as i8 * orient2d(c, d, b) as i8 {
            1 => Lie::Apart,
            -1 if s * t < 0 => Lie::Crossing,
            _ => Lie::Touching,
        }
    }

    fn equal(&self, k: u32, l: u32) -> bool {
        self.corners[k as usize].v == self.corners[l as usize].v
    }

    fn inside(&self, e: u32, corner: u32) -> bool {
        let ([a, b], v) = (self.ends(e), self.corners[corner as usize].v);
        let axis = longer([a, b]);
        let between = (a[axis] < v[axis]) == (v[axis] < b[axis]) && v[axis] != b[axis];
        between && v[axis] != a[axis] && orient2d(a, b, v) == Sign::Zero
    }

    fn along(&self, e: u32, k: u32, l: u32) -> Ordering {
        let ends = self.ends(e);
        let axis = longer(ends);
        let [a, b] = ends.map(|v| v[axis]);
        let [x, y] = [k, l].map(|corner| self.corners[corner as usize].v[axis]);
        let order = x.total_cmp(&y);
        if b > a { order } else { order.reverse() }
    }

    fn turn(&self, at: u32, from: u32, to: u32) -> i8 {
        let [a, b, c] = [at, from, to].map(|k| self.corners[k as usize].v);
        orient2d(a, b, c) as i8
    }
}

impl Region {
    #[inline]
    fn ends(&self, k: u32) -> [Point2; 2] {
        let a = self.corners[k as usize];
        [a.v, self.corners[a.next as usize].v]
    }

    /// Whether no corner is to the right of a side, and the ring runs around once: see `Cell`.
    fn is_convex(&self) -> bool {
        let count = self.corners.len();
        let one_ring = (0..count).all(|k| self.corners[k].next as usize == (k + 1) % count);
        let once = (1..count).all(|k| self.corners[..k].iter().all(|p| p.v != self.corners[k].v));
        one_ring
            && once
            && (0..count as u32).all(|e| {
                let [a, b] = self.ends(e);
                let own = self.corners.iter().map(|c| c.v);
                own.filter(|v| *v != a && *v != b)
                    .all(|v| orient2d(a, b, v) != Sign::Negative)
            })
    }
}

/// The coordinate in which a side is longer; differences may be rounded.
fn longer([a, b]: [Point2; 2]) -> usize {
    usize::from((b[1] - a[1]).abs() > (b[0] - a[0]).abs())
}

/// How sides on one line lie to each other. A cell with an area would cover what is beside a part that
/// both run along in the same direction twice.
fn lie_along(first: [Point2; 2], second: [Point2; 2], usable: bool) -> Lie {
    let axis = longer(first);
    let ([a, b], [c, d]) = (first.map(|v| v[axis]), second.map(|v| v[axis]));
    let (low, high) = (a.min(b), a.max(b));
    if c.max(d) < low || high < c.min(d) {
        return Lie::Apart;
    }
    let common = c.min(d) < high && low < c.max(d);
    if usable && common && (b > a) == (d > c) {
        Lie::Crossing
    } else {
        Lie::Touching
    }
}

/// The side of a line on which a corner is, without ties.
#[inline]
fn side([a, b]: [Point2; 2], q: Point2, moved: Moved) -> i8 {
    let found = orient2d(a, b, q) as i8;
    if found != 0 {
        return found;
    }
    let grows = |x: f64, y: f64| i8::from(y > x) - i8::from(y < x);
    let change = match -grows(a[1], b[1]) {
        0 => grows(a[0], b[0]),
        sign => sign,
    };
    match moved {
        Moved::Corner => change,
        Moved::Side => -change,
        Moved::Neither => 0,
    }
}

impl Outline<2> for Region {
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

    /// The box of the corners.
    fn extent(&self) -> Extent<2> {
        self.extent
    }

    fn reach(&self, k: u32) -> Extent<2> {
        Extent::of(self.ends(k))
    }

    fn kept(&self) -> &OnceLock<Boxes<2>> {
        &self.kept
    }

    #[inline]
    fn sign(&self, k: u32, other: &Self, corner: u32, moved: Moved) -> i8 {
        side(self.ends(k), other.corners[corner as usize].v, moved)
    }

    /// The parity of sides that cross the ray from the corner in the direction of the first axis.
    fn holds(
        &self,
        other: &Self,
        corner: u32,
        moved: Moved,
        found: &mut Vec<u32>,
        pace: &mut Pace,
    ) -> Result<bool> {
        let q = other.corners[corner as usize].v;
        // A corner that has moved is above others of its height; so are corners of sides that have.
        let above = |v: Point2| v[1] > q[1] || (v[1] == q[1] && moved == Moved::Side);
        let ray = Extent {
            min: q,
            max: [f64::INFINITY, q[1]],
        };
        found.clear();
        meeting(self, &ray, found, pace.watch())?;
        pace.spend(found.len())?;
        let mut odd = false;
        for &k in &*found {
            let [a, b] = self.ends(k);
            let up = above(b);
            if above(a) != up {
                odd ^= up == (side([a, b], q, moved) > 0);
            }
        }
        Ok(odd)
    }
}

/// What terms of a side are computed from.
enum Along {
    /// Its start: a term is the triangle of the origin, the start and a place.
    Start([Pair; 2]),
    /// Of a long one, the triangle of the origin and the side, over the square of its length, and its
    /// direction: a term is the product of these and a place. It is not 0 at the start.
    Line(Pair, [Pair; 2]),
}

/// The sum of terms, relative to a corner of the smaller cell.
struct Doubled<'a> {
    p: &'a Region,
    q: &'a Region,
    origin: Point2,
    /// The extent of the smaller cell.
    size: f64,
    sum: Pair,
    /// The side of the first cell, and what its terms are computed from.
    e: u32,
    along: Along,
}

/// The larger coordinate of a side, rounded.
fn length([a, b]: [Point2; 2]) -> f64 {
    (b[0] - a[0]).abs().max((b[1] - a[1]).abs())
}

/// The largest power of two that is not above a number.
fn exponent(x: f64) -> i64 {
    ((x.to_bits() >> 52) & 0x7ff) as i64 - 1023
}

/// Twice the area of the triangle of three places, exactly.
fn triangle(a: Point2, b: Point2, c: Point2) -> Big {
    let [u, v] = [b, c].map(|p| [0, 1].map(|k| Big::of(p[k]).minus(&Big::of(a[k]))));
    u[0].times(&v[1]).minus(&u[1].times(&v[0]))
}

impl Doubled<'_> {
    fn long(&self, ends: [Point2; 2]) -> bool {
        length(ends) > LONG * self.size
    }

    fn along(&self, ends: [Point2; 2]) -> Along {
        let [a, b] = ends;
        if !self.long(ends) {
            return Along::Start(from(self.origin, a));
        }
        // By a power of two, so that squares are in range.
        let exponent = exponent(length(ends));
        let direction = from(a, b).map(|x| scaled(x, -exponent));
        let square = direction[0] * direction[0] + direction[1] * direction[1];
        let (apart, own) = triangle(self.origin, a, b).leveled();
        let apart = scaled(apart, own - exponent);
        Along::Line(quotient(apart, square), direction)
    }

    fn term(&self, along: &Along, x: &[Pair; 2]) -> Pair {
        match along {
            Along::Start(start) => cross(start, x),
            Along::Line(apart, d) => *apart * (d[0] * x[0] + d[1] * x[1]),
        }
    }

    fn add(&mut self, term: Pair, minus: bool) {
        self.sum = if minus {
            self.sum - term
        } else {
            self.sum + term
        };
    }

    /// Adds the end of one side, which is the start of the next one.
    fn turn(&mut self, along: &Along, ends: [Point2; 2], next: [Point2; 2]) {
        let end = from(self.origin, ends[1]);
        self.add(self.term(along, &end), false);
        if self.long(next) {
            self.add(self.term(&self.along(next), &end), true);
        }
    }
}

impl Pieces for Doubled<'_> {
    type Spot = [Pair; 2];

    fn corner(&self, second: bool, k: u32) -> [Pair; 2] {
        let cell = if second { self.q } else { self.p };
        from(self.origin, cell.corners[k as usize].v)
    }

    fn place(&self, e: u32, f: u32, _: bool) -> [Pair; 2] {
        let (mut short, mut other) = (self.p.ends(e), self.q.ends(f));
        if length(other) < length(short) {
            (short, other) = (other, short);
        }
        let ([a, b], [c, d]) = (short, other);
        let share = if self.long(other) {
            let [s, t] = [a, b].map(|v| triangle(c, d, v));
            share_of(s.leveled(), s.minus(&t).leveled())
        } else {
            let across = from(c, d);
            let [s, t] = [a, b].map(|v| cross(&across, &from(c, v)));
            share_of((s, 0), (s - t, 0))
        };
        let along = from(a, b);
        let start = from(self.origin, a);
        [0, 1].map(|k| start[k] + along[k] * share)
    }

    fn piece(&mut self, from: &[Pair; 2], to: &[Pair; 2]) {
        self.add(cross(from, to), false);
    }
}

/// The quotient of two numbers times powers of two, to both parts from 0 to 1: one that rounds to 1
/// may be less. On one line, where the divisor is 0, any place serves.
fn share_of(part: (Pair, i64), whole: (Pair, i64)) -> Pair {
    if whole.0.hi == 0.0 {
        return ZERO;
    }
    let share = scaled(quotient(part.0, whole.0), part.1 - whole.1);
    if share.hi < 0.0 {
        ZERO
    } else if share.hi > 1.0 || (share.hi == 1.0 && share.lo > 0.0) {
        ONE
    } else {
        share
    }
}

impl Sum for Doubled<'_> {
    fn side(&mut self, e: u32) {
        (self.e, self.along) = (e, self.along(self.p.ends(e)));
    }

    fn first(&mut self) {
        let next = self.p.next(self.e);
        let along = std::mem::replace(&mut self.along, Along::Start([ZERO; 2]));
        self.turn(&along, self.p.ends(self.e), self.p.ends(next));
        self.along = along;
    }

    fn crossing(&mut self, f: u32, leaves: bool) {
        let x = self.place(self.e, f, leaves);
        self.add(self.term(&self.along, &x), !leaves);
        let along = self.along(self.q.ends(f));
        self.add(self.term(&along, &x), leaves);
    }

    fn second(&mut self, f: u32) {
        let ends = self.q.ends(f);
        self.turn(&self.along(ends), ends, self.q.ends(self.q.next(f)));
    }
}

/// The area that cells share; the second one has moved.
pub fn shared(p: &Region, q: &Region, work: &mut Work, pace: &mut Pace) -> Result<f64> {
    let (first, second) = (p.extent.side(), q.extent.side());
    let (small, size) = if first < second {
        (p, first)
    } else {
        (q, second)
    };
    let mut sum = Doubled {
        p,
        q,
        origin: small.corners[0].v,
        size,
        sum: ZERO,
        e: 0,
        along: Along::Start([ZERO; 2]),
    };
    Ok(match meet(p, q, work, pace, &mut sum)? {
        Met::Nothing => 0.0,
        Met::First => p.area,
        Met::Second => q.area,
        Met::Part => {
            let area = sum.sum.hi / 2.0;
            if area > TINY * size * size { area } else { 0.0 }
        }
    })
}
