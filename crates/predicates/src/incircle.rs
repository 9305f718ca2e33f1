//! Whether a point lies inside the circle through three others.
//!
//! With A = a - d, B = b - d, C = c - d the determinant is
//! |A|^2 (B x C) + |B|^2 (C x A) + |C|^2 (A x B).
//!
//! # The bound of the filter
//!
//! Let u = 2^-53 and P, the permanent, be the sum of the magnitudes of the determinant's monomials.
//! Each monomial passes through 4 differences, 2 products and 2 sums on the way to a squared length
//! and a cross product, the product of those, and the first of the two last sums: 10 roundings.
//! The last sum changes no sign. So the computed value errs by ((1 + u)^10 - 1) P, if nothing
//! underflows, and 11 u times the computed P leaves room for the terms of second order and the
//! roundings of P (11 each way) and of the bound.
//!
//! An underflowing product adds at most 2^-1075. With L = |A|^2 + |B|^2 + |C|^2: four such terms
//! (two in a cross product, two in a squared length) are multiplied by a squared length or by a
//! cross product, both at most L, for each of three terms, which end in one more product; nine
//! such terms lie in P. Together less than 2^-1068 (1 + L), and [`FLOOR`] (1 + L) suffices.
//!
//! Scaled coordinates lie below 2^190 and are off by up to 2^-1074, so their differences, below
//! M = 2^191, by 2^-1073. Each of 12 monomials of degree 4 is then off by
//! 4 M'^3 2^-1073 where M' is the largest difference involved, and M'^2 <= L + tiny, M' <= 2^192:
//! in all 2^-875 L at most, or tiny, less than [`FLOOR_SCALED`] (1 + L).

use crate::Point2;
use crate::expansion::Pair;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{Scaled, is_safe, lattice as lattice_of, scale_to_window};
use crate::sign::Sign;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of the filter, see the head of the file.
const BOUND: f64 = 11.0 * U;
/// Absolute bound of the filter, to be multiplied by 1 + L.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// [`FLOOR`] for scaled coordinates: 2^-822.
const FLOOR_SCALED: f64 = FLOOR * (1_u128 << 100) as f64 * (1_u128 << 100) as f64;
/// Relative bound of expansions: each monomial goes through three products, a sum in the squared
/// length, a difference in the cross product and two last sums: 27 + 16 = 43 u^2.
const BOUND_EXPANSION: f64 = 64.0 * U * U;
/// Most bits for 64-bit minors and a 128-bit sum: below 2^2b+1 and 3 * 2^4b+2.
const BITS_NARROW: u32 = 30;

/// Whether `d` lies inside the circle through `a`, `b`, `c`.
///
/// For counterclockwise `a`, `b`, `c`: [`Sign::Positive`] inside, [`Sign::Zero`] on the circle,
/// [`Sign::Negative`] outside. For clockwise ones the sign flips; for collinear ones the circle is
/// the line. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, incircle};
/// let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
/// assert_eq!(incircle(a, b, c, [0.5, 0.5]), Sign::Positive);
/// assert_eq!(incircle(a, b, c, [0.0, 1.0]), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    match filter(a, b, c, d) {
        Some(sign) => sign,
        None => incircle_exact(a, b, c, d),
    }
}

/// Like [`incircle()`], without the floating-point filter: for callers that have tried one.
#[cold]
#[inline(never)]
#[must_use]
pub fn incircle_exact(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    lattice(a, b, c, d)
        .or_else(|| expansion(a, b, c, d))
        .or_else(|| scaled(a, b, c, d))
        .unwrap_or_else(|| integer(a, b, c, d))
}

/// The sign, if plain floating point proves it.
#[inline]
pub fn filter(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    filter_above(FLOOR, a, b, c, d)
}

#[inline]
fn filter_above(floor: f64, a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    let [(ax, ay), (bx, by), (cx, cy)] = [a, b, c].map(|p| (p[0] - d[0], p[1] - d[1]));
    let (bc, cb) = (bx * cy, by * cx);
    let (ca, ac) = (cx * ay, cy * ax);
    let (ab, ba) = (ax * by, ay * bx);
    let [aa, bb, cc] = [ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy];
    let det = aa * (bc - cb) + bb * (ca - ac) + cc * (ab - ba);
    let permanent =
        aa * (bc.abs() + cb.abs()) + bb * (ca.abs() + ac.abs()) + cc * (ab.abs() + ba.abs());
    let bound = BOUND * permanent + floor * (1.0 + aa + bb + cc);
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The sign, if the differences lie on a lattice of 64-bit integers.
#[inline]
pub fn lattice(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    let found = lattice_of(
        [a[0], a[1], b[0], b[1], c[0], c[1]],
        [d[0], d[1], d[0], d[1], d[0], d[1]],
    )?;
    let [ax, ay, bx, by, cx, cy] = found.values;
    if found.bits <= BITS_NARROW {
        let wide = |x: i64, y: i64| i128::from(x) * i128::from(y);
        let det = wide(ax * ax + ay * ay, bx * cy - by * cx)
            + wide(bx * bx + by * by, cx * ay - cy * ax)
            + wide(cx * cx + cy * cy, ax * by - ay * bx);
        return Some(Sign::from(det));
    }
    let [a, b, c] = [[ax, ay], [bx, by], [cx, cy]].map(|p| p.map(Integer::new));
    Some(determinant::<1, 2, 4>([&a, &b, &c]))
}

/// The sign, if double-double arithmetic proves it.
#[inline]
pub fn expansion(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    if !is_safe(&[a, b, c, d]) {
        return None;
    }
    let [(ax, ay), (bx, by), (cx, cy)] =
        [a, b, c].map(|p| (Pair::difference(p[0], d[0]), Pair::difference(p[1], d[1])));
    let (bc, cb) = (bx * cy, by * cx);
    let (ca, ac) = (cx * ay, cy * ax);
    let (ab, ba) = (ax * by, ay * bx);
    let [aa, bb, cc] = [
        ax.square() + ay.square(),
        bx.square() + by.square(),
        cx.square() + cy.square(),
    ];
    let det = (aa * (bc - cb) + bb * (ca - ac) + cc * (ab - ba)).hi;
    let permanent = aa.hi * (bc.hi.abs() + cb.hi.abs())
        + bb.hi * (ca.hi.abs() + ac.hi.abs())
        + cc.hi * (ab.hi.abs() + ba.hi.abs());
    (det.abs() > BOUND_EXPANSION * permanent).then(|| Sign::of(det))
}

/// The sign, if the previous stages prove it for coordinates scaled into their range.
pub fn scaled(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    let points = [a, b, c, d];
    if is_safe(&points) {
        return None;
    }
    let Scaled { points, exact } = scale_to_window(&points)?;
    let [a, b, c, d] = points;
    filter_above(FLOOR_SCALED, a, b, c, d).or_else(|| {
        if exact {
            lattice(a, b, c, d).or_else(|| expansion(a, b, c, d))
        } else {
            None
        }
    })
}

/// The sign, by integers that hold every double.
#[cold]
#[inline(never)]
pub fn integer(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    let points = [a, b, c, d];
    by_width(
        &points,
        |low| from_points::<2, 4, 8>(&points, low),
        |low| from_points::<5, 10, 20>(&points, low),
        |low| from_points::<12, 24, 48>(&points, low),
        |low| from_points::<FULL, { 2 * FULL }, { 4 * FULL }>(&points, low),
    )
}

fn from_points<const D: usize, const D2: usize, const D4: usize>(
    points: &[Point2; 4],
    low: i32,
) -> Sign {
    let [a, b, c] = differences::<D, 2, 4, 3>(points, low);
    determinant::<D, D2, D4>([&a, &b, &c])
}

/// The sign of the determinant, for differences of `D` limbs.
#[inline]
fn determinant<const D: usize, const D2: usize, const D4: usize>(
    [a, b, c]: [&[Integer<D>; 2]; 3],
) -> Sign {
    let length = |p: &[Integer<D>; 2]| -> Integer<D2> {
        p[0].times::<D, D2>(&p[0]).plus(&p[1].times(&p[1]))
    };
    let cross = |p: &[Integer<D>; 2], q: &[Integer<D>; 2]| -> Integer<D2> {
        p[0].times::<D, D2>(&q[1]).minus(&p[1].times(&q[0]))
    };
    let term = |p, q, r| -> Integer<D4> { length(p).times(&cross(q, r)) };
    term(a, b, c)
        .plus(&term(b, c, a))
        .plus(&term(c, a, b))
        .sign()
}
