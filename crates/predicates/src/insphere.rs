//! Whether a point lies inside the sphere through four others.
//!
//! With A = a - e and so on, and [P, Q, R] the determinant of three vectors, the determinant is
//! |A|^2 [B, C, D] - |B|^2 [A, C, D] + |C|^2 [A, B, D] - |D|^2 [A, B, C]. At the circumcenter all
//! lengths are equal, and the rest is [b - a, c - a, d - a]: positive inside, for positively
//! oriented a, b, c, d.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53 and P the sum of the magnitudes of the monomials. Each passes through 5
//! differences; a product and two sums for the squared length; a product, a difference, a product and
//! two sums for the 3 x 3 minor; the product of both; and the first of the two levels of the last
//! sum: 15 roundings. The last sum changes no sign. 16 u times the computed P leaves room for the
//! terms of second order and the roundings of P and of the bound.
//!
//! An underflowing product adds at most 2^-1075. Let L be the sum of the squared lengths, so that
//! each difference is at most M = L^(1/2). Such an addition in a 2 x 2 minor (12 of them) meets at
//! most M and L, and serves two 3 x 3 minors; one in a 3 x 3 minor (12) meets L; one in a squared length (12) meets a 3 x 3
//! minor, at most M^3; 4 end the terms; as many lie in P. As L^(3/2) <= (1 + L)^2, all are less
//! than 2^-1067 (1 + L)^2, and [`FLOOR`] (1 + L)^2 suffices.
//!
//! Scaled coordinates are off by up to 2^-1074, their differences by 2^-1073, and each of the 72
//! monomials by 5 M^4 2^-1073: less than 2^-1064 (1 + L)^2, which [`FLOOR`] covers, too.

use crate::Point3;
use crate::expansion::Pair;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{Scaled, is_safe, lattice as lattice_of, scale_to_window};
use crate::sign::Sign;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of the filter, see the head of the file.
const BOUND: f64 = 16.0 * U;
/// Absolute bound of the filter, to be multiplied by (1 + L)^2.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// Relative bound of expansions: each monomial passes four products and seven sums (two in the
/// squared length, one and two in the minors, two at the end): 36 + 28 = 64 u^2.
const BOUND_EXPANSION: f64 = 96.0 * U * U;
/// Most bits for 64-bit 2 x 2 minors and squared lengths (below 2^2b+2) and a 128-bit sum, below
/// 4 * 3 * 2^2b * 6 * 2^3b.
const BITS_NARROW: u32 = 24;
/// Most bits for 128-bit 3 x 3 minors, below 6 * 2^3b; the sum has 256.
const BITS_MEDIUM: u32 = 41;

/// Whether `e` lies inside the sphere through `a`, `b`, `c`, `d`.
///
/// For positively oriented `a`, `b`, `c`, `d` (see [`orient3d`](crate::orient3d())):
/// [`Sign::Positive`] inside, [`Sign::Zero`] on the sphere, [`Sign::Negative`] outside. For
/// negatively oriented ones the sign flips; for coplanar ones the sphere is the plane, or, if they
/// are cocircular, everything is on it. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, insphere};
/// let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// assert_eq!(insphere(a, b, c, d, [0.5, 0.5, 0.5]), Sign::Positive);
/// assert_eq!(insphere(a, b, c, d, [1.0, 1.0, 1.0]), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn insphere(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Sign {
    match filter(a, b, c, d, e) {
        Some(sign) => sign,
        None => insphere_exact(a, b, c, d, e),
    }
}

/// Like [`insphere()`], without the floating-point filter: for callers that have tried one.
#[cold]
#[inline(never)]
#[must_use]
pub fn insphere_exact(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Sign {
    lattice(a, b, c, d, e)
        .or_else(|| expansion(a, b, c, d, e))
        .or_else(|| scaled(a, b, c, d, e))
        .unwrap_or_else(|| integer(a, b, c, d, e))
}

/// The sign, if plain floating point proves it.
#[inline]
pub fn filter(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Option<Sign> {
    let [a, b, c, d] = [a, b, c, d].map(|p| [p[0] - e[0], p[1] - e[1], p[2] - e[2]]);
    let length = |p: [f64; 3]| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    let products = |p: [f64; 3], q: [f64; 3]| (p[0] * q[1], p[1] * q[0]);
    let minor = |(x, y): (f64, f64)| x - y;
    let size = |(x, y): (f64, f64)| x.abs() + y.abs();

    let (ab, bc, cd) = (products(a, b), products(b, c), products(c, d));
    let (da, ac, bd) = (products(d, a), products(a, c), products(b, d));
    let bcd = b[2] * minor(cd) - c[2] * minor(bd) + d[2] * minor(bc);
    let acd = c[2] * minor(da) + d[2] * minor(ac) + a[2] * minor(cd);
    let abd = d[2] * minor(ab) + a[2] * minor(bd) + b[2] * minor(da);
    let abc = a[2] * minor(bc) - b[2] * minor(ac) + c[2] * minor(ab);
    let [aa, bb, cc, dd] = [a, b, c, d].map(length);
    let det = (aa * bcd - bb * acd) + (cc * abd - dd * abc);

    let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].abs());
    let permanent = aa * (bz * size(cd) + cz * size(bd) + dz * size(bc))
        + bb * (cz * size(da) + dz * size(ac) + az * size(cd))
        + cc * (dz * size(ab) + az * size(bd) + bz * size(da))
        + dd * (az * size(bc) + bz * size(ac) + cz * size(ab));
    let lengths = 1.0 + aa + bb + cc + dd;
    let bound = BOUND * permanent + FLOOR * (lengths * lengths);
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The sign, if the differences lie on a lattice of 64-bit integers.
#[inline]
pub fn lattice(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Option<Sign> {
    let found = lattice_of(
        [
            a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2],
        ],
        [
            e[0], e[1], e[2], e[0], e[1], e[2], e[0], e[1], e[2], e[0], e[1], e[2],
        ],
    )?;
    let [ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz] = found.values;
    let points = [[ax, ay, az], [bx, by, bz], [cx, cy, cz], [dx, dy, dz]];
    Some(if found.bits <= BITS_NARROW {
        narrow(points)
    } else if found.bits <= BITS_MEDIUM {
        medium(points)
    } else {
        let [a, b, c, d] = points.map(|p| p.map(Integer::new));
        determinant::<1, 2, 3, 5>([&a, &b, &c, &d])
    })
}

/// The sign for differences of up to [`BITS_NARROW`] bits.
#[inline]
fn narrow([a, b, c, d]: [[i64; 3]; 4]) -> Sign {
    let length = |p: [i64; 3]| i128::from(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    let cross = |p: [i64; 3], q: [i64; 3]| p[0] * q[1] - p[1] * q[0];
    let wide = |x: i64, y: i64| i128::from(x) * i128::from(y);
    let minor = |p: [i64; 3], q: [i64; 3], r: [i64; 3]| {
        wide(p[2], cross(q, r)) + wide(q[2], cross(r, p)) + wide(r[2], cross(p, q))
    };
    let det = (length(a) * minor(b, c, d) - length(b) * minor(a, c, d))
        + (length(c) * minor(a, b, d) - length(d) * minor(a, b, c));
    Sign::from(det)
}

/// The sign for differences of up to [`BITS_MEDIUM`] bits.
#[inline]
fn medium([a, b, c, d]: [[i64; 3]; 4]) -> Sign {
    let wide = |x: i64, y: i64| i128::from(x) * i128::from(y);
    let length = |p: [i64; 3]| wide(p[0], p[0]) + wide(p[1], p[1]) + wide(p[2], p[2]);
    let cross = |p: [i64; 3], q: [i64; 3]| wide(p[0], q[1]) - wide(p[1], q[0]);
    let minor = |p: [i64; 3], q: [i64; 3], r: [i64; 3]| {
        i128::from(p[2]) * cross(q, r)
            + i128::from(q[2]) * cross(r, p)
            + i128::from(r[2]) * cross(p, q)
    };
    let term = |length: i128, minor: i128| -> Integer<4> {
        Integer::<2>::from(length).times(&Integer::<2>::from(minor))
    };
    let positive = term(length(a), minor(b, c, d)).plus(&term(length(c), minor(a, b, d)));
    let negative = term(length(b), minor(a, c, d)).plus(&term(length(d), minor(a, b, c)));
    positive.minus(&negative).sign()
}

/// The sign, if double-double arithmetic proves it.
#[inline]
pub fn expansion(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Option<Sign> {
    if !is_safe(&[a, b, c, d, e]) {
        return None;
    }
    let [a, b, c, d] = [a, b, c, d].map(|p| [0, 1, 2].map(|k| Pair::difference(p[k], e[k])));
    let length = |p: [Pair; 3]| p[0].square() + p[1].square() + p[2].square();
    let products = |p: [Pair; 3], q: [Pair; 3]| (p[0] * q[1], p[1] * q[0]);
    let minor = |(x, y): (Pair, Pair)| x - y;
    let size = |(x, y): (Pair, Pair)| x.hi.abs() + y.hi.abs();

    let (ab, bc, cd) = (products(a, b), products(b, c), products(c, d));
    let (da, ac, bd) = (products(d, a), products(a, c), products(b, d));
    let bcd = b[2] * minor(cd) - c[2] * minor(bd) + d[2] * minor(bc);
    let acd = c[2] * minor(da) + d[2] * minor(ac) + a[2] * minor(cd);
    let abd = d[2] * minor(ab) + a[2] * minor(bd) + b[2] * minor(da);
    let abc = a[2] * minor(bc) - b[2] * minor(ac) + c[2] * minor(ab);
    let [aa, bb, cc, dd] = [a, b, c, d].map(length);
    let det = ((aa * bcd - bb * acd) + (cc * abd - dd * abc)).hi;

    let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].hi.abs());
    let permanent = aa.hi * (bz * size(cd) + cz * size(bd) + dz * size(bc))
        + bb.hi * (cz * size(da) + dz * size(ac) + az * size(cd))
        + cc.hi * (dz * size(ab) + az * size(bd) + bz * size(da))
        + dd.hi * (az * size(bc) + bz * size(ac) + cz * size(ab));
    (det.abs() > BOUND_EXPANSION * permanent).then(|| Sign::of(det))
}

/// The sign, if the previous stages prove it for coordinates scaled into their range.
pub fn scaled(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Option<Sign> {
    let points = [a, b, c, d, e];
    if is_safe(&points) {
        return None;
    }
    let Scaled { points, exact } = scale_to_window(&points)?;
    let [a, b, c, d, e] = points;
    filter(a, b, c, d, e).or_else(|| {
        if exact {
            lattice(a, b, c, d, e).or_else(|| expansion(a, b, c, d, e))
        } else {
            None
        }
    })
}

/// The sign, by integers that hold every double.
#[cold]
#[inline(never)]
pub fn integer(a: Point3, b: Point3, c: Point3, d: Point3, e: Point3) -> Sign {
    let points = [a, b, c, d, e];
    by_width(
        &points,
        |low| from_points::<2, 4, 6, 10>(&points, low),
        |low| from_points::<5, 10, 15, 25>(&points, low),
        |low| from_points::<12, 24, 36, 60>(&points, low),
        |low| from_points::<FULL, { 2 * FULL }, { 3 * FULL }, { 5 * FULL }>(&points, low),
    )
}

fn from_points<const D: usize, const D2: usize, const D3: usize, const D5: usize>(
    points: &[Point3; 5],
    low: i32,
) -> Sign {
    let [a, b, c, d] = differences::<D, 3, 5, 4>(points, low);
    determinant::<D, D2, D3, D5>([&a, &b, &c, &d])
}

/// The sign of the determinant, for differences of `D` limbs.
#[inline]
fn determinant<const D: usize, const D2: usize, const D3: usize, const D5: usize>(
    [a, b, c, d]: [&[Integer<D>; 3]; 4],
) -> Sign {
    type Vector<const D: usize> = [Integer<D>; 3];
    let square = |x: &Integer<D>| -> Integer<D2> { x.times(x) };
    let length = |p: &Vector<D>| square(&p[0]).plus(&square(&p[1])).plus(&square(&p[2]));
    let cross = |p: &Vector<D>, q: &Vector<D>| -> Integer<D2> {
        p[0].times::<D, D2>(&q[1]).minus(&p[1].times(&q[0]))
    };
    let (ab, bc, cd) = (cross(a, b), cross(b, c), cross(c, d));
    let (da, ac, bd) = (cross(d, a), cross(a, c), cross(b, d));
    let part = |minor: &Integer<D2>, p: &Vector<D>| -> Integer<D3> { minor.times(&p[2]) };
    let bcd = part(&cd, b).minus(&part(&bd, c)).plus(&part(&bc, d));
    let acd = part(&da, c).plus(&part(&ac, d)).plus(&part(&cd, a));
    let abd = part(&ab, d).plus(&part(&bd, a)).plus(&part(&da, b));
    let abc = part(&bc, a).minus(&part(&ac, b)).plus(&part(&ab, c));
    let term = |p: &Vector<D>, minor: &Integer<D3>| -> Integer<D5> { length(p).times(minor) };
    let positive = term(a, &bcd).plus(&term(c, &abd));
    positive.minus(&term(b, &acd)).minus(&term(d, &abc)).sign()
}
