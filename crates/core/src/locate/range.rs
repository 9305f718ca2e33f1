//! Points relative to an origin, in a unit in which their products neither overflow nor underflow.

use std::array::from_fn;

use crate::base::points::Extent;

/// Differences within these bounds are not scaled: their fourth powers are doubles.
const SAFE: std::ops::Range<f64> = 1e-60..1e60;

/// `points` minus `origin`, divided by a power of two, and that power; it is 1 unless some
/// difference is very large or all are very small.
#[inline]
pub fn seen_from<const N: usize, const D: usize>(
    origin: [f64; D],
    points: [[f64; D]; N],
) -> ([[f64; D]; N], f64) {
    let seen = points.map(|p| from_fn(|k| p[k] - origin[k]));
    if SAFE.contains(&largest(&seen)) {
        return (seen, 1.0);
    }
    scaled(origin, points)
}

/// `p` minus `origin` in a unit returned by [`seen_from`].
#[inline]
pub fn in_unit<const D: usize>(origin: [f64; D], p: [f64; D], unit: f64) -> [f64; D] {
    if unit == 1.0 {
        from_fn(|k| p[k] - origin[k])
    } else if unit < 1.0 {
        from_fn(|k| (p[k] - origin[k]) / unit)
    } else {
        from_fn(|k| (p[k] / 4.0 - origin[k] / 4.0) / (unit / 4.0))
    }
}

/// A unit of length in which no power of the distances leaves the range of doubles, unless they
/// differ as much among themselves.
pub fn unit_of<const D: usize>(points: &[[f64; D]]) -> f64 {
    let extent = Extent::of(points.iter().copied());
    if extent.min[0] > extent.max[0] {
        return 1.0;
    }
    seen_from(extent.min, [extent.max]).1
}

/// The longest side of the bounding box of points, in a unit.
pub fn longest_side<const D: usize>(points: &[[f64; D]], unit: f64) -> f64 {
    let extent = Extent::of(points.iter().copied());
    let sides = in_unit(extent.min, extent.max, unit);
    sides.into_iter().fold(0.0, f64::max)
}

/// Whether all coordinates are finite.
pub fn is_finite<const D: usize>(q: &[f64; D]) -> bool {
    q.iter().all(|x| x.is_finite())
}

/// The square of a distance, rounded.
pub fn squared<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum()
}

#[inline]
fn largest<const D: usize>(points: &[[f64; D]]) -> f64 {
    let coordinates = points.as_flattened();
    coordinates
        .iter()
        .fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most })
}

#[cold]
#[inline(never)]
fn scaled<const N: usize, const D: usize>(
    origin: [f64; D],
    points: [[f64; D]; N],
) -> ([[f64; D]; N], f64) {
    // Quarters cannot overflow, and they lose no digits if the differences are large.
    let (lead, unit) = if largest(&points).max(largest(&[origin])) > 1e300 {
        (0.25, 4.0)
    } else {
        (1.0, 1.0)
    };
    let seen = points.map(|p| from_fn(|k| p[k] * lead - origin[k] * lead));
    let most = largest::<D>(&seen);
    if most == 0.0 {
        return (seen, 1.0);
    }
    // Twice a square root of the power, since 2^1074 is not a double. The unit itself is one, so
    // that differences beyond all doubles are up to 8 units.
    let root = ((most.log2() / 2.0).round() as i32).min(510);
    let factor = 2f64.powi(-root);
    let seen = seen.map(|p: [f64; D]| p.map(|x| x * factor * factor));
    (seen, 2f64.powi(root) * 2f64.powi(root) * unit)
}
