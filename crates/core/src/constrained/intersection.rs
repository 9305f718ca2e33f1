//! Where two segments cross: the exact point, each coordinate correctly rounded.
//!
//! The lines ab and cd meet at a + t (b - a) with t = (c - a) x (d - c) / (b - a) x (d - c).
//! Correct rounding makes the result a function of the two lines: the order of the segments and of
//! their ends does not matter. Rounding is monotone, so each coordinate stays in the closed
//! interval between any doubles that enclose the exact one: the result lies in the closed box of
//! either segment.
//!
//! # Stages
//!
//! 1. A vertical or horizontal segment gives its coordinate as it is.
//! 2. Double-double arithmetic (`delone_predicates`' expansions), where the exponents rule out
//!    overflow: the result counts if all numbers within the error bound round to it.
//! 3. Integers: all coordinates in units of their lowest bit, one division to 63 bits or more, the
//!    remainder kept as a sticky bit. Always correct. Zeros and rounding ties are decided here.
//!
//! # The bound of stage 2
//!
//! Let u = 2^-53. Differences are exact, so each of the two determinants n and d errs by at most
//! 13 u^2 times its permanent, taken as 32 here. The quotient of the computed ones, head and one
//! correction, errs by at most 29 u^2 |t|: 17 for the remainder (a product, and a difference of
//! two numbers of size n), 12 for the rounding of the correction, itself at most 4 u |t|. With |d|
//! far above its error, t errs by (errors of n + |t| errors of d) / |d| and that; the product with
//! b - a adds 9 u^2 |t|. 64 u^2 |t| hold both, and all is taken twice for terms of higher order.
//! Underflow, which the window of coordinates excludes but in the division, is below 2^-1070 in the
//! remainder, thus 2^-646 in t (d is a multiple of 2^-424), thus 2^-455 in the product.

use delone_predicates::arithmetic::{Pair, bit_span, decode_odd, is_safe, two_sum};
use delone_predicates::{Point2, Sign, orient2d};
use num_bigint::{BigInt, BigUint, Sign as BigSign};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of a determinant, in its permanent.
const DETERMINANT: f64 = 32.0 * U * U;
/// Relative bound of a quotient and a product.
const QUOTIENT: f64 = 64.0 * U * U;
/// Absolute bound of underflow: 2^-440.
const FLOOR: f64 = f64::from_bits((1023 - 440) << 52);
/// How far a denominator must be above its error: 2^20.
const CLEAR: f64 = (1 << 20) as f64;

/// Whether the open segments ab and cd cross in a single point.
///
/// Segments that touch at an end, overlap along a line or have no length do not cross.
#[inline]
#[must_use]
pub fn crosses(a: Point2, b: Point2, c: Point2, d: Point2) -> bool {
    let apart = |p: Sign, q: Sign| !p.is_zero() && !q.is_zero() && p != q;
    apart(orient2d(a, b, c), orient2d(a, b, d)) && apart(orient2d(c, d, a), orient2d(c, d, b))
}

/// The point where ab and cd cross, each coordinate rounded to the nearest double, ties to even.
///
/// Exact for all finite doubles; a zero is +0.0. The point lies in the closed box of each segment,
/// and is independent of the order of the segments and of their ends. For segments that do not meet
/// but whose lines do, it is the intersection of the lines, infinite if it exceeds all doubles.
/// Parallel lines give NaN. Segments of zero length have no line; the result is meaningless.
///
/// ```
/// use delone_core::constrained::intersection::intersection;
/// assert_eq!(intersection([0., 0.], [3., 1.], [1., 0.], [1., 1.]), [1.0, 1.0 / 3.0]);
/// ```
#[must_use]
pub fn intersection(a: Point2, b: Point2, c: Point2, d: Point2) -> Point2 {
    let level = [0, 1].map(|k| level(k, a, b, c, d));
    if let [Some(x), Some(y)] = level {
        return [x, y];
    }
    let near = expansion(a, b, c, d);
    let found: [Option<f64>; 2] = std::array::from_fn(|k| level[k].or(near[k]));
    if let [Some(x), Some(y)] = found {
        // Turns -0.0 into +0.0.
        return [x + 0.0, y + 0.0];
    }
    let exact = integer(a, b, c, d);
    [0, 1].map(|k| found[k].unwrap_or(exact[k]) + 0.0)
}

/// Coordinate `k` of a segment on which it is constant.
#[inline]
fn level(k: usize, a: Point2, b: Point2, c: Point2, d: Point2) -> Option<f64> {
    // If both segments are such, the lines are parallel: no answer.
    match (a[k] == b[k], c[k] == d[k]) {
        (true, false) => Some(a[k] + 0.0),
        (false, true) => Some(c[k] + 0.0),
        _ => None,
    }
}

/// A determinant, and the bound of its error.
#[inline]
fn cross(p: [Pair; 2], q: [Pair; 2]) -> (Pair, f64) {
    let (left, right) = (p[0] * q[1], p[1] * q[0]);
    let permanent = left.hi.abs() + right.hi.abs();
    (left - right, DETERMINANT * permanent)
}

/// `n / d`, to about 29 u^2 of it.
#[inline]
fn quotient(n: Pair, d: Pair) -> Pair {
    let head = n.hi / d.hi;
    let rest = n - d * Pair { hi: head, lo: 0.0 };
    let (hi, lo) = two_sum(head, rest.hi / d.hi);
    Pair { hi, lo }
}

/// The coordinates that double-double arithmetic proves.
#[inline]
fn expansion(a: Point2, b: Point2, c: Point2, d: Point2) -> [Option<f64>; 2] {
    if !is_safe(&[a, b, c, d]) {
        return [None; 2];
    }
    let minus = |p: Point2, q: Point2| [0, 1].map(|k| Pair::difference(p[k], q[k]));
    let (along, across) = (minus(b, a), minus(d, c));
    let (below, below_error) = cross(along, across);
    let size = below.hi.abs();
    if size <= CLEAR * below_error {
        return [None; 2];
    }
    let (above, above_error) = cross(minus(c, a), across);
    let t = quotient(above, below);
    let t_size = t.hi.abs();
    let error = 2.0 * ((above_error + t_size * below_error) / size + QUOTIENT * t_size);
    [0, 1].map(|k| rounded(a[k], t * along[k], error * along[k].hi.abs() + FLOOR))
}

/// The double nearest to `base + step`, if the `error` of the step cannot change it.
#[inline]
fn rounded(base: f64, step: Pair, error: f64) -> Option<f64> {
    let (head, tail) = two_sum(base, step.hi);
    let tail = tail + step.lo;
    // The two roundings of the tail, and those of the error.
    let error = 2.0 * error + 4.0 * U * tail.abs();
    let (low, high) = (head + (tail - error), head + (tail + error));
    (low == high).then_some(low)
}

/// The coordinates by exact integers.
#[cold]
#[inline(never)]
fn integer(a: Point2, b: Point2, c: Point2, d: Point2) -> Point2 {
    let Some((low, _)) = bit_span(&[a, b, c, d]) else {
        return [f64::NAN; 2];
    };
    let [a, b, c, d] = [a, b, c, d].map(|p| p.map(|x| in_units(x, low)));
    let minus = |p: &[BigInt; 2], q: &[BigInt; 2]| [&p[0] - &q[0], &p[1] - &q[1]];
    let cross = |p: &[BigInt; 2], q: &[BigInt; 2]| &p[0] * &q[1] - &p[1] * &q[0];
    let (along, across) = (minus(&b, &a), minus(&d, &c));
    let (above, below) = (cross(&minus(&c, &a), &across), cross(&along, &across));
    [0, 1].map(|k| nearest(&(&a[k] * &below + &above * &along[k]), &below, low))
}

/// `x / 2^low`, where x is a multiple of 2^low.
fn in_units(x: f64, low: i32) -> BigInt {
    let (magnitude, exponent) = decode_odd(x);
    if magnitude == 0 {
        return BigInt::ZERO;
    }
    let size = BigInt::from(magnitude) << (exponent - low) as usize;
    if x < 0.0 { -size } else { size }
}

/// The double nearest to `n / d * 2^unit`, ties to even.
fn nearest(n: &BigInt, d: &BigInt, unit: i32) -> f64 {
    if d.sign() == BigSign::NoSign {
        return f64::NAN;
    }
    if n.sign() == BigSign::NoSign {
        return 0.0;
    }
    // Shifted so that the quotient has 63 or 64 bits.
    let shift = 63 + d.bits() as i64 - n.bits() as i64;
    let up = |x: &BigUint, by: i64| x << by.max(0) as usize;
    let (n_up, d_up) = (up(n.magnitude(), shift), up(d.magnitude(), -shift));
    let whole = &n_up / &d_up;
    let sticky = u64::from(&whole * &d_up != n_up);
    let bits = whole.iter_u64_digits().next().unwrap_or(0) | sticky;
    let size = round(bits, i64::from(unit) - shift);
    if n.sign() == d.sign() { size } else { -size }
}

/// The double nearest to `bits * 2^exponent`, where `bits` has 63 or 64 bits. The lowest bit may be
/// sticky and stand for all below it: it never decides alone.
fn round(bits: u64, exponent: i64) -> f64 {
    const LOWEST: i64 = -1074;
    let length = i64::from(64 - bits.leading_zeros());
    let unit = (exponent + length - 53).max(LOWEST);
    // From 66 bits on, everything is below half a unit.
    let drop = (unit - exponent).min(66);
    let (bits, half) = (u128::from(bits), 1u128 << (drop - 1));
    let (kept, rest) = ((bits >> drop) as u64, bits & (2 * half - 1));
    let kept = kept + u64::from(rest > half || rest == half && kept & 1 == 1);
    // The implicit bit of `kept` adds one to the exponent field, and so does a carry.
    match u64::try_from(unit - LOWEST) {
        Ok(field) if field <= 2045 => f64::from_bits((field << 52) + kept),
        _ => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudorandom numbers in [0, 1).
    fn numbers() -> impl FnMut() -> f64 {
        let mut x = 7u64;
        move || {
            x = x
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (x >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// How many of 10,000 coordinates double-double arithmetic proves, each checked against the
    /// integers.
    fn proved(mut draw: impl FnMut() -> Point2) -> usize {
        let (mut cases, mut proved) = (0, 0);
        while cases < 10_000 {
            let [a, b, c, d] = [(); 4].map(|()| draw());
            if !crosses(a, b, c, d) {
                continue;
            }
            let (near, exact) = (expansion(a, b, c, d), integer(a, b, c, d));
            for k in 0..2 {
                cases += 1;
                proved += usize::from(near[k].is_some());
                assert_eq!(
                    near[k].unwrap_or(exact[k]),
                    exact[k],
                    "{a:?} {b:?} {c:?} {d:?}"
                );
            }
        }
        proved
    }

    #[test]
    fn expansions_prove_almost_all() {
        let mut unit = numbers();
        assert_eq!(proved(|| [unit(), unit()]), 10_000);
        assert_eq!(proved(|| [4e5 + unit(), 5e6 + unit()]), 10_000);
        // Integer coordinates sometimes cross at zero.
        let lattice = proved(|| [0, 1].map(|_| (20.0 * unit()).floor() - 10.0));
        assert!((9_500..10_000).contains(&lattice), "{lattice}");
        let millimeters = proved(|| [0, 1].map(|_| (9e6 + 1e6 * unit()).floor() / 1e3));
        assert!(millimeters > 9_900, "{millimeters}");
    }

    #[test]
    fn expansions_prove_nothing_wrong_near_the_bounds() {
        // Sizes across the whole window, and segments that nearly coincide.
        let mut unit = numbers();
        let spread =
            proved(|| [0, 1].map(|_| (unit() - 0.5) * 2f64.powi((349.0 * unit()) as i32 - 159)));
        assert!(spread > 5_000, "{spread}");
        let mut numbers = numbers();
        for bits in [40, 44, 48, 52] {
            let grain = 2f64.powi(-bits);
            let mut unit = || (numbers() * 8.0).floor();
            proved(|| [unit(), 1.0 + unit() * grain]);
            proved(|| {
                let x = unit();
                [x, 0.7 * x + unit() * grain]
            });
        }
    }

    #[test]
    fn rounding_is_right_at_the_ends_of_the_range() {
        let top = 1 << 63;
        assert_eq!(round(top, 0), 2f64.powi(63));
        assert_eq!(round(u64::MAX, 0), 2f64.powi(64));
        assert_eq!(round(top, 960), 2f64.powi(1023));
        assert_eq!(round(u64::MAX, 960), f64::INFINITY);
        assert_eq!(round(u64::MAX << 11, 960), f64::MAX);
        assert_eq!(round(top, 5_000), f64::INFINITY);
        // Half the least double rounds to zero, slightly more does not.
        assert_eq!(round(top, -1138), 0.0);
        assert_eq!(round(top | 1, -1138), f64::from_bits(1));
        assert_eq!(round(u64::MAX, -1139), 0.0);
        assert_eq!(round(u64::MAX, -9_999), 0.0);
        assert_eq!(round(top, -1085), f64::MIN_POSITIVE);
        assert_eq!(round(u64::MAX, -1086), f64::MIN_POSITIVE);
    }
}
