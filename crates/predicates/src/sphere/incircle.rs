//! Whether a direction lies inside the circle through three others, and the rule for ties.
//!
//! # The bounds of the stages
//!
//! The determinant is -[P, Q, R] with P = a - d, Q = b - d, R = c - d, of directions. Let p, q, r be the
//! 1-norms, and u, h as in `orient`. In *pairs* each entry errs by 2 u of itself and h. A monomial passes
//! two products, a difference and at most two sums: with 6 u from the entries 11 u of the permanent, and
//! 12 u leaves room for the second order. An error h in an entry meets a minor of the other rows; those
//! of a row sum up to at most q r, and all to h (p q + q r + r p), for which 2^-99 (p q + q r + r p) has
//! room, for products of two and three such errors, too, as long as p, q, r >= 2^-90. Underflow is
//! below 2^-1070, and the sum is at least 2^-278.
//!
//! In *double-double* arithmetic a difference of pairs errs by 4 u^2 (|a_k| + |d_k|) <= 2^-103, and h
//! covers that, too. A monomial passes two products (9 u^2 each) and three sums (4 u^2 each): 30 u^2 of
//! the permanent, which itself is computed from the heads; 64 u^2 leaves room.
//!
//! # Ties
//!
//! Push the smallest direction p in the order of `order` outward, and the others infinitely less:
//! 1/|p| becomes (1 + e) / |p|. The determinant is multilinear in the four rows (v / |v|, 1); for the row
//! k of p, the sum gains e times (-1)^(k + 1) orient(others) times a positive number, so that
//! -(-1)^k orient(others) decides. Distinct directions that tie lie on one circle. On a
//! small circle no three of them are coplanar with the origin, so the smallest decides. On a great circle
//! the sign stays zero: no triangle with a positive determinant has its corners there.

use crate::Point3;
use std::cmp::Ordering;

use crate::expansion::Pair;
use crate::integer::{FULL, Integer, capacity};
use crate::range::bit_span;
use crate::sign::Sign;

use super::order::compare;
use super::orient::{NEAREST, determinant, difference, orient_exact, pair_difference, size};
use super::roots;
use super::unit::Unit;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Bound of pairs relative to the permanent.
const BOUND: f64 = 12.0 * U;
/// Bound of double-double arithmetic relative to the permanent.
const BOUND_DOUBLE: f64 = 64.0 * U * U;
/// Bound of both relative to the products of the lengths of the differences, 2^-99.
const ABSOLUTE: f64 = 1.0 / (1_u128 << 99) as f64;

/// Whether `d` lies inside the circle through the directions of `a`, `b`, `c`.
///
/// For `a`, `b`, `c` counterclockwise seen from outside (see [`orient`](super::orient())):
/// [`Sign::Positive`] inside, [`Sign::Zero`] on the circle, [`Sign::Negative`] outside. Exact for all
/// finite doubles; lengths do not count.
///
/// ```
/// use delone_predicates::{Sign, sphere::incircle};
/// let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1e-300]];
/// assert_eq!(incircle(a, b, c, [1.0, 1.0, 1.0]), Sign::Positive);
/// assert_eq!(incircle(a, b, c, [2.0, 2.0, -1.0]), Sign::Zero);
/// ```
#[must_use]
pub fn incircle(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    incircle_of([a, b, c, d], [a, b, c, d].map(Unit::of).each_ref())
}

/// The same, with the directions given, too.
#[inline]
#[must_use]
pub fn incircle_of(vectors: [Point3; 4], units: [&Unit; 4]) -> Sign {
    pairs(units)
        .or_else(|| double_double(units))
        .unwrap_or_else(|| incircle_exact(vectors))
}

/// Like [`incircle`], with ties broken by a symbolic perturbation in the order of [`compare`].
///
/// [`Sign::Zero`] only if two directions are equal or all four lie on a great circle. Swapping two of
/// them negates the sign.
#[must_use]
pub fn incircle_canonical(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    match incircle(a, b, c, d) {
        Sign::Zero => tie([a, b, c, d]),
        sign => sign,
    }
}

/// The sign of four directions on one circle.
#[cold]
#[inline(never)]
#[must_use]
pub fn tie(vectors: [Point3; 4]) -> Sign {
    let mut smallest = 0;
    for i in 1..4 {
        match compare(vectors[i], vectors[smallest]) {
            Ordering::Less => smallest = i,
            Ordering::Equal => return Sign::Zero,
            Ordering::Greater => {}
        }
    }
    let [a, b, c, d] = vectors;
    let others = [[b, c, d], [a, c, d], [a, b, d], [a, b, c]][smallest];
    (-orient_exact(others)).flip_if(smallest % 2 == 1)
}

/// The sign, if pairs prove it.
#[inline]
pub fn pairs(units: [&Unit; 4]) -> Option<Sign> {
    let (det, bound) = by_pairs(units);
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The determinant by pairs and the bound of its error; infinite where none is proved.
#[inline]
pub fn by_pairs([a, b, c, d]: [&Unit; 4]) -> (f64, f64) {
    let [p, q, r] = [a, b, c].map(|x| difference(x, d));
    let (det, permanent) = determinant(p, q, r);
    let (s, t, w) = (size(p), size(q), size(r));
    let bound = BOUND * permanent + ABSOLUTE * (s * t + t * w + w * s);
    let apart = s >= NEAREST && t >= NEAREST && w >= NEAREST;
    (-det, if apart { bound } else { f64::INFINITY })
}

/// The sign, if double-double arithmetic proves it.
#[inline]
pub fn double_double(units: [&Unit; 4]) -> Option<Sign> {
    let (det, bound) = by_double_double(units);
    (det.hi.abs() > bound).then(|| Sign::of(det.hi))
}

/// The same in double-double arithmetic.
#[inline]
pub fn by_double_double([a, b, c, d]: [&Unit; 4]) -> (Pair, f64) {
    let [p, q, r] = [a, b, c].map(|x| pair_difference(x, d));
    let minor = |i: usize, j: usize| q[i] * r[j] - q[j] * r[i];
    let det = p[0] * minor(1, 2) + p[1] * minor(2, 0) + p[2] * minor(0, 1);
    let heads = |p: [Pair; 3]| p.map(|x| x.hi);
    let [p, q, r] = [p, q, r].map(heads);
    let (_, permanent) = determinant(p, q, r);
    let (s, t, w) = (size(p), size(q), size(r));
    let bound = BOUND_DOUBLE * permanent + ABSOLUTE * (s * t + t * w + w * s);
    let apart = s >= NEAREST && t >= NEAREST && w >= NEAREST;
    let negated = Pair {
        hi: -det.hi,
        lo: -det.lo,
    };
    (negated, if apart { bound } else { f64::INFINITY })
}

/// The same by integers: always right.
#[cold]
#[inline(never)]
#[must_use]
pub fn incircle_exact(vectors: [Point3; 4]) -> Sign {
    let (mut lows, mut width) = ([0; 4], 0);
    for (low, v) in lows.iter_mut().zip(vectors) {
        match bit_span(&[v]) {
            None => return Sign::Zero,
            Some((lowest, wide)) => {
                *low = lowest;
                width = width.max(wide);
            }
        }
    }
    if width <= capacity(1) {
        integer::<1, 2, 3, 6, 8, 16, 32>(vectors, lows)
    } else if width <= capacity(2) {
        integer::<2, 4, 6, 12, 16, 32, 64>(vectors, lows)
    } else if width <= capacity(5) {
        integer::<5, 10, 15, 30, 40, 80, 160>(vectors, lows)
    } else {
        integer::<FULL, 66, 99, 198, 264, 528, 1056>(vectors, lows)
    }
}

/// The same with coordinates of `L` limbs.
fn integer<
    const L: usize,
    const L2: usize,
    const L3: usize,
    const L6: usize,
    const L8: usize,
    const L16: usize,
    const L32: usize,
>(
    vectors: [Point3; 4],
    lows: [i32; 4],
) -> Sign {
    let v: [[Integer<L>; 3]; 4] =
        std::array::from_fn(|i| vectors[i].map(|x| Integer::from_double(x, lows[i])));
    let minor = |i: usize, j: usize, k: usize| -> Integer<L3> {
        let cross = |m: usize, n: usize| -> Integer<L2> {
            v[j][m].times(&v[k][n]).minus(&v[j][n].times(&v[k][m]))
        };
        let term = |m: usize, n: usize, o: usize| v[i][m].times::<L2, L3>(&cross(n, o));
        term(0, 1, 2).plus(&term(1, 2, 0)).plus(&term(2, 0, 1))
    };
    let factors = [
        minor(1, 2, 3),
        minor(0, 2, 3).negated(),
        minor(0, 1, 3),
        minor(0, 1, 2).negated(),
    ];
    let squares = v.map(|v| {
        let square = |k: usize| v[k].times::<L, L2>(&v[k]);
        square(0).plus(&square(1)).plus(&square(2))
    });
    roots::sign::<L2, L3, L6, L8, L16, L32>(factors, squares)
}
