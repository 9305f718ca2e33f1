//! Triangle quality in plain floating point: which triangles are bad, and which subsegments are
//! encroached.

use delone_predicates::Point2;
use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

pub use crate::base::vector::{cross2 as cross, dot, minus};
use crate::base::wide::{lowest, scaled};

/// Squared cosines with a smaller relative difference are compared exactly; each has four rounding
/// errors.
const UNSURE: f64 = 1e-14;

/// The same in double-double arithmetic. Fronts of equilateral triangles meet at 30 degrees up to
/// the last bit, so cases close to this bound are common.
///
/// In units of u^2 = 2^-106 (see `Pair`): a dot product errs by 13 of its terms, whose sum is at most
/// 20 times the cosine, see `is_skinny`; so the square of the cosine errs by 2 * 260 + 9 of itself,
/// the bound by 2 * 13 + 2 * 9 of itself, and their difference by 4 of both. 2^-96 is 1024 units.
const SURE: f64 = f64::from_bits((1023 - 96) << 52);

/// The bounds.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// The squared cosine of the smallest allowed angle.
    cos2: f64,
    /// The squared cosine of the angle at which a lens is seen from its boundary.
    lens: f64,
}

/// Why a triangle is bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// Its smallest angle.
    Angle,
    /// Its area.
    Size,
}

/// A triangle, relative to its shortest edge.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// The corner opposite the shortest edge, where the smallest angle is.
    pub apex: usize,
    /// The squared length of the shortest edge.
    pub shortest: f64,
    /// Twice the area.
    pub area2: f64,
    /// Whether its smallest angle is below the bound.
    pub skinny: bool,
}

/// The smallest angle of a triangle in degrees.
pub fn angle([a, b, c]: [Point2; 3]) -> f64 {
    let edges = [minus(c, b), minus(a, c), minus(b, a)];
    let at = |k: usize| -dot(edges[(k + 1) % 3], edges[(k + 2) % 3]);
    let largest = at(0).max(at(1)).max(at(2));
    cross(edges[0], edges[1]).atan2(largest).to_degrees()
}

impl Shape {
    /// Bounds for the smallest angle `degrees`, below 60; with `circles` lenses are diametral
    /// circles. If no angle counts as too small, lenses are empty, and rounding must not put a
    /// vertex into one.
    pub fn new(degrees: f64, circles: bool) -> Self {
        let angle = degrees.to_radians();
        // If the squared cosine is a simple fraction, use it exactly, not a neighboring double.
        let cos2 = match degrees {
            30.0 => 0.75,
            45.0 => 0.5,
            _ => angle.cos() * angle.cos(),
        };
        Self {
            cos2,
            lens: if circles {
                0.0
            } else if degrees == 0.0 {
                f64::INFINITY
            } else {
                (2.0 * cos2 - 1.0).powi(2)
            },
        }
    }

    /// A bound on the smallest angle, by its squared cosine; lenses are empty.
    pub fn of_square(cos2: f64) -> Self {
        Self {
            cos2,
            lens: f64::INFINITY,
        }
    }

    /// Measures a triangle.
    pub fn see(&self, corners: [Point2; 3]) -> Seen {
        let [a, b, c] = corners;
        let edges = [minus(c, b), minus(a, c), minus(b, a)];
        let lengths = edges.map(|e| dot(e, e));
        let apex = match lengths {
            [x, y, z] if x <= y && x <= z => 0,
            [_, y, z] if y <= z => 1,
            _ => 2,
        };
        let [l, m] = [(apex + 1) % 3, (apex + 2) % 3];
        // The two edges at the apex are directed away from it and back to it.
        let cosine = -dot(edges[l], edges[m]);
        let (square, bound) = (cosine * cosine, self.cos2 * lengths[l] * lengths[m]);
        let skinny = if (square - bound).abs() > UNSURE * bound {
            square > bound
        } else {
            self.is_skinny([corners[apex], corners[l], corners[m]])
        };
        Seen {
            apex,
            shortest: lengths[apex],
            area2: cross(edges[0], edges[1]),
            skinny: cosine > 0.0 && skinny,
        }
    }

    /// Whether the angle at `a`, which is less than a right angle, is too small.
    fn is_skinny(&self, [a, b, c]: [Point2; 3]) -> bool {
        let between = |p: Point2| [0, 1].map(|k| Pair::difference(p[k], a[k]));
        let (u, v) = (between(b), between(c));
        let dot = |u: [Pair; 2], v: [Pair; 2]| u[0] * v[0] + u[1] * v[1];
        // Terms of opposite signs cancel in the dot product, but never to less than a twentieth of
        // their sum: angles that close to a right angle are not tested.
        let cosine = dot(u, v);
        let bound = dot(u, u) * dot(v, v) * Pair::difference(self.cos2, 0.0);
        let over = (cosine.square() - bound).hi;
        // Outside this range the low parts may have underflowed.
        let within = (1e-200..1e200).contains(&bound.hi);
        if within && over.abs() > SURE * bound.hi {
            over > 0.0
        } else {
            self.is_skinny_exactly([a, b, c])
        }
    }

    #[cold]
    fn is_skinny_exactly(&self, [a, b, c]: [Point2; 3]) -> bool {
        let low = lowest(&[a, b, c], &[]);
        let [a, b, c] = [a, b, c].map(|p| p.map(|x| scaled(x, low)));
        let [u, v] = [b, c].map(|p| [&p[0] - &a[0], &p[1] - &a[1]]);
        let dot = |u: &[BigInt; 2], v: &[BigInt; 2]| &u[0] * &v[0] + &u[1] * &v[1];
        let of_bound = lowest(&[[self.cos2, 1.0]], &[]);
        let [bound, one] = [self.cos2, 1.0].map(|x| scaled(x, of_bound));
        let cosine = dot(&u, &v);
        &cosine * &cosine * one > dot(&u, &u) * dot(&v, &v) * bound
    }

    /// Why a triangle with at most twice the area `cap2` allowed is bad, if it is.
    pub fn fault(&self, seen: &Seen, cap2: f64) -> Option<Reason> {
        if seen.skinny {
            Some(Reason::Angle)
        } else if seen.area2 > cap2 {
            Some(Reason::Size)
        } else {
            None
        }
    }

    /// Whether `r` is in the diametral lens of the subsegment `p q` (L. P. Chew,
    /// "Guaranteed-quality mesh generation for curved surfaces", 1993): r sees it at an angle of at
    /// least 180 degrees minus twice the bound.
    pub fn in_lens(&self, p: Point2, q: Point2, r: Point2) -> bool {
        let (u, v) = (minus(p, r), minus(q, r));
        let cosine = dot(u, v);
        cosine < 0.0 && cosine * cosine >= self.lens * dot(u, u) * dot(v, v)
    }

    /// The same, even if lenses are circles.
    pub fn is_flat(&self, p: Point2, q: Point2, r: Point2) -> bool {
        let lens = (2.0 * self.cos2 - 1.0).powi(2);
        Self { lens, ..*self }.in_lens(p, q, r)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_is_thinner_than_the_circle() {
        let shape = Shape::new(30.0, false);
        let lens = |y| shape.in_lens([-1.0, 0.0], [1.0, 0.0], [0.0, y]);
        assert!(lens(0.57) && !lens(0.58));
        assert!(!shape.in_lens([-1.0, 0.0], [1.0, 0.0], [3.0, 0.0]));
        // A vertex so close to the subsegment that rounding puts it there.
        let flat = Shape::new(0.0, false);
        assert!(!flat.in_lens([0.0, 0.0], [2.0, 0.0], [1.0, -1e-9]));
        let shape = Shape::new(30.0, true);
        let circle = |y| shape.in_lens([-1.0, 0.0], [1.0, 0.0], [0.0, y]);
        assert!(circle(0.99) && !circle(1.01));
    }
}
