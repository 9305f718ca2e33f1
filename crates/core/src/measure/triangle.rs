//! Quality of triangles: angles, area, radius and edge ratios.

use num_bigint::{BigInt, Sign};

use super::batch::{SHARE, columns, each};
use super::corners::{Corners, Integers, Measure, Number, Vectors, determinant2, in_units};
use crate::base::error::Result;
use crate::base::parallel::map_watched;
use crate::base::watch::Watch;
use crate::base::wide::{angle, lowest, ratio, root, scaled};

/// Squares whose relative difference is smaller are compared exactly: about eight roundings each.
const UNSURE: f64 = 1e-13;
/// How much larger than the smallest tangent so far a rounded one must be to be larger for sure:
/// inner products and tangents have relative errors of a few roundings.
const MARGIN: f64 = 1e-9;
/// Bounds the error of twice an area, as a share of the product of two sides: 2^-46, where four
/// roundings of such products are 2^-51.
const AREA_ERROR: f64 = f64::from_bits((1023 - 46) << 52);

/// For each triangle the smallest and the largest angle in degrees, the area, twice the inradius
/// over the circumradius, and the longest over the shortest edge.
pub fn qualities2(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<[Vec<f64>; 5]> {
    let quality = |corners| Corners::new(corners).measure(&Quality);
    columns(points, simplices, workers, watch, quality)
}

/// The smallest angle of all triangles in degrees, 180 if there are none: the least first number of
/// [`qualities2`].
pub fn smallest_angle(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<f64> {
    let shares = simplices.chunks(SHARE).collect();
    let least = map_watched(workers, shares, watch, |share| {
        let mut least = Least::new(180.0);
        for simplex in share {
            least.add(simplex.map(|v| points[v as usize]));
        }
        Ok(least.degrees)
    })?;
    Ok(least.into_iter().fold(180.0, f64::min))
}

/// The smallest angle so far.
struct Least {
    degrees: f64,
    /// Its tangent with a margin, infinite for right and obtuse angles.
    tangent: f64,
}

impl Least {
    fn new(degrees: f64) -> Self {
        let tangent = if degrees < 89.0 {
            degrees.to_radians().tan() * (1.0 + MARGIN)
        } else {
            f64::INFINITY
        };
        Self { degrees, tangent }
    }

    /// Takes the smallest angle of one more triangle into account.
    #[inline]
    fn add(&mut self, corners: [[f64; 2]; 3]) {
        let corners = Corners::new(corners);
        // Most triangles need no angle, and no more digits.
        if corners
            .rounded()
            .is_some_and(|sides| is_blunter(sides, self.tangent))
        {
            return;
        }
        let [found, ..] = corners.measure(&Quality);
        if found < self.degrees {
            *self = Self::new(found);
        }
    }
}

/// Whether the smallest angle of a triangle, given by its rounded vectors, surely has a larger tangent.
/// It is at the corner with the largest inner product, at which no digits cancel.
#[inline]
fn is_blunter(&[a, b]: &[[f64; 2]; 2], tangent: f64) -> bool {
    let c = [b[0] - a[0], b[1] - a[1]];
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let (_, most) = ends([dot(a, b), -dot(a, c), dot(b, c)]);
    let error = AREA_ERROR * (dot(a, a) * dot(b, b)).sqrt();
    determinant2(&[a, b]) - error > tangent * most
}

struct Quality;

impl Measure<2> for Quality {
    type Out = [f64; 5];

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 2]; 2]) -> T {
        determinant2(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 2>) -> [f64; 5] {
        let [a, b] = vectors.to;
        let c = [b[0] - a[0], b[1] - a[1]];
        let dot = |p: [T; 2], q: [T; 2]| (p[0] * q[0] + p[1] * q[1]).value();
        let twice = determinant2(&vectors.to).value();
        // The cotangent of the angle at a corner is the inner product over twice the area.
        let dots = [dot(a, b), -dot(a, c), dot(b, c)];
        let lengths = [a, b, c].map(|v| dot(v, v).sqrt());
        let (least, most) = ends(dots);
        let (short, long) = ends(lengths);
        let around = lengths.iter().sum::<f64>() * lengths.iter().product::<f64>();
        [
            twice.atan2(most).to_degrees(),
            twice.atan2(least).to_degrees(),
            in_units(twice / 2.0, 2 * vectors.exponent),
            // Rounding must not give an equilateral triangle more than 1.
            (4.0 * twice * (twice / around)).min(1.0),
            long / short,
        ]
    }

    fn exact(&self, vectors: &Integers<2>) -> [f64; 5] {
        let [a, b] = &vectors.to;
        let c = [&b[0] - &a[0], &b[1] - &a[1]];
        let dot = |p: &[BigInt; 2], q: &[BigInt; 2]| &p[0] * &q[0] + &p[1] * &q[1];
        let twice = &a[0] * &b[1] - &a[1] * &b[0];
        let mut dots = [dot(a, b), -dot(a, &c), dot(b, &c)];
        dots.sort();
        let mut lengths = [a, b, &c].map(|v| root(&dot(v, v)));
        lengths.sort();
        let around = lengths.iter().sum::<BigInt>() * lengths.iter().product::<BigInt>();
        // Four lengths, each scaled by 2^64.
        let squares = (&twice * &twice) << (2 + 4 * 64_u32);
        let infinite = f64::INFINITY;
        [
            angle(&twice, &dots[2]).to_degrees(),
            angle(&twice, &dots[0]).to_degrees(),
            ratio(&twice, &BigInt::from(2), 2 * vectors.low).unwrap_or(infinite),
            ratio(&squares, &around, 0).unwrap_or(1.0).min(1.0),
            ratio(&lengths[2], &lengths[0], 0).unwrap_or(infinite),
        ]
    }
}

/// Which triangles have an angle below a bound, given by its squared cosine. Exact for that double:
/// an angle is smaller if its squared cosine is larger.
pub fn below(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    squared_cosine: f64,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<i32>> {
    each(points, simplices, workers, watch, |corners| {
        i32::from(is_below(corners, squared_cosine))
    })
}

/// Whether one triangle has such an angle.
#[inline]
pub fn is_below(corners: [[f64; 2]; 3], squared_cosine: f64) -> bool {
    let below = Below { squared_cosine };
    let corners = Corners::new(corners);
    let found = corners.measure(&below);
    found.unwrap_or_else(|| below.decided(&corners.integers()))
}

/// Whether the smallest angle is below a bound; `None` if that is uncertain.
struct Below {
    squared_cosine: f64,
}

impl Measure<2> for Below {
    type Out = Option<bool>;

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 2]; 2]) -> T {
        determinant2(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 2>) -> Option<bool> {
        let [a, b] = vectors.to;
        let c = [b[0] - a[0], b[1] - a[1]];
        let dot = |p: [T; 2], q: [T; 2]| (p[0] * q[0] + p[1] * q[1]).value();
        let [aa, bb, cc] = [dot(a, a), dot(b, b), dot(c, c)];
        // The smallest angle is opposite the shortest edge; on a tie either is right.
        let (inner, beside) = if cc <= aa && cc <= bb {
            (dot(a, b), aa * bb)
        } else if aa <= bb {
            (dot(b, c), bb * cc)
        } else {
            (-dot(a, c), aa * cc)
        };
        let over = inner * inner - self.squared_cosine * beside;
        (over.abs() > UNSURE * beside).then_some(over > 0.0)
    }

    fn exact(&self, vectors: &Integers<2>) -> Option<bool> {
        Some(self.decided(vectors))
    }
}

impl Below {
    #[cold]
    fn decided(&self, vectors: &Integers<2>) -> bool {
        let [a, b] = &vectors.to;
        let c = [&b[0] - &a[0], &b[1] - &a[1]];
        let dot = |p: &[BigInt; 2], q: &[BigInt; 2]| &p[0] * &q[0] + &p[1] * &q[1];
        let [aa, bb, cc] = [a, b, &c].map(|v| dot(v, v));
        let low = lowest(&[[self.squared_cosine]], &[]).min(0);
        let bound = scaled(self.squared_cosine, low);
        let sharp = |inner: BigInt, beside: BigInt| {
            inner.sign() == Sign::Plus && ((&inner * &inner) << -low as u64) > beside * &bound
        };
        sharp(dot(a, b), &aa * &bb) || sharp(dot(b, &c), &bb * &cc) || sharp(-dot(a, &c), aa * cc)
    }
}

/// The smallest and the largest of three numbers.
#[inline]
fn ends([a, b, c]: [f64; 3]) -> (f64, f64) {
    (a.min(b).min(c), a.max(b).max(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_angle_is_the_least_of_all_qualities() {
        let mut state = 7_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / f64::from(1 << 30) / 2.0
        };
        let mut sharp = 0;
        for round in 0..60 {
            // Triangles of all shapes: the third corner is near the line through the others, as near
            // as a few units in the last place, and the unit is small, large, or beyond squares.
            let unit = 2.0_f64.powi([0, -1000, 900, -300, 30][round % 5]);
            let (mut points, mut simplices) = (Vec::new(), Vec::new());
            for t in 0..3 * SHARE as i32 / 2 {
                let [a, b] = [[random(), random()], [random(), random()]];
                let (share, aside) = (random(), 2.0_f64.powi(-(round as i32 % 12) * 4) * random());
                let c = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                let c = [c[0] - aside * (b[1] - a[1]), c[1] + aside * (b[0] - a[0])];
                if delone_predicates::orient2d(a, b, c) == delone_predicates::Sign::Positive {
                    let first = points.len() as i32;
                    let turn = t % 3;
                    points.extend([a, b, c].map(|p| p.map(|x| x * unit)));
                    simplices.push([0, 1, 2].map(|k| first + (k + turn) % 3));
                }
            }
            let watch = Watch::idle();
            let all = qualities2(&points, &simplices, 1, &watch).unwrap();
            let least = all[0].iter().copied().fold(180.0, f64::min);
            sharp += usize::from(least < 1e-6);
            for workers in [1, 3] {
                let found = smallest_angle(&points, &simplices, workers, &watch).unwrap();
                assert_eq!(found, least, "round {round}");
            }
        }
        assert!(sharp > 10);
        assert_eq!(smallest_angle(&[], &[], 1, &Watch::idle()).unwrap(), 180.0);
    }

    #[test]
    fn the_stages_agree_where_all_are_accurate() {
        let right = [[4.0, 0.0], [4.0, 3.0], [0.0, 0.0]];
        let corners = Corners::new(right);
        let plain = corners.measure(&Quality);
        let area = 6.0;
        assert_eq!(plain[1], 90.0);
        assert_eq!(plain[2], area);
        assert!((plain[0] - 0.75_f64.atan().to_degrees()).abs() < 1e-14);
        assert!((plain[3] - 0.8).abs() < 1e-15);
        let exact = Quality.exact(&corners.integers());
        for (p, q) in plain.iter().zip(exact) {
            assert!(
                (p - q).abs() <= 4.0 * f64::EPSILON * q.abs(),
                "{plain:?} {exact:?}"
            );
        }
        let pairs = Quality.of(&corners.pairs().unwrap());
        for (p, q) in pairs.iter().zip(exact) {
            assert!(
                (p - q).abs() <= 4.0 * f64::EPSILON * q.abs(),
                "{pairs:?} {exact:?}"
            );
        }
    }
}
