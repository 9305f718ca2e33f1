//! Exact predicates in plain floating point for points on a small lattice, such as the voxels of an
//! image.
//!
//! There every determinant is exact in plain floating point, and nearly every cavity has ties.
//!
//! Let all coordinates be multiples of a power of two, the unit, and M < 2^9 the largest difference
//! of two along an axis, in units. All differences are integers of at most M, exact as they are
//! below 2^53. Squared lengths are integers of at most 3 M^2, 2 x 2 minors and their parts of at
//! most 2 M^2, 3 x 3 minors of at most 6 M^3, products of a minor and a length of at most 18 M^5,
//! and the sum of four, like each part of it, of at most 72 M^5 < 2^52. So no operation rounds.
//! Units between 2^-200 and 2^[`RANGE`] keep everything in the range of doubles.

use crate::base::vector::minus;
use delone_predicates::{Point3, Sign};

use super::sphere::RANGE;

/// The largest difference along an axis, in units, is less than this.
const SPAN: f64 = 512.0;

/// Whether finite `points` with coordinates below 2^[`RANGE`] lie on a small lattice.
pub fn is_small(points: &[Point3]) -> bool {
    let Some(&first) = points.first() else {
        return false;
    };
    let (mut min, mut max) = (first, first);
    let mut unit = f64::INFINITY;
    for p in points {
        for k in 0..3 {
            min[k] = min[k].min(p[k]);
            max[k] = max[k].max(p[k]);
            unit = unit.min(lowest_bit(p[k]));
        }
        // Scattered points fail here early.
        if (0..3).any(|k| max[k] - min[k] >= SPAN * unit) {
            return false;
        }
    }
    unit > 2f64.powi(-200) && unit < 2f64.powi(RANGE)
}

/// The largest power of two of which `x` is a multiple; infinite for zero, and 0 for subnormal
/// results.
fn lowest_bit(x: f64) -> f64 {
    const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
    let exponent = (x.to_bits() >> MANTISSA & 0x7ff) as i32;
    let zeros = (x.to_bits() | 1 << MANTISSA).trailing_zeros() as i32;
    match exponent {
        _ if x == 0.0 => f64::INFINITY,
        64.. => 2f64.powi(exponent - 1023 - MANTISSA as i32 + zeros),
        _ => 0.0,
    }
}

/// The determinant of three vectors.
#[inline(always)]
fn det3(a: Point3, b: Point3, c: Point3) -> f64 {
    a[2] * (b[0] * c[1] - b[1] * c[0])
        + b[2] * (c[0] * a[1] - c[1] * a[0])
        + c[2] * (a[0] * b[1] - a[1] * b[0])
}

fn orient3d(a: Point3, b: Point3, c: Point3, d: Point3) -> Sign {
    Sign::of(det3(minus(b, a), minus(c, a), minus(d, a)))
}

/// Like `insphere_canonical`, for points on a small lattice.
pub fn insphere_canonical(points: [Point3; 5]) -> Sign {
    let [a, b, c, d, e] = points;
    let (a, b, c, d) = (minus(a, e), minus(b, e), minus(c, e), minus(d, e));
    let length = |p: Point3| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    let inner = length(a) * det3(b, c, d) + length(c) * det3(a, b, d);
    let outer = length(b) * det3(a, c, d) + length(d) * det3(a, b, c);
    if inner == outer {
        tie(points)
    } else {
        Sign::of(inner - outer)
    }
}

/// Breaks a tie: the smallest of the distinct points decides, or else the next; see
/// `delone_predicates` on ties. Moving a point from place i to the front takes i swaps of adjacent
/// points, which leave the others in their order.
fn tie(points: [Point3; 5]) -> Sign {
    let i = smallest(&points);
    let other = |k: usize| points[k + usize::from(k >= i)];
    let others = [other(0), other(1), other(2), other(3)];
    let [a, b, c, d] = others;
    let first = orient3d(a, b, c, d);
    if first != Sign::Zero {
        return first.flip_if(i % 2 == 1);
    }
    let j = smallest(&others);
    let other = |k: usize| others[k + usize::from(k >= j)];
    (-orient3d(points[i], other(0), other(1), other(2))).flip_if((i + j) % 2 == 1)
}

/// The index of the smallest point in lexicographic order, without a branch, which would be
/// unpredictable.
fn smallest(points: &[Point3]) -> usize {
    let mut least = 0;
    for (i, p) in points.iter().enumerate().skip(1) {
        let q = points[least];
        let last = (p[1] < q[1]) | ((p[1] == q[1]) & (p[2] < q[2]));
        let less = (p[0] < q[0]) | ((p[0] == q[0]) & last);
        least = if less { i } else { least };
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64, below: u64) -> f64 {
        *state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        ((*state >> 33) % below) as f64
    }

    #[test]
    fn agrees_with_the_predicate() {
        let mut state = 5;
        let mut ties = 0;
        // The largest steps are just below the span.
        for (side, step, shift) in [
            (2, 511.0, 0.0),
            (3, 255.5, 7.5),
            (4, 0.125, -3.0),
            (512, 1.0, -9.0),
        ] {
            for _ in 0..30_000 {
                let p: [Point3; 5] = std::array::from_fn(|_| {
                    [(); 3].map(|()| random(&mut state, side) * step + shift)
                });
                if (0..5).any(|i| p[..i].contains(&p[i])) {
                    continue;
                }
                let [a, b, c, d, e] = p;
                let right = delone_predicates::insphere_canonical(a, b, c, d, e);
                assert_eq!(insphere_canonical(p), right, "{p:?}");
                ties += usize::from(delone_predicates::insphere(a, b, c, d, e) == Sign::Zero);
            }
        }
        assert!(ties > 10_000);
    }

    #[test]
    fn small_lattices_are_recognized() {
        let cube = |step: f64, far: f64| vec![[0.0, -step, 2.0 * step], [far, step, 0.0]];
        assert!(is_small(&cube(1.0, 511.0)));
        assert!(!is_small(&cube(1.0, 512.0)));
        assert!(is_small(&cube(0.25, 127.75)));
        assert!(!is_small(&cube(0.25, 128.0)));
        assert!(!is_small(&cube(0.1, 1.0)));
        assert!(!is_small(&cube(2f64.powi(-210), 0.0)));
        assert!(!is_small(&cube(5e-324, 0.0)));
        assert!(!is_small(&[[0.0; 3]]));
        assert!(!is_small(&[]));
    }
}
