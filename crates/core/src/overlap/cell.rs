//! Cells with arcs of great circles as sides, prepared for overlaps.
//!
//! A cell is what is to the left of its rings: outer ones run counterclockwise and holes clockwise,
//! whatever the order in which they are given. Each ring starts at its smallest corner, so that a
//! rotated, reversed or repeated ring gives the same cell, bit for bit.
//!
//! All corners are within a hemisphere around `center`. So sides are within the cap of `radius`
//! around it, the opposite side of the sphere is outside, and areas are below 2 pi.

use std::cmp::Ordering;
use std::sync::OnceLock;

use delone_predicates::arithmetic::Pair;
use delone_predicates::sphere::{Unit, leveled, same};
use delone_predicates::{Point3, Sign, orient2d};

use crate::base::points::Extent;
use crate::locate::boxes::Boxes;

use super::outline::{Fault, Lie, Prepared, distinct, start_at_smallest};
use super::pairs::{Pair3, Turn, chart_of, cross_of, heads};
use super::sides::MANY;
use super::signs::{Moved, Side, side};

/// Cells with smaller areas, in steradians, are empty: sums of triangles err by less.
pub const LEAST: f64 = 1e-29;
/// The least cosine of the angle between the center and a corner.
const WITHIN: f64 = 1e-6;

/// A direction that no usual cell has sides toward.
const OBLIQUE: Point3 = [0.36, 0.48, 0.8];

/// Directions that agree in multiples of its inverse are one for the smallest cap.
const GRAIN: f64 = 1e9;
/// A direction so far beyond a cap is not there by rounding: of directions as close as the grain, the
/// normal of their plane is known to 1e-7.
const MISSED: f64 = 1e-6;

/// A corner and the side that starts there.
#[derive(Clone)]
pub struct Corner {
    /// The vector, leveled.
    pub v: Point3,
    /// Its direction.
    pub unit: Pair3,
    /// The normal of the side to `next`.
    pub n: Pair3,
    /// The end of the side.
    pub next: u32,
}

/// A cell.
pub struct Cell {
    /// All corners, ring by ring.
    pub corners: Vec<Corner>,
    /// Where rings after the first one start.
    pub later: Vec<u32>,
    /// The area.
    pub area: f64,
    /// A direction around which the cell is, a unit vector.
    pub center: Point3,
    /// The largest distance of a corner from it, through the sphere.
    pub radius: f64,
    /// Whether it is known to be convex.
    pub convex: bool,
    /// Whether outer rings were clockwise.
    pub turned: bool,
    /// Corners that repeat the one before.
    pub repeated: usize,
    /// Whether it has an area.
    pub usable: bool,
    /// Sides by their boxes.
    pub kept: OnceLock<Boxes<3>>,
}

/// Corners with their directions.
type Ring = Vec<(Point3, Pair3)>;

impl Prepared<3> for Cell {
    fn of(rings: &mut dyn Iterator<Item = (bool, &[Point3])>) -> (Option<Self>, Option<Fault>) {
        let mut cell = Self {
            corners: Vec::new(),
            later: Vec::new(),
            area: 0.0,
            center: [0.0; 3],
            radius: 0.0,
            convex: false,
            turned: false,
            repeated: 0,
            usable: false,
            kept: OnceLock::new(),
        };
        let mut kept: Vec<(bool, Ring)> = Vec::new();
        let mut opposite = false;
        for (hole, ring) in rings {
            let mut ring = cell.distinct(ring);
            // Two opposite corners, such as the poles, may be meant as a lune: they are not an empty cell.
            opposite |= ring.len() > 1 && has_opposite(&ring);
            if ring.len() > 2 {
                start_at_smallest(&mut ring, |p, q| compare(&p.0, &q.0));
                kept.push((hole, ring));
            }
        }
        if opposite {
            return (None, Some(Fault::Opposite));
        }
        if kept.is_empty() {
            return (None, Some(Fault::Empty));
        }
        let Some(mut cap) = around(&kept) else {
            return (Some(cell.with_rings(&kept)), Some(Fault::Large));
        };
        let (mut axis, mut changed) = (chart_of(cap.0), false);
        let mut all = Turn::new();
        for (hole, ring) in &mut kept {
            let mut own = Turn::new();
            own.around(axis, ring);
            if (own.area() < 0.0) != *hole {
                ring.reverse();
                start_at_smallest(ring, |p, q| compare(&p.0, &q.0));
                cell.turned |= !*hole;
                changed = true;
            }
            all = own;
        }
        if changed {
            // Again, now that the order of corners is independent of that of the input: charts depend
            // on the last bits of a center that is as near to one axis as to another.
            let Some(again) = around(&kept) else {
                return (Some(cell.with_rings(&kept)), Some(Fault::Large));
            };
            (cap, axis) = (again, chart_of(again.0));
        }
        if changed || kept.len() > 1 {
            all = Turn::new();
            for (_, ring) in &kept {
                all.around(axis, ring);
            }
        }
        (cell.center, cell.radius) = cap;
        cell.area = all.area();
        if cell.area < LEAST {
            return (Some(cell.with_rings(&kept)), Some(Fault::Empty));
        }
        cell = cell.with_rings(&kept);
        cell.usable = true;
        cell.convex = cell.corners.len() <= MANY && cell.is_convex();
        (Some(cell), None)
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
        let (first, second) = (self.side(e as usize), self.side(f as usize));
        let [s, t] = [second.a, second.b].map(|v| side(first, v, Moved::Neither));
        if s == 0 && t == 0 {
            let bad = self.usable && same_way(first, second);
            return if bad { Lie::Crossing } else { Lie::Touching };
        }
        if s * t > 0 || (s * t == 0 && self.follow(e, f)) {
            return Lie::Apart;
        }
        let [u, v] = [first.a, first.b].map(|v| side(second, v, Moved::Neither));
        match u * v {
            1 => Lie::Apart,
            // One arc, not its antipode, crosses the other: see `meet`.
            -1 if s * t < 0 && s == v => Lie::Crossing,
            -1 if s * t < 0 => Lie::Apart,
            _ => Lie::Touching,
        }
    }

    fn equal(&self, k: u32, l: u32) -> bool {
        same(self.corners[k as usize].v, self.corners[l as usize].v)
    }

    fn inside(&self, e: u32, corner: u32) -> bool {
        let (e, v) = (self.side(e as usize), self.corners[corner as usize].v);
        if side(e, v, Moved::Neither) != 0 {
            return false;
        }
        let seen = Seen::along(e);
        seen.turn(e.a, v) == seen.way && seen.turn(v, e.b) == seen.way
    }

    fn along(&self, e: u32, k: u32, l: u32) -> Ordering {
        let seen = Seen::along(self.side(e as usize));
        let [k, l] = [k, l].map(|corner| self.corners[corner as usize].v);
        match seen.turn(k, l) {
            Sign::Zero => Ordering::Equal,
            turn if turn == seen.way => Ordering::Less,
            _ => Ordering::Greater,
        }
    }

    fn turn(&self, at: u32, from: u32, to: u32) -> i8 {
        let [a, b, v] = [at, from, to].map(|k| self.corners[k as usize].v);
        let n = cross_of(a, b);
        side(Side { a, b, n: &n }, v, Moved::Neither) as i8
    }
}

impl Cell {
    /// The corners of a ring, leveled, without those that repeat the one before.
    ///
    /// A coordinate below 2^-1022 of the largest may lose digits: the corner moves by 2^-1073
    /// before anything is decided.
    fn distinct(&mut self, ring: &[Point3]) -> Ring {
        // Adding 0 removes the sign of a negative zero.
        let corners = ring.iter().map(|&v| leveled(v).map(|x| x + 0.0));
        let found = distinct(corners, |&a, &b| same(a, b), compare);
        let found: Ring = found.into_iter().map(|v| (v, unit_of(v))).collect();
        self.repeated += ring.len() - found.len();
        found
    }

    fn with_rings(mut self, rings: &[(bool, Ring)]) -> Self {
        for (_, ring) in rings {
            self.add(ring);
        }
        self
    }

    fn add(&mut self, ring: &Ring) {
        let from = self.corners.len();
        if from > 0 {
            self.later.push(from as u32);
        }
        self.corners.reserve_exact(ring.len());
        for (k, &(v, unit)) in ring.iter().enumerate() {
            let next = if k + 1 == ring.len() { 0 } else { k + 1 };
            self.corners.push(Corner {
                v,
                unit,
                n: cross_of(v, ring[next].0),
                next: (from + next) as u32,
            });
        }
    }

    /// The side that starts at a corner.
    #[inline]
    pub fn side(&self, k: usize) -> Side<'_> {
        let corner = &self.corners[k];
        Side {
            a: corner.v,
            b: self.corners[corner.next as usize].v,
            n: &corner.n,
        }
    }

    /// Whether no corner is to the right of a side, and the ring runs around once.
    ///
    /// Seen from the center of the sphere, the ring is a polygon in a plane. Let `far` be
    /// a direction at infinity of that plane. If the ring turns left at each corner, then each time that
    /// it runs around, its sides change twice between having `far` on their left and on their right. If
    /// a corner or `far` is on the circle of a side, all corners are compared with all sides.
    fn is_convex(&self) -> bool {
        if !self.later.is_empty() {
            return false;
        }
        let (count, c) = (self.corners.len(), self.center);
        let far = [
            c[1] * OBLIQUE[2] - c[2] * OBLIQUE[1],
            c[2] * OBLIQUE[0] - c[0] * OBLIQUE[2],
            c[0] * OBLIQUE[1] - c[1] * OBLIQUE[0],
        ];
        let (mut changes, mut last) = (0, 0);
        let mut tied = dotted(&far, &far) < 0.01;
        for k in 0..count {
            let own = self.side(k);
            let turn = side(own, self.corners[(k + 2) % count].v, Moved::Neither);
            if turn < 0 {
                return false;
            }
            let seen = side(own, far, Moved::Neither);
            tied |= turn == 0 || seen == 0;
            changes += i32::from(k > 0 && seen != last);
            last = seen;
        }
        if tied {
            self.is_convex_with_ties()
        } else {
            // The last change is between the last side and the first.
            changes <= 2
        }
    }

    /// The same by comparing all corners with all sides. A ring that runs around several times, with no
    /// corner to the right of a side, visits the corners of its hull again.
    fn is_convex_with_ties(&self) -> bool {
        let count = self.corners.len();
        let distinct = |p: &Corner, q: &Corner| {
            (0..3).any(|k| (p.unit[k].hi - q.unit[k].hi).abs() > 1e-12) || !same(p.v, q.v)
        };
        let once = (1..count).all(|k| {
            let before = &self.corners[..k];
            before.iter().all(|p| distinct(p, &self.corners[k]))
        });
        once && (0..count).all(|e| {
            let next = self.corners[e].next as usize;
            (0..count).all(|k| {
                k == e || k == next || side(self.side(e), self.corners[k].v, Moved::Neither) >= 0
            })
        })
    }
}

/// A circle seen along the largest coordinate of its normal, where turns are exact.
struct Seen {
    axes: [usize; 2],
    /// The turn of a side on the circle.
    way: Sign,
}

impl Seen {
    fn along(e: Side) -> Self {
        let top = (1..3).fold(0, |top: usize, k| {
            if e.n[k].hi.abs() > e.n[top].hi.abs() {
                k
            } else {
                top
            }
        });
        let mut seen = Self {
            axes: [(top + 1) % 3, (top + 2) % 3],
            way: Sign::Zero,
        };
        seen.way = seen.turn(e.a, e.b);
        seen
    }

    fn turn(&self, p: Point3, q: Point3) -> Sign {
        let [i, j] = self.axes;
        orient2d([p[i], p[j]], [q[i], q[j]], [0.0; 2])
    }
}

/// Whether sides of one circle run the same way in a common part: the cell is to the left of both, so
/// it covers what is beside them twice.
fn same_way(e: Side, f: Side) -> bool {
    let seen = Seen::along(e);
    // Whether a corner is after the start of a side, or is it, and before its end.
    let from = |s: Side, q: Point3| same(s.a, q) || seen.turn(s.a, q) == seen.way;
    let starts = |s: Side, q: Point3| from(s, q) && seen.turn(q, s.b) == seen.way;
    seen.turn(f.a, f.b) == seen.way && (starts(e, f.a) || starts(f, e.a))
}

/// The direction as pairs.
fn unit_of(v: Point3) -> Pair3 {
    let unit = Unit::of(v);
    [0, 1, 2].map(|k| Pair {
        hi: unit.hi[k],
        lo: unit.lo[k],
    })
}

/// Whether the ends of a side are opposite.
fn has_opposite(ring: &Ring) -> bool {
    let zero = |a: Point3, b: Point3, i: usize, j: usize| {
        orient2d([a[i], a[j]], [b[i], b[j]], [0.0; 2]) == Sign::Zero
    };
    (0..ring.len()).any(|k| {
        let (a, b) = (ring[k].0, ring[(k + 1) % ring.len()].0);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.0
            && [(0, 1), (1, 2), (2, 0)]
                .iter()
                .all(|&(i, j)| zero(a, b, i, j))
    })
}

/// A box that contains a cell with these corners, even if the cell has faults: the box of the
/// corners, and some more because the sphere bulges; see [`Cell::extent`].
pub fn bounds(corners: &[Point3]) -> Extent<3> {
    let directions = corners.iter().map(|&v| {
        let w = leveled(v);
        let length = dotted(&w, &w).sqrt();
        w.map(|x| x / length)
    });
    let own = Extent::of(directions);
    if corners.is_empty() {
        return own;
    }
    let middle = [0, 1, 2].map(|k| 0.5 * (own.min[k] + own.max[k]));
    let Some(center) = scaled(middle) else {
        return Extent::EVERYWHERE;
    };
    // The farthest place of the box from the center.
    let square = (0..3)
        .map(|k| {
            (own.max[k] - center[k])
                .abs()
                .max((own.min[k] - center[k]).abs())
        })
        .map(|x| x * x)
        .sum::<f64>();
    if square > 1.0 {
        return Extent::EVERYWHERE;
    }
    let bulge = 0.5 * square + 1e-12;
    Extent {
        min: own.min.map(|x| x - bulge),
        max: own.max.map(|x| x + bulge),
    }
}

/// A center of a hemisphere that contains all corners, and the largest distance from it: the mean of
/// the corners, else the center of the smallest cap that contains them.
fn around(rings: &[(bool, Ring)]) -> Option<(Point3, f64)> {
    let units = || {
        let rings = rings.iter().flat_map(|(_, ring)| ring);
        rings.map(|(_, unit)| heads(unit))
    };
    let mut sum = [0.0; 3];
    for p in units() {
        sum = [0, 1, 2].map(|k| sum[k] + p[k]);
    }
    let center = match scaled(sum).or(units().next()) {
        Some(mean) if within(units(), mean) => mean,
        _ => {
            let all: Vec<Point3> = units().collect();
            smallest_cap(&all).filter(|&center| within(units(), center))?
        }
    };
    // By differences: near the center, products do not distinguish corners.
    let distance = |p: Point3| (0..3).map(|k| (p[k] - center[k]).powi(2)).sum::<f64>();
    let farthest = units().map(distance).fold(0.0, f64::max);
    Some((center, farthest.sqrt()))
}

/// The dot product.
pub fn dotted(a: &Point3, b: &Point3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector divided by its length, if that is not tiny.
fn scaled(c: Point3) -> Option<Point3> {
    let length = dotted(&c, &c).sqrt();
    (length > 1e-9).then(|| c.map(|x| x / length))
}

/// Whether all directions are within the hemisphere around a center.
fn within(mut units: impl Iterator<Item = Point3>, center: Point3) -> bool {
    units.all(|p| dotted(&p, &center) > WITHIN)
}

/// The center of the smallest cap that contains all directions, if that is less than a hemisphere:
/// it touches two or three of them (E. Welzl, "Smallest enclosing disks", 1991). Where roundings
/// mislead it, `within` fails.
fn smallest_cap(units: &[Point3]) -> Option<Point3> {
    // Distinct places, in an order that is independent of the order of the ring and of where they
    // are: otherwise the loops below are cubic.
    let mut places: Vec<[i64; 3]> = units
        .iter()
        .map(|p| p.map(|x| (x * GRAIN).round() as i64))
        .collect();
    places.sort_unstable();
    places.dedup();
    let count = places.len();
    let stride = (count * 618 / 1000..=count)
        .find(|&stride| gcd(stride, count) == 1)
        .unwrap_or(1);
    let order: Vec<Point3> = (0..count)
        .map(|k| places[k * stride % count].map(|x| x as f64 / GRAIN))
        .collect();
    // Whether a direction is in the cap around a center through another one.
    let beyond = |c: &Point3, on: &Point3, p: &Point3| dotted(c, p) < dotted(c, on) - 1e-15;
    let (mut center, mut on) = (order[0], order[0]);
    for i in 1..count {
        let p = order[i];
        if !beyond(&center, &on, &p) {
            continue;
        }
        // The smallest cap of the first ones that touches p.
        (center, on) = (p, p);
        for j in 0..i {
            let q = order[j];
            if !beyond(&center, &on, &q) {
                continue;
            }
            // The one that touches p and q.
            center = scaled([0, 1, 2].map(|k| p[k] + q[k]))?;
            for (k, r) in order[..j].iter().enumerate() {
                if beyond(&center, &on, r) {
                    let [u, v] = [q, *r].map(|x| [0, 1, 2].map(|k| x[k] - p[k]));
                    let n = heads(&cross_of(u, v));
                    let sign = if dotted(&n, &p) < 0.0 { -1.0 } else { 1.0 };
                    let length = dotted(&n, &n).sqrt();
                    center = n.map(|x| sign * x / length);
                    // A hemisphere that contains all has such a cap in it, which contains those before.
                    // Without one, almost every direction would be beyond each cap.
                    let level = dotted(&center, &p) - MISSED;
                    if order[..k].iter().any(|r| dotted(&center, r) < level) {
                        return None;
                    }
                }
            }
        }
    }
    Some(center)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

fn compare(a: &Point3, b: &Point3) -> Ordering {
    a[0].total_cmp(&b[0])
        .then(a[1].total_cmp(&b[1]))
        .then(a[2].total_cmp(&b[2]))
}
