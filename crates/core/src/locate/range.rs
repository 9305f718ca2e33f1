//! Points as seen from another, in a unit in which their products neither overflow nor vanish.

use delone_predicates::Point2;

use crate::points::Extent;

/// Differences within these bounds are left as they are: their fourth powers are doubles.
const SAFE: std::ops::Range<f64> = 1e-60..1e60;

/// `points` minus `origin`, divided by a power of two, and that power; 1 unless the differences are
/// very large or all very small.
#[inline]
pub fn seen_from<const N: usize>(origin: Point2, points: [Point2; N]) -> ([Point2; N], f64) {
    let seen = points.map(|p| [p[0] - origin[0], p[1] - origin[1]]);
    if SAFE.contains(&largest(&seen)) {
        return (seen, 1.0);
    }
    scaled(origin, points)
}

/// `p` minus `origin` in a unit that [`seen_from`] has given.
#[inline]
pub fn in_unit(origin: Point2, p: Point2, unit: f64) -> Point2 {
    if unit == 1.0 {
        [p[0] - origin[0], p[1] - origin[1]]
    } else if unit < 1.0 {
        [0, 1].map(|k| (p[k] - origin[k]) / unit)
    } else {
        [0, 1].map(|k| (p[k] / 4.0 - origin[k] / 4.0) / (unit / 4.0))
    }
}

/// A unit of length in which no power of the distances leaves the range of doubles, unless they
/// differ by as much among themselves.
pub fn unit_of(points: &[Point2]) -> f64 {
    let extent = Extent::of(points.iter().copied());
    if extent.min[0] > extent.max[0] {
        return 1.0;
    }
    seen_from(extent.min, [extent.max]).1
}

/// The longer side of the box of points, in a unit.
pub fn longer_side(points: &[Point2], unit: f64) -> f64 {
    let extent = Extent::of(points.iter().copied());
    let [x, y] = in_unit(extent.min, extent.max, unit);
    x.max(y)
}

#[inline]
fn largest(points: &[Point2]) -> f64 {
    let coordinates = points.as_flattened();
    coordinates
        .iter()
        .fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most })
}

#[cold]
#[inline(never)]
fn scaled<const N: usize>(origin: Point2, points: [Point2; N]) -> ([Point2; N], f64) {
    // Quarters cannot overflow; they lose nothing where the differences are large.
    let (lead, unit) = if largest(&points).max(largest(&[origin])) > 1e300 {
        (0.25, 4.0)
    } else {
        (1.0, 1.0)
    };
    let seen = points.map(|p| [0, 1].map(|k| p[k] * lead - origin[k] * lead));
    let most = largest(&seen);
    if most == 0.0 {
        return (seen, 1.0);
    }
    // Twice a square root of the power, since 2^1074 is no double.
    // The unit itself is one, so that differences beyond all doubles are up to 8 units.
    let root = ((most.log2() / 2.0).round() as i32).min(510);
    let factor = 2f64.powi(-root);
    let seen = seen.map(|p| p.map(|x| x * factor * factor));
    (seen, 2f64.powi(root) * 2f64.powi(root) * unit)
}
