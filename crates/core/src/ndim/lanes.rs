//! The spheres of several simplices at once, one in each lane of vector registers.
//!
//! The bounds are those of `filter`, which hold for any approximate inverse. Here rows are not exchanged for
//! larger pivots, so that all lanes take the same steps. Where that is not accurate, as the defect
//! shows, the caller measures a simplex alone, with pivots.

use super::filter::{LEAST_RESIDUAL, LEAST_VALUE, ROUNDED, Test, U};

/// Simplices that are measured at once: a register of AVX-512, two of AVX2.
pub const LANES: usize = 8;

/// One number of each simplex.
pub type Lane = [f64; LANES];

/// A defect up to which pivots are not worthwhile: fewer than one test in a million is uncertain for it.
const ACCURATE: f64 = 1.0 / (1u64 << 30) as f64;

/// Adds products.
#[inline(always)]
fn add(sum: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        sum[l] += a[l] * b[l];
    }
}

/// The inverses of matrices in rows, by Gauss-Jordan elimination in place.
#[inline(always)]
fn invert<const D: usize>(a: &[[Lane; D]; D]) -> [[Lane; D]; D] {
    let mut m = *a;
    for k in 0..D {
        let mut pivot = m[k];
        let f = pivot[k].map(|x| 1.0 / x);
        pivot[k] = [1.0; LANES];
        for x in &mut pivot {
            for l in 0..LANES {
                x[l] *= f[l];
            }
        }
        for (i, row) in m.iter_mut().enumerate() {
            if i != k {
                let g = row[k].map(|x| -x);
                row[k] = [0.0; LANES];
                for j in 0..D {
                    add(&mut row[j], &g, &pivot[j]);
                }
            }
        }
        m[k] = pivot;
    }
    m
}

/// Bounds of |A^-1| where the approximate inverse `b` is accurate, and infinity elsewhere.
#[inline(always)]
fn norms<const D: usize>(a: &[[Lane; D]; D], b: &[[Lane; D]; D]) -> Lane {
    let (mut e, mut na, mut nb) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
    for i in 0..D {
        let mut row = [[0.0; LANES]; D];
        row[i] = [-1.0; LANES];
        for k in 0..D {
            for j in 0..D {
                add(&mut row[j], &a[i][k], &b[k][j]);
            }
        }
        for j in 0..D {
            add(&mut e, &row[j], &row[j]);
            add(&mut na, &a[i][j], &a[i][j]);
            add(&mut nb, &b[i][j], &b[i][j]);
        }
    }
    std::array::from_fn(|l| {
        let (e, na, nb) = (e[l].sqrt(), na[l].sqrt(), nb[l].sqrt());
        let defect = ROUNDED * (e + (2 * D + 16) as f64 * U * (na * nb + D as f64));
        // A comparison that NaN fails.
        if defect < ACCURATE {
            ROUNDED * nb / (1.0 - defect)
        } else {
            f64::INFINITY
        }
    })
}

/// The tests of simplices with the differences `a`, and the weights of the corners less that of the first
/// one, as `Test::lifted` makes them; `None` where pivots are needed.
#[inline(always)]
pub fn lifted<const D: usize>(
    a: &[[Lane; D]; D],
    weights: Option<&[Lane; D]>,
) -> [Option<Test<D>>; LANES] {
    let mut b = [[0.0; LANES]; D];
    for i in 0..D {
        for k in 0..D {
            add(&mut b[i], &a[i][k], &a[i][k]);
        }
    }
    let mut sizes = b;
    if let Some(weights) = weights {
        for i in 0..D {
            for l in 0..LANES {
                sizes[i][l] += weights[i][l].abs();
                b[i][l] -= weights[i][l];
            }
        }
    }
    let inverse = invert(a);
    let (mut x, mut square) = ([[0.0; LANES]; D], [0.0; LANES]);
    for k in 0..D {
        for i in 0..D {
            add(&mut x[k], &inverse[k][i], &b[i]);
        }
        add(&mut square, &x[k], &x[k]);
    }
    let norm = norms(a, &inverse);
    let mut squares = [0.0; LANES];
    for i in 0..D {
        let (mut sum, mut size) = ([0.0; LANES], sizes[i]);
        for k in 0..D {
            for l in 0..LANES {
                let product = a[i][k][l] * x[k][l];
                sum[l] += product;
                size[l] += product.abs();
            }
        }
        for l in 0..LANES {
            let rounding = (2 * D + 8) as f64 * U * size[l];
            let residual = (sum[l] - b[i][l]).abs() + rounding + LEAST_RESIDUAL;
            squares[l] += residual * residual;
        }
    }
    let c = (D + 5) as f64 * U;
    let (mut q0, mut q1) = ([0.0; LANES], [0.0; LANES]);
    for l in 0..LANES {
        let size = square[l].sqrt();
        let slope = ROUNDED * (ROUNDED * norm[l] * squares[l].sqrt() + c * size);
        q0[l] = slope * size / 2.0 + LEAST_VALUE;
        q1[l] = slope / (2.0 * size) + ROUNDED * c;
    }
    // If these are finite, so is x: its length is one of their factors.
    std::array::from_fn(|l| {
        (q0[l].is_finite() && q1[l].is_finite()).then(|| Test {
            x: std::array::from_fn(|k| x[k][l]),
            q0: q0[l],
            q1: q1[l],
        })
    })
}
