//! Numbers with automatic differentiation: a double, or a double with its derivatives.
//!
//! Formulas are written once for both. Derivatives are with respect to the position of the query
//! (R. E. Wengert, "A simple automatic derivative evaluation program", 1964).

use std::ops::{Add, Div, Mul, Neg, Sub};

use delone_predicates::Point2;

use crate::base::vector;

/// The operations that formulas need.
pub trait Number: vector::Number + Div<Output = Self> + Neg<Output = Self> {
    /// How many doubles it has: the value, or with it the derivatives by x, y, xx, xy and yy.
    const PARTS: usize;
    /// Builds the number from these parts.
    fn of_parts(parts: &[f64]) -> Self;
    /// A number that is independent of the query.
    fn constant(value: f64) -> Self;
    /// A number with this value and this gradient, linear in the position of the query.
    fn linear(value: f64, gradient: Point2) -> Self;
    /// The number without its derivatives.
    fn value(self) -> f64;
    /// The first derivatives; zero for a plain double.
    fn gradient(self) -> [f64; 2];
    /// The same derivatives with another value.
    fn with_value(self, value: f64) -> Self;
    /// The square root, of a positive number.
    fn sqrt(self) -> Self;
    /// The same with derivatives per length, if they were per multiple of `unit`.
    fn per_length(self, unit: f64) -> Self;
}

impl Number for f64 {
    const PARTS: usize = 1;
    #[inline]
    fn of_parts(parts: &[f64]) -> Self {
        parts[0]
    }
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn linear(value: f64, _: Point2) -> Self {
        value
    }
    #[inline]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn gradient(self) -> [f64; 2] {
        [0.0; 2]
    }
    #[inline]
    fn with_value(self, value: f64) -> Self {
        value
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn per_length(self, _: f64) -> Self {
        self
    }
}

/// A value, its gradient and its Hessian.
#[derive(Debug, Clone, Copy, Default)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// Derivatives by x and y.
    pub gradient: [f64; 2],
    /// Second derivatives: xx, xy, yy.
    pub hessian: [f64; 3],
}

/// The pair of axes of each entry of a Hessian.
const PAIRS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

impl Jet {
    /// A function of one number, by its value and its first two derivatives there.
    #[inline]
    fn chain(self, value: f64, first: f64, second: f64) -> Self {
        let g = self.gradient;
        Self {
            value,
            gradient: g.map(|x| first * x),
            hessian: std::array::from_fn(|i| {
                let (k, l) = PAIRS[i];
                first * self.hessian[i] + second * g[k] * g[l]
            }),
        }
    }
}

impl Number for Jet {
    const PARTS: usize = 6;
    fn of_parts(parts: &[f64]) -> Self {
        Self {
            value: parts[0],
            gradient: [parts[1], parts[2]],
            hessian: [parts[3], parts[4], parts[5]],
        }
    }
    fn constant(value: f64) -> Self {
        Self {
            value,
            ..Self::default()
        }
    }
    fn linear(value: f64, gradient: Point2) -> Self {
        Self {
            value,
            gradient,
            hessian: [0.0; 3],
        }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn gradient(self) -> [f64; 2] {
        self.gradient
    }
    fn with_value(self, value: f64) -> Self {
        Self { value, ..self }
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root, -0.25 / (root * self.value))
    }
    fn per_length(self, unit: f64) -> Self {
        Self {
            value: self.value,
            gradient: self.gradient.map(|x| x / unit),
            hessian: self.hessian.map(|x| x / unit / unit),
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: std::array::from_fn(|k| self.gradient[k] + other.gradient[k]),
            hessian: std::array::from_fn(|k| self.hessian[k] + other.hessian[k]),
        }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            gradient: self.gradient.map(|x| -x),
            hessian: self.hessian.map(|x| -x),
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

#[expect(
    clippy::suspicious_arithmetic_impl,
    reason = "the product rule is a sum"
)]
impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        let (g, h) = (self.gradient, other.gradient);
        Self {
            value: a * b,
            gradient: std::array::from_fn(|k| a * h[k] + b * g[k]),
            hessian: std::array::from_fn(|i| {
                let (k, l) = PAIRS[i];
                a * other.hessian[i] + b * self.hessian[i] + g[k] * h[l] + g[l] * h[k]
            }),
        }
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let one = 1.0 / other.value;
        self * other.chain(one, -one * one, 2.0 * one * one * one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_formula() {
        let (x, y) = (Jet::linear(3.0, [1.0, 0.0]), Jet::linear(2.0, [0.0, 1.0]));
        // x^2 y / (x - y) at (3, 2), and the root of its square.
        let f = x * x * y / (x - y);
        assert_eq!(f.value, 18.0);
        assert_eq!(f.gradient, [-6.0, 27.0]);
        assert_eq!(f.hessian, [16.0, -27.0, 54.0]);
        let same = (f * f).sqrt();
        assert!(
            same.hessian
                .iter()
                .zip(f.hessian)
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
    }
}
