//! The kinds of numbers in which balls are computed: rounded with a bound, and integers.
//!
//! A rounded number carries the sum of the magnitudes of the monomials of its expression. Each
//! operation errs by a few units of that sum (u for doubles, 8 u^2 for pairs of doubles, with u =
//! 2^-53), and fewer than 60 operations contribute to a monomial of the expressions in `ball`. So
//! the error of each is at most 64 such units of its size, as long as nothing overflows or
//! underflows, which `ball` ensures by the range of the differences.

use std::ops::{Add, Mul, Sub};

use delone_predicates::Sign;
use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use crate::base::vector::Ring;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Operations that contribute to a monomial, with room for the rounding of bounds.
const MOST: f64 = 64.0;
/// More than underflow can change, in the range of differences that `ball` allows: 2^-600.
pub const FLOOR: f64 = f64::from_bits((1023 - 600) << 52);

/// Numbers of one formula.
pub trait Number: Ring {
    /// One.
    fn one() -> Self;
    /// The square.
    fn squared(self) -> Self;
    /// The number with the other sign.
    fn negated(self) -> Self;
}

impl Number for BigInt {
    fn one() -> Self {
        Self::from(1)
    }

    fn squared(self) -> Self {
        &self * &self
    }

    fn negated(self) -> Self {
        -self
    }
}

impl Number for i128 {
    fn one() -> Self {
        1
    }

    fn squared(self) -> Self {
        self * self
    }

    fn negated(self) -> Self {
        -self
    }
}

/// Doubles and pairs of doubles.
pub trait Rounded: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The error of an operation, as a share of the size.
    const UNIT: f64;
    /// `a - b`, for pairs exactly.
    fn difference(a: f64, b: f64) -> Self;
    /// The leading double.
    fn leading(self) -> f64;
}

impl Rounded for f64 {
    const UNIT: f64 = U;

    #[inline]
    fn difference(a: f64, b: f64) -> Self {
        a - b
    }

    #[inline]
    fn leading(self) -> f64 {
        self
    }
}

impl Rounded for Pair {
    const UNIT: f64 = 8.0 * U * U;

    #[inline]
    fn difference(a: f64, b: f64) -> Self {
        Self::difference(a, b)
    }

    #[inline]
    fn leading(self) -> f64 {
        self.hi
    }
}

/// A rounded number and the sum of the magnitudes of its monomials.
#[derive(Clone, Copy)]
pub struct Rough<T> {
    /// The number.
    pub value: T,
    /// The sum.
    pub size: f64,
}

impl<T: Rounded> Rough<T> {
    /// `a - b`.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        let value = T::difference(a, b);
        let size = value.leading().abs();
        Self { value, size }
    }

    /// A bound of the error.
    #[inline]
    pub fn error(self) -> f64 {
        MOST * T::UNIT * self.size
    }

    /// The sign, if it is certain; NaN is not.
    #[inline]
    pub fn sign(self) -> Option<Sign> {
        let value = self.value.leading();
        (value.abs() > self.error() + FLOOR).then(|| Sign::of(value))
    }
}

impl<T: Rounded> Number for Rough<T> {
    #[inline]
    fn one() -> Self {
        Self::difference(1.0, 0.0)
    }

    /// Squaring `v` with error e causes the error 2 |v| e + e^2, and the size is such that `error`
    /// bounds it.
    #[inline]
    fn squared(self) -> Self {
        let size = 2.0 * self.value.leading().abs() * self.size + self.error() * self.size;
        Self {
            value: self.value * self.value,
            size,
        }
    }

    #[inline]
    fn negated(self) -> Self {
        Self {
            value: T::difference(0.0, 0.0) - self.value,
            ..self
        }
    }
}

impl<T: Rounded> Add for Rough<T> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            size: self.size + other.size,
        }
    }
}

impl<T: Rounded> Sub for Rough<T> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            size: self.size + other.size,
        }
    }
}

impl<T: Rounded> Mul for Rough<T> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            size: self.size * other.size,
        }
    }
}

/// `n / (4 d) - w`, if its whole error interval rounds to one double.
///
/// The quotient errs by the shares of its parts, and by 32 u^2 of itself; the difference by 4 u^2 of
/// both terms. All is doubled, for terms of second order and the rounding of the bound.
#[inline]
pub fn certain(n: Rough<Pair>, d: Rough<Pair>, w: f64) -> Option<f64> {
    let (top, bottom) = (n.value.hi, d.value.hi);
    // Not if they are NaN, or so small that underflow matters.
    let right = top > FLOOR && bottom > FLOOR && d.error() < bottom / 1024.0;
    if !right {
        return None;
    }
    let q = quotient(n.value, d.value);
    let q = Pair {
        hi: q.hi / 4.0,
        lo: q.lo / 4.0,
    };
    let share = n.error() / top + d.error() / bottom + 32.0 * U * U;
    let (value, error) = if w == 0.0 {
        (q, 2.0 * q.hi * share)
    } else {
        let error = 2.0 * (q.hi * share + 4.0 * U * U * (q.hi + w.abs()));
        (q - Pair::difference(w, 0.0), error)
    };
    let (low, high) = (value.hi + (value.lo - error), value.hi + (value.lo + error));
    (low == high).then_some(low)
}

/// `n / d` to about 100 bits.
#[inline]
fn quotient(n: Pair, d: Pair) -> Pair {
    let as_pair = |x: f64| Pair { hi: x, lo: 0.0 };
    let first = n.hi / d.hi;
    let rest = n - d * as_pair(first);
    let second = rest.hi / d.hi;
    let rest = rest - d * as_pair(second);
    (as_pair(first) + as_pair(second)) + as_pair(rest.hi / d.hi)
}
