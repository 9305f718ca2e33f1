//! Whether an angle is acute, right or obtuse: whether a point is outside, on or inside a diametral
//! circle.
//!
//! The dot product (a - p) . (b - p) of exact values goes through the same roundings as the cross
//! product in `orient2d`, with a plus instead of a minus: the bounds are the same.

use crate::Point2;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::lattice;
use crate::sign::Sign;

/// Relative bound of the filter: see `orient2d`.
const BOUND: f64 = 4.0 * (f64::EPSILON / 2.0);
/// Its absolute bound.
const FLOOR: f64 = f64::MIN_POSITIVE;

/// The angle at `p` between `a` and `b`: [`Sign::Positive`] if it is acute (or `p` is neither and
/// sees both in one direction), [`Sign::Zero`] if it is right or `p` is one of them,
/// [`Sign::Negative`] if it is obtuse, which means that `p` is inside the diametral circle of `a
/// b`. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, angle};
/// assert_eq!(angle([-1.0, 0.0], [0.0, 1.0 - 1e-16], [1.0, 0.0]), Sign::Negative);
/// ```
#[inline]
#[must_use]
pub fn angle(a: Point2, p: Point2, b: Point2) -> Sign {
    let x = (a[0] - p[0]) * (b[0] - p[0]);
    let y = (a[1] - p[1]) * (b[1] - p[1]);
    let dot = x + y;
    if dot.abs() > BOUND * (x.abs() + y.abs()) + FLOOR {
        Sign::of(dot)
    } else {
        exact(a, p, b)
    }
}

#[cold]
#[inline(never)]
fn exact(a: Point2, p: Point2, b: Point2) -> Sign {
    if let Some(found) = lattice([a[0], a[1], b[0], b[1]], [p[0], p[1], p[0], p[1]]) {
        let [ax, ay, bx, by] = found.values.map(i128::from);
        return Sign::from(ax * bx + ay * by);
    }
    let points = [a, b, p];
    by_width(
        &points,
        |low| integer::<2, 4>(&points, low),
        |low| integer::<5, 10>(&points, low),
        |low| integer::<12, 24>(&points, low),
        |low| integer::<FULL, { 2 * FULL }>(&points, low),
    )
}

fn integer<const D: usize, const D2: usize>(points: &[Point2; 3], low: i32) -> Sign {
    let [a, b] = differences::<D, 2, 3, 2>(points, low);
    let product = |k: usize| -> Integer<D2> { a[k].times(&b[k]) };
    product(0).plus(&product(1)).sign()
}
