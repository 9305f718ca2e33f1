//! Circumcenters and power centers of four sites, correctly rounded or within 4 ulp.
//!
//! With the first corner a as the origin, d = b - a, e = c - a and f = the last one - a, the point
//! u with equal power to all four solves 2 u.d = |d|^2 + w(a) - w(b) = L, and likewise M for e and
//! N for f, so that
//!
//! ```text
//! u = (L e x f + M f x d + N d x e) / (2 d . (e x f)),    center = a + u
//! ```
//!
//! and without weights it is the circumcenter. The stages are those of 2-D (see `circle`): doubles
//! with a bound on the error, accepted up to 4 units in the last place; double-double arithmetic,
//! accepted if the interval of the error rounds to one double; arbitrary-precision integers. The
//! last two are correctly rounded.
//!
//! Corners are taken in lexicographic order, so the result is independent of the order of the
//! corners.
//!
//! # The bound of the plain stage
//!
//! Let u = 2^-53, P and Q the sums of the magnitudes of the monomials of a component of the
//! numerator and of d . (e x f). A monomial of the numerator goes through 13 roundings: 2
//! differences, a product, 2 sums and the one with the weights in L; 2 differences, a product and a
//! sum in the minor; their product; 2 sums. One of the determinant goes through 3 differences, 2
//! products and 3 sums. With room for terms of second order they err by 15 u P and 9 u Q. If |D| >
//! 36 u Q for D = 2 d . (e x f), the quotient q errs by 2 u (15 P + 18 |q| Q) / |D| + u |q|, and
//! x = a + q by u |x| more. Underflow is negligible while P, Q > 2^-700 and all differences and
//! weights are below 2^200.

use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::{Point3, lexicographic};
use num_bigint::{BigInt, Sign};

use super::center::{Center, Centered};
use super::component::component;
use crate::base::wide::{determinant, lowest, ratio, scaled};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Below this a sum of magnitudes may be inaccurate because of underflow, see the head of the file.
const SMALL: f64 = f64::from_bits((1023 - 700) << 52);
/// Squared differences and weights up to here cannot overflow in degree 4.
const LARGE: f64 = f64::from_bits((1023 + 400) << 52);

/// Four affinely independent sites and their weights, in lexicographic order.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    points: [Point3; 4],
    weights: [f64; 4],
}

impl Centered<3, 4> for Corners {
    #[inline]
    fn new(mut points: [Point3; 4], mut weights: [f64; 4]) -> Self {
        // A sorting network for four.
        for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if lexicographic(points[j], points[i]).is_lt() {
                points.swap(i, j);
                weights.swap(i, j);
            }
        }
        Self { points, weights }
    }

    #[inline]
    fn center(&self) -> Center<3> {
        match self.plain() {
            Some(at) => Center::At(at),
            None => self.rounded(),
        }
    }

    #[cold]
    #[inline(never)]
    fn rounded(&self) -> Center<3> {
        self.pairs().map_or_else(|| self.exact(), Center::At)
    }

    fn coordinates(&self) -> [f64; 3] {
        let (numerators, den, low) = self.quotients();
        numerators.map(|n| {
            let far = f64::INFINITY.copysign(if n.sign() == Sign::Minus { -1.0 } else { 1.0 });
            ratio(&n, &den, low).unwrap_or(far)
        })
    }
}

impl Corners {
    #[inline]
    fn plain(&self) -> Option<Point3> {
        let [a, b, c, g] = self.points;
        let w = self.weights;
        let minus = |p: Point3| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let (d, e, f) = (minus(b), minus(c), minus(g));
        let square = |p: Point3| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        let extra = [w[0] - w[1], w[0] - w[2], w[0] - w[3]];
        let lengths = [square(d), square(e), square(f)];
        let (mut n, mut p) = ([0.0; 3], [0.0; 3]);
        let (mut half, mut size) = (0.0, 0.0);
        for (i, (v, [r, s])) in [(d, [e, f]), (e, [f, d]), (f, [d, e])]
            .into_iter()
            .enumerate()
        {
            let (l, big) = (lengths[i] + extra[i], lengths[i] + extra[i].abs());
            for k in 0..3 {
                let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                let (left, right) = (r[x] * s[y], r[y] * s[x]);
                n[k] += l * (left - right);
                p[k] += big * (left.abs() + right.abs());
                if i == 0 {
                    half += v[k] * (left - right);
                    size += v[k].abs() * (left.abs() + right.abs());
                }
            }
        }
        let den = 2.0 * half;
        let mut sure = den.abs() > 36.0 * U * size
            && size > SMALL
            && lengths.iter().zip(&extra).all(|(l, w)| l + w.abs() < LARGE);
        let mut at = a;
        for k in 0..3 {
            let q = n[k] / den;
            at[k] += q;
            // Written so that NaN fails.
            sure &= p[k] > SMALL
                && 30.0 * p[k] + 36.0 * q.abs() * size <= (3.0 * at[k].abs() - q.abs()) * den.abs();
        }
        sure.then_some(at)
    }

    fn pairs(&self) -> Option<Point3> {
        if !is_safe(&self.points) || !is_safe(&[self.weights]) {
            return None;
        }
        let [a, b, c, g] = self.points;
        let w = self.weights;
        let minus = |p: Point3| [0, 1, 2].map(|k| Pair::difference(p[k], a[k]));
        let vectors = [minus(b), minus(c), minus(g)];
        let zero = Pair::difference(0.0, 0.0);
        let (mut n, mut p) = ([zero; 3], [0.0; 3]);
        let (mut half, mut size) = (zero, 0.0);
        for i in 0..3 {
            let (v, r, s) = (vectors[i], vectors[(i + 1) % 3], vectors[(i + 2) % 3]);
            let length = v[0].square() + v[1].square() + v[2].square();
            let extra = Pair::difference(w[0], w[i + 1]);
            let (l, big) = (length + extra, length.hi + extra.hi.abs());
            for k in 0..3 {
                let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                let (left, right) = (r[x] * s[y], r[y] * s[x]);
                let (minor, around) = (left - right, left.hi.abs() + right.hi.abs());
                n[k] = n[k] + l * minor;
                p[k] += big * around;
                if i == 0 {
                    half = half + v[k] * minor;
                    size += v[k].hi.abs() * around;
                }
            }
        }
        if half.hi.abs() <= 128.0 * U * U * size {
            return None;
        }
        // With the bounds of `Pair`, a numerator errs by 51 u^2 P, the determinant by 30 u^2 of its
        // size: doubled, with room.
        let mut at = [0.0; 3];
        for k in 0..3 {
            at[k] = component(a[k], n[k], p[k], half, size, 128.0)?;
        }
        Some(at)
    }

    fn exact(&self) -> Center<3> {
        let (numerators, den, low) = self.quotients();
        match [0, 1, 2].map(|k| ratio(&numerators[k], &den, low)) {
            [Some(x), Some(y), Some(z)] => Center::At([x, y, z]),
            _ => Center::Beyond(direction(&numerators)),
        }
    }

    /// The coordinates as exact quotients: numerators, their positive denominator, and the exponent
    /// of their unit.
    fn quotients(&self) -> ([BigInt; 3], BigInt, i64) {
        let low = lowest(&self.points, &self.weights);
        let at = self.points.map(|p| p.map(|x| scaled(x, low)));
        let scaled_weights = self.weights.map(|w| scaled(w, 2 * low));
        let seen: [[BigInt; 3]; 3] =
            std::array::from_fn(|i| [0, 1, 2].map(|k| &at[i + 1][k] - &at[0][k]));
        let [d, e, f] = &seen;
        let lengths: [BigInt; 3] = std::array::from_fn(|i| {
            let [x, y, z] = &seen[i];
            x * x + y * y + z * z + &scaled_weights[0] - &scaled_weights[i + 1]
        });
        let half = determinant([d, e, f]);
        let den = half.magnitude().clone() * 2_u32;
        let den = BigInt::from(den);
        let numerators = [0, 1, 2].map(|k| {
            let (x, y) = ((k + 1) % 3, (k + 2) % 3);
            let minor = |r: &[BigInt; 3], s: &[BigInt; 3]| &r[x] * &s[y] - &r[y] * &s[x];
            let n =
                &lengths[0] * minor(e, f) + &lengths[1] * minor(f, d) + &lengths[2] * minor(d, e);
            let n = if half.sign() == Sign::Minus { -n } else { n };
            n + &at[0][k] * &den
        });
        (numerators, den, low)
    }
}

/// The direction, of length 1, of a nonzero vector.
pub(crate) fn direction(vector: &[BigInt; 3]) -> Point3 {
    // Sixty bits of the largest component are more than a double holds.
    let bits = vector.iter().map(BigInt::bits).max().unwrap_or(0);
    let shift = bits.saturating_sub(60);
    let v = [0, 1, 2].map(|k| i64::try_from(&vector[k] >> shift).unwrap_or(0) as f64);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length + 0.0)
}

/// The direction of (b - a) x (c - a), of length 1, within a few units in the last place; a, b and
/// c are not collinear.
pub(crate) fn normal(a: Point3, b: Point3, c: Point3) -> Point3 {
    let minus = |p: Point3| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (p, q) = (minus(b), minus(c));
    let (mut v, mut size) = ([0.0; 3], 0.0_f64);
    for (k, v) in v.iter_mut().enumerate() {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        let (left, right) = (p[x] * q[y], p[y] * q[x]);
        *v = left - right;
        size = size.max(left.abs() + right.abs());
    }
    let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    // Each component errs by at most 5 u of its products: if these are not far larger than the
    // vector, and nothing overflows or underflows, its direction is accurate.
    if square > SMALL && square < 1.0 / SMALL && square * 16.0 > size * size {
        let length = square.sqrt();
        return v.map(|x| x / length + 0.0);
    }
    let low = lowest(&[a, b, c], &[]);
    let at = [a, b, c].map(|p| p.map(|x| scaled(x, low)));
    let minus = |i: usize| [0, 1, 2].map(|k| &at[i][k] - &at[0][k]);
    let (p, q) = (minus(1), minus(2));
    direction(&[0, 1, 2].map(|k| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        &p[x] * &q[y] - &p[y] * &q[x]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;
    use delone_predicates::{Sign as Turn, orient3d};

    const NONE: [f64; 4] = [0.0; 4];

    #[test]
    fn the_center_of_a_box_corner_is_its_middle() {
        let corners = [
            [4.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, 5.0],
        ];
        let corners = Corners::new(corners, NONE);
        let middle = [2.0, 1.5, 2.5];
        assert_eq!(corners.center(), Center::At(middle));
        assert_eq!(corners.exact(), Center::At(middle));
        assert_eq!(corners.pairs(), Some(middle));
    }

    #[test]
    fn the_stages_agree_as_far_as_they_promise() {
        let mut next = uniform(7);
        let mut plain = 0;
        for i in 0..4000 {
            let thin = if i % 2 == 0 { 1.0 } else { 1e-7 };
            let offset = [0.0, 1e3, -0.3][i % 3];
            let points = [(); 4].map(|()| [1.0, 1.0, thin].map(|s| offset + s * next()));
            if orient3d(points[0], points[1], points[2], points[3]) == Turn::Zero {
                continue;
            }
            let weights = if i % 5 == 0 {
                [next(), next(), next(), next()]
            } else {
                NONE
            };
            let corners = Corners::new(points, weights);
            let Center::At(exact) = corners.exact() else {
                panic!("in range")
            };
            assert!(corners.pairs().is_none_or(|p| p == exact));
            if let Some(found) = corners.plain() {
                plain += 1;
                for k in 0..3 {
                    let ulp = exact[k].abs().next_up() - exact[k].abs();
                    assert!((found[k] - exact[k]).abs() <= 4.0 * ulp);
                }
            }
        }
        assert!(plain > 100, "{plain}");
    }

    #[test]
    fn a_center_beyond_the_range_has_a_direction() {
        let flat = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 5e-324],
            [-1.0, 1.0, 5e-324],
            [-1.0, -1.0, 5e-324],
        ];
        let found = Corners::new(flat, NONE).center();
        assert!(
            matches!(found, Center::Beyond([_, _, z]) if z > 0.999),
            "{found:?}"
        );
    }

    #[test]
    fn normals_of_thin_triangles_are_those_of_integers() {
        let up = normal([0.0; 3], [1.0, 0.0, 0.0], [1.0, 1e-300, 0.0]);
        assert_eq!(up, [0.0, 0.0, 1.0]);
        let up = normal([0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0 + f64::EPSILON, 0.0]);
        assert_eq!(up, [0.0, 0.0, 1.0]);
    }
}
