//! Integers times powers of two: signs where filters fail.

use delone_predicates::Point3;
use delone_predicates::arithmetic::{Pair, decode_odd};
use num_bigint::{BigInt, Sign};

/// An integer times a power of two.
#[derive(Clone)]
pub struct Big {
    digits: BigInt,
    exponent: i64,
}

impl Big {
    /// The double, exactly.
    pub fn of(x: f64) -> Self {
        let (magnitude, exponent) = decode_odd(x);
        let digits = BigInt::from(magnitude);
        Self {
            digits: if x < 0.0 { -digits } else { digits },
            exponent: if magnitude == 0 { 0 } else { exponent.into() },
        }
    }

    /// -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        match self.digits.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }

    /// The product.
    pub fn times(&self, other: &Self) -> Self {
        Self {
            digits: &self.digits * &other.digits,
            exponent: self.exponent + other.exponent,
        }
    }

    /// The square.
    pub fn square(&self) -> Self {
        self.times(self)
    }

    /// The sum.
    pub fn plus(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let aligned = |x: &Self| &x.digits << (x.exponent - exponent) as usize;
        Self {
            digits: aligned(self) + aligned(other),
            exponent,
        }
    }

    /// The number with the other sign.
    pub fn negated(&self) -> Self {
        Self {
            digits: -&self.digits,
            exponent: self.exponent,
        }
    }

    /// The difference.
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    /// The number as a pair of 1 <= |x| < 2, to 2^-105 of itself, and the exponent of a power of two; or
    /// zero.
    pub fn leveled(&self) -> (Pair, i64) {
        const KEPT: u64 = 106;
        let (bits, magnitude) = (self.digits.bits(), self.digits.magnitude());
        let kept = match bits.checked_sub(KEPT) {
            Some(beyond) => magnitude >> beyond,
            None => magnitude << (KEPT - bits),
        };
        if bits == 0 {
            return (Pair::from_double(0.0), 0);
        }
        let kept: u128 = kept
            .iter_u64_digits()
            .rev()
            .fold(0, |all, part| all << 64 | u128::from(part));
        // The head takes 53 bits, and what is left fits into the tail.
        let (head, tail) = (kept >> 53, kept & ((1 << 53) - 1));
        let unit = f64::from(self.sign()) / (1_u64 << 52) as f64;
        let (hi, lo) = (
            head as f64 * unit,
            tail as f64 * unit * (f64::EPSILON / 2.0),
        );
        let exponent = self.exponent + bits as i64 - 1;
        (Pair::from_double(hi) + Pair::from_double(lo), exponent)
    }
}

/// A vector, exactly.
pub type Big3 = [Big; 3];

/// The vector, exactly.
pub fn big3(v: Point3) -> Big3 {
    v.map(Big::of)
}

/// The cross product.
pub fn across(a: &Big3, b: &Big3) -> Big3 {
    let minor = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The dot product.
pub fn product(a: &Big3, b: &Big3) -> Big {
    let term = |k: usize| a[k].times(&b[k]);
    term(0).plus(&term(1)).plus(&term(2))
}

/// The sign of a + b sqrt(n) for n >= 0: by the signs of both terms, else by their squares.
pub fn with_root(a: &Big, b: &Big, n: &Big) -> i32 {
    let (p, q) = (a.sign(), b.sign() * n.sign());
    if p == q || q == 0 {
        p
    } else if p == 0 {
        q
    } else {
        p * a.square().minus(&b.square().times(n)).sign()
    }
}
