//! Double-double arithmetic, about 104 bits, for what one double cannot decide.
//!
//! It decides before integers are needed. Fronts of equilateral triangles meet at 30 degrees up to
//! the last bit, so at this bound uncertainty is common.
//!
//! T. J. Dekker, "A floating-point technique for extending the available precision", Numerische
//! Mathematik 18 (1971). Overflow and underflow lead to NaN or to an uncertain comparison.

/// A number as a double and its remainder.
#[derive(Debug, Clone, Copy)]
pub struct Twofold(f64, f64);

/// The relative error bound of a result: 2^-100, with some bits to spare.
pub const ERROR: f64 = 1e-29;

/// 2^27 + 1 splits a double into two halves.
const CUT: f64 = 134_217_729.0;

fn sum(a: f64, b: f64) -> Twofold {
    let s = a + b;
    let t = s - a;
    Twofold(s, (a - (s - t)) + (b - t))
}

fn halves(a: f64) -> [f64; 2] {
    let c = CUT * a;
    let high = c - (c - a);
    [high, a - high]
}

fn product(a: f64, b: f64) -> Twofold {
    let p = a * b;
    let ([ah, al], [bh, bl]) = (halves(a), halves(b));
    Twofold(p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Twofold {
    /// A double.
    pub fn of(a: f64) -> Self {
        Self(a, 0.0)
    }

    /// The difference of two doubles, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        sum(a, -b)
    }

    /// The sum of two numbers that are not nearly opposite.
    pub fn plus(self, other: Self) -> Self {
        let Self(s, e) = sum(self.0, other.0);
        let low = e + (self.1 + other.1);
        sum(s, low)
    }

    /// A product.
    pub fn times(self, other: Self) -> Self {
        let Self(p, e) = product(self.0, other.0);
        sum(p, e + (self.0 * other.1 + self.1 * other.0))
    }

    /// The difference of the leading doubles, plus the difference of the remainders.
    pub fn minus(self, other: Self) -> f64 {
        (self.0 - other.0) + (self.1 - other.1)
    }

    /// The number, rounded.
    pub fn rounded(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_sums_have_twice_the_bits() {
        let a = Twofold::difference(1.0, -f64::EPSILON / 4.0);
        assert_eq!((a.0, a.1), (1.0, f64::EPSILON / 4.0));
        let square = a.times(a);
        // 1 + e / 2, and a remainder of e^2 / 16.
        assert_eq!(square.0, 1.0 + 0.0);
        assert_eq!(square.1, f64::EPSILON / 2.0);
        let third = Twofold::of(1.0 / 3.0);
        let nine = Twofold::of(3.0).times(third).plus(Twofold::of(8.0));
        // A third is rounded down by 2^-54 / 3.
        assert_eq!(nine.minus(Twofold::of(9.0)), -f64::EPSILON / 4.0);
        let p = product(1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        assert_eq!((p.0, p.1), (1.0, -f64::EPSILON * f64::EPSILON));
    }
}
