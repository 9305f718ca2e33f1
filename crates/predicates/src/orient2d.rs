//! On which side of the line through two points a third point lies.
//!
//! The determinant is the cross product l - r = (b - a) x (c - a), with l = (bx - ax)(cy - ay) and
//! r = (by - ay)(cx - ax).
//!
//! # The bound of the filter
//!
//! Let u = 2^-53. A rounded difference of doubles errs by a factor 1 + d, |d| <= u, and never
//! underflows; a rounded product by such a factor and an absolute 2^-1075. Each of l and r passes
//! through three roundings (two differences, the product), so with P = |l| + |r| of exact values the
//! unrounded difference of the computed ones errs by ((1 + u)^3 - 1) P + 2^-1074. The last
//! subtraction changes no sign, and the size of the result by a factor 1 + u. The computed P is
//! P (1 + u)^-4 or more, less 2^-1074. In all 4 u times the computed P and [`FLOOR`] suffice: the
//! fourth u holds all terms of second order and the roundings of the bound itself.
//!
//! For scaled coordinates, below 2^190 and off by up to 2^-1074, differences are off by 2^-1073
//! and the determinant by 2 * 2 * 2^192 * 2^-1073, less than [`FLOOR_SCALED`].

use crate::Point2;
use crate::expansion::Pair;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{Scaled, is_safe, lattice as lattice_of, scale_to_window};
use crate::sign::Sign;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of the filter, see the head of the file.
const BOUND: f64 = 4.0 * U;
/// Absolute bound of the filter: far above 2^-1074, and not subnormal, which may be slow.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// [`FLOOR`] for scaled coordinates: 2^-822.
const FLOOR_SCALED: f64 = FLOOR * (1_u128 << 100) as f64 * (1_u128 << 100) as f64;
/// Relative bound of expansions: one product and one sum make 13 u^2.
const BOUND_EXPANSION: f64 = 32.0 * U * U;

/// The side of the line from `a` to `b` on which `c` lies.
///
/// [`Sign::Positive`] if `a`, `b`, `c` turn left (counterclockwise), [`Sign::Zero`] if they are
/// collinear. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, orient2d};
/// assert_eq!(orient2d([0.0, 0.0], [1.0, 1.0], [0.0, 5e-324]), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    match filter(a, b, c) {
        Some(sign) => sign,
        None => orient2d_exact(a, b, c),
    }
}

/// Like [`orient2d()`], without the floating-point filter: for callers that have tried one.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient2d_exact(a: Point2, b: Point2, c: Point2) -> Sign {
    lattice(a, b, c)
        .or_else(|| expansion(a, b, c))
        .or_else(|| scaled(a, b, c))
        .unwrap_or_else(|| integer(a, b, c))
}

/// The sign, if plain floating point proves it.
#[inline]
pub fn filter(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    filter_above(FLOOR, a, b, c)
}

#[inline]
fn filter_above(floor: f64, a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    let left = (b[0] - a[0]) * (c[1] - a[1]);
    let right = (b[1] - a[1]) * (c[0] - a[0]);
    let det = left - right;
    let bound = BOUND * (left.abs() + right.abs()) + floor;
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The sign, if the differences lie on a lattice of 64-bit integers.
#[inline]
pub fn lattice(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    let found = lattice_of([b[0], b[1], c[0], c[1]], [a[0], a[1], a[0], a[1]])?;
    let [bx, by, cx, cy] = found.values.map(i128::from);
    Some(Sign::from(bx * cy - by * cx))
}

/// The sign, if double-double arithmetic proves it.
#[inline]
pub fn expansion(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    if !is_safe(&[a, b, c]) {
        return None;
    }
    let [bx, by] = [0, 1].map(|k| Pair::difference(b[k], a[k]));
    let [cx, cy] = [0, 1].map(|k| Pair::difference(c[k], a[k]));
    let (left, right) = (bx * cy, by * cx);
    let det = (left - right).hi;
    let bound = BOUND_EXPANSION * (left.hi.abs() + right.hi.abs());
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The sign, if the previous stages prove it for coordinates scaled into their range.
pub fn scaled(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    let points = [a, b, c];
    if is_safe(&points) {
        return None;
    }
    let Scaled { points, exact } = scale_to_window(&points)?;
    let [a, b, c] = points;
    filter_above(FLOOR_SCALED, a, b, c).or_else(|| {
        if exact {
            lattice(a, b, c).or_else(|| expansion(a, b, c))
        } else {
            None
        }
    })
}

/// The sign, by integers that hold every double.
#[cold]
#[inline(never)]
pub fn integer(a: Point2, b: Point2, c: Point2) -> Sign {
    let points = [b, c, a];
    by_width(
        &points,
        |low| determinant::<2, 4>(&points, low),
        |low| determinant::<5, 10>(&points, low),
        |low| determinant::<12, 24>(&points, low),
        |low| determinant::<FULL, { 2 * FULL }>(&points, low),
    )
}

/// The sign of b x c, for differences of `D` limbs.
fn determinant<const D: usize, const D2: usize>(points: &[Point2; 3], low: i32) -> Sign {
    let [b, c] = differences::<D, 2, 3, 2>(points, low);
    let left: Integer<D2> = b[0].times(&c[1]);
    left.minus(&b[1].times(&c[0])).sign()
}
