//! Areas of triangles and volumes of tetrahedra, and areas and normals of triangles in 3-D.

use num_bigint::BigInt;

use super::batch::each;
use super::corners::{
    Corners, Integers, Measure, Number, Vectors, cross, determinant2, determinant3, dot, in_units,
};
use super::sphere;
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::base::wide::{across, determinant, lowest, ratio, root, scaled, times_power};

/// The areas of triangles, with a relative error below 1e-14; infinite, or subnormal and rounded,
/// if out of range.
pub fn areas(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    let area = |corners| Corners::new(corners).measure(&Area);
    each(points, simplices, workers, watch, area)
}

/// The volumes of tetrahedra, with the same accuracy.
pub fn volumes(
    points: &[[f64; 3]],
    simplices: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    let volume = |corners| Corners::new(corners).measure(&Volume);
    each(points, simplices, workers, watch, volume)
}

/// The areas of triangles in 3-D, none of which is degenerate, with the same accuracy.
pub fn face_areas(
    points: &[[f64; 3]],
    faces: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    each(points, faces, workers, watch, face_area)
}

/// The unit normals of triangles in 3-D, none of which is degenerate, toward the side from which
/// they are counterclockwise: within a few units in the last place.
pub fn face_normals(
    points: &[[f64; 3]],
    faces: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; 3]>> {
    let normal = |[a, b, c]: [[f64; 3]; 3]| sphere::normal(a, b, c);
    each(points, faces, workers, watch, normal)
}

struct Area;

impl Measure<2> for Area {
    type Out = f64;

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 2]; 2]) -> T {
        determinant2(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 2>) -> f64 {
        in_units(
            determinant2(&vectors.to).value() / 2.0,
            2 * vectors.exponent,
        )
    }

    fn exact(&self, vectors: &Integers<2>) -> f64 {
        let [a, b] = &vectors.to;
        let twice = &a[0] * &b[1] - &a[1] * &b[0];
        ratio(&twice, &BigInt::from(2), 2 * vectors.low).unwrap_or(f64::INFINITY)
    }
}

struct Volume;

impl Measure<3> for Volume {
    type Out = f64;

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 3]; 3]) -> T {
        determinant3(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 3>) -> f64 {
        in_units(
            determinant3(&vectors.to).value() / 6.0,
            3 * vectors.exponent,
        )
    }

    fn exact(&self, vectors: &Integers<3>) -> f64 {
        let [a, b, c] = &vectors.to;
        let six = determinant([a, c, b]);
        ratio(&six, &BigInt::from(6), 3 * vectors.low).unwrap_or(f64::INFINITY)
    }
}

fn face_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let minus = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (p, q) = (minus(b), minus(c));
    let normal = cross(p, q);
    let (square, size) = (dot(normal, normal), dot(p, p) * dot(q, q));
    // 2^-10: at most five bits are lost. Between 2^-500 and 2^500 there is no overflow or
    // underflow.
    let (small, large) = (times_power(1.0, -500), times_power(1.0, 500));
    if square > size / 1024.0 && square > small && size < large {
        return square.sqrt() / 2.0;
    }
    let low = lowest(&[a, b, c], &[]);
    let at = [a, b, c].map(|p| p.map(|x| scaled(x, low)));
    let minus = |i: usize| [0, 1, 2].map(|k| &at[i][k] - &at[0][k]);
    let (p, q): ([BigInt; 3], [BigInt; 3]) = (minus(1), minus(2));
    let square: BigInt = across(&p, &q).iter().map(|x| x * x).sum();
    // The root is scaled by 2^64.
    let twice = BigInt::from(2) << 64_u32;
    ratio(&root(&square), &twice, 2 * low).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_right_at_every_magnitude() {
        let watch = Watch::idle();
        for e in [-1074, -600, -300, -41, -1, 0, 59, 300, 500] {
            let u = times_power(1.0, e);
            let flat = [[0.0, 0.0], [4.0 * u, 0.0], [0.0, 3.0 * u]];
            let found = areas(&flat, &[[0, 1, 2]], 1, &watch).unwrap();
            assert_eq!(found, [times_power(6.0, 2 * e)], "{e}");
            let solid = [
                [0.0; 3],
                [3.0 * u, 0.0, 0.0],
                [0.0, 2.0 * u, 0.0],
                [0.0, 0.0, 4.0 * u],
            ];
            let found = volumes(&solid, &[[0, 1, 2, 3]], 1, &watch).unwrap();
            assert_eq!(found, [times_power(4.0, 3 * e)], "{e}");
            let found = face_areas(&solid, &[[0, 1, 2]], 1, &watch).unwrap();
            assert_eq!(found, [times_power(3.0, 2 * e)], "{e}");
        }
    }

    #[test]
    fn slivers_keep_their_size() {
        let watch = Watch::idle();
        // Off the diagonal by one unit in the last place, far from the origin.
        let far = 1e6_f64;
        let points = [
            [far, far],
            [far + 1.0, far + 1.0],
            [far + 0.5, (far + 0.5).next_up()],
        ];
        let expected = ((far + 0.5).next_up() - (far + 0.5)) / 2.0;
        let found = areas(&points, &[[0, 1, 2]], 1, &watch).unwrap();
        assert_eq!(found, [expected]);
    }
}
