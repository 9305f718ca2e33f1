//! Circumcenters and power centers of three sites, correctly rounded or within 4 ulp.
//!
//! With the first corner a as the origin, d = b - a and e = c - a, the point u with equal power to
//! all three solves 2 u.d = |d|^2 + w(a) - w(b) = L and 2 u.e = |e|^2 + w(a) - w(c) = M, so that
//!
//! ```text
//! u = (e_y L - d_y M, d_x M - e_x L) / (2 d x e),    center = a + u
//! ```
//!
//! and without weights it is the circumcenter. Three stages, each certain of what it returns:
//!
//! 1. *Plain*: in doubles, with a bound on the error, accepted up to 4 units in the last place.
//! 2. *Pairs*: the same in double-double arithmetic, accepted if the whole interval of the error
//!    rounds to one double: correctly rounded.
//! 3. *Exact*: arbitrary-precision integers, correctly rounded, in any range.
//!
//! The corner that serves as the origin is the lexicographically smallest one, so the result is
//! independent of the order of the corners.
//!
//! # The bound of the plain stage
//!
//! Let u = 2^-53, N the numerator of a component, D = 2 d x e, and P, Q the sums of the magnitudes
//! of their monomials. A monomial of N goes through 3 differences, 2 products and 3 sums, one of D
//! through 2 differences, a product and a sum: N errs by at most 10 u P, D by 5 u Q, with room for
//! terms of second order. If D > 10 u Q, the quotient q = N / D errs by 2 u (10 P + 5 |q| Q) /
//! |D| + u |q|, and x = a + q by u |x| more. Underflow is negligible while P, Q > 2^-700 and all
//! differences and weights are below 2^300.

use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::{Point2, lexicographic};
use num_bigint::{BigInt, Sign};

use super::center::{Center, Centered};
use super::component::component;
use crate::base::wide::{lowest, ratio, scaled};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Below this a sum of magnitudes may be inaccurate because of underflow, see the head of the file.
const SMALL: f64 = f64::from_bits((1023 - 700) << 52);
/// Differences and weights up to here cannot overflow in degree 3.
const LARGE: f64 = f64::from_bits((1023 + 300) << 52);

/// Three sites, counterclockwise, and their weights.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    points: [Point2; 3],
    weights: [f64; 3],
}

impl Centered<2, 3> for Corners {
    #[inline]
    fn new([a, b, c]: [Point2; 3], [u, v, w]: [f64; 3]) -> Self {
        Self {
            points: [a, b, c],
            weights: [u, v, w],
        }
    }

    #[inline]
    fn center(&self) -> Center<2> {
        match self.turned().plain() {
            Some(at) => Center::At(at),
            None => self.rounded(),
        }
    }

    #[cold]
    #[inline(never)]
    fn rounded(&self) -> Center<2> {
        self.pairs().map_or_else(|| self.exact(), Center::At)
    }

    fn coordinates(&self) -> [f64; 2] {
        let (Center::At(at) | Center::Beyond(at)) = self.exact();
        at
    }
}

impl Corners {
    /// Rotated so that the lexicographically smallest corner is first.
    #[inline]
    fn turned(&self) -> Self {
        let ([a, b, c], [u, v, w]) = (self.points, self.weights);
        let first = lexicographic(a, b).is_lt() && lexicographic(a, c).is_lt();
        let second = !first && lexicographic(b, c).is_lt();
        let (points, weights) = if first {
            ([a, b, c], [u, v, w])
        } else if second {
            ([b, c, a], [v, w, u])
        } else {
            ([c, a, b], [w, u, v])
        };
        Self { points, weights }
    }

    #[inline]
    fn plain(&self) -> Option<Point2> {
        let [a, b, c] = self.points;
        let [wa, wb, wc] = self.weights;
        let (dx, dy, ex, ey) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
        let (dw, ew) = (wa - wb, wa - wc);
        let (dd, ee) = (dx * dx + dy * dy, ex * ex + ey * ey);
        let (l, m) = (dd + dw, ee + ew);
        let (left, right) = (dx * ey, dy * ex);
        let (den, size) = (2.0 * (left - right), 2.0 * (left.abs() + right.abs()));
        let (big_l, big_m) = (dd + dw.abs(), ee + ew.abs());
        let px = ey.abs() * big_l + dy.abs() * big_m;
        let py = dx.abs() * big_m + ex.abs() * big_l;
        let (qx, qy) = ((ey * l - dy * m) / den, (dx * m - ex * l) / den);
        let (x, y) = (a[0] + qx, a[1] + qy);
        let certain = |q: f64, p: f64, x: f64| {
            20.0 * p + 10.0 * q.abs() * size <= (3.0 * x.abs() - q.abs()) * den
        };
        // Separate comparisons, so that NaN fails each.
        let sure = den > 10.0 * U * size
            && size > SMALL
            && px > SMALL
            && py > SMALL
            && big_l < LARGE
            && big_m < LARGE
            && certain(qx, px, x)
            && certain(qy, py, y);
        sure.then_some([x, y])
    }

    fn pairs(&self) -> Option<Point2> {
        if !is_safe(&self.points) || !is_safe(&[self.weights]) {
            return None;
        }
        let [a, b, c] = self.points;
        let [wa, wb, wc] = self.weights;
        let [dx, dy, ex, ey] = [
            Pair::difference(b[0], a[0]),
            Pair::difference(b[1], a[1]),
            Pair::difference(c[0], a[0]),
            Pair::difference(c[1], a[1]),
        ];
        let (dw, ew) = (Pair::difference(wa, wb), Pair::difference(wa, wc));
        let (dd, ee) = (dx.square() + dy.square(), ex.square() + ey.square());
        let (l, m) = (dd + dw, ee + ew);
        let (left, right) = (dx * ey, dy * ex);
        let half = left - right;
        let size = left.hi.abs() + right.hi.abs();
        // A product and a sum may err by 13 u^2, see `Pair`.
        if half.hi <= 64.0 * U * U * size {
            return None;
        }
        let (big_l, big_m) = (dd.hi + dw.hi.abs(), ee.hi + ew.hi.abs());
        let px = ey.hi.abs() * big_l + dy.hi.abs() * big_m;
        let py = dx.hi.abs() * big_m + ex.hi.abs() * big_l;
        // N errs by 30 u^2 P, D by 13 u^2 of its size: doubled, with room.
        let x = component(a[0], ey * l - dy * m, px, half, size, 64.0)?;
        let y = component(a[1], dx * m - ex * l, py, half, size, 64.0)?;
        Some([x, y])
    }

    fn exact(&self) -> Center<2> {
        let low = lowest(&self.points, &self.weights);
        let at = |x: f64| scaled(x, low);
        let weights = self.weights.map(|w| scaled(w, 2 * low));
        meeting(&self.points.map(|p| p.map(at)), &weights, low)
    }
}

/// The center of three sites whose coordinates are integers in units of 2^low, and whose weights
/// are in units of its square.
pub(crate) fn meeting(
    [a, b, c]: &[[BigInt; 2]; 3],
    [wa, wb, wc]: &[BigInt; 3],
    low: i64,
) -> Center<2> {
    let (dx, dy, ex, ey) = (&b[0] - &a[0], &b[1] - &a[1], &c[0] - &a[0], &c[1] - &a[1]);
    let l = &dx * &dx + &dy * &dy + wa - wb;
    let m = &ex * &ex + &ey * &ey + wa - wc;
    let den = (&dx * &ey - &dy * &ex) * 2;
    let x = &ey * &l - &dy * &m + &a[0] * &den;
    let y = &dx * &m - &ex * &l + &a[1] * &den;
    match (ratio(&x, &den, low), ratio(&y, &den, low)) {
        (Some(x), Some(y)) => Center::At([x, y]),
        (x_found, y_found) => {
            let far = |n: &BigInt| {
                f64::INFINITY.copysign(if n.sign() == Sign::Minus { -1.0 } else { 1.0 })
            };
            Center::Beyond([
                x_found.unwrap_or_else(|| far(&x)),
                y_found.unwrap_or_else(|| far(&y)),
            ])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;
    use delone_predicates::{Sign as Turn, orient2d};

    const NONE: [f64; 3] = [0.0; 3];

    #[test]
    fn the_center_of_a_right_triangle_halves_its_longest_side() {
        let corners = Corners::new([[4.0, 0.0], [4.0, 3.0], [0.0, 0.0]], NONE);
        assert_eq!(corners.center(), Center::At([2.0, 1.5]));
        assert_eq!(corners.exact(), Center::At([2.0, 1.5]));
        assert_eq!(corners.pairs(), Some([2.0, 1.5]));
    }

    #[test]
    fn the_stages_agree_as_far_as_they_promise() {
        let mut next = uniform(7);
        let mut plain = 0;
        for i in 0..4000 {
            let thin = if i % 2 == 0 { 1.0 } else { 1e-9 };
            let offset = [0.0, 1e6, -0.3][i % 3];
            let [a, b, c] = [(); 3].map(|()| [offset + next(), offset + next() * thin]);
            let points = match orient2d(a, b, c) {
                Turn::Positive => [a, b, c],
                Turn::Negative => [a, c, b],
                Turn::Zero => continue,
            };
            let weights = if i % 5 == 0 {
                [next(), next(), next()]
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
                for k in 0..2 {
                    let ulp = exact[k].abs().next_up() - exact[k].abs();
                    assert!((found[k] - exact[k]).abs() <= 4.0 * ulp);
                }
            }
        }
        assert!(plain > 500);
    }

    #[test]
    fn a_center_beyond_the_range_has_infinite_coordinates() {
        let flat = [[0.0, 0.0], [1.0, 5e-324], [-1.0, 5e-324]];
        assert_eq!(
            Corners::new(flat, NONE).center(),
            Center::Beyond([0.0, f64::INFINITY])
        );
        let far = [[0.0, 0.0], [f64::MAX, 0.0], [0.0, f64::MAX]];
        let half = f64::MAX / 2.0;
        assert_eq!(Corners::new(far, NONE).center(), Center::At([half, half]));
    }
}
