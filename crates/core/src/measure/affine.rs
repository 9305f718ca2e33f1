//! The affine maps to barycentric coordinates.
//!
//! Each is the inverse of the matrix whose columns are the vectors from the last corner to the
//! others, followed by the last corner.

use num_bigint::{BigInt, Sign};

use super::batch::each;
use super::corners::{
    Corners, Integers, Measure, Number, Vectors, cross, determinant2, determinant3, in_units,
};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::base::wide::{across, determinant, ratio};

/// The maps of triangles. Entries have a relative error below 1e-13; those out of range are
/// infinite.
pub fn transforms2(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[[f64; 2]; 3]>> {
    each(points, simplices, workers, watch, |corners| {
        let [first, second] = Corners::new(corners).measure(&Rows2);
        [first, second, corners[2]]
    })
}

/// The maps of tetrahedra. Rows have an error below 1e-13 of their length.
pub fn transforms3(
    points: &[[f64; 3]],
    simplices: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[[f64; 3]; 4]>> {
    each(points, simplices, workers, watch, |corners| {
        let [first, second, third] = Corners::new(corners).measure(&Rows3);
        [first, second, third, corners[3]]
    })
}

struct Rows2;

impl Measure<2> for Rows2 {
    type Out = [[f64; 2]; 2];

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 2]; 2]) -> T {
        determinant2(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 2>) -> Self::Out {
        let [a, b] = vectors.to;
        let size = determinant2(&vectors.to).value();
        let rows = [[b[1], b[0].negated()], [a[1].negated(), a[0]]];
        rows.map(|row| row.map(|x| quotient(x.value(), size, vectors.exponent)))
    }

    fn exact(&self, vectors: &Integers<2>) -> Self::Out {
        let [a, b] = &vectors.to;
        let size = &a[0] * &b[1] - &a[1] * &b[0];
        let rows = [[b[1].clone(), -&b[0]], [-&a[1], a[0].clone()]];
        rows.map(|row| row.map(|x| exact_quotient(&x, &size, vectors.low)))
    }
}

struct Rows3;

impl Measure<3> for Rows3 {
    type Out = [[f64; 3]; 3];

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 3]; 3]) -> T {
        determinant3(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 3>) -> Self::Out {
        let [a, b, c] = vectors.to;
        let size = determinant3(&vectors.to).value();
        let rows = [cross(c, b), cross(a, c), cross(b, a)];
        rows.map(|row| row.map(|x| quotient(x.value(), size, vectors.exponent)))
    }

    fn exact(&self, vectors: &Integers<3>) -> Self::Out {
        let [a, b, c] = &vectors.to;
        let size = determinant([a, c, b]);
        let rows = [across(c, b), across(a, c), across(b, a)];
        rows.map(|row| row.map(|x| exact_quotient(&x, &size, vectors.low)))
    }
}

/// A quotient whose dimension is that of an inverse length. Adding 0 turns -0 into 0.
#[inline]
fn quotient(x: f64, size: f64, exponent: i32) -> f64 {
    in_units(x / size, -exponent) + 0.0
}

fn exact_quotient(x: &BigInt, size: &BigInt, low: i64) -> f64 {
    let far = if x.sign() == Sign::Minus {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    ratio(x, size, -low).unwrap_or(far) + 0.0
}
