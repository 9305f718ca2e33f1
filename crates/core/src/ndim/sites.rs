//! The points of a triangulation, sorted, scaled, and as integers in one unit.
//!
//! Let all coordinates be multiples of 2^low and smaller than 2^high in magnitude. They are scaled by
//! 2^-high: all are below 1, and nothing overflows but inverses of thin simplices, whose bounds then
//! are not finite and send the decision to the integers. If high - low is at most [`WIDEST`], the
//! scaled coordinates are exact, differences that are not zero are at least 2^-400, and their squares
//! at least 2^-800: what underflows is far below the floors in `filter`. Otherwise no filter is used.

use delone_predicates::arithmetic::{Pair, bit_span, decode_odd};
use num_bigint::BigInt;

use super::filter::{Matrix, dot, minus};
use super::frame::Integers;
use super::residues::{Points, ROWS};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::wide;

/// Bits from the lowest to the highest of coordinates that the filters take.
pub const WIDEST: u32 = 400;

/// Differences of fewer bits are kept as machine integers. Two of them are added without overflow.
pub const SMALL: u32 = 61;

/// The coordinates of points in a flat that its axes leave out, padded with zeros.
pub type Rest = [f64; MOST];

/// The most coordinates of points.
pub const MOST: usize = ROWS - 1;

/// Distinct points in lexicographic order.
pub struct Sites<const D: usize, const P: usize> {
    /// The coordinates times 2^-high, and zeros.
    pub scaled: Vec<[f64; P]>,
    /// Whether `scaled` is exact and filters hold.
    pub filtered: bool,
    /// Differences are below 2^bits units.
    pub bits: u32,
    /// The unit of `scaled` is 2^unit.
    pub unit: i64,
    /// The weights times 2^(-2 high); none if all are zero.
    pub weights: Vec<f64>,
    /// Whether heights are not the squares of the coordinates alone: there are weights, or the
    /// points are in a flat, where the coordinates that its axes leave out count as well.
    pub is_lifted: bool,
    /// In a flat, the coordinates that its axes leave out.
    rest: Vec<Rest>,
    /// The same times 2^-high.
    scaled_rest: Vec<Rest>,
    /// The same in units, if they have few bits.
    small_rest: Vec<[i64; MOST]>,
    /// The coordinates as they were given.
    given: Vec<[f64; D]>,
    /// The weights as they were given.
    given_weights: Vec<f64>,
    /// The exponent of the unit of `given`.
    low: i64,
    /// The coordinates in units, if they have few bits.
    small: Option<Vec<[i64; D]>>,
}

impl<const D: usize, const P: usize> Sites<D, P> {
    /// From finite points, distinct and in lexicographic order.
    pub fn new(given: Vec<[f64; D]>) -> Result<Self> {
        Self::made(given, Vec::new(), Vec::new())
    }

    /// The same with finite weights, one for each point or none.
    pub fn weighted(given: Vec<[f64; D]>, given_weights: Vec<f64>) -> Result<Self> {
        Self::made(given, given_weights, Vec::new())
    }

    /// Points in a flat: the coordinates along its axes, and those that these determine.
    pub fn in_flat(given: Vec<[f64; D]>, rest: Vec<Rest>) -> Result<Self> {
        Self::made(given, Vec::new(), rest)
    }

    fn made(given: Vec<[f64; D]>, given_weights: Vec<f64>, rest: Vec<Rest>) -> Result<Self> {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        let mut widen = |span: Option<(i32, u32)>| {
            // A width of zero: all coordinates are zero.
            if let Some((least, width @ 1..)) = span {
                low = low.min(least);
                high = high.max(least + width as i32);
            }
        };
        for p in &given {
            widen(bit_span(&[*p]));
        }
        for p in &rest {
            widen(bit_span(&[*p]));
        }
        for &w in &given_weights {
            // Weights are multiples of 2^(2 low), and smaller than 2^(2 high).
            if let Some((least, width @ 1..)) = bit_span(&[[w]]) {
                low = low.min(least.div_euclid(2));
                high = high.max((least + width as i32 + 1).div_euclid(2));
            }
        }
        if low > high {
            (low, high) = (0, 1);
        }
        let span = (high - low) as u32;
        // Two factors, as one may not be a double.
        let (first, second) = (factor(-high / 2), factor(-high - (-high / 2)));
        let mut scaled = with_room(given.len())?;
        scaled.extend(
            given
                .iter()
                .map(|p| std::array::from_fn(|k| if k < D { p[k] * first * second } else { 0.0 })),
        );
        let mut weights = with_room(given_weights.len())?;
        weights.extend(
            given_weights
                .iter()
                .map(|w| w * first * second * first * second),
        );
        let mut scaled_rest = with_room(rest.len())?;
        scaled_rest.extend(rest.iter().map(|p| p.map(|x| x * first * second)));
        let mut sites = Self {
            scaled,
            is_lifted: !weights.is_empty() || !rest.is_empty(),
            weights,
            scaled_rest,
            small_rest: Vec::new(),
            filtered: span <= WIDEST,
            bits: span + 1,
            rest,
            unit: -i64::from(span),
            given,
            given_weights,
            low: i64::from(low),
            small: None,
        };
        if sites.bits <= SMALL {
            let mut small = with_room(sites.given.len())?;
            // Below 2^60 units, so `scaled` times a power of two is an integer, exactly.
            let units = factor(span as i32);
            small.extend(sites.scaled.iter().map(|p| {
                let integers: [i64; D] = std::array::from_fn(|k| (p[k] * units) as i64);
                integers
            }));
            sites.small = Some(small);
            let integers = |p: &Rest| p.map(|x| (x * units) as i64);
            sites.small_rest = with_room(sites.rest.len())?;
            sites
                .small_rest
                .extend(sites.scaled_rest.iter().map(integers));
        }
        Ok(sites)
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.given.len()
    }

    /// A coordinate as it was given, and the exponent of the unit.
    pub fn coordinate(&self, p: u32, k: usize) -> (f64, i64) {
        (self.given[p as usize][k], self.low)
    }

    /// Some of the points, in their order.
    pub fn only(&self, kept: &[u32]) -> Result<Self> {
        let (mut given, mut rest) = (with_room(kept.len())?, with_room(kept.len())?);
        given.extend(kept.iter().map(|&p| self.given[p as usize]));
        rest.extend(kept.iter().filter_map(|&p| self.rest_of(p)));
        Self::in_flat(given, rest)
    }

    /// The coordinates of points, as they were given.
    pub fn corners<const V: usize>(&self, v: &[u32; V]) -> [[f64; D]; V] {
        v.map(|p| self.given[p as usize])
    }

    /// The scaled differences of corners from the first one, rounded.
    #[inline(always)]
    pub fn differences<const V: usize>(&self, v: &[u32; V]) -> Matrix<D, P> {
        let o = &self.scaled[v[0] as usize];
        std::array::from_fn(|i| minus(&self.scaled[v[i + 1] as usize], o))
    }

    /// The coordinates of a point that its axes leave out, as they were given, if it is in a flat.
    fn rest_of(&self, p: u32) -> Option<&Rest> {
        self.rest.get(p as usize)
    }

    /// The scaled weight of `p` less that of `o`, rounded.
    ///
    /// Lifted heights may be measured from any point of a flat: that changes them by an affine
    /// function. From `o`, the height of `p` is the square of their distance, of which the coordinates
    /// that are not axes are a negative weight of `p`. It passes through a product and, in four
    /// parts, three sums, so with the differences it errs by at most 6 u of itself.
    #[inline(always)]
    pub fn weight(&self, p: u32, o: u32) -> f64 {
        if !self.is_lifted {
            return 0.0;
        }
        if self.weights.is_empty() {
            let d = minus(&self.scaled_rest[p as usize], &self.scaled_rest[o as usize]);
            return -dot(&d, &d);
        }
        self.weights[p as usize] - self.weights[o as usize]
    }

    /// The same in a pair of doubles: exactly with weights, and in a flat by the rule of `fine`, one
    /// product and at most six sums.
    pub fn weight_pair(&self, p: u32, o: u32) -> Pair {
        let mut sum = Pair::from_double(0.0);
        if !self.weights.is_empty() {
            sum = Pair::difference(self.weights[p as usize], self.weights[o as usize]);
        } else if self.is_lifted {
            let (p, o) = (&self.scaled_rest[p as usize], &self.scaled_rest[o as usize]);
            for k in 0..MOST - D {
                sum = sum - Pair::difference(p[k], o[k]).square();
            }
        }
        sum
    }

    /// Points as integers for residues.
    pub fn integers(&self, points: impl Iterator<Item = u32>) -> Points {
        let mut rows = [[(0, 0); ROWS - 1]; ROWS + 1];
        let mut weights = [(0, 0); ROWS + 1];
        let mut count = 0;
        let integer = |x: f64, low: i64| {
            let (odd, exponent) = decode_odd(x);
            let signed = if x < 0.0 { -(odd as i64) } else { odd as i64 };
            // The exponent of zero means nothing.
            let shift = (i64::from(exponent) - low) * i64::from(odd != 0);
            (signed, shift as u32)
        };
        for p in points {
            for k in 0..D {
                let (x, low) = self.coordinate(p, k);
                rows[count][k] = integer(x, low);
            }
            if let Some(rest) = self.rest_of(p) {
                for k in D..MOST {
                    rows[count][k] = integer(rest[k - D], self.low);
                }
            }
            if let Some(&w) = self.given_weights.get(p as usize) {
                weights[count] = integer(w, 2 * self.low);
            }
            count += 1;
        }
        Points {
            rows,
            weights,
            count,
            dimension: D,
            squares: if self.rest.is_empty() { D } else { MOST },
        }
    }

    /// log2 of a bound of the determinant of the differences of corners: Hadamard's inequality.
    pub fn log_determinant<const V: usize>(&self, v: &[u32; V]) -> f64 {
        let a: Matrix<D, P> = self.differences(v);
        a.iter().map(|row| 0.5 * dot(row, row).log2()).sum()
    }
}

impl<const D: usize, const P: usize> Integers for Sites<D, P> {
    fn small_weight(&self, p: u32, o: u32) -> i128 {
        if self.weights.is_empty() {
            let Some((p, o)) = self
                .small_rest
                .get(p as usize)
                .zip(self.small_rest.get(o as usize))
            else {
                return 0;
            };
            let square = |k: usize| i128::from(p[k] - o[k]).pow(2);
            return -(0..MOST - D).map(square).sum::<i128>();
        }
        // Below 2^120 squared units: a double times a power of two is an integer, exactly.
        let units = factor(-(self.unit as i32));
        let integer = |p: u32| (self.weights[p as usize] * units * units) as i128;
        integer(p) - integer(o)
    }

    fn wide_weight(&self, p: u32, o: u32) -> BigInt {
        if let Some((p, o)) = self.rest_of(p).zip(self.rest_of(o)) {
            let at = |x: f64| wide::scaled(x, self.low);
            let square = |k: usize| (at(p[k]) - at(o[k])).pow(2);
            return -(0..MOST - D).map(square).sum::<BigInt>();
        }
        let of = |p: u32| {
            let w = self.given_weights.get(p as usize);
            w.map_or(BigInt::ZERO, |&w| wide::scaled(w, 2 * self.low))
        };
        of(p) - of(o)
    }

    #[inline(always)]
    fn dimension(&self) -> usize {
        D
    }

    fn bits(&self) -> u32 {
        self.bits
    }

    fn is_small(&self) -> bool {
        self.small.is_some()
    }

    #[inline]
    fn small(&self, p: u32, o: u32, k: usize) -> Option<i64> {
        let small = self.small.as_ref()?;
        Some(small[p as usize][k] - small[o as usize][k])
    }

    fn wide(&self, p: u32, o: u32, k: usize) -> BigInt {
        match self.small(p, o, k) {
            Some(difference) => difference.into(),
            None => {
                let at = |q: u32| wide::scaled(self.given[q as usize][k], self.low);
                at(p) - at(o)
            }
        }
    }
}

/// 2^exponent, for exponents from -1022 to 1023.
pub fn factor(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}
