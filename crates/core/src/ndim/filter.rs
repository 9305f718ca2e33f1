//! Rounded spheres and planes with proven bounds.
//!
//! Let u = 2^-53, and let A be the true matrix of a simplex, with the rows a_i = v_i - v_0, and A^ the
//! matrix of the rounded differences: |A - A^| <= u |A| entry by entry. Bounds have three parts, and
//! each constant is larger than the sum of its first-order terms by several u times the same
//! quantity, which holds all terms of higher order: they are below 1000 u^2 times that quantity.
//!
//! **The norm of the inverse.** Let B be any matrix, in practice an approximate inverse, and E = I - A B.
//! An entry of A^ B - I is a sum of D products and 1: computed in any order it errs by at most (D + 1) u
//! times the sum of the magnitudes, and A^ in place of A adds u times that. So with Frobenius norms,
//! |E| <= e = computed + (2 D + 16) u (|A| |B| + D). If e < 1/2, A is not singular, A^-1 = B (I - E)^-1,
//! and |A^-1| <= |B| / (1 - e). Norms are computed with a relative error below (D^2 + 8) u, which the
//! factor [`ROUNDED`] covers.
//!
//! **The solution.** Let A x = b, and let x^ be any vector, in practice B b. Then
//! |x - x^| <= |A^-1| |b - A x^|. A component of the residual is computed with an error of at most
//! (D + 2) u sum |a_ik x^_k| for the products, their sum and A^, (D + 3) u |b_i| for b_i = |a_i|^2 from
//! rounded differences, and 2 u of the difference: at most (2 D + 8) u (sum |a_ik x^_k| + |b_i|). With
//! weights, b_i has the rounded difference of two of them as another term, which passes through two
//! sums, and the sum of both magnitudes is in place of |b_i|. In a flat, this term already errs by 6 u;
//! with these sums and the difference, that is 10 u, which is below (2 D + 8) u. (The magnitude of the
//! weight is at most that of the squares, the products and the residual together. So without it the bound
//! would be at most half as large, which only the worst case of all roundings could exceed.)
//!
//! **The value.** A point p with d = p - v_0 has the power P = |d|^2 - x . d. In rounded numbers |d|^2
//! errs by (D + 2) u |d|^2, x^ . d by (D + 1) u |x^| |d|, the difference by u of both, and x^ in place of x
//! adds |d| |x - x^|. With c = (D + 5) u, |P^ - P| <= |d| (|x - x^| + c |x^|) + c |d|^2. For any r > 0,
//! |d| <= (|d|^2 / r + r) / 2, so the bound is q0 + q1 |d|^2. It needs no root, and D + 5 in place of
//! D + 3 pays for its own roundings. (Other parts have room, but not proven to be enough to leave out the
//! last one: with a large residual in one row and large products in another, lengths hardly add up.)
//!
//! With weights, the rounded difference of two is subtracted last:
//! that errs by u of it, and by u of the result, at most u times the sum of both magnitudes. In a flat,
//! the difference errs by 6 u instead of u.
//!
//! **Underflow.** Coordinates are as `sites` describes: differences are zero or at least 2^-400. A
//! product may underflow and err by 2^-1075 only if another factor is tiny. The floors below are larger
//! than any number of these: [`LEAST_RESIDUAL`] in residuals and [`LEAST_VALUE`] in values.
//! The comparison with u |A| |B| covers the first part, as |A| |B| >= |A B| is near the square root of D.

/// Half of the distance from 1 to the next double.
pub const U: f64 = f64::EPSILON / 2.0;

/// More than the product of (1 + relative error) of all norms, roots and products in a bound.
pub const ROUNDED: f64 = 1.0001;

/// Added to components of residuals. Its square does not underflow.
pub const LEAST_RESIDUAL: f64 = f64::from_bits((1023 - 500) << 52);

/// Added to bounds of values.
pub const LEAST_VALUE: f64 = f64::from_bits((1023 - 1000) << 52);

/// A matrix in rows, padded with zeros.
pub type Matrix<const D: usize, const P: usize> = [[f64; P]; D];

/// The scalar product; in four parts, which compile to vector instructions.
#[inline(always)]
pub fn dot<const P: usize>(a: &[f64; P], b: &[f64; P]) -> f64 {
    let mut parts = [0.0; 4];
    for k in 0..P {
        parts[k % 4] += a[k] * b[k];
    }
    (parts[0] + parts[1]) + (parts[2] + parts[3])
}

/// The difference.
#[inline(always)]
pub fn minus<const P: usize>(a: &[f64; P], b: &[f64; P]) -> [f64; P] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// An approximate inverse of a matrix and what is proven about it.
pub struct Inverse<const D: usize, const P: usize> {
    /// The approximation B.
    pub b: Matrix<D, P>,
    /// A bound of |A^-1|, infinite if nothing is proven.
    pub norm: f64,
    /// A bound of |I - A B|.
    pub defect: f64,
}

/// Inverts by Gauss-Jordan elimination with pivots from the columns.
#[inline(always)]
pub fn invert<const D: usize, const P: usize>(a: &Matrix<D, P>) -> Inverse<D, P> {
    let mut m = *a;
    let mut b = [[0.0; P]; D];
    for k in 0..D {
        b[k][k] = 1.0;
    }
    for k in 0..D {
        let mut pivot = k;
        for i in k + 1..D {
            if m[i][k].abs() > m[pivot][k].abs() {
                pivot = i;
            }
        }
        m.swap(k, pivot);
        b.swap(k, pivot);
        let f = 1.0 / m[k][k];
        for j in 0..P {
            m[k][j] *= f;
            b[k][j] *= f;
        }
        let (mk, bk) = (m[k], b[k]);
        for i in 0..D {
            if i != k {
                let g = m[i][k];
                for j in 0..P {
                    m[i][j] -= g * mk[j];
                    b[i][j] -= g * bk[j];
                }
            }
        }
    }
    judged(a, b)
}

/// The same for small matrices by cofactors, without branches: less accurate for thin simplices, as the
/// bounds show.
#[inline(always)]
pub fn invert_small<const D: usize, const P: usize>(a: &Matrix<D, P>) -> Inverse<D, P> {
    let mut b = [[0.0; P]; D];
    if D == 2 {
        b[0][0] = a[1][1];
        b[0][1] = -a[0][1];
        b[1][0] = -a[1][0];
        b[1][1] = a[0][0];
    } else if D == 3 {
        for i in 0..3 {
            let (p, q) = (&a[(i + 1) % 3], &a[(i + 2) % 3]);
            for k in 0..3 {
                let (l, m) = ((k + 1) % 3, (k + 2) % 3);
                b[k][i] = p[l] * q[m] - p[m] * q[l];
            }
        }
    } else if D == 4 {
        // Pairs of rows by pairs of columns; a cofactor is a sum of three of them.
        let minor = |i: usize, k: usize, l: usize| a[i][k] * a[i + 1][l] - a[i][l] * a[i + 1][k];
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let (low, high) = (
            pairs.map(|(k, l)| minor(0, k, l)),
            pairs.map(|(k, l)| minor(2, k, l)),
        );
        let at = |k: usize, l: usize| k * (7 - k) / 2 + l - k - 1;
        for i in 0..4 {
            let (row, of) = (&a[i ^ 1], if i < 2 { &high } else { &low });
            for k in 0..4 {
                let mut rest = [0; 3];
                for (n, l) in (0..4).filter(|&l| l != k).enumerate() {
                    rest[n] = l;
                }
                let [l, m, n] = rest;
                let sum = row[l] * of[at(m, n)] - row[m] * of[at(l, n)] + row[n] * of[at(l, m)];
                b[k][i] = if (i + k) % 2 == 0 { sum } else { -sum };
            }
        }
    } else {
        return invert(a);
    }
    let determinant: f64 = (0..D).map(|k| a[0][k] * b[k][0]).sum();
    let f = 1.0 / determinant;
    for row in &mut b {
        for x in row {
            *x *= f;
        }
    }
    judged(a, b)
}

/// An approximate inverse with what is proven about it.
#[inline(always)]
fn judged<const D: usize, const P: usize>(a: &Matrix<D, P>, b: Matrix<D, P>) -> Inverse<D, P> {
    let (norm, defect) = proven(a, &b);
    Inverse { b, norm, defect }
}

/// Bounds of |A^-1| and of |I - A B|.
#[inline(always)]
fn proven<const D: usize, const P: usize>(a: &Matrix<D, P>, b: &Matrix<D, P>) -> (f64, f64) {
    let (mut e, mut na, mut nb) = ([0.0; P], [0.0; P], [0.0; P]);
    for i in 0..D {
        let mut row = [0.0; P];
        row[i] = -1.0;
        for k in 0..D {
            let f = a[i][k];
            for j in 0..P {
                row[j] += f * b[k][j];
            }
        }
        for j in 0..P {
            e[j] += row[j] * row[j];
            na[j] += a[i][j] * a[i][j];
            nb[j] += b[i][j] * b[i][j];
        }
    }
    let norm = |v: &[f64; P]| v.iter().sum::<f64>().sqrt();
    let (e, na, nb) = (norm(&e), norm(&na), norm(&nb));
    let defect = ROUNDED * (e + (2 * D + 16) as f64 * U * (na * nb + D as f64));
    // A comparison that NaN fails.
    if defect < 0.5 {
        (ROUNDED * nb / (1.0 - defect), defect)
    } else {
        (f64::INFINITY, f64::INFINITY)
    }
}

/// A bound of |x - A^-1 b|, where `sizes` has the sums of the magnitudes that b is made of.
#[inline(always)]
pub fn error_of<const D: usize, const P: usize>(
    a: &Matrix<D, P>,
    b: &[f64; P],
    sizes: &[f64; P],
    x: &[f64; P],
    norm: f64,
) -> f64 {
    let mut squares = 0.0;
    for i in 0..D {
        let mut products = [0.0; P];
        for k in 0..P {
            products[k] = a[i][k] * x[k];
        }
        let (mut sum, mut size) = (0.0, 0.0);
        for product in products {
            sum += product;
            size += product.abs();
        }
        let rounding = (2 * D + 8) as f64 * U * (size + sizes[i].abs());
        let residual = (sum - b[i]).abs() + rounding + LEAST_RESIDUAL;
        squares += residual * residual;
    }
    ROUNDED * norm * squares.sqrt()
}

/// What a cell is tested with: the value s |d|^2 - x . d of a point with d = p - v_0, where s is 1 for
/// a simplex and 0 for a ghost, is certain if above q0 + q1 |d|^2 in magnitude.
#[derive(Clone, Copy)]
pub struct Test<const D: usize> {
    /// Twice the center, from v_0; of a ghost, minus the gradient of the distance to its facet.
    pub x: [f64; D],
    /// The constant part of the bound.
    pub q0: f64,
    /// The other part.
    pub q1: f64,
}

impl<const D: usize> Test<D> {
    /// A test that decides nothing.
    pub const UNKNOWN: Self = Self {
        x: [0.0; D],
        q0: f64::INFINITY,
        q1: 0.0,
    };

    /// The test, unless a number is not finite.
    #[inline(always)]
    fn checked<const P: usize>(x: [f64; P], q0: f64, q1: f64) -> Self {
        let x: [f64; D] = std::array::from_fn(|k| x[k]);
        let finite = x.iter().fold(q0.is_finite() & q1.is_finite(), |all, v| {
            all & v.is_finite()
        });
        if finite {
            let q0 = q0 + LEAST_VALUE;
            Self { x, q0, q1 }
        } else {
            Self::UNKNOWN
        }
    }

    /// The test of a simplex with the differences `a`, and the weights of the corners less that of the
    /// first one.
    #[inline(always)]
    pub fn lifted<const P: usize>(a: &Matrix<D, P>, weights: Option<[f64; D]>) -> Self {
        let (mut b, mut sizes) = ([0.0; P], [0.0; P]);
        for i in 0..D {
            b[i] = dot(&a[i], &a[i]);
            sizes[i] = b[i];
        }
        if let Some(weights) = weights {
            for i in 0..D {
                sizes[i] += weights[i].abs();
                b[i] -= weights[i];
            }
        }
        let inverse = invert(a);
        let mut x = [0.0; P];
        for k in 0..D {
            x[k] = dot(&inverse.b[k], &b);
        }
        let size = dot(&x, &x).sqrt();
        let c = (D + 5) as f64 * U;
        let slope = ROUNDED * (error_of(a, &b, &sizes, &x, inverse.norm) + c * size);
        // The best r is the length of x: most points that are tested are at that distance.
        Self::checked(x, slope * size / 2.0, slope / (2.0 * size) + ROUNDED * c)
    }

    /// The test of a ghost: the barycentric coordinate of the last vertex of the simplex behind it,
    /// of which `a` has the differences. It is positive inside.
    #[inline(always)]
    pub fn plane<const P: usize>(a: &Matrix<D, P>) -> Self {
        let inverse = invert(a);
        let mut unit = [0.0; P];
        unit[D - 1] = 1.0;
        let mut x = [0.0; P];
        for k in 0..D {
            x[k] = inverse.b[k][D - 1];
        }
        let c = (D + 5) as f64 * U;
        let error = error_of(a, &unit, &unit, &x, inverse.norm);
        let slope = ROUNDED * (error + c * dot(&x, &x).sqrt());
        let longest = a.iter().map(|r| dot(r, r)).fold(0.0, f64::max).sqrt();
        let x = x.map(|v| -v);
        Self::checked(x, slope * longest / 2.0, slope / (2.0 * longest))
    }

    /// The value of a point with the difference `d`, and the bound of its error.
    #[inline(always)]
    pub fn value<const P: usize>(&self, d: &[f64; P], ghost: bool) -> (f64, f64) {
        let square = dot(d, d);
        let mut across = 0.0;
        for k in 0..D {
            across += d[k] * self.x[k];
        }
        let s = if ghost { 0.0 } else { square };
        (s - across, self.q0 + self.q1 * square)
    }
}

/// Barycentric coordinates from an inverse, and one bound of their errors, infinite if unknown.
///
/// l_i for i > 0 is component i of d A^-1. |A^-1 - B| <= |A^-1| |E|, so l_i errs by
/// |d| |A^-1| |E| for B and (D + 2) u |B| |d| for roundings, where |B| <= |A^-1| (1 + |E|) < 2 |A^-1|.
/// l_0 is 1 less the others, D errors and (D + 1) u of a sum of magnitude 1 + D |d| |B|.
pub fn barycentric<const D: usize, const V: usize, const P: usize>(
    inverse: &Inverse<D, P>,
    d: &[f64; P],
) -> ([f64; V], f64) {
    let mut l = [0.0; V];
    let mut rest = 1.0;
    for i in 0..D {
        let mut sum = 0.0;
        for k in 0..D {
            sum += inverse.b[k][i] * d[k];
        }
        l[i + 1] = sum;
        rest -= sum;
    }
    l[0] = rest;
    let size = dot(d, d).sqrt() * inverse.norm;
    let one = size * (inverse.defect + (2 * D + 8) as f64 * U);
    let sum = (2 * D + 8) as f64 * U * (1.0 + 2.0 * D as f64 * size);
    let bound = ROUNDED * (D as f64 * one + sum) + LEAST_VALUE;
    (
        l,
        if bound.is_finite() {
            bound
        } else {
            f64::INFINITY
        },
    )
}
