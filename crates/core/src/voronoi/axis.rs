//! Points on the radical axis of two weighted sites (the bisector, if weights are equal), rounded.
//!
//! All z with equal power from a and b satisfy 2 d.z = |b|^2 - |a|^2 + w(a) - w(b), d = b - a. In
//! doubles, with m = (a + b) / 2, this is d.(z - m) = (w(a) - w(b)) / 2.
//!
//! # The bound of the plain stage
//!
//! Let u = 2^-53. For z[k] = v, z[l] = m[l] + s / d[l], where s = d[k] t + w, t = m[k] - v and w is
//! half the difference of the weights. m errs by u of itself, t by u |m[k]| + u |t|, the product by
//! |d[k]| (3 u |t| + u |m[k]|), w by u |w|, s by u |s| more, and the quotient by 3 u of itself.
//! Hence z[l] errs by 5 u (|d[k]| (|t| + |m[k]|) + |w|) / |d[l]| + u |m[l]| and the last rounding,
//! with room for terms of second order. Underflow is negligible while all nonzero values are larger
//! than 2^-400. If the bound does not guarantee 4 units in the last place, the coordinate is
//! computed in arbitrary-precision integers and correctly rounded.

use delone_predicates::Point2;
use num_bigint::BigInt;

use crate::base::wide::{lowest, ratio, scaled};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// 2^-400 and 2^400.
const RANGE: (f64, f64) = (
    f64::from_bits((1023 - 400) << 52),
    f64::from_bits((1023 + 400) << 52),
);

/// A site and its weight.
pub(super) type Weighted = (Point2, f64);

/// Whether a number is zero, or its magnitude is within the range.
fn safe(x: f64) -> bool {
    x == 0.0 || (x.abs() > RANGE.0 && x.abs() < RANGE.1)
}

fn middle(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.is_finite() {
        sum / 2.0
    } else {
        a / 2.0 + b / 2.0
    }
}

/// The other coordinate of the point where the axis meets the line on which coordinate `k` is
/// `value`, within 4 units in the last place: infinite if out of range, NaN if they are parallel.
pub(super) fn crossing(sites: [Weighted; 2], k: usize, value: f64) -> f64 {
    let [(a, wa), (b, wb)] = sites;
    let l = 1 - k;
    let (dk, dl) = (b[k] - a[k], b[l] - a[l]);
    let (mk, ml) = (middle(a[k], b[k]), middle(a[l], b[l]));
    let (t, w) = (mk - value, (wa - wb) / 2.0);
    let z = ml + (dk * t + w) / dl;
    let size = dk.abs() * (t.abs() + mk.abs()) + w.abs();
    let error = 5.0 * U * size / dl.abs() + U * ml.abs();
    let inside = [dk, dl, t, mk, ml, w, wa, wb, z].into_iter().all(safe);
    if inside && dl != 0.0 && error <= 3.0 * U * z.abs() {
        return z;
    }
    exact_crossing(sites, k, value)
}

#[cold]
fn exact_crossing([(a, wa), (b, wb)]: [Weighted; 2], k: usize, value: f64) -> f64 {
    let low = lowest(&[a, b, [value, 0.0]], &[wa, wb]);
    let [a, b] = [a, b].map(|p| p.map(|x| scaled(x, low)));
    let value = scaled(value, low);
    let l = 1 - k;
    let n = right_side(&a, &b, wa, wb, low) - (&b[k] - &a[k]) * value * 2;
    quotient(n, (&b[l] - &a[l]) * 2, low)
}

/// |b|^2 - |a|^2 + w(a) - w(b).
fn right_side(a: &[BigInt; 2], b: &[BigInt; 2], wa: f64, wb: f64, low: i64) -> BigInt {
    let square = |p: &[BigInt; 2]| &p[0] * &p[0] + &p[1] * &p[1];
    square(b) - square(a) + scaled(wa, 2 * low) - scaled(wb, 2 * low)
}

/// n / d in units of 2^low, correctly rounded: infinite if out of range, NaN if d is zero.
fn quotient(n: BigInt, d: BigInt, low: i64) -> f64 {
    let zero = BigInt::ZERO;
    if d == zero {
        return f64::NAN;
    }
    let (n, d) = if d < zero { (-n, -d) } else { (n, d) };
    let far = if n < zero {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    ratio(&n, &d, low).unwrap_or(far)
}

/// The point where the axis meets the line through the sites; a coordinate is infinite if out of
/// range.
pub(super) fn foot([(a, wa), (b, wb)]: [Weighted; 2]) -> Point2 {
    if wa == wb {
        return [middle(a[0], b[0]), middle(a[1], b[1])];
    }
    let low = lowest(&[a, b], &[wa, wb]);
    let w = scaled(wa, 2 * low) - scaled(wb, 2 * low);
    let [a, b] = [a, b].map(|p| p.map(|x| scaled(x, low)));
    let d = [&b[0] - &a[0], &b[1] - &a[1]];
    let square = &d[0] * &d[0] + &d[1] * &d[1];
    [0, 1].map(|k| {
        let n = (&a[k] + &b[k]) * &square + &d[k] * &w;
        quotient(n, &square * 2, low)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    #[test]
    fn both_stages_agree_as_far_as_they_promise() {
        let mut next = uniform(5);
        for i in 0..4000 {
            let offset = [0.0, 1e6, -0.5][i % 3];
            let weight = [0.0, 1.0][i % 2];
            let mut site = || ([offset + next(), offset + next()], weight * next());
            let (sites, value) = ([site(), site()], offset + 0.25);
            let (found, exact) = (
                crossing(sites, i % 2, value),
                exact_crossing(sites, i % 2, value),
            );
            let ulp = exact.abs().next_up() - exact.abs();
            assert!((found - exact).abs() <= 4.0 * ulp, "{found} {exact}");
        }
    }

    #[test]
    fn the_ends_of_the_range() {
        let huge = f64::MAX;
        let sites = [([0.0, -huge], 0.0), ([huge, huge], 0.0)];
        // 2 (h x + 2 h y) = h^2: at x = 0, y = h / 4.
        assert_eq!(crossing(sites, 0, 0.0), huge / 4.0);
        assert_eq!(foot(sites), [huge / 2.0, 0.0]);
        let near = [([0.0, 0.0], 1e300), ([1e-300, 1e-300], 0.0)];
        assert_eq!(crossing(near, 0, 0.0), f64::INFINITY);
        assert_eq!(foot(near), [f64::INFINITY; 2]);
        let level = [([0.0, 0.0], 0.0), ([1.0, 0.0], 0.0)];
        assert!(crossing(level, 0, 0.0).is_nan());
        assert_eq!(crossing(level, 1, 7.0), 0.5);
    }
}
