//! The direction of a vector as an unevaluated sum of two doubles per coordinate.
//!
//! # The bound
//!
//! Let u = 2^-53, and w the vector times the power of two that brings its largest coordinate to
//! 1 <= |w_k| < 2. Coordinates may underflow, by 2^-1073 at most, which is far below what follows.
//!
//! The squares are exact, and two sums err by 4 u^2 each, relatively: n = |w|^2 (1 + e), |e| <= 8 u^2, in
//! 1 <= n < 12. Three roundings (n to a double, root, quotient) give r = |w|^-1 (1 + d), |d| < 2.6 u. Its
//! square is exact; the product with n errs by 9 u^2 and the difference from 1 by 8 u^2 (as both terms
//! are below 1 + 6 u). With e, the residue y = 1 - r^2 |w|^2 is thus known to 25 u^2, and |y| < 5.3 u.
//! Then |w|^-1 = r (1 - y)^(-1/2) = r (1 + y / 2 + 3 y^2 / 8 + ...), where the terms left out are below
//! u^2 / 2^48. The correction r (y / 2 + 3 y^2 / 8) in doubles, from the head of y, errs by 2.7 u^2 for
//! the tail of y and 8 u^2 for four roundings; adding it to r is exact. In all the reciprocal
//! length errs by 12.5 u^2 + 2.7 u^2 + 8 u^2 < 24 u^2, and the product with a coordinate by 9 u^2 more:
//! each coordinate of the sum `hi + lo` errs by less than 33 u^2 < 2^-100.9 of itself.

use crate::Point3;
use crate::expansion::Pair;
use crate::range::{exponent_field, power_of_two};

/// A direction: `hi + lo` is the unit vector, each coordinate to 2^-100.9 of itself; `hi` is that sum
/// rounded to doubles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The unit vector, rounded.
    pub hi: Point3,
    /// What is left.
    pub lo: Point3,
}

impl Unit {
    /// The direction of a vector that is finite and not zero; NaN for others.
    #[must_use]
    pub fn of(v: Point3) -> Self {
        let w = leveled(v);
        let n = Pair::product(w[0], w[0]) + Pair::product(w[1], w[1]) + Pair::product(w[2], w[2]);
        let r = 1.0 / n.hi.sqrt();
        let y = (Pair::from_double(1.0) - n * Pair::product(r, r)).hi;
        let length = Pair::from_double(r) + Pair::from_double(r * (0.5 * y + 0.375 * (y * y)));
        let unit = w.map(|x| length * Pair::from_double(x));
        Self {
            hi: unit.map(|x| x.hi),
            lo: unit.map(|x| x.lo),
        }
    }

    /// A coordinate as a pair.
    pub(super) fn pair(&self, k: usize) -> Pair {
        Pair {
            hi: self.hi[k],
            lo: self.lo[k],
        }
    }
}

/// The vector times the power of two that brings its largest coordinate to 1 <= |x| < 2.
#[must_use]
pub fn leveled(v: Point3) -> Point3 {
    let top = v.iter().fold(0.0, |top: f64, x| top.max(x.abs()));
    // A subnormal vector becomes normal first, exactly.
    let (v, top) = if exponent_field(top) == 0 {
        let up = power_of_two(200);
        (v.map(|x| x * up), top * up)
    } else {
        (v, top)
    };
    let exponent = exponent_field(top) - 1023;
    // In two factors, as one may not be a double.
    let first = power_of_two(-exponent / 2);
    let second = power_of_two(-exponent - -exponent / 2);
    v.map(|x| x * first * second)
}
