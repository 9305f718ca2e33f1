//! Vectors of numbers: doubles, pairs of doubles, doubles with derivatives, and integers of any length.
//!
//! Sums are from the first coordinate to the last one. The bounds of rounding errors, which depend
//! on that, are stated next to the formulas that they belong to.

use std::ops::{Add, Mul, Sub};

/// A number with sums, differences and products.
pub trait Ring: Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T: Clone + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Ring for T {}

/// One that is copied.
pub trait Number: Ring + Copy {}

impl<T: Ring + Copy> Number for T {}

/// The difference.
#[inline(always)]
pub fn minus<T: Number, const D: usize>(p: [T; D], q: [T; D]) -> [T; D] {
    std::array::from_fn(|k| p[k] - q[k])
}

/// The sum.
#[inline(always)]
pub fn plus<T: Number, const D: usize>(p: [T; D], q: [T; D]) -> [T; D] {
    std::array::from_fn(|k| p[k] + q[k])
}

/// The inner product.
#[inline(always)]
pub fn dot<T: Number, const D: usize>(p: [T; D], q: [T; D]) -> T {
    dot_of(&p, &q)
}

/// The inner product of borrowed vectors.
#[inline(always)]
pub fn dot_of<T: Ring, const D: usize>(p: &[T; D], q: &[T; D]) -> T {
    let product = |k: usize| p[k].clone() * q[k].clone();
    (1..D).fold(product(0), |sum, k| sum + product(k))
}

/// The cross product of two vectors in 3-D.
#[inline(always)]
pub fn cross<T: Number>(p: [T; 3], q: [T; 3]) -> [T; 3] {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

/// The determinant of two vectors in 2-D.
#[inline(always)]
pub fn cross2<T: Number>(p: [T; 2], q: [T; 2]) -> T {
    p[0] * q[1] - p[1] * q[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_begin_at_the_first_coordinate() {
        let (p, q) = ([1e16, 1.0, -1e16], [1.0, 1.0, 1.0]);
        assert_eq!(dot(p, q), 0.0);
        assert_eq!(dot([1e16, -1e16, 1.0], q), 1.0);
        assert_eq!(cross([1, 2, 3], [4, 5, 7]), [-1, 5, -3]);
        assert_eq!(cross2([1, 2], [3, 5]), -1);
        assert_eq!(minus([5, 7], [1, 2]), [4, 5]);
        assert_eq!(plus([5, 7], [1, 2]), [6, 9]);
    }
}
