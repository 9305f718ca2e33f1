//! On which side of the great circle through two directions a third one lies.
//!
//! # The bound of the filter
//!
//! The determinant is [a - c, b - c, c] of the directions. Let u = 2^-53 and h = 2^-99.7. A computed
//! difference of pairs, P_k = (a_hi - c_hi) + (a_lo - c_lo), errs by u |P_k| for its last sum, by u
//! times the difference of the heads, which is at most |P_k| (1 + u) + 2 u, and by the errors of the pairs,
//! 2^-99.9: in all by 2 u |P_k| + h, as 2 u^2 + u 2 u is below 2^-103. The head of c errs by u
//! of itself. Then each of the six monomials of the determinant passes two products, a difference and at
//! most two sums: with 2 + 2 + 1 units from the entries that is 10 u of the permanent; 12 u leaves room
//! for the terms of second order. An error h in an entry of the first row meets the 2 x 2
//! minors of the others, at most |Q| |c| in the 1-norm, and |c| < 1.74: h 1.74 (|P| + |Q|), for which
//! 2^-98 (|P| + |Q|) has room, for products of two such errors, too, as long as |P| and |Q| are
//! at least [`NEAREST`]. Underflow is below 2^-1070 then, which is far less.

use crate::expansion::Pair;
use crate::sign::Sign;
use crate::{Point3, orient3d};

use super::unit::{Unit, leveled};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Bound relative to the permanent.
const BOUND: f64 = 12.0 * U;
/// Bound relative to the lengths of the differences, 2^-98.
const ABSOLUTE: f64 = 1.0 / (1_u128 << 98) as f64;
/// Directions nearer to each other than this, 2^-90, are left to integers.
pub(super) const NEAREST: f64 = 1.0 / (1_u128 << 90) as f64;

/// The difference of two directions, rounded.
#[inline]
pub(super) fn difference(a: &Unit, b: &Unit) -> Point3 {
    [0, 1, 2].map(|k| (a.hi[k] - b.hi[k]) + (a.lo[k] - b.lo[k]))
}

/// The 1-norm.
#[inline]
pub(super) fn size(p: Point3) -> f64 {
    p[0].abs() + p[1].abs() + p[2].abs()
}

/// The determinant of three vectors and its permanent, rounded.
#[inline]
pub(super) fn determinant(p: Point3, q: Point3, r: Point3) -> (f64, f64) {
    let products = |i: usize, j: usize| (q[i] * r[j], q[j] * r[i]);
    let (yz, zx, xy) = (products(1, 2), products(2, 0), products(0, 1));
    let minor = |(x, y): (f64, f64)| x - y;
    let both = |(x, y): (f64, f64)| x.abs() + y.abs();
    (
        p[0] * minor(yz) + p[1] * minor(zx) + p[2] * minor(xy),
        p[0].abs() * both(yz) + p[1].abs() * both(zx) + p[2].abs() * both(xy),
    )
}

/// The sign of [a, b, c], if pairs prove it.
#[inline]
pub fn pairs(units: [&Unit; 3]) -> Option<Sign> {
    let (det, bound) = by_pairs(units);
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The determinant by pairs and the bound of its error; infinite where none is proved.
#[inline]
pub fn by_pairs([a, b, c]: [&Unit; 3]) -> (f64, f64) {
    let (p, q) = (difference(a, c), difference(b, c));
    let (det, permanent) = determinant(p, q, c.hi);
    let (s, t) = (size(p), size(q));
    let bound = BOUND * permanent + ABSOLUTE * (s + t);
    let apart = s >= NEAREST && t >= NEAREST;
    (det, if apart { bound } else { f64::INFINITY })
}

/// The sign of the determinant [a, b, c] of three vectors: positive if they turn counterclockwise seen
/// from outside, zero on a great circle. Exact for all finite doubles; lengths do not count.
///
/// ```
/// use delone_predicates::{Sign, sphere::orient};
/// let [x, y, z] = [[2.0, 0.0, 0.0], [0.0, 1e-300, 0.0], [1.0, 1.0, 1e300]];
/// assert_eq!(orient(x, y, z), Sign::Positive);
/// assert_eq!(orient(x, y, [-3.0, 5.0, 0.0]), Sign::Zero);
/// ```
#[must_use]
pub fn orient(a: Point3, b: Point3, c: Point3) -> Sign {
    orient_of([a, b, c], [&Unit::of(a), &Unit::of(b), &Unit::of(c)])
}

/// The same, with the directions given, too.
#[inline]
#[must_use]
pub fn orient_of(vectors: [Point3; 3], units: [&Unit; 3]) -> Sign {
    match pairs(units) {
        Some(sign) => sign,
        None => orient_exact(vectors),
    }
}

/// The same by the vectors alone.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient_exact(vectors: [Point3; 3]) -> Sign {
    let [a, b, c] = vectors.map(level);
    orient3d([0.0; 3], a, b, c)
}

/// The vector times a power of two, such that lengths are alike, if that is exact.
fn level(v: Point3) -> Point3 {
    let w = leveled(v);
    // A coordinate far above the least double has lost nothing.
    let kept = |(&x, &y): (&f64, &f64)| x == 0.0 || y.abs() >= f64::MIN_POSITIVE;
    if v.iter().zip(&w).all(kept) { w } else { v }
}

/// The difference of two directions as pairs.
pub(super) fn pair_difference(a: &Unit, b: &Unit) -> [Pair; 3] {
    [0, 1, 2].map(|k| a.pair(k) - b.pair(k))
}
