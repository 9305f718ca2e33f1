//! How much one distance exceeds another, even if both round to the same double.
//!
//! Let r be the point of a box around all facets that is nearest to the query q, which takes only
//! comparisons to find. The squared distance of a point p exceeds that of r by the sum, over the
//! axes, of |p - r| (|p - r| + 2 |q - r|): on an axis where q is outside the range of the box, the
//! box lies on the other side of r. No term is negative, so that sum keeps its digits even if both
//! distances round to the same double, and has an error bound of its own. What that bound leaves
//! undecided is compared in integers.

use std::array::from_fn;

use crate::base::points::Extent;

/// Error bound of a coordinate of the nearest point of a facet, relative to the largest
/// coordinate of its corners: weights of its corners, each with a few roundings.
const PLACE: f64 = 16.0 * f64::EPSILON;
/// Relative error bound of a sum of such products.
const SUM: f64 = 16.0 * f64::EPSILON;
/// Larger than the sum of all underflow errors.
const NOTHING: f64 = 1e-290;
/// Above this, differences of coordinates may overflow.
const LARGE: f64 = 1e300;

/// For points in a box, by how much their squared distance exceeds that of its nearest point, in a
/// unit of its own.
#[derive(Debug)]
pub struct Excess<const D: usize> {
    /// The nearest point of the box, and twice the vector from there to the query, in units.
    origin: [f64; D],
    reach: [f64; D],
    /// Factors of coordinates, first one that keeps differences in range.
    halved: f64,
    unit: f64,
    /// The factor from coordinates in this unit to those of the reach.
    across: f64,
}

impl<const D: usize> Excess<D> {
    /// For points in `extent` and query `q`.
    pub fn over(extent: &Extent<D>, q: [f64; D]) -> Self {
        let Extent { min, max } = extent;
        let origin: [f64; D] = from_fn(|k| q[k].clamp(min[k], max[k]));
        let is_large = |p: &[f64; D]| p.iter().any(|x| x.abs() > LARGE);
        let halved = if is_large(min) || is_large(max) {
            0.25
        } else {
            1.0
        };
        let away = if is_large(&q) { 0.25 } else { halved };
        let side = (0..D).fold(0.0_f64, |m, k| m.max(max[k] * halved - min[k] * halved));
        let way: [f64; D] = from_fn(|k| (q[k] * away - origin[k] * away).abs());
        let unit = unit_of(side);
        // `away` is at most `halved`, so nothing overflows here.
        let far = unit_of(way.iter().fold(side * (away / halved), |m, x| m.max(*x)));
        Self {
            origin,
            reach: way.map(|x| x * far * 2.0),
            halved,
            unit,
            across: (away / halved) * (far / unit),
        }
    }

    /// The difference of a coordinate from that of the nearest point of the box.
    fn beyond(&self, k: usize, x: f64) -> f64 {
        (x * self.halved - self.origin[k] * self.halved) * self.unit
    }

    /// A lower bound of the excess in a box.
    pub fn least(&self, extent: &Extent<D>) -> f64 {
        let sum: f64 = (0..D)
            .map(|k| {
                let gap = self
                    .beyond(k, extent.min[k])
                    .max(-self.beyond(k, extent.max[k]));
                let gap = gap.max(0.0);
                gap * (gap * self.across + self.reach[k])
            })
            .sum();
        sum * (1.0 - SUM) - NOTHING
    }

    /// Lower and upper bounds of the excess of the point with given corner weights.
    pub fn bounds<const K: usize>(&self, corners: &[[f64; D]; K], shares: [f64; K]) -> [f64; 2] {
        let (mut sum, mut lost) = (0.0, 0.0);
        for k in 0..D {
            let (mut at, mut most) = (0.0, 0.0_f64);
            for (corner, share) in corners.iter().zip(shares) {
                if share > 0.0 {
                    let way = self.beyond(k, corner[k]);
                    at += share * way;
                    most = most.max(way.abs());
                }
            }
            let (at, off) = (f64::abs(at), PLACE * most);
            sum += at * (at * self.across + self.reach[k]);
            lost += off * ((2.0 * at + off) * self.across + self.reach[k]);
        }
        let lost = 2.0 * lost + SUM * sum + NOTHING;
        [sum - lost, sum + lost]
    }
}

/// A power of two that scales a number to near 1; less so at the ends of the range.
fn unit_of(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1000, 1000)) as u64) << 52)
}
