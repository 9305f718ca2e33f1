//! Double-double arithmetic: numbers as unevaluated sums of two doubles, and their error bounds.
//!
//! Let u = 2^-53, and let a [`Pair`] stand for `hi + lo` with |lo| <= u |hi|. Assume that nothing
//! overflows or underflows (`range::is_safe` sees to it). Then
//!
//! - `Pair::difference` of two doubles is exact (Knuth's two-sum);
//! - a sum or difference errs by at most 4 u^2 (|a| + |b|): the tails' sum errs by u^2 (|a| + |b|),
//!   adding it to the error of the heads, itself at most u (|a| + |b|), errs by 2 u^2 (|a| + |b|),
//!   and the last two-sum is exact whatever the order of its operands;
//! - a product errs by at most 9 u^2 |a b|: u^2 for the product of the tails, left out, u^2 for each
//!   of the two mixed products, 2 u^2 for their sum, 3 u^2 for adding the error of the product of
//!   the heads, which is exact (Dekker's product, or one fused operation); the fast two-sum that
//!   ends it is exact as the sum so far is at most 4 u times the product of the heads.
//!
//! (The ninth and the fourth unit hold the terms of third order.) The bounds are absolute in what a
//! cancellation-free evaluation would give, the *permanent*: with P(a + b) = P(a) + P(b) and
//! P(a b) = P(a) P(b), an expression whose monomials each pass through p products and s sums errs
//! by at most (9 p + 4 s) u^2 P, and a little of fourth order.

use std::ops::{Add, Mul, Sub};

/// `a + b` rounded, and the error made.
#[inline]
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// `a - b` rounded, and the error made. Exact unless it overflows.
#[inline]
pub fn two_difference(a: f64, b: f64) -> (f64, f64) {
    two_sum(a, -b)
}

/// Like [`two_sum`], for |a| >= |b| or both zero.
#[inline]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Veltkamp's splitting into halves of 26 bits and a sign.
#[inline]
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = ((1_u64 << 27) + 1) as f64;
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

/// `a * b` rounded, and the error made.
///
/// A fused multiply-add is used if the target has it in hardware: in software it would be right,
/// too, but many times slower than Dekker's product.
#[inline]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
        return (product, a.mul_add(b, -product));
    }
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (
        product,
        al * bl - (((product - ah * bh) - al * bh) - ah * bl),
    )
}

/// An unevaluated sum of two doubles, |lo| <= 2^-53 |hi|.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// The sum, rounded.
    pub hi: f64,
    /// The rounding error of the sum.
    pub lo: f64,
}

impl Pair {
    /// `a - b`, exactly.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_difference(a, b);
        Self { hi, lo }
    }

    /// `a * b`, exactly.
    #[inline]
    pub fn product(a: f64, b: f64) -> Self {
        let (hi, lo) = two_product(a, b);
        Self { hi, lo }
    }

    /// The double itself.
    #[inline]
    pub fn from_double(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// The square.
    #[inline]
    pub fn square(self) -> Self {
        self * self
    }
}

impl Add for Pair {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let (sum, error) = two_sum(self.hi, other.hi);
        let (hi, lo) = two_sum(sum, error + (self.lo + other.lo));
        Self { hi, lo }
    }
}

impl Sub for Pair {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + Self {
            hi: -other.hi,
            lo: -other.lo,
        }
    }
}

impl Mul for Pair {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (product, error) = two_product(self.hi, other.hi);
        let mixed = self.hi * other.lo + self.lo * other.hi;
        let (hi, lo) = fast_two_sum(product, error + mixed);
        Self { hi, lo }
    }
}
