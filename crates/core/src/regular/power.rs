//! Predicates of weighted sites in 2-D: orientation, and whether a lifted site is below the plane
//! of three.
//!
//! A site p of weight w is lifted to the height |p|^2 - w; the regular triangulation is the lower
//! hull of the lifted sites. With A = a - d and alpha = |A|^2 - w(a) + w(d), and likewise for b and
//! c, d lies below the plane of a, b and c (counterclockwise) if alpha (B x C) + beta (C x A) +
//! gamma (A x B) is positive.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53 and P the sum of the magnitudes of the monomials. A monomial goes through 4
//! differences, 2 products, 3 sums (the third with the difference of weights), the product, and one
//! of the last two sums: 11 roundings; 14 u P leaves room, as in the in-circle test without
//! weights. The filter is used only if all magnitudes are between 2^-200 and 2^200 or zero, so that
//! nothing overflows or underflows. Arbitrary-precision integers decide what it cannot.
//!
//! # Ties
//!
//! As without weights, the height of each site is lowered by an infinitesimal, infinitely larger
//! for a lexicographically smaller site. With weights, three of four coplanar lifted sites may be
//! collinear, so the smallest site need not decide: the first site decides whose cofactor, the
//! orientation of the other three, is not zero. If three sites are on one line in the plane and
//! their lifts are collinear, the middle one counts as above the other two.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};
use num_bigint::BigInt;

use super::insertion::Sites;
use crate::base::wide::{lowest, scaled, sign};

const BOUND: f64 = 14.0 * f64::EPSILON / 2.0;
/// 2^-200 and 2^200.
const RANGE: (f64, f64) = (
    f64::from_bits((1023 - 200) << 52),
    f64::from_bits((1023 + 200) << 52),
);

/// Distinct points and their weights.
#[derive(Clone, Copy)]
pub struct Weighted<'a, const D: usize = 2> {
    /// Coordinates.
    pub points: &'a [[f64; D]],
    /// Weights.
    pub weights: &'a [f64],
}

impl Sites for Weighted<'_> {
    fn turn(&self, [a, b, c]: [u32; 3]) -> Sign {
        let at = |v: u32| self.points[v as usize];
        orient2d(at(a), at(b), at(c))
    }

    fn height(&self, sites: [u32; 4]) -> Sign {
        let points = sites.map(|v| self.points[v as usize]);
        power_sign(points, sites.map(|v| self.weights[v as usize]))
    }

    fn height_in_line(&self, sites: [u32; 3]) -> Sign {
        let points = sites.map(|v| self.points[v as usize]);
        let weights = sites.map(|v| self.weights[v as usize]);
        let low = lowest(&points, &weights);
        let [a, b, p] = points.map(|p| p.map(|x| scaled(x, low)));
        let [wa, wb, wp] = weights.map(|w| scaled(w, 2 * low));
        let [b, p] = [b, p].map(|q| [&q[0] - &a[0], &q[1] - &a[1]]);
        let height = |q: &[BigInt; 2], w| &q[0] * &q[0] + &q[1] * &q[1] - w + &wa;
        in_line([&b, &p], [height(&b, &wb), height(&p, &wp)])
    }

    fn smaller(&self, a: u32, b: u32) -> bool {
        lexicographic(self.points[a as usize], self.points[b as usize]).is_lt()
    }
}

/// Whether p is below (positive) the line through the lifted origin and b, where b and p are
/// collinear with the origin and heights are relative to it.
pub(super) fn in_line([b, p]: [&[BigInt; 2]; 2], [hb, hp]: [BigInt; 2]) -> Sign {
    let k = usize::from(b[0] == BigInt::ZERO);
    sign(&(&p[k] * &hb - &b[k] * &hp)) * sign(&b[k])
}

/// Whether the fourth site is below the plane of the other three, lifted to |p|^2 - w: positive if
/// it is, for counterclockwise corners.
pub fn power_sign(points: [Point2; 4], weights: [f64; 4]) -> Sign {
    filter(points, weights).unwrap_or_else(|| exact(points, weights))
}

fn filter([a, b, c, d]: [Point2; 4], w: [f64; 4]) -> Option<Sign> {
    let [(ax, ay), (bx, by), (cx, cy)] = [a, b, c].map(|p| (p[0] - d[0], p[1] - d[1]));
    let [wa, wb, wc] = [w[3] - w[0], w[3] - w[1], w[3] - w[2]];
    let inside = |x: f64| x == 0.0 || (x.abs() > RANGE.0 && x.abs() < RANGE.1);
    if ![ax, ay, bx, by, cx, cy, wa, wb, wc]
        .iter()
        .all(|&x| inside(x))
    {
        return None;
    }
    let (bc, cb) = (bx * cy, by * cx);
    let (ca, ac) = (cx * ay, cy * ax);
    let (ab, ba) = (ax * by, ay * bx);
    let [aa, bb, cc] = [ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy];
    let det = (aa + wa) * (bc - cb) + (bb + wb) * (ca - ac) + (cc + wc) * (ab - ba);
    let permanent = (aa + wa.abs()) * (bc.abs() + cb.abs())
        + (bb + wb.abs()) * (ca.abs() + ac.abs())
        + (cc + wc.abs()) * (ab.abs() + ba.abs());
    (det.abs() > BOUND * permanent).then(|| Sign::of(det))
}

#[cold]
fn exact(points: [Point2; 4], weights: [f64; 4]) -> Sign {
    let low = lowest(&points, &weights);
    let [a, b, c, d] = points.map(|p| p.map(|x| scaled(x, low)));
    let [wa, wb, wc, wd] = weights.map(|w| scaled(w, 2 * low));
    let corners = [a, b, c].map(|p| [&p[0] - &d[0], &p[1] - &d[1]]);
    determinant(&corners, [wd.clone() - wa, wd.clone() - wb, wd - wc])
}

/// The sign of the determinant of three sites relative to the fourth, with `extra` added to the
/// squares of their distances.
pub(super) fn determinant([a, b, c]: &[[BigInt; 2]; 3], extra: [BigInt; 3]) -> Sign {
    let [ea, eb, ec] = extra;
    let height = |p: &[BigInt; 2], w| &p[0] * &p[0] + &p[1] * &p[1] + w;
    let cross = |p: &[BigInt; 2], q: &[BigInt; 2]| &p[0] * &q[1] - &p[1] * &q[0];
    let det = height(a, ea) * cross(b, c) + height(b, eb) * cross(c, a);
    sign(&(det + height(c, ec) * cross(a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    #[test]
    fn a_heavier_site_sinks_below_the_plane() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(power_sign(square, [0.0; 4]), Sign::Zero);
        assert_eq!(power_sign(square, [0.0, 0.0, 0.0, 1e-300]), Sign::Positive);
        assert_eq!(power_sign(square, [1e-300, 0.0, 0.0, 0.0]), Sign::Negative);
        assert_eq!(power_sign(square, [7.25; 4]), Sign::Zero);
    }

    #[test]
    fn the_filter_agrees_with_integers() {
        let mut next = uniform(3);
        let mut sure = 0;
        for _ in 0..2000 {
            let points = [(); 4].map(|()| [next(), next()]);
            let weights = [(); 4].map(|()| 0.2 * next());
            if let Some(sign) = filter(points, weights) {
                sure += 1;
                assert_eq!(sign, exact(points, weights));
            }
        }
        assert!(sure > 1900);
    }
}
