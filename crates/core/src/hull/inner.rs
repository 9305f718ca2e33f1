//! A point strictly inside a tetrahedron, and orientation tests with it.

use delone_predicates::{Point3, Sign, orient3d};
use num_bigint::{BigInt, Sign as Turn};

use crate::base::wide::{lowest, scaled};

/// The mean of four points: rounded if that is strictly inside their tetrahedron; otherwise exact,
/// as when two of their planes are at neighboring doubles.
#[derive(Debug, Clone, Copy)]
pub enum Inner {
    /// The rounded mean.
    At(Point3),
    /// The exact mean of these points.
    Mean([Point3; 4]),
}

impl Inner {
    /// The inner point of a positively oriented tetrahedron.
    pub fn of(corners: [Point3; 4]) -> Self {
        let mean = [0, 1, 2].map(|k| corners.iter().map(|p| p[k] / 4.0).sum());
        let within = |k: usize| {
            let mut with = corners;
            with[k] = mean;
            let [a, b, c, d] = with;
            orient3d(a, b, c, d) == Sign::Positive
        };
        if (0..4).all(within) {
            Self::At(mean)
        } else {
            Self::Mean(corners)
        }
    }

    /// The orientation of this point and three others.
    #[inline]
    pub fn side(&self, u: Point3, v: Point3, p: Point3) -> Sign {
        match self {
            Self::At(o) => orient3d(*o, u, v, p),
            Self::Mean(corners) => of_mean(corners, u, v, p),
        }
    }
}

/// Differences within these bounds have products that neither overflow nor underflow.
const SAFE: std::ops::Range<f64> = 1e-90..1e90;

#[cold]
fn of_mean(corners: &[Point3; 4], u: Point3, v: Point3, p: Point3) -> Sign {
    let seen = |q: Point3| [0, 1, 2].map(|k| q[k] - p[k]);
    let (b, c) = (seen(u), seen(v));
    let (mut sum, mut size) = (0.0, 0.0);
    let mut safe = true;
    for a in corners.map(seen) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            sum += a[k] * (b[i] * c[j] - b[j] * c[i]);
            size += a[k].abs() * ((b[i] * c[j]).abs() + (b[j] * c[i]).abs());
            safe &= [a[k], b[k], c[k]]
                .iter()
                .all(|x| *x == 0.0 || SAFE.contains(&x.abs()));
        }
    }
    // 12 terms with 6 roundings each, and their sums: less than 32 units of rounding.
    if safe && sum.abs() > 16.0 * f64::EPSILON * size {
        // Relative to the last point, the determinant has the opposite sign.
        return Sign::of(-sum);
    }
    let [a, b, c, d] = *corners;
    let low = lowest(&[a, b, c, d, u, v, p], &[]);
    let integer = |q: Point3| q.map(|x| scaled(x, low));
    let p = integer(p);
    let seen = |q: Point3| {
        let q = integer(q);
        [0, 1, 2].map(|k| &q[k] - &p[k])
    };
    let (b, c) = (seen(u), seen(v));
    let mut sum = BigInt::ZERO;
    for a in corners.map(seen) {
        for (k, x) in a.iter().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            sum += x * (&b[i] * &c[j] - &b[j] * &c[i]);
        }
    }
    match sum.sign() {
        Turn::Minus => Sign::Positive,
        Turn::NoSign => Sign::Zero,
        Turn::Plus => Sign::Negative,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_neighboring_planes_is_between_them() {
        let up = 1f64.next_up();
        let corners = [
            [0.0, 0.0, 1.0],
            [4.0, 0.0, 1.0],
            [0.0, 4.0, 1.0],
            [0.0, 0.0, up],
        ];
        let inner = Inner::of(corners);
        assert!(matches!(inner, Inner::Mean(_)));
        let plane = |z: f64, p: Point3| inner.side([1.0, 0.0, z], [0.0, 1.0, z], p);
        assert_ne!(plane(up, [9.0, 9.0, up]), plane(1.0, [9.0, 9.0, 1.0]));
        assert_ne!(plane(1.0, [9.0, 9.0, 1.0]), Sign::Zero);
        for scale in [1.0, 1e-300, 1e300] {
            let corners = corners.map(|p| [p[0] * scale, p[1] * scale, p[2]]);
            let exact = Inner::Mean(corners);
            let at = |x: f64, y: f64, z: f64| [x * scale, y * scale, z];
            // The mean is on the line through both, and in the plane x = 1.
            let (u, v) = (at(1.0, 1.0, 0.0), at(1.0, 1.0, 2.0));
            assert_eq!(exact.side(u, v, at(9.0, 1.0, 1.0)), Sign::Zero);
            let (u, v) = (at(1.0, 0.0, 0.0), at(1.0, 0.0, 2.0));
            assert_eq!(exact.side(u, v, at(1.0, 7.0, 1.0)), Sign::Zero);
            let sides = [-9.0, 9.0].map(|x| exact.side(u, v, at(x, 1.0, 1.0)));
            assert_eq!(sides[0], -sides[1]);
            assert_ne!(sides[0], Sign::Zero);
        }
    }
}
