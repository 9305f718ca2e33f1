//! Delaunay and regular triangulations of points that are periodic in x, in y, or both.
//!
//! The copies of the points one period away on all sides are triangulated with them; triangles with
//! a corner among the points themselves are those of the whole periodic set. Proof: let p be a
//! point, z a location in its cell and q a copy two periods away in x. Then z is at most half a
//! period from p in x, since the copies of p bound the cell there, and so the copy of q one period
//! nearer is strictly nearer to z. (N. P. Dolbilin and D. H. Huson, "Periodic Delone tilings",
//! 1997.) This holds if all points lie within one period, excluding its end.
//!
//! The coordinate of a copy, x + k L, is generally not a double. Predicates therefore use the pair
//! of point and periods: a filter on x - x' + (k - k') L with a bound that includes the rounding of
//! both, and integers on the exact sum. Nothing is rounded to a double before a sign is known. Ties
//! are broken by the lexicographic order of the copies, which no translation changes, so all
//! periods are triangulated alike.
//!
//! # The bounds of the filters
//!
//! Let u = 2^-53, m the largest of |x - x'| + |k - k'| L over the differences of a predicate, D the
//! largest rounded difference. A difference errs by at most 4 u m (three roundings). An orientation
//! has 2 monomials of degree 2, each off by 2 D 4 u m, and roundings of 4 u D^2: together less than
//! 32 u D (m + D). An in-circle test has 12 of degree 4, each off by 4 D^3 4 u m and roundings of
//! 16 u D^4: less than 256 u D^3 (m + D). With weights, and W the largest difference of two, a
//! square of up to 2 D^2 becomes a term of up to 2 D^2 + W, and the total error stays below 256 u D
//! (m + D) (D^2 + W). Magnitudes are kept between 2^-200 and 2^200.
//!
//! All copies of a site have the same weight, so the copy of q that is nearer to z also has less
//! power. Hence copies one period away suffice with weights, too.

use delone_predicates::{Point2, Sign};
use num_bigint::BigInt;

use super::insertion::{Sites, insert_all};
use super::power::{determinant, in_line};
use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::base::wide::{lowest, scaled, sign};
use crate::order::arrange;

const U: f64 = f64::EPSILON / 2.0;
/// 2^-200 and 2^200.
const RANGE: (f64, f64) = (
    f64::from_bits((1023 - 200) << 52),
    f64::from_bits((1023 + 200) << 52),
);

/// Copies of points.
pub struct Images<'a> {
    /// Coordinates.
    pub points: &'a [Point2],
    /// The lengths of the periods, 0 if not periodic.
    pub periods: Point2,
    /// Weights of the points; empty for none.
    pub weights: &'a [f64],
    /// The point of each copy, and the number of periods by which it is translated.
    pub of: Vec<(u32, [i32; 2])>,
}

/// A triangulation of copies.
#[derive(Debug)]
pub struct Copies {
    /// Triangles of copies.
    pub triangles: Arrays<3>,
    /// Copies in order along a line, if there is no triangle.
    pub chain: Vec<u32>,
    /// The row of each copy.
    pub rows: Vec<i32>,
    /// The number of periods by which each copy is translated.
    pub moved: Vec<[i32; 2]>,
}

/// Triangulates distinct points and the copies of them listed in `taken`: row, and periods in x and
/// y of -1, 0 or 1. A period of 0 means not periodic. With weights, one for each point, the
/// triangulation is the regular one.
pub fn of_copies(
    points: &[Point2],
    weights: &[f64],
    periods: Point2,
    taken: &[[i32; 3]],
    watch: &Watch,
) -> Result<Copies> {
    let images: Vec<(u32, [i32; 2])> = taken
        .iter()
        .map(|&[row, x, y]| (row as u32, [x, y]))
        .collect();
    // Rounded copies are only used for the insertion order; two may round to the same point.
    let mut near = with_room(images.len())?;
    let at = |&(row, moved): &(u32, [i32; 2]), share: f64| {
        let p = points[row as usize];
        [0, 1].map(|k| p[k] * share + f64::from(moved[k]) * (periods[k] * share))
    };
    near.extend(images.iter().map(|image| at(image, 1.0)));
    if !near.as_flattened().iter().all(|x| x.is_finite()) {
        // A copy may exceed the range of doubles, but by less than a factor of four.
        near.clear();
        near.extend(images.iter().map(|image| at(image, 0.25)));
    }
    let arranged = arrange(&near, 1, watch)?;
    let rest = arranged.duplicates.iter().map(|&[row, _]| row);
    let order: Vec<u32> = arranged.rows.iter().copied().chain(rest).collect();
    let sites = Images {
        points,
        periods,
        weights,
        of: order.iter().map(|&i| images[i as usize]).collect(),
    };
    let (triangles, chain) = match insert_all(&sites, order.len(), watch)? {
        Ok(triangles) => (triangles, Vec::new()),
        Err(chain) => (Arrays::default(), chain),
    };
    Ok(Copies {
        triangles,
        chain,
        rows: sites.of.iter().map(|&(row, _)| row as i32).collect(),
        moved: sites.of.iter().map(|&(_, moved)| moved).collect(),
    })
}

impl Images<'_> {
    /// Rounded differences to the last site, and the largest magnitude in any of them.
    fn differences<const N: usize>(&self, sites: [u32; N], last: u32) -> ([Point2; N], f64) {
        let (origin, zero) = self.of[last as usize];
        let origin = self.points[origin as usize];
        let mut most = 0.0_f64;
        let found = sites.map(|v| {
            let (row, moved) = self.of[v as usize];
            let p = self.points[row as usize];
            [0, 1].map(|k| {
                let inner = p[k] - origin[k];
                let outer = f64::from(moved[k] - zero[k]) * self.periods[k];
                most = most.max(inner.abs() + outer.abs());
                inner + outer
            })
        });
        (found, most)
    }

    /// Exact coordinates in units of a power of two, and its exponent.
    pub fn coordinates<const N: usize>(&self, sites: [u32; N]) -> ([[BigInt; 2]; N], i64) {
        let mut corners = vec![self.periods];
        corners.extend(sites.map(|v| self.points[self.of[v as usize].0 as usize]));
        let low = lowest(&corners, &sites.map(|v| self.weight(v)));
        let found = sites.map(|v| {
            let (row, moved) = self.of[v as usize];
            let p = self.points[row as usize];
            [0, 1].map(|k| scaled(p[k], low) + scaled(self.periods[k], low) * moved[k])
        });
        (found, low)
    }

    fn weight(&self, v: u32) -> f64 {
        let row = self.of[v as usize].0 as usize;
        self.weights.get(row).copied().unwrap_or(0.0)
    }

    /// The weights of some sites in units of 2^(2 low).
    pub fn exact_weights<const N: usize>(&self, sites: [u32; N], low: i64) -> [BigInt; N] {
        sites.map(|v| scaled(self.weight(v), 2 * low))
    }

    /// Exact differences to the last site.
    fn seen_from_last<const N: usize, const M: usize>(&self, sites: [u32; N]) -> [[BigInt; 2]; M] {
        const { assert!(M + 1 == N, "one site is the origin") }
        let (at, _) = self.coordinates(sites);
        std::array::from_fn(|i| [0, 1].map(|k| &at[i][k] - &at[M][k]))
    }
}

impl Images<'_> {
    fn exact_height(&self, sites: [u32; 4]) -> Sign {
        let (at, low) = self.coordinates(sites);
        let [wa, wb, wc, wd] = self.exact_weights(sites, low);
        let corners: [[BigInt; 2]; 3] =
            std::array::from_fn(|i| [0, 1].map(|k| &at[i][k] - &at[3][k]));
        determinant(&corners, [&wd - wa, &wd - wb, &wd - wc])
    }
}

/// The largest of some coordinates, if all magnitudes are in the range of the filters.
fn largest(points: &[Point2], most: f64) -> Option<f64> {
    let largest = points
        .as_flattened()
        .iter()
        .fold(0.0_f64, |d, x| d.max(x.abs()));
    let inside = |x: f64| x > RANGE.0 && x < RANGE.1;
    (inside(largest) && inside(most)).then_some(largest)
}

impl Sites for Images<'_> {
    fn turn(&self, [a, b, c]: [u32; 3]) -> Sign {
        let ([p, q], most) = self.differences([a, b], c);
        let det = p[0] * q[1] - p[1] * q[0];
        match largest(&[p, q], most) {
            Some(d) if det.abs() > 32.0 * U * d * (most + d) => Sign::of(det),
            _ => {
                let [p, q] = self.seen_from_last([a, b, c]);
                sign(&(&p[0] * &q[1] - &p[1] * &q[0]))
            }
        }
    }

    fn height(&self, [a, b, c, d]: [u32; 4]) -> Sign {
        let ([p, q, r], most) = self.differences([a, b, c], d);
        let w = [a, b, c, d].map(|v| self.weight(v));
        let extra = [w[3] - w[0], w[3] - w[1], w[3] - w[2]];
        let heaviest = extra.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let lifted = |v: Point2, w: f64| v[0] * v[0] + v[1] * v[1] + w;
        let cross = |v: Point2, w: Point2| v[0] * w[1] - v[1] * w[0];
        let det = lifted(p, extra[0]) * cross(q, r)
            + lifted(q, extra[1]) * cross(r, p)
            + lifted(r, extra[2]) * cross(p, q);
        let inside = heaviest == 0.0 || (heaviest > RANGE.0 && heaviest < RANGE.1);
        match largest(&[p, q, r], most).filter(|_| inside) {
            Some(size)
                if det.abs() > 256.0 * U * size * (most + size) * (size * size + heaviest) =>
            {
                Sign::of(det)
            }
            _ => self.exact_height([a, b, c, d]),
        }
    }

    fn height_in_line(&self, [a, b, p]: [u32; 3]) -> Sign {
        let sites = [b, p, a];
        let (at, low) = self.coordinates(sites);
        let [wb, wp, wa] = self.exact_weights(sites, low);
        let [b, p] = [0, 1].map(|i| [0, 1].map(|k| &at[i][k] - &at[2][k]));
        let height = |q: &[BigInt; 2], w| &q[0] * &q[0] + &q[1] * &q[1] - w + &wa;
        in_line([&b, &p], [height(&b, &wb), height(&p, &wp)])
    }

    fn smaller(&self, a: u32, b: u32) -> bool {
        let ([d], most) = self.differences([a], b);
        let sure = |x: f64| x.abs() > 8.0 * U * most && most > RANGE.0;
        if sure(d[0]) {
            return d[0] < 0.0;
        }
        let [[x, y]] = self.seen_from_last([a, b]);
        let zero = BigInt::ZERO;
        x < zero || (x == zero && y < zero)
    }
}
