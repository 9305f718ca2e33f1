//! The point where three planes meet, correctly rounded, in arbitrary-precision integers.
//!
//! By Cramer's rule: with n_i . x = c_i, and D the determinant of the normals, the point is
//!
//! ```text
//! x = (c_0 n_1 x n_2 + c_1 n_2 x n_0 + c_2 n_0 x n_1) / D
//! ```

use delone_predicates::Point3;
use num_bigint::{BigInt, Sign};

use crate::base::wide::{determinant, lowest, ratio, scaled};

/// A plane in one of its given forms.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plane {
    /// The points with equal power from two weighted sites.
    Between([Point3; 2], [f64; 2]),
    /// n . x = c.
    Equation([f64; 4]),
    /// Through three points.
    Through([Point3; 3]),
}

impl Plane {
    /// An exponent such that all lengths are multiples of its power of two.
    fn low(&self) -> i64 {
        match self {
            Self::Between(points, weights) => lowest(points, weights),
            Self::Through(points) => lowest(points, &[]),
            Self::Equation([.., 0.0]) => 0,
            Self::Equation([x, y, z, c]) => lowest(&[[*c]], &[]) - lowest(&[[*x, *y, *z]], &[]),
        }
    }

    /// The normal and c in integers, for lengths in units of a power of two.
    fn integers(&self, low: i64) -> ([BigInt; 3], BigInt) {
        let at = |p: Point3| p.map(|x| scaled(x, low));
        match *self {
            Self::Between([p, q], [v, w]) => {
                let (a, b) = (at(p), at(q));
                let n = [0, 1, 2].map(|k| (&b[k] - &a[k]) * 2);
                let lift = scaled(v, 2 * low) - scaled(w, 2 * low);
                (n, inner(&b, &b) - inner(&a, &a) + lift)
            }
            Self::Equation([x, y, z, c]) => {
                let unit = lowest(&[[x, y, z]], &[]);
                ([x, y, z].map(|x| scaled(x, unit)), scaled(c, unit + low))
            }
            Self::Through([p, q, r]) => {
                let (a, b, c) = (at(p), at(q), at(r));
                let minus = |p: &[BigInt; 3]| [0, 1, 2].map(|k| &p[k] - &a[k]);
                let n = cross(&minus(&b), &minus(&c));
                let offset = inner(&n, &a);
                (n, offset)
            }
        }
    }
}

/// The common point of three planes; `None` if it is not unique, or out of range.
#[cold]
#[inline(never)]
pub(super) fn meeting(planes: [Plane; 3]) -> Option<Point3> {
    let low = planes.iter().map(Plane::low).min().unwrap_or(0);
    let [(n, c), (m, d), (l, e)] = planes.map(|plane| plane.integers(low));
    let det = determinant([&n, &m, &l]);
    if det.sign() == Sign::NoSign {
        return None;
    }
    let (first, second, third) = (cross(&m, &l), cross(&l, &n), cross(&n, &m));
    let turn = BigInt::from(if det.sign() == Sign::Minus { -1 } else { 1 });
    let det = det * &turn;
    let mut at = [0.0; 3];
    for (k, x) in at.iter_mut().enumerate() {
        let sum = &c * &first[k] + &d * &second[k] + &e * &third[k];
        *x = ratio(&(sum * &turn), &det, low)?;
    }
    Some(at)
}

fn cross(p: &[BigInt; 3], q: &[BigInt; 3]) -> [BigInt; 3] {
    [0, 1, 2].map(|k| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        &p[x] * &q[y] - &p[y] * &q[x]
    })
}

fn inner(p: &[BigInt; 3], q: &[BigInt; 3]) -> BigInt {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_of_each_kind_meet() {
        let between = Plane::Between([[0.0; 3], [3.0, 0.0, 0.0]], [0.0, 3.0]);
        let through = Plane::Through([[0.0, 0.1, 0.0], [1.0, 0.1, 0.0], [0.0, 0.1, 7.0]]);
        let given = Plane::Equation([0.0, 0.0, -0.75, 1e-300]);
        let at = meeting([between, through, given]).unwrap();
        assert_eq!(at, [1.0, 0.1, -1e-300 / 0.75]);
        assert_eq!(meeting([through, between, given]), Some(at));
        assert_eq!(meeting([through, between, between]), None);
    }

    #[test]
    fn planes_that_differ_in_the_last_place_meet_exactly() {
        // (1 + u) x + y = 2 and x + y = 2 meet at x = 0.
        let tilted = Plane::Equation([1.0 + f64::EPSILON, 1.0, 0.0, 2.0]);
        let plain = Plane::Equation([1.0, 1.0, 0.0, 2.0]);
        let level = Plane::Equation([0.0, 0.0, 1.0, 0.0]);
        assert_eq!(meeting([tilted, plain, level]), Some([0.0, 2.0, 0.0]));
        let far = Plane::Equation([1.0 + f64::EPSILON, 1.0, 0.0, 1e300]);
        let also = Plane::Equation([1.0, 1.0, 0.0, -1e300]);
        assert_eq!(meeting([far, also, level]), None);
    }
}
