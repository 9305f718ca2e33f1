//! Doubles as arbitrary-precision integers, with correctly rounded quotients, roots and angles.
//!
//! The last resort of predicates and constructions when no filter decides.

use delone_predicates::Sign as Turn;
use delone_predicates::arithmetic::decode_odd;
use num_bigint::{BigInt, Sign};

/// Exponent of the least subnormal.
const LEAST: i64 = -1074;

/// An exponent `low` such that all coordinates are multiples of 2^low and all weights of 2^(2 low).
pub fn lowest<const D: usize>(points: &[[f64; D]], weights: &[f64]) -> i64 {
    let exponent = |x: &f64| {
        let (magnitude, exponent) = decode_odd(*x);
        (magnitude != 0).then(|| i64::from(exponent))
    };
    let of_points = points.as_flattened().iter().filter_map(exponent).min();
    let of_weights = weights.iter().filter_map(exponent).min();
    let half = of_weights.map(|e| e.div_euclid(2));
    of_points.into_iter().chain(half).min().unwrap_or(0)
}

/// `x / 2^low`, an integer.
pub fn scaled(x: f64, low: i64) -> BigInt {
    let (magnitude, exponent) = decode_odd(x);
    // The exponent of zero means nothing; otherwise `low` is at most `exponent`.
    let integer = BigInt::from(magnitude) << (i64::from(exponent) - low).max(0);
    if x < 0.0 { -integer } else { integer }
}

/// `n / d * 2^low` correctly rounded, ties to even; `None` if it exceeds the range or `d` is zero.
pub fn ratio(n: &BigInt, d: &BigInt, low: i64) -> Option<f64> {
    if d.sign() == Sign::NoSign {
        return None;
    }
    if n.sign() == Sign::NoSign {
        return Some(0.0);
    }
    // At least 66 bits of the quotient, and a sticky bit for the remainder.
    let shift = 67 + d.bits() as i64 - n.bits() as i64;
    let (n, positive) = (n.magnitude(), n.sign() == d.sign());
    let (wide_n, wide_d) = if shift >= 0 {
        (n << shift, d.magnitude().clone())
    } else {
        (n.clone(), d.magnitude() << -shift)
    };
    let (whole, rest) = (&wide_n / &wide_d, &wide_n % &wide_d);
    let mut digits = u128::try_from(whole).unwrap_or(u128::MAX);
    digits = digits << 1 | u128::from(rest.bits() != 0);
    let value = rounded(digits, low - shift - 1)?;
    Some(if positive { value } else { -value })
}

/// `digits * 2^exponent` rounded to a double. The last digit is sticky: it represents all that
/// follow.
fn rounded(digits: u128, exponent: i64) -> Option<f64> {
    let top = exponent + 127 - i64::from(digits.leading_zeros());
    let unit = (top - 52).max(LEAST);
    let drop = unit - exponent;
    // Below half of the least subnormal, all digits are dropped.
    let (mut kept, tail, half) = if drop > 127 {
        (0, 0, 1)
    } else {
        let tail = digits & ((1_u128 << drop) - 1);
        ((digits >> drop) as u64, tail, 1_u128 << (drop - 1))
    };
    if tail > half || (tail == half && kept % 2 == 1) {
        kept += 1;
    }
    let value = kept as f64 * power(unit)?;
    value.is_finite().then_some(value)
}

/// 2^exponent, from the least subnormal up, if it is a double.
fn power(exponent: i64) -> Option<f64> {
    match exponent {
        LEAST..-1022 => Some(f64::from_bits(1 << (exponent - LEAST))),
        -1022..=1023 => Some(f64::from_bits(((exponent + 1023) as u64) << 52)),
        _ => None,
    }
}

/// The sign of an integer.
pub fn sign(value: &BigInt) -> Turn {
    match value.sign() {
        Sign::Minus => Turn::Negative,
        Sign::NoSign => Turn::Zero,
        Sign::Plus => Turn::Positive,
    }
}

/// The cross product.
pub fn across(p: &[BigInt; 3], q: &[BigInt; 3]) -> [BigInt; 3] {
    [0, 1, 2].map(|k| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        &p[x] * &q[y] - &p[y] * &q[x]
    })
}

/// The determinant of three vectors.
pub fn determinant([p, q, r]: [&[BigInt; 3]; 3]) -> BigInt {
    (&q[1] * &r[2] - &q[2] * &r[1]) * &p[0]
        + (&q[2] * &r[0] - &q[0] * &r[2]) * &p[1]
        + (&q[0] * &r[1] - &q[1] * &r[0]) * &p[2]
}

/// The square root of an integer, times 2^64 and rounded down.
pub fn root(square: &BigInt) -> BigInt {
    (square << 128_u32).sqrt()
}

/// The angle, in radians, from its positive sine and its cosine, both scaled by the same factor.
pub fn angle(sine: &BigInt, cosine: &BigInt) -> f64 {
    // The quotient is below 1, or so large that the arc tangent depends on its sign only.
    let quotient = |n: &BigInt, d: &BigInt| ratio(n, d, 0).unwrap_or(f64::MAX);
    if sine.magnitude() < cosine.magnitude() {
        let positive = BigInt::from(cosine.magnitude().clone());
        let way = if cosine.sign() == Sign::Minus {
            -1.0
        } else {
            1.0
        };
        quotient(sine, &positive).atan2(way)
    } else {
        1.0_f64.atan2(quotient(cosine, sine))
    }
}

/// `x * 2^exponent`, rounded at most once.
pub fn times_power(x: f64, exponent: i32) -> f64 {
    const STEP: i32 = 1000;
    let power = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
    // Only the last step may reach subnormal numbers; otherwise the result is zero anyway.
    let mut x = x * power(exponent % STEP);
    for _ in 0..(exponent / STEP).abs() {
        x *= power(STEP * exponent.signum());
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_rounded_to_even_down_to_subnormals() {
        let big = |x: u64| BigInt::from(x);
        assert_eq!(ratio(&big(1), &big(3), 0), Some(1.0 / 3.0));
        assert_eq!(ratio(&-big(7), &big(5), -1074), Some(-5e-324));
        assert_eq!(ratio(&big(1), &big(2), -1074), Some(0.0));
        assert_eq!(ratio(&big(3), &big(2), -1074), Some(1e-323));
        assert_eq!(
            ratio(&big((1 << 53) + 1), &big(1), 0),
            Some((1_u64 << 53) as f64)
        );
        assert_eq!(ratio(&big(1), &big(1), 1023), Some(2_f64.powi(1023)));
        assert_eq!(ratio(&big(1), &big(1), 1024), None);
        assert_eq!(ratio(&big(1), &big(1), -1300), Some(0.0));
    }
}
