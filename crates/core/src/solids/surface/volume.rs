//! The signed volume of triangles, correctly rounded, with its exact sign.
//!
//! Six times the volume is the sum of the determinants of the triangles' corners. It is computed
//! in double-double arithmetic with an error bound; if that does not decide the double nearest to
//! the volume, in integers.
//!
//! # The bound
//!
//! Let u = 2^-53. Products and sums of pairs have a relative error below 8 u^2 (M. Joldes,
//! J.-M. Muller and V. Popescu, 2017) if nothing overflows or underflows, which `is_safe` ensures
//! for degree 3. A determinant goes through at most five of them: its error is below 64 u^2 times
//! the sum of the magnitudes of its six products. Each addition to the total adds 8 u^2 of the
//! total, at most (n + 1) of the sum of all magnitudes P. Together below 64 (n + 2) u^2 P, and
//! 128 (n + 2) u^2 P leaves room for the roundings of P.

use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::{Point3, Sign};
use num_bigint::BigInt;

use crate::base::error::Result;
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::base::wide::{determinant, lowest, ratio, scaled, sign};

/// Triangles per task.
const SHARE: usize = 1 << 14;
/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// A sum of determinants, and of the magnitudes of their products.
#[derive(Debug, Clone, Copy)]
struct Total {
    sum: Pair,
    magnitude: f64,
    safe: bool,
}

/// The volume, infinite beyond the range of doubles, and its exact sign.
pub fn volume(
    points: &[Point3],
    faces: &[[u32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<(f64, Sign)> {
    let shares: Vec<_> = faces.chunks(SHARE).collect();
    let corners = |face: &[u32; 3]| face.map(|v| points[v as usize]);
    let parts = parallel::map_watched(workers, shares.clone(), watch, |share| {
        let start = Total {
            sum: Pair::from_double(0.0),
            magnitude: 0.0,
            safe: true,
        };
        Ok(share
            .iter()
            .fold(start, |total, face| total.and(corners(face))))
    })?;
    let filtered = total_of(&parts).and_then(|total| total.volume(faces.len()));
    if let Some(found) = filtered {
        return Ok((found, Sign::of(found)));
    }
    let low = lowest(points, &[]);
    let sums = parallel::map_watched(workers, shares, watch, |share| {
        let mut pace = Pace::new(watch, SHARE / 16);
        let mut sum = BigInt::ZERO;
        for face in share {
            pace.spend(1)?;
            let [a, b, c] = corners(face).map(|p| p.map(|x| scaled(x, low)));
            sum += determinant([&a, &b, &c]);
        }
        Ok(sum)
    })?;
    let six: BigInt = sums.into_iter().sum();
    Ok((nearest(&six, low), sign(&six)))
}

/// A sixth of `six`, in units of 2^(3 low).
fn nearest(six: &BigInt, low: i64) -> f64 {
    let infinite = if sign(six) == Sign::Negative {
        f64::NEG_INFINITY
    } else {
        f64::INFINITY
    };
    ratio(six, &BigInt::from(6), 3 * low).unwrap_or(infinite)
}

/// The total of parts; `None` if one of them is not safe.
fn total_of(parts: &[Total]) -> Option<Total> {
    let start = Total {
        sum: Pair::from_double(0.0),
        magnitude: 0.0,
        safe: true,
    };
    let total = parts.iter().fold(start, |a, b| Total {
        sum: a.sum + b.sum,
        magnitude: a.magnitude + b.magnitude,
        safe: a.safe && b.safe,
    });
    total.safe.then_some(total)
}

impl Total {
    fn and(self, corners: [Point3; 3]) -> Self {
        let [a, b, c] = corners;
        let minor = |j: usize, k: usize| {
            let (p, q) = (Pair::product(b[j], c[k]), Pair::product(b[k], c[j]));
            (p - q, p.hi.abs() + q.hi.abs())
        };
        let terms = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(i, j, k)| {
            let (value, magnitude) = minor(j, k);
            (Pair::from_double(a[i]) * value, a[i].abs() * magnitude)
        });
        let [x, y, z] = terms.map(|(value, _)| value);
        Self {
            sum: self.sum + (x + y + z),
            magnitude: self.magnitude + terms.iter().map(|(_, m)| m).sum::<f64>(),
            safe: self.safe && is_safe(&corners),
        }
    }

    /// The double nearest to a sixth of the sum of `n` determinants, if it is certain.
    fn volume(self, n: usize) -> Option<f64> {
        let bound = 128.0 * (n as f64 + 2.0) * U * U * self.magnitude;
        let quotient = self.sum.hi / 6.0;
        // What the quotient leaves: the product is exact as a pair.
        let rest = self.sum - Pair::product(quotient, 6.0);
        let [low, high] = [-bound, bound].map(|e| (rest.hi + rest.lo + e) / 6.0);
        // Room for the roundings of the two ends.
        let room = 8.0 * U * (low.abs() + high.abs());
        let (least, most) = (quotient + (low - room), quotient + (high + room));
        let certain = self.sum.hi.abs() > bound && least == most && quotient.is_normal();
        certain.then_some(least)
    }
}
