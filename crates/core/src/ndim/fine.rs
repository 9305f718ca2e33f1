//! Spheres in double-double arithmetic, with the proof of `filter`.
//!
//! The center is refined: three times, the residual is computed in pairs of doubles and solved with
//! the approximate inverse. By the rule of `delone_predicates` for pairs, an expression whose monomials
//! pass through p products and s sums errs by at most (9 p + 4 s) u^2 times the sum of their magnitudes.
//! Differences of coordinates are exact. A component of the residual, the sum of D squares less D
//! products, passes through one product and 2 D sums: (8 D + 9) u^2; the power, a sum of D products
//! d (d - x), through one product and D + 1 sums: (4 D + 13) u^2 |d| (|d| + |x|). In a
//! flat, weights are sums of up to six squares: they pass through one product and D + 7 sums in the
//! residual, (4 D + 37) u^2, and through one product and 7 sums in the power, 37 u^2. The constants are
//! larger than these by 7 and more, which holds the terms of higher order and the roundings of the sums
//! of magnitudes.

use delone_predicates::arithmetic::Pair;

use super::filter::{LEAST_RESIDUAL, LEAST_VALUE, Matrix, ROUNDED, U, dot, invert};

/// The center of a sphere to some 100 bits.
#[derive(Clone, Copy)]
pub struct Fine<const D: usize> {
    /// Twice the center, from vertex 0.
    x: [Pair; D],
    /// A bound of its length.
    size: f64,
    /// A bound of its error.
    error: f64,
}

/// The components of `p - o`, exactly.
pub fn differences<const D: usize, const P: usize>(p: &[f64; P], o: &[f64; P]) -> [Pair; D] {
    std::array::from_fn(|k| Pair::difference(p[k], o[k]))
}

impl<const D: usize> Fine<D> {
    /// The sphere of a simplex with the given corners.
    pub fn new<const V: usize, const P: usize>(corners: &[&[f64; P]; V]) -> Self {
        Self::lifted(corners, [Pair::from_double(0.0); D])
    }

    /// The same with the weights of the corners less that of the first one.
    pub fn lifted<const V: usize, const P: usize>(
        corners: &[&[f64; P]; V],
        weights: [Pair; D],
    ) -> Self {
        let mut rounded: Matrix<D, P> = [[0.0; P]; D];
        let mut a = [[Pair::from_double(0.0); D]; D];
        let mut b = [Pair::from_double(0.0); D];
        let mut sizes = [0.0; D];
        for i in 0..D {
            a[i] = differences(corners[i + 1], corners[0]);
            for k in 0..D {
                rounded[i][k] = a[i][k].hi;
                b[i] = b[i] + a[i][k].square();
            }
            sizes[i] = b[i].hi + weights[i].hi.abs();
            b[i] = b[i] - weights[i];
        }
        let inverse = invert(&rounded);
        let mut fine = Self {
            x: [Pair::from_double(0.0); D],
            size: 0.0,
            error: f64::INFINITY,
        };
        // The first step is the solution itself. Each of the others gains at least some 30 bits, if
        // the simplex is not too thin; the last pass measures only.
        for step in 0..5 {
            let (residual, bound) = fine.residual::<P>(&a, &b, &sizes);
            fine.error = ROUNDED * inverse.norm * bound;
            if step < 4 {
                for k in 0..D {
                    fine.x[k] = fine.x[k] + Pair::from_double(dot(&inverse.b[k], &residual));
                }
            }
        }
        let squares: f64 = fine.x.iter().map(|x| x.hi * x.hi).sum();
        fine.size = ROUNDED * squares.sqrt();
        fine
    }

    /// Component `k` of twice the center, from vertex 0.
    pub fn center(&self, k: usize) -> Pair {
        self.x[k]
    }

    /// A bound of the error of twice the center.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// `b - A x` rounded, and a bound of its true length; `sizes` has the magnitudes in b.
    fn residual<const P: usize>(
        &self,
        a: &[[Pair; D]; D],
        b: &[Pair; D],
        sizes: &[f64; D],
    ) -> ([f64; P], f64) {
        let mut residual = [0.0; P];
        let mut squares = 0.0;
        for i in 0..D {
            let (mut sum, mut size) = (b[i], sizes[i]);
            for k in 0..D {
                let product = a[i][k] * self.x[k];
                size += product.hi.abs();
                sum = sum - product;
            }
            residual[i] = sum.hi;
            let rounding = (8 * D + 48) as f64 * U * U * size;
            let bound = ROUNDED * sum.hi.abs() + rounding + LEAST_RESIDUAL;
            squares += bound * bound;
        }
        (residual, squares.sqrt())
    }

    /// The power of `p` with respect to the sphere, where `o` is vertex 0 and `weight` the difference
    /// of their weights, and the bound of its error.
    pub fn power<const P: usize>(&self, p: &[f64; P], o: &[f64; P], weight: Pair) -> (f64, f64) {
        let d: [Pair; D] = differences(p, o);
        let (mut sum, mut square) = (Pair::from_double(0.0), 0.0);
        for k in 0..D {
            square += d[k].hi * d[k].hi;
            sum = sum + d[k] * (d[k] - self.x[k]);
        }
        sum = sum - weight;
        let length = ROUNDED * square.sqrt();
        let unit = (4 * D + 48) as f64 * U * U;
        let rounding = unit * (length + self.size);
        // What is left out of the pair is below u of its head.
        let bound = ROUNDED * (length * (self.error + rounding) + unit * weight.hi.abs())
            + U * sum.hi.abs()
            + LEAST_VALUE;
        (sum.hi, bound)
    }
}
