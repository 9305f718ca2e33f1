//! Heights of points above one sphere that is near all of them, for which the in-sphere test is then
//! certain in plain floating point.
//!
//! Where all points are on a sphere up to rounding, as directions are, it is the circumsphere of each
//! tetrahedron, and neither a center and a radius nor the usual filter decides any test. But the
//! determinant of the in-sphere test stays the same if an affine function of the coordinates is added
//! to all squared lengths. With the height L(v) = |v - c|^2 - k, for any c and k, in place of |v|^2 it
//! is the sum of (L(a) - L(e)) [B, C, D] and so on, see `delone_predicates::insphere`. If c and k are a
//! center and a squared radius, the heights are as small as the determinant itself, and nothing
//! cancels.
//!
//! # The bound of a height
//!
//! Let u = 2^-53 and S = |v - c|^2 + |k|. For each coordinate, h + l = v - c exactly, with |l| <= u |h|,
//! and p + e = h^2 exactly. The tail e + 2 h l errs by 2 u^2 h^2 in the product, 3 u^2 h^2 in the sum,
//! and u^2 h^2 in l^2, which is left out. The three p and -k are summed with their exact errors, each
//! at most u S. The tails together are at most 6 u S, and five sums of them err by 30 u^2 S. So a height
//! errs by at most u |L| for its last rounding and 36 u^2 S, to first order; [`Heights::error`] is u
//! max |L| + 64 u^2 max S.
//!
//! # The bound of the filter
//!
//! The difference of two heights, l, errs by u |l| + 2 E, with E this error. A monomial of a 3 x 3 minor
//! passes 3 differences, 2 products, a difference and two sums; then the product with l and the first of
//! two levels of the last sum, which itself changes no sign: 10 roundings. With P the sum of the
//! magnitudes of the monomials of a minor, the determinant errs by at most the sum of P (11 u |l| + 2 E),
//! to first order. 16 u and 5/2 E leave room for the second order, and for the roundings of P and of the
//! bound.
//!
//! # Underflow
//!
//! Coordinates are below 2^40, so differences are below 2^41. A sphere that is certain has a radius
//! below 2^69 (see `sphere`), so heights are below 2^118. An underflow adds at most 2^-1074 to a height,
//! less than [`TINY`]; in the determinant each of the 28 products adds at most 2^-1075 times 2^41 times
//! 2^119: less than TINY together.

use delone_predicates::{Point3, Sign};

use super::sphere::{Ray, sphere};
use crate::base::error::Result;
use crate::base::memory::with_room;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// More than underflows add.
const TINY: f64 = 1e-270;
/// Heights are used where all are below this part of the squared radius: spheres of tetrahedra, whose
/// [`SLACK`](super::sphere::SLACK) is 2^-16, do not decide most tests there.
const NEAR: f64 = 1.0 / (1 << 20) as f64;
/// With fewer points nothing is gained.
const LEAST: usize = 64;

/// The height of each point.
pub struct Heights {
    all: Vec<f64>,
    error: f64,
}

impl Heights {
    /// The heights of `points` along the curve, with coordinates below 2^40; `None` unless they are
    /// near a sphere and not exactly on it.
    pub fn of(points: &[Point3]) -> Result<Option<Self>> {
        let n = points.len();
        if n < LEAST {
            return Ok(None);
        }
        // Far from each other along the curve, so that the center is well determined.
        let [p, q, r, s] = [0, 1, 2, 3].map(|i| points[i * (n - 1) / 3]);
        let [x, y, z, square] = sphere(p, Ray::new(q, p), Ray::new(r, p), Ray::new(s, p), 0.0);
        let (center, limit) = ([x, y, z], NEAR * square);
        // NaN compares false.
        let near = |h: f64| h.abs() < limit;
        let step = n / LEAST;
        let sample = points.iter().step_by(step);
        if !sample.map(|&p| height(p, center, square).0).all(near) {
            return Ok(None);
        }
        let mut all = with_room(n)?;
        let (mut most, mut size) = (0f64, 0f64);
        for &p in points {
            let (h, s) = height(p, center, square);
            if !near(h) {
                return Ok(None);
            }
            (most, size) = (most.max(h.abs()), size.max(s));
            all.push(h);
        }
        let error = U * most + 64.0 * U * U * size + TINY;
        // If all heights are as small as their error, most tests are ties.
        Ok((most > 4.0 * error).then_some(Self { all, error }))
    }

    /// The sign of the in-sphere test of the last of five vertices, if it is certain.
    pub fn insphere(&self, points: &[Point3], vertices: [u32; 5]) -> Option<Sign> {
        let [a, b, c, d, e] = vertices.map(|v| points[v as usize]);
        let [a, b, c, d] = [a, b, c, d].map(|p| [p[0] - e[0], p[1] - e[1], p[2] - e[2]]);
        let [la, lb, lc, ld, le] = vertices.map(|v| self.all[v as usize]);
        let [la, lb, lc, ld] = [la - le, lb - le, lc - le, ld - le];
        let products = |p: Point3, q: Point3| (p[0] * q[1], p[1] * q[0]);
        let minor = |(x, y): (f64, f64)| x - y;
        let size = |(x, y): (f64, f64)| x.abs() + y.abs();

        let (ab, bc, cd) = (products(a, b), products(b, c), products(c, d));
        let (da, ac, bd) = (products(d, a), products(a, c), products(b, d));
        let bcd = b[2] * minor(cd) - c[2] * minor(bd) + d[2] * minor(bc);
        let acd = c[2] * minor(da) + d[2] * minor(ac) + a[2] * minor(cd);
        let abd = d[2] * minor(ab) + a[2] * minor(bd) + b[2] * minor(da);
        let abc = a[2] * minor(bc) - b[2] * minor(ac) + c[2] * minor(ab);
        let det = (la * bcd - lb * acd) + (lc * abd - ld * abc);

        let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].abs());
        let doubt = |l: f64| 16.0 * U * l.abs() + 2.5 * self.error;
        let bound = doubt(la) * (bz * size(cd) + cz * size(bd) + dz * size(bc))
            + doubt(lb) * (cz * size(da) + dz * size(ac) + az * size(cd))
            + doubt(lc) * (dz * size(ab) + az * size(bd) + bz * size(da))
            + doubt(ld) * (az * size(bc) + bz * size(ac) + cz * size(ab));
        (det.abs() > bound + TINY).then(|| Sign::of(det))
    }
}

/// The height of a point above a sphere, and the sum of magnitudes that its error depends on.
fn height(p: Point3, center: Point3, square: f64) -> (f64, f64) {
    let (mut sum, mut tail, mut size) = (-square, 0.0, square);
    for k in 0..3 {
        let (high, low) = two_sum(p[k], -center[k]);
        let (product, error) = two_square(high);
        let (next, lost) = two_sum(sum, product);
        tail += (error + 2.0 * high * low) + lost;
        (sum, size) = (next, size + product);
    }
    (sum + tail, size)
}

/// A sum and its rounding error (D. E. Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let other = sum - a;
    (sum, (a - (sum - other)) + (b - other))
}

/// A square and its rounding error (G. W. Veltkamp and T. J. Dekker).
fn two_square(a: f64) -> (f64, f64) {
    let square = a * a;
    let big = 134_217_729.0 * a; // 2^27 + 1
    let high = big - (big - a);
    let low = a - high;
    (
        square,
        ((high * high - square) + 2.0 * high * low) + low * low,
    )
}

#[cfg(test)]
mod tests {
    use delone_predicates::insphere;

    use super::*;
    use crate::base::random::uniform;

    /// Points near the sphere with this center and radius, up to `noise`.
    fn near(n: usize, center: Point3, radius: f64, noise: f64) -> Vec<Point3> {
        let mut next = uniform(5);
        let mut point = || {
            let p = [next() - 0.5, next() - 0.5, next() - 0.5];
            let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            let r = radius * (1.0 + noise * next()) / length;
            [0, 1, 2].map(|k| center[k] + r * p[k])
        };
        (0..n).map(|_| point()).collect()
    }

    /// Compares the filter with the exact predicate; returns how many of the tests it decides.
    fn decided(points: &[Point3]) -> usize {
        let heights = Heights::of(points).unwrap().unwrap();
        let mut next = uniform(9);
        let mut vertex =
            |base: u32, span: f64| (base + (span * next()) as u32) % points.len() as u32;
        let mut found = 0;
        for i in 0..4000 {
            // Anywhere, and close together in the order of the points.
            let (base, span) = (vertex(0, 1e9), if i % 2 == 0 { 1e9 } else { 8.0 });
            let v = [0; 5].map(|_| vertex(base, span));
            let [a, b, c, d, e] = v.map(|v| points[v as usize]);
            if let Some(sign) = heights.insphere(points, v) {
                assert_eq!(sign, insphere(a, b, c, d, e));
                found += 1;
            }
        }
        found
    }

    #[test]
    fn heights_decide_what_is_on_a_sphere_up_to_rounding() {
        // Vertices that repeat make a determinant zero: four fifths of those close together.
        assert!(decided(&near(3000, [0.0; 3], 1.0, 0.0)) > 2200);
        assert!(decided(&near(3000, [5e5, 4.5e6, 300.0], 10.0, 0.0)) > 2200);
        assert!(decided(&near(3000, [0.0; 3], 1e-9, 1e-13)) > 2200);
        assert!(decided(&near(3000, [1.0, 2.0, 3.0], 1e9, 1e-8)) > 2200);
    }

    #[test]
    fn other_points_have_no_heights() {
        let none = |points: &[Point3]| Heights::of(points).unwrap().is_none();
        assert!(none(&near(1000, [0.0; 3], 1.0, 1e-3)));
        assert!(none(&near(20, [0.0; 3], 1.0, 0.0)));
        let mut one_off = near(1000, [0.0; 3], 1.0, 0.0);
        one_off[500] = [0.0; 3];
        assert!(none(&one_off));
        // Exactly on a sphere: all tests are ties.
        let cube = |i: u32| [i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from);
        assert!(none(&(0..100).map(cube).collect::<Vec<_>>()));
    }

    #[test]
    fn heights_are_nearly_exact() {
        // 1 + 2^-52 + ... : what is lost in the squares is found in the tails.
        let x = 1.0 + f64::EPSILON;
        let (h, _) = height([x, 0.0, 0.0], [0.0; 3], 1.0);
        assert_eq!(h, 2.0 * f64::EPSILON);
        let (h, _) = height([3.0, 4.0, 12.0], [0.0; 3], 169.0);
        assert_eq!(h, 0.0);
    }
}
