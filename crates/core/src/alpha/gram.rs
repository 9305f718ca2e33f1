//! The smallest balls orthogonal to the sites of simplices in any dimension, as in `ball`.
//!
//! Let v_i be the k vectors from the first corner to the others, G their Gram matrix, and h_i as in
//! `ball`. The center of the ball is p_0 + sum m_i v_i with 2 G m = h, so |c|^2 = h G^-1 h / 4. Both that
//! and the power of a site q with the vector v and the height h_q are quotients of determinants:
//!
//! | what | numerator | denominator |
//! |---|---|---|
//! | 4 \|c\|^2 | -det of G bordered by h, h and 0 | det G > 0 |
//! | power | det of G bordered by h, (v . v_i) and h_q | det G |
//!
//! Determinants are expanded row by row, with all minors of the first rows: n 2^(n - 1) products.
//!
//! # Rounding
//!
//! A monomial of a determinant of n rows is made of n entries, each a sum of d products of
//! differences, with two weights at most, and passes through n products and n sums of at most n terms.
//! That is at most n (d + 5) + n (n + 1) <= 207 operations for d = 8 and n = 9, of which products of pairs
//! err by 9 u^2: less than 256 units of `number`, four times what it counts with.
//! Vectors are scaled by a power of two, so that the largest component is about 1. Then all entries are
//! below 2^6, and what underflows changes a determinant by less than 2^-1000.

use delone_predicates::Sign;
use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use super::number::{Number, Rough, Rounded, certain};
use crate::base::wide::{lowest, ratio, scaled, sign};

/// Exponents of the largest component that are scaled.
const SCALED: std::ops::Range<i32> = -450..450;

/// Weights that are scaled, in units of the square of the largest component.
const HEAVY: f64 = (1_u64 << 50) as f64;

/// Points with any number of coordinates, and weights; empty without.
#[derive(Clone, Copy)]
pub struct Cloud<'a> {
    /// The coordinates of all rows.
    pub points: &'a [f64],
    /// The number of coordinates.
    pub dimension: usize,
    /// Weights of all rows, or none.
    pub weights: &'a [f64],
}

/// Vectors from the first site to others, and their heights.
struct Lifted<N> {
    to: Vec<N>,
    heights: Vec<N>,
}

impl<'a> Cloud<'a> {
    fn at(&self, row: i32) -> &'a [f64] {
        &self.points[row as usize * self.dimension..][..self.dimension]
    }

    /// The weight of a row.
    pub fn weight(&self, row: i32) -> f64 {
        self.weights.get(row as usize).copied().unwrap_or(0.0)
    }

    /// The power of two by which vectors are multiplied; `None` if that could lose something.
    fn scale(&self, rows: &[i32]) -> Option<f64> {
        let first = self.at(rows[0]);
        let mut most = 0.0_f64;
        for &row in &rows[1..] {
            for (x, o) in self.at(row).iter().zip(first) {
                // Written so that NaN of differences that overflow stays.
                let size = (x - o).abs();
                most = if size <= most { most } else { size };
            }
        }
        let exponent = (most.to_bits() >> 52) as i32 - 1023;
        if !SCALED.contains(&exponent) {
            return None;
        }
        let scale = f64::from_bits(((1023 - exponent) as u64) << 52);
        let is_light = |&row: &i32| self.weight(row).abs() * scale * scale < HEAVY;
        (self.weights.is_empty() || rows.iter().all(is_light)).then_some(scale)
    }

    /// Rounded vectors, scaled.
    fn rounded<T: Rounded>(&self, rows: &[i32], scale: f64) -> Lifted<Rough<T>> {
        let first = self.at(rows[0]);
        let mut to = Vec::with_capacity((rows.len() - 1) * self.dimension);
        let mut heights = Vec::with_capacity(rows.len() - 1);
        for &row in &rows[1..] {
            let start = to.len();
            let steps = self.at(row).iter().zip(first);
            to.extend(steps.map(|(x, o)| Rough::difference(x * scale, o * scale)));
            let mut height = dot(&to[start..], &to[start..]);
            if !self.weights.is_empty() {
                let heavy = |row: i32| self.weight(row) * scale * scale;
                height = height + Rough::difference(heavy(rows[0]), heavy(row));
            }
            heights.push(height);
        }
        Lifted { to, heights }
    }

    /// The exponent of a unit of which all coordinates are multiples; of weights, its square.
    fn unit(&self, rows: &[i32]) -> i64 {
        let of = |&row: &i32| {
            let points = self.at(row).as_chunks::<1>().0;
            lowest(points, &[self.weight(row)])
        };
        rows.iter().map(of).min().unwrap_or(0)
    }

    /// Vectors as integers, in the unit 2^low.
    fn integers(&self, rows: &[i32], low: i64) -> Lifted<BigInt> {
        let first = self.at(rows[0]);
        let (mut to, mut heights) = (Vec::new(), Vec::new());
        for &row in &rows[1..] {
            let start = to.len();
            let steps = self.at(row).iter().zip(first);
            to.extend(steps.map(|(&x, &o)| scaled(x, low) - scaled(o, low)));
            let weight = |row: i32| scaled(self.weight(row), 2 * low);
            heights.push(dot(&to[start..], &to[start..]) + weight(rows[0]) - weight(row));
        }
        Lifted { to, heights }
    }

    /// Vectors as integers of 128 bits, if there are no weights and determinants fit.
    fn on_grid(&self, rows: &[i32], scale: f64) -> Option<Lifted<i128>> {
        if !self.weights.is_empty() {
            return None;
        }
        let (n, d) = (rows.len() as u32 - 1, self.dimension as u32);
        // A determinant of n rows has n! monomials, n <= 9 of which have less than 20 bits.
        let entry = (127 - 20) / n - (u32::BITS - d.leading_zeros());
        // Components are at most 2 in magnitude, and entries at most d times their squares.
        let units = f64::from_bits(u64::from(1023 + entry / 2 - 2) << 52);
        let first = self.at(rows[0]);
        let (mut to, mut heights) = (Vec::new(), Vec::new());
        for &row in &rows[1..] {
            let start = to.len();
            for (x, o) in self.at(row).iter().zip(first) {
                let pair = Pair::difference(x * scale, o * scale);
                let integer = pair.hi * units;
                if pair.lo != 0.0 || integer != integer.trunc() {
                    return None;
                }
                to.push(integer as i128);
            }
            heights.push(dot(&to[start..], &to[start..]));
        }
        Some(Lifted { to, heights })
    }

    /// The squared radius of the smallest ball of a simplex, correctly rounded.
    pub fn radius(&self, corners: &[i32]) -> f64 {
        let weight = self.weight(corners[0]);
        if corners.len() == 1 {
            return 0.0 - weight;
        }
        let found = self.scale(corners).and_then(|scale| {
            let [n, d] = self.rounded::<Pair>(corners, scale).ball(self.dimension);
            // Not subnormal, as half of the largest component is less than the radius.
            Some(certain(wider(n), wider(d), weight * scale * scale)? / scale / scale)
        });
        // Adding 0 makes -0 the 0 that it is.
        found.unwrap_or_else(|| self.exact_radius(corners)) + 0.0
    }

    #[cold]
    #[inline(never)]
    fn exact_radius(&self, corners: &[i32]) -> f64 {
        let low = self.unit(corners);
        let [n, d] = self.integers(corners, low).ball(self.dimension);
        let below: BigInt = d * 4;
        let above = n - &below * scaled(self.weight(corners[0]), 2 * low);
        let infinite = if above < BigInt::ZERO {
            f64::NEG_INFINITY
        } else {
            f64::INFINITY
        };
        ratio(&above, &below, 2 * low).unwrap_or(infinite)
    }

    /// Whether a site is in conflict with the smallest ball of a simplex. `rows` has the corners and
    /// the site, last.
    pub fn meets(&self, rows: &[i32]) -> bool {
        let d = self.dimension;
        if let Some(scale) = self.scale(rows) {
            let power = self.rounded::<f64>(rows, scale).power(d);
            if let Some(sign) = wider(power).sign() {
                return sign == Sign::Negative;
            }
            if let Some(lifted) = self.on_grid(rows, scale) {
                return lifted.power(d) < 0;
            }
            let power = self.rounded::<Pair>(rows, scale).power(d);
            if let Some(sign) = wider(power).sign() {
                return sign == Sign::Negative;
            }
        }
        let power = self.integers(rows, self.unit(rows)).power(d);
        sign(&power) == Sign::Negative
    }
}

/// A number with four times the error.
fn wider<T: Rounded>(x: Rough<T>) -> Rough<T> {
    Rough {
        size: 4.0 * x.size,
        ..x
    }
}

fn dot<N: Number>(p: &[N], q: &[N]) -> N {
    let product = |k: usize| p[k].clone() * q[k].clone();
    (1..p.len()).fold(product(0), |sum, k| sum + product(k))
}

impl<N: Number> Lifted<N> {
    /// The rows of the Gram matrix of the first `k` vectors, each with its height.
    fn bordered(&self, d: usize, k: usize) -> Vec<N> {
        let of = |i: usize| &self.to[i * d..(i + 1) * d];
        let mut m: Vec<N> = Vec::with_capacity((k + 1) * (k + 1));
        for i in 0..k {
            for j in 0..k {
                // It is symmetric.
                let entry = if j < i {
                    m[j * (k + 1) + i].clone()
                } else {
                    dot(of(i), of(j))
                };
                m.push(entry);
            }
            m.push(self.heights[i].clone());
        }
        m
    }

    /// Numerator and denominator of 4 |c|^2.
    fn ball(&self, d: usize) -> [N; 2] {
        let k = self.heights.len();
        let mut m = self.bordered(d, k);
        m.extend_from_slice(&self.heights);
        let minors = minors(&m, k + 1);
        let whole = signed(&minors, k + 1, (1 << (k + 1)) - 1);
        [whole.negated(), signed(&minors, k, (1 << k) - 1)]
    }

    /// The power of the last site, times the denominator.
    fn power(&self, d: usize) -> N {
        let k = self.heights.len() - 1;
        let last = &self.to[k * d..];
        if k == 0 {
            return self.heights[0].clone();
        }
        let mut m = self.bordered(d, k);
        m.extend((0..k).map(|j| dot(last, &self.to[j * d..(j + 1) * d])));
        m.push(self.heights[k].clone());
        signed(&minors(&m, k + 1), k + 1, (1 << (k + 1)) - 1)
    }
}

/// The minors of the first rows of a matrix of n columns, by the set of their columns, without their
/// signs: each is expanded along its last row with alternating signs that begin with plus. An entry
/// that is missing at the end is zero.
fn minors<N: Number>(m: &[N], n: usize) -> Vec<N> {
    let mut found: Vec<N> = Vec::with_capacity(1 << n);
    found.push(N::one());
    for set in 1..1_usize << n {
        let row = set.count_ones() as usize - 1;
        let (mut sum, mut plus) = (None, true);
        for column in (0..n).filter(|column| set >> column & 1 == 1) {
            if let Some(entry) = m.get(row * n + column) {
                let term = entry.clone() * found[set ^ 1 << column].clone();
                sum = Some(match sum {
                    None => term,
                    Some(sum) if plus => sum + term,
                    Some(sum) => sum - term,
                });
            }
            plus = !plus;
        }
        // Each row has an entry in the first column of a set.
        found.push(sum.unwrap_or_else(N::one));
    }
    found
}

/// A minor of n rows with its sign: that of row r has the sign (-1)^r more.
fn signed<N: Number>(minors: &[N], n: usize, set: usize) -> N {
    let minor = minors[set].clone();
    if n * (n - 1) / 2 % 2 == 1 {
        minor.negated()
    } else {
        minor
    }
}

#[cfg(test)]
mod tests {
    use super::super::ball::{self, Kind, Site};
    use super::*;
    use crate::base::random::uniform;

    #[test]
    fn balls_are_those_of_formulas_in_space() {
        let mut next = uniform(7);
        let mut met = [0; 2];
        for i in 0..600 {
            let (weighted, size) = (i % 2 == 1, [1.0, 1e-200, 1e90, 1e-5][i % 4]);
            let lattice = i % 3 == 0;
            let mut number = || {
                if lattice {
                    (next() * 4.0).floor()
                } else {
                    3.0 * next()
                }
            };
            let points: Vec<f64> = (0..15).map(|_| size * number()).collect();
            let weights: Vec<f64> = match weighted {
                true => (0..5).map(|_| size * size * number() / 4.0).collect(),
                false => Vec::new(),
            };
            let cloud = Cloud {
                points: &points,
                dimension: 3,
                weights: &weights,
            };
            let kind = Kind {
                weighted,
                moved: false,
            };
            let at = |row: usize| Site {
                at: [0, 1, 2].map(|k| points[3 * row + k]),
                shift: [0.0; 3],
                weight: cloud.weight(row as i32),
            };
            let rows = [0, 1, 2, 3, 4];
            let is_flat = |n: usize| {
                let lifted = cloud.integers(&rows[..n], cloud.unit(&rows[..n]));
                lifted.ball(3)[1] == BigInt::ZERO
            };
            if is_flat(2) || is_flat(3) || is_flat(4) {
                continue;
            }
            let [a, b, c, d] = [0, 1, 2, 3].map(at);
            assert_eq!(cloud.radius(&rows[..2]), ball::edge(kind, [a, b]));
            assert_eq!(cloud.radius(&rows[..3]), ball::triangle(kind, [a, b, c]));
            assert_eq!(
                cloud.radius(&rows[..4]),
                ball::tetrahedron(kind, [a, b, c, d])
            );
            let found = [cloud.meets(&rows[..3]), cloud.meets(&rows[..4])];
            let expected = [
                ball::meets_edge(kind, [a, b], c),
                ball::meets_triangle(kind, [a, b, c], d),
            ];
            assert_eq!(found, expected);
            assert_eq!(cloud.meets(&rows[..2]), ball::hides(kind, a, b));
            for found in found {
                met[usize::from(found)] += 1;
            }
        }
        assert!(met[0] > 200 && met[1] > 200, "{met:?}");
    }

    #[test]
    fn rounded_differences_are_not_taken_for_a_grid() {
        let near = 0.5_f64.powi(70);
        for (moved, met) in [(near, true), (0.0, false), (-near, false)] {
            // The product of the last point less the others is 2 - moved - 2.
            let points = [moved, 0.0, 0.0, 1.0, 3.0, 0.0, 2.0, 2.0, 0.0];
            let cloud = Cloud {
                points: &points,
                dimension: 3,
                weights: &[],
            };
            assert_eq!(cloud.meets(&[0, 1, 2]), met, "{moved}");
        }
    }
}
