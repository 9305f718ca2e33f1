//! Predicates of directions by square roots of integers, taken to so many bits that a sum of them that is
//! smaller is zero.

use delone_predicates::{Point3, Sign};
use num_bigint::BigInt;
use num_traits::{One, Signed};

use super::{determinant, integers, sign_of};

/// The vector as integers, times its own power of two.
pub fn whole(v: Point3) -> Vec<BigInt> {
    integers(&[v]).remove(0)
}

/// The square of the length.
pub fn square(v: &[BigInt]) -> BigInt {
    v.iter().map(|x| x * x).sum()
}

/// The sign of the sum of x sqrt n. The product of all sums with other signs of the roots is an integer:
/// so the sum is zero, or at least M^-7, where M bounds all eight that are not opposite to another.
pub fn sign_of_roots(terms: &[(BigInt, BigInt)]) -> Sign {
    let bits: u64 = terms
        .iter()
        .map(|(x, n)| x.bits() + n.bits() / 2 + 3)
        .max()
        .unwrap_or(0);
    let last = 7 * bits + 8;
    let mut extra = 64;
    loop {
        let mut sum = BigInt::default();
        let mut error = BigInt::one();
        for (x, n) in terms {
            let root: BigInt = n << (2 * extra);
            sum += x * root.sqrt();
            error += x.abs();
        }
        if sum.abs() > error {
            return sign_of(&sum);
        }
        if extra > last + bits {
            return Sign::Zero;
        }
        extra = (4 * extra).min(last + bits + 1);
    }
}

/// The sign of the determinant of three vectors.
pub fn true_orient(points: [Point3; 3]) -> Sign {
    sign_of(&determinant(&points.map(whole)))
}

/// Whether the last direction is inside the circle of the others, counterclockwise.
pub fn true_incircle(points: [Point3; 4]) -> Sign {
    let rows = points.map(whole);
    let mut terms = Vec::new();
    for i in 0..4 {
        let others: Vec<_> = (0..4)
            .filter(|&j| j != i)
            .map(|j| rows[j].clone())
            .collect();
        let minor = determinant(&others);
        let minor = if i % 2 == 0 { minor } else { -minor };
        terms.push((minor, square(&rows[i])));
    }
    sign_of_roots(&terms)
}
