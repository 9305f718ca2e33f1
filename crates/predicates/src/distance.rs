//! Which of two points is nearer to a third.
//!
//! With A = a - o and B = b - o the determinant is |B|^2 - |A|^2.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53. Each squared length passes through a difference twice, a product and a sum: 4
//! roundings. The last difference changes no sign. So the computed value errs by
//! ((1 + u)^4 - 1)(|A|^2 + |B|^2), and 6 u times the computed sum leaves room for the terms of second
//! order and the roundings of the bound. Four products may underflow, by 2^-1075 each: [`FLOOR`] is far
//! above.

use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::lattice as lattice_of;
use crate::sign::Sign;
use crate::{Point2, Point3};

/// Relative bound of the filter, see the head of the file.
const BOUND: f64 = 6.0 * (f64::EPSILON / 2.0);
/// Absolute bound of the filter.
const FLOOR: f64 = f64::MIN_POSITIVE;

/// Whether `a` is nearer to `o` than `b` is: [`Sign::Positive`] if it is, [`Sign::Zero`] if both
/// are equally near. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, nearer};
/// assert_eq!(nearer([0.0, 0.0], [3.0, 4.0], [5.0, 0.0]), Sign::Zero);
/// assert_eq!(nearer([0.0, 0.0], [3.0, 4.0], [5.0, 5e-324]), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn nearer(o: Point2, a: Point2, b: Point2) -> Sign {
    let squared = |p: Point2| {
        let (x, y) = (p[0] - o[0], p[1] - o[1]);
        x * x + y * y
    };
    let (aa, bb) = (squared(a), squared(b));
    let det = bb - aa;
    // A comparison that NaN and infinity fail.
    if det.abs() > BOUND * (aa + bb) + FLOOR {
        return Sign::of(det);
    }
    nearer_exact(o, a, b)
}

#[cold]
#[inline(never)]
fn nearer_exact(o: Point2, a: Point2, b: Point2) -> Sign {
    if let Some(found) = lattice_of([a[0], a[1], b[0], b[1]], [o[0], o[1], o[0], o[1]]) {
        let [ax, ay, bx, by] = found.values.map(i128::from);
        return Sign::from(bx * bx + by * by - (ax * ax + ay * ay));
    }
    let points = [a, b, o];
    by_width(
        &points,
        |low| determinant::<2, 4>(&points, low),
        |low| determinant::<5, 10>(&points, low),
        |low| determinant::<12, 24>(&points, low),
        |low| determinant::<FULL, { 2 * FULL }>(&points, low),
    )
}

/// The sign, for differences of `D` limbs.
fn determinant<const D: usize, const D2: usize>(points: &[Point2; 3], low: i32) -> Sign {
    let [a, b] = differences::<D, 2, 3, 2>(points, low);
    let squared =
        |p: &[Integer<D>; 2]| -> Integer<D2> { p[0].times(&p[0]).plus(&p[1].times(&p[1])) };
    squared(&b).minus(&squared(&a)).sign()
}

/// Relative bound of the filter in 3-D: one more sum, so 5 roundings and 7 u.
const BOUND3: f64 = 7.0 * (f64::EPSILON / 2.0);

/// Whether `a` is nearer to `o` than `b` is, in 3-D: like [`nearer`].
///
/// ```
/// use delone_predicates::{Sign, nearer3};
/// assert_eq!(nearer3([0.0; 3], [1.0, 2.0, 2.0], [3.0, 0.0, 0.0]), Sign::Zero);
/// assert_eq!(nearer3([0.0; 3], [1.0, 2.0, 2.0], [3.0, 0.0, 5e-324]), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn nearer3(o: Point3, a: Point3, b: Point3) -> Sign {
    let squared = |p: Point3| {
        let (x, y, z) = (p[0] - o[0], p[1] - o[1], p[2] - o[2]);
        x * x + y * y + z * z
    };
    let (aa, bb) = (squared(a), squared(b));
    let det = bb - aa;
    // A comparison that NaN and infinity fail.
    if det.abs() > BOUND3 * (aa + bb) + FLOOR {
        return Sign::of(det);
    }
    nearer3_exact(o, a, b)
}

#[cold]
#[inline(never)]
fn nearer3_exact(o: Point3, a: Point3, b: Point3) -> Sign {
    let (minuends, subtrahends) = (
        [a[0], a[1], a[2], b[0], b[1], b[2]],
        [o[0], o[1], o[2], o[0], o[1], o[2]],
    );
    if let Some(found) = lattice_of(minuends, subtrahends) {
        // Below 2^61, so that three squares are below 2^124.
        let [ax, ay, az, bx, by, bz] = found.values.map(i128::from);
        return Sign::from(bx * bx + by * by + bz * bz - (ax * ax + ay * ay + az * az));
    }
    let points = [a, b, o];
    by_width(
        &points,
        |low| determinant3::<2, 4>(&points, low),
        |low| determinant3::<5, 10>(&points, low),
        |low| determinant3::<12, 24>(&points, low),
        |low| determinant3::<FULL, { 2 * FULL }>(&points, low),
    )
}

/// The sign, for differences of `D` limbs.
fn determinant3<const D: usize, const D2: usize>(points: &[Point3; 3], low: i32) -> Sign {
    let [a, b] = differences::<D, 3, 3, 2>(points, low);
    let squared = |p: &[Integer<D>; 3]| -> Integer<D2> {
        let [x, y, z] = [0, 1, 2].map(|k| p[k].times(&p[k]));
        x.plus(&y).plus(&z)
    };
    squared(&b).minus(&squared(&a)).sign()
}
