//! On which side of the plane through three points a fourth point lies.
//!
//! With B = b - a, C = c - a, D = d - a the determinant is
//! det[B, C, D] = Bz (C x D) - Cz (B x D) + Dz (B x C), where x is the cross product in the plane.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53 and P the sum of the magnitudes of the six monomials. Each passes through 3
//! differences, a product, a difference, a product, and the first of the two last sums: 7
//! roundings; the last sum changes no sign. 8 u times the computed P leaves room for the terms of
//! second order and the roundings of P and of the bound.
//!
//! An underflowing product adds at most 2^-1075: two in each cross product, multiplied by Z at most,
//! the sum of the heights, and one more for each of three terms; as many lie in P. Together less
//! than 2^-1070 (1 + Z), and [`FLOOR`] (1 + Z) suffices.
//!
//! Scaled coordinates lie below 2^190 and are off by up to 2^-1074, their differences by 2^-1073,
//! and the determinant by 6 * 3 * 2^(2 * 192) * 2^-1073, less than [`FLOOR_SCALED`].

use crate::Point3;
use crate::expansion::Pair;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{Scaled, is_safe, lattice as lattice_of, scale_to_window};
use crate::sign::Sign;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of the filter, see the head of the file.
const BOUND: f64 = 8.0 * U;
/// Absolute bound of the filter, to be multiplied by 1 + Z.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// [`FLOOR`] for scaled coordinates: 2^-622.
const FLOOR_SCALED: f64 = {
    let hundred = (1_u128 << 100) as f64;
    FLOOR * hundred * hundred * hundred * hundred
};
/// Relative bound of expansions: each monomial goes through two products and three sums: 30 u^2.
const BOUND_EXPANSION: f64 = 64.0 * U * U;
/// Most bits for a 128-bit determinant: below 6 * 2^3b, and minors below 2^2b+1.
const BITS_NARROW: u32 = 41;

/// The side of the plane through `a`, `b`, `c` on which `d` lies.
///
/// [`Sign::Positive`] if `b - a`, `c - a`, `d - a` are a right-handed frame (the tetrahedron is
/// positively oriented), [`Sign::Zero`] if the four are coplanar. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, orient3d};
/// let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(orient3d(a, b, c, [0.0, 0.0, 1.0]), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn orient3d(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    match filter(a, b, c, d) {
        Some(sign) => sign,
        None => orient3d_exact(a, b, c, d),
    }
}

/// Like [`orient3d()`], without the floating-point filter: for callers that have tried one.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient3d_exact(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    lattice(a, b, c, d)
        .or_else(|| expansion(a, b, c, d))
        .or_else(|| scaled(a, b, c, d))
        .unwrap_or_else(|| integer(a, b, c, d))
}

/// The sign, if plain floating point proves it.
#[inline]
pub fn filter(a: Point3, b: Point3, c: Point3, d: Point3) -> Option<Sign> {
    filter_above(FLOOR, a, b, c, d)
}

#[inline]
fn filter_above(floor: f64, a: Point3, b: Point3, c: Point3, d: Point3) -> Option<Sign> {
    let [b, c, d] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let (cd, dc) = (c[0] * d[1], c[1] * d[0]);
    let (db, bd) = (d[0] * b[1], d[1] * b[0]);
    let (bc, cb) = (b[0] * c[1], b[1] * c[0]);
    let det = b[2] * (cd - dc) + c[2] * (db - bd) + d[2] * (bc - cb);
    let [bz, cz, dz] = [b, c, d].map(|p| p[2].abs());
    let permanent =
        bz * (cd.abs() + dc.abs()) + cz * (db.abs() + bd.abs()) + dz * (bc.abs() + cb.abs());
    let bound = BOUND * permanent + floor * (1.0 + bz + cz + dz);
    (det.abs() > bound).then(|| Sign::of(det))
}

/// The sign, if the differences lie on a lattice of 64-bit integers.
#[inline]
pub fn lattice(a: Point3, b: Point3, c: Point3, d: Point3) -> Option<Sign> {
    let found = lattice_of(
        [b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2]],
        [a[0], a[1], a[2], a[0], a[1], a[2], a[0], a[1], a[2]],
    )?;
    let [bx, by, bz, cx, cy, cz, dx, dy, dz] = found.values;
    if found.bits <= BITS_NARROW {
        let cross = |x: i64, y: i64, v: i64, w: i64| {
            i128::from(x) * i128::from(w) - i128::from(y) * i128::from(v)
        };
        let det = i128::from(bz) * cross(cx, cy, dx, dy)
            + i128::from(cz) * cross(dx, dy, bx, by)
            + i128::from(dz) * cross(bx, by, cx, cy);
        return Some(Sign::from(det));
    }
    let [b, c, d] = [[bx, by, bz], [cx, cy, cz], [dx, dy, dz]].map(|p| p.map(Integer::new));
    Some(determinant::<1, 2, 3>([&b, &c, &d]))
}

/// The sign, if double-double arithmetic proves it.
#[inline]
pub fn expansion(a: Point3, b: Point3, c: Point3, d: Point3) -> Option<Sign> {
    if !is_safe(&[a, b, c, d]) {
        return None;
    }
    let [b, c, d] = [b, c, d].map(|p| [0, 1, 2].map(|k| Pair::difference(p[k], a[k])));
    let (cd, dc) = (c[0] * d[1], c[1] * d[0]);
    let (db, bd) = (d[0] * b[1], d[1] * b[0]);
    let (bc, cb) = (b[0] * c[1], b[1] * c[0]);
    let det = (b[2] * (cd - dc) + c[2] * (db - bd) + d[2] * (bc - cb)).hi;
    let permanent = b[2].hi.abs() * (cd.hi.abs() + dc.hi.abs())
        + c[2].hi.abs() * (db.hi.abs() + bd.hi.abs())
        + d[2].hi.abs() * (bc.hi.abs() + cb.hi.abs());
    (det.abs() > BOUND_EXPANSION * permanent).then(|| Sign::of(det))
}

/// The sign, if the previous stages prove it for coordinates scaled into their range.
pub fn scaled(a: Point3, b: Point3, c: Point3, d: Point3) -> Option<Sign> {
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
pub fn integer(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    let points = [b, c, d, a];
    by_width(
        &points,
        |low| from_points::<2, 4, 6>(&points, low),
        |low| from_points::<5, 10, 15>(&points, low),
        |low| from_points::<12, 24, 36>(&points, low),
        |low| from_points::<FULL, { 2 * FULL }, { 3 * FULL }>(&points, low),
    )
}

fn from_points<const D: usize, const D2: usize, const D3: usize>(
    points: &[Point3; 4],
    low: i32,
) -> Sign {
    let [b, c, d] = differences::<D, 3, 4, 3>(points, low);
    determinant::<D, D2, D3>([&b, &c, &d])
}

/// The sign of det[b, c, d], for differences of `D` limbs.
#[inline]
fn determinant<const D: usize, const D2: usize, const D3: usize>(
    [b, c, d]: [&[Integer<D>; 3]; 3],
) -> Sign {
    let cross = |p: &[Integer<D>; 3], q: &[Integer<D>; 3]| -> Integer<D2> {
        p[0].times::<D, D2>(&q[1]).minus(&p[1].times(&q[0]))
    };
    let term = |p: &[Integer<D>; 3], q, r| -> Integer<D3> { cross(q, r).times(&p[2]) };
    term(b, c, d)
        .plus(&term(c, d, b))
        .plus(&term(d, b, c))
        .sign()
}
