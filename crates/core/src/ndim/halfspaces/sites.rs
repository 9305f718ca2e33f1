//! Half-spaces as rows of doubles, as rounded dual points, and as integers.

use std::cmp::Ordering;

use delone_predicates::arithmetic::{Pair, bit_span};
use num_bigint::BigInt;

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::wide::{lowest, ratio, scaled};
use crate::ndim::filter::{LEAST_VALUE, ROUNDED, U};

/// Magnitudes whose products, as pairs of doubles, do not overflow or underflow.
pub const SAFE: std::ops::Range<f64> = 1e-100..1e100;

/// Filters are valid if the exponent of the largest dual point is at least this.
const LEAST_EXPONENT: i32 = -50;

/// Rows of at most this many bits are kept as machine integers.
const SMALL: u32 = 62;

/// Half-spaces around a point.
pub struct Sites<'a, const D: usize, const V: usize, const P: usize> {
    /// The half-spaces.
    pub given: &'a [[f64; V]],
    /// The interior point.
    pub point: [f64; D],
    /// The dual points; each coordinate has a relative error below 3 u, or is infinite.
    pub dual: Vec<[f64; D]>,
    /// Dual points, scaled, as seen from a point inside of their hull; the last one is the origin.
    pub seen: Vec<[f64; P]>,
    /// Bounds on their lengths.
    pub reach: Vec<f64>,
    /// The part of their error that does not depend on their length.
    pub slack: f64,
    /// The exponent of the scale of `seen`.
    pub exponent: i32,
    /// The first row that is the same half-space, for rows that are vertices.
    pub first: Vec<u32>,
    /// The rows, each in its own unit, if they have few bits, and the width of the widest.
    pub small: Option<Vec<[i64; V]>>,
    pub bits: u32,
    /// The interior point in units of 2^low.
    units: [BigInt; D],
    low: i64,
}

impl<'a, const D: usize, const V: usize, const P: usize> Sites<'a, D, V, P> {
    /// Creates them from finite numbers. `Err` is the first row that does not contain the point strictly.
    pub fn new(given: &'a [[f64; V]], point: [f64; D]) -> Result<std::result::Result<Self, u32>> {
        let low = lowest(&[point], &[]).min(0);
        let mut sites = Self {
            given,
            point,
            dual: with_room(given.len())?,
            seen: Vec::new(),
            reach: Vec::new(),
            slack: 0.0,
            exponent: 0,
            first: with_room(given.len())?,
            small: None,
            bits: 0,
            units: point.map(|x| scaled(x, low)),
            low,
        };
        for (row, v) in (0u32..).zip(given) {
            let (scale, v) = leveled(v);
            let Some(depth) = sites.depth(row, &v, scale) else {
                return Ok(Err(row));
            };
            let is_safe = |x: &f64| *x == 0.0 || SAFE.contains(&x.abs());
            sites.dual.push(if v.iter().chain([&depth]).all(is_safe) {
                std::array::from_fn(|k| v[k] / depth)
            } else {
                sites.exact_dual(row)
            });
            sites.first.push(row);
        }
        sites.narrow()?;
        Ok(Ok(sites))
    }

    /// Keeps rows as machine integers if they fit.
    fn narrow(&mut self) -> Result<()> {
        let mut small = with_room(self.given.len() + 1)?;
        for row in 0..=self.given.len() as u32 {
            let v = self.row(row);
            let (low, width) = bit_span(&[v]).unwrap_or((0, SMALL + 1));
            if width > SMALL {
                return Ok(());
            }
            self.bits = self.bits.max(width);
            let unit = i64::from(low);
            // At most 62 bits.
            small.push(v.map(|x| i64::try_from(scaled(x, unit)).unwrap_or(0)));
        }
        self.small = Some(small);
        Ok(())
    }

    /// The number of half-spaces, which is also the row of the half-space that contains everything.
    pub fn len(&self) -> u32 {
        self.given.len() as u32
    }

    /// The vector of a half-space; the row after the last one is 0 x - 1 <= 0, whose boundary is at
    /// infinity.
    pub fn row(&self, w: u32) -> [f64; V] {
        let last = std::array::from_fn(|k| if k == D { -1.0 } else { 0.0 });
        self.given.get(w as usize).copied().unwrap_or(last)
    }

    /// The vector as integers, in its own unit.
    pub fn integers(&self, w: u32) -> [BigInt; V] {
        let v = self.row(w);
        let low = lowest(&[v], &[]);
        v.map(|x| scaled(x, low))
    }

    /// -(a p + b) for a scaled row, with a relative error of at most u, if it is positive.
    fn depth(&self, row: u32, v: &[f64; V], scale: i32) -> Option<f64> {
        let is_safe = |x: &f64| *x == 0.0 || SAFE.contains(&x.abs());
        if v.iter().chain(&self.point).all(is_safe) {
            let mut sum = Pair::from_double(v[D]);
            let mut size = v[D].abs();
            for k in 0..D {
                let product = Pair::product(v[k], self.point[k]);
                size += product.hi.abs();
                sum = sum + product;
            }
            // D sums err by 4 u^2 of the magnitudes each: less than u / 2 of the result.
            if sum.hi.abs() > (8 * D + 16) as f64 * U * size {
                return (sum.hi < 0.0).then_some(-sum.hi);
            }
        }
        let depth = self.exact_depth(row);
        if depth <= BigInt::ZERO {
            return None;
        }
        let unit = lowest(&[self.row(row)], &[]) + self.low - i64::from(scale);
        Some(ratio(&depth, &1.into(), unit).unwrap_or(f64::INFINITY))
    }

    /// A dual point, each coordinate correctly rounded.
    fn exact_dual(&self, row: u32) -> [f64; D] {
        let (v, depth) = (self.integers(row), self.exact_depth(row));
        let given = self.given[row as usize];
        std::array::from_fn(|k| {
            ratio(&v[k], &depth, -self.low).unwrap_or(f64::INFINITY.copysign(given[k]))
        })
    }

    /// -(a p + b) in units of the row and the point.
    fn exact_depth(&self, row: u32) -> BigInt {
        let v = self.integers(row);
        let sum: BigInt = (0..D).map(|k| &v[k] * &self.units[k]).sum();
        -(sum + (&v[D] << -self.low))
    }

    /// The lexicographic order of two dual points, exactly.
    pub fn compare(&self, i: u32, j: u32) -> Ordering {
        let (p, q) = (&self.dual[i as usize], &self.dual[j as usize]);
        let (a, b) = (&self.given[i as usize], &self.given[j as usize]);
        let mut exact = None;
        for k in 0..D {
            let (x, y) = (p[k], q[k]);
            if (x - y).abs() > 8.0 * U * (x.abs() + y.abs()) + LEAST_VALUE {
                return x.total_cmp(&y);
            }
            if a[k] == 0.0 && b[k] == 0.0 {
                continue;
            }
            // a / |a p + b|: the units of the rows cancel, and that of the point is the same.
            let (a, b, of_a, of_b) = exact.get_or_insert_with(|| {
                let depths = (self.exact_depth(i), self.exact_depth(j));
                (self.integers(i), self.integers(j), depths.0, depths.1)
            });
            let order = (&a[k] * &*of_b).cmp(&(&b[k] * &*of_a));
            if order != Ordering::Equal {
                return order;
            }
        }
        Ordering::Equal
    }

    /// Scales dual points to lengths of about 1.
    pub fn scale(&mut self) -> Result<Vec<[f64; D]>> {
        let most = self
            .dual
            .as_flattened()
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        self.exponent = exponent_of(most);
        let (first, second) = factors(-self.exponent);
        let mut found = with_room(self.dual.len())?;
        found.extend(self.dual.iter().map(|q| q.map(|x| x * first * second)));
        Ok(found)
    }

    /// Makes scaled dual points relative to a point c.
    ///
    /// The true vector g* = q* - c and the rounded one g differ by at most u |g| from the subtraction and
    /// 3 u |q*| <= 3 u (|g*| + |c|): less than 6 u |g| plus the slack, which also covers underflow.
    pub fn look(&mut self, scaled: &[[f64; D]], c: &[f64; D]) -> Result<()> {
        let far = c.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.slack = 4.0 * U * ROUNDED * far + LEAST_VALUE;
        if self.exponent < LEAST_EXPONENT {
            // Subnormal dual points are not accurate enough: integers decide everything.
            self.slack = f64::INFINITY;
        }
        let (mut seen, mut reach) = (with_room(scaled.len() + 1)?, with_room(scaled.len() + 1)?);
        for q in scaled.iter().chain([&[0.0; D]]) {
            let g: [f64; P] = std::array::from_fn(|k| if k < D { q[k] - c[k] } else { 0.0 });
            reach.push(ROUNDED * g.iter().map(|x| x * x).sum::<f64>().sqrt() + LEAST_VALUE);
            seen.push(g);
        }
        (self.seen, self.reach) = (seen, reach);
        Ok(())
    }

    /// The numerator of the step from the interior point to `normal / normal[D]`, for all coordinates,
    /// and its denominator.
    pub fn step(&self, normal: &[BigInt; V]) -> ([BigInt; D], BigInt) {
        let last = &normal[D];
        let steps = std::array::from_fn(|k| (&normal[k] << -self.low) - last * &self.units[k]);
        (steps, last << -self.low)
    }
}

/// A row times the power of two that makes its largest number about 1, and the exponent. What
/// underflows is less than 2^-1000 of the largest: such rows are not [`SAFE`] for pairs of doubles.
pub fn leveled<const V: usize>(v: &[f64; V]) -> (i32, [f64; V]) {
    let most = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let exponent = exponent_of(most);
    let (first, second) = factors(-exponent);
    (exponent, v.map(|x| x * first * second))
}

/// An exponent such that 2^exponent is about `x`; 0 for zero, the least for subnormals.
pub fn exponent_of(x: f64) -> i32 {
    if x == 0.0 {
        return 0;
    }
    match (x.to_bits() >> 52 & 0x7ff) as i32 {
        0 => -1060,
        biased => biased - 1023,
    }
}

/// Two factors whose product is 2^exponent, which may not be a double.
pub fn factors(exponent: i32) -> (f64, f64) {
    let power = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
    (power(exponent / 2), power(exponent - exponent / 2))
}
