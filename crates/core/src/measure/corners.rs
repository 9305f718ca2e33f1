//! The vectors of a simplex from its last corner, in its own unit, and the stages of its
//! measurement.
//!
//! Coordinates enter only as differences to the last corner, so that no digits are lost far from
//! the origin, and in a unit in which the largest is about 1, so that nothing overflows or
//! underflows. For a thin simplex cancellation occurs: its determinant D is a small share of the
//! product P of the lengths of its vectors. So there are three stages:
//!
//! 1. *Plain*, in doubles, if D > 2^-5 P: at most five or six bits are lost.
//! 2. *Pairs* of doubles, if D > 2^-48 P. The vectors are exact then, and values of degree 3 err
//!    by about 40 u^2 P (see `Pair`), a share of 2^-52 of D.
//! 3. *Exact*, arbitrary-precision integers, for the rest.
//!
//! If the share of D is large, D is not the only accurate value. So are the vectors of the faces,
//! each at least D over the length of the edge that it omits, and the lengths of the edges.

use delone_predicates::arithmetic::{Pair, decode_odd};
use num_bigint::BigInt;

use crate::base::vector;
pub use crate::base::vector::{cross, dot};
use crate::base::wide::{lowest, scaled, times_power};

/// Above this share of the product of the lengths, a determinant in doubles is accurate enough.
const PLAIN: f64 = 1.0 / 32.0;
/// Above this share, one in double-double arithmetic is: 2^-48.
const PAIRED: f64 = f64::from_bits((1023 - 48) << 52);
/// Differences between these, 2^-40 and 2^60, need no unit of their own.
const SMALL: f64 = f64::from_bits((1023 - 40) << 52);
const LARGE: f64 = f64::from_bits((1023 + 60) << 52);
/// Coordinates above this, 2^-200, have differences whose products of four do not underflow,
/// including their low parts: they are multiples of 2^-252.
const TINY: f64 = f64::from_bits((1023 - 200) << 52);

/// The kinds of numbers in which a simplex is measured.
pub trait Number: vector::Number {
    /// The number, rounded.
    fn value(self) -> f64;
    /// The negated number.
    fn negated(self) -> Self;
}

impl Number for f64 {
    #[inline]
    fn value(self) -> f64 {
        self
    }

    #[inline]
    fn negated(self) -> Self {
        -self
    }
}

impl Number for Pair {
    #[inline]
    fn value(self) -> f64 {
        self.hi
    }

    #[inline]
    fn negated(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

/// A measure of a simplex of D dimensions.
pub trait Measure<const D: usize> {
    /// The result, in the units of the coordinates.
    type Out;
    /// D! times the size of the simplex, from its vectors.
    fn determinant<T: Number>(vectors: &[[T; D]; D]) -> T;
    /// The result from vectors that determine it accurately.
    fn of<T: Number>(&self, vectors: &Vectors<T, D>) -> Self::Out;
    /// The result from exact vectors.
    fn exact(&self, vectors: &Integers<D>) -> Self::Out;
}

/// Vectors from the last corner to the others, in units of 2^exponent.
#[derive(Clone, Copy)]
pub struct Vectors<T, const D: usize> {
    /// One vector for each corner except the last.
    pub to: [[T; D]; D],
    /// The exponent of the unit.
    pub exponent: i32,
}

/// The corners of a simplex, and its vectors rounded.
#[derive(Clone, Copy)]
pub struct Corners<const D: usize, const N: usize> {
    points: [[f64; D]; N],
    rounded: Vectors<f64, D>,
}

impl<const D: usize, const N: usize> Corners<D, N> {
    /// From finite corners.
    #[inline]
    pub fn new(points: [[f64; D]; N]) -> Self {
        let last = points[N - 1];
        let to: [[f64; D]; D] =
            std::array::from_fn(|i| std::array::from_fn(|k| points[i][k] - last[k]));
        let largest = to
            .as_flattened()
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        let rounded = Vectors { to, exponent: 0 };
        if largest > SMALL && largest < LARGE {
            return Self { points, rounded };
        }
        Self::in_own_unit(points, rounded, largest)
    }

    #[cold]
    fn in_own_unit(points: [[f64; D]; N], mut rounded: Vectors<f64, D>, largest: f64) -> Self {
        // If a difference overflows, or all are zero, only integers can decide.
        if largest.is_finite() && largest > 0.0 {
            let (magnitude, odd) = decode_odd(largest);
            let exponent = odd + 64 - magnitude.leading_zeros() as i32;
            rounded.exponent = exponent;
            rounded.to = rounded.to.map(|v| v.map(|x| times_power(x, -exponent)));
        }
        Self { points, rounded }
    }

    /// The vectors rounded, in a unit of their own; `None` if products of them may lose digits.
    #[inline]
    pub(super) fn rounded(&self) -> Option<&[[f64; D]; D]> {
        (product_of_lengths(&self.rounded.to) > TINY).then_some(&self.rounded.to)
    }

    /// The measure, by the first stage that is accurate.
    #[inline]
    pub fn measure<M: Measure<D>>(&self, measure: &M) -> M::Out {
        let product = product_of_lengths(&self.rounded.to);
        // Written so that NaN fails.
        if M::determinant(&self.rounded.to) > PLAIN * product && product > TINY {
            return measure.of(&self.rounded);
        }
        self.thin(measure, product)
    }

    #[cold]
    #[inline(never)]
    fn thin<M: Measure<D>>(&self, measure: &M, product: f64) -> M::Out {
        let accurate = |vectors: &Vectors<Pair, D>| {
            M::determinant(&vectors.to).hi > PAIRED * product && product > TINY
        };
        match self.pairs().filter(accurate) {
            Some(vectors) => measure.of(&vectors),
            None => measure.exact(&self.integers()),
        }
    }

    /// The exact vectors; `None` if parts of products may underflow.
    pub(super) fn pairs(&self) -> Option<Vectors<Pair, D>> {
        let (last, e) = (self.points[N - 1], self.rounded.exponent);
        let unit = |x: f64| times_power(x, -e);
        let safe = |x: &f64| *x == 0.0 || (x.abs() > TINY && x.is_finite());
        let points = self.points.map(|p| p.map(unit));
        if !points.as_flattened().iter().all(safe) {
            return None;
        }
        // Scaling may round values far below the largest difference.
        let kept = |(x, y): (&f64, &f64)| times_power(*y, e) == *x;
        let pairs = self.points.as_flattened().iter().zip(points.as_flattened());
        if e != 0 && !pairs.into_iter().all(kept) {
            return None;
        }
        let last = last.map(unit);
        Some(Vectors {
            to: std::array::from_fn(|i| {
                std::array::from_fn(|k| Pair::difference(points[i][k], last[k]))
            }),
            exponent: e,
        })
    }

    pub(super) fn integers(&self) -> Integers<D> {
        let low = lowest(&self.points, &[]);
        let at = self.points.map(|p| p.map(|x| scaled(x, low)));
        Integers {
            to: std::array::from_fn(|i| std::array::from_fn(|k| &at[i][k] - &at[N - 1][k])),
            low,
        }
    }
}

/// Vectors as integers, in units of 2^low.
pub struct Integers<const D: usize> {
    /// One vector for each corner except the last.
    pub to: [[BigInt; D]; D],
    /// The exponent of the unit.
    pub low: i64,
}

#[inline]
fn product_of_lengths<const D: usize>(vectors: &[[f64; D]; D]) -> f64 {
    let squares = vectors.map(|v| v.iter().map(|x| x * x).sum::<f64>());
    squares.iter().product::<f64>().sqrt()
}

/// `x * 2^exponent`; the exponent is usually 0.
#[inline]
pub fn in_units(x: f64, exponent: i32) -> f64 {
    if exponent == 0 {
        x
    } else {
        times_power(x, exponent)
    }
}

/// Twice the area of a triangle, from its vectors from the last corner.
#[inline]
pub fn determinant2<T: Number>([a, b]: &[[T; 2]; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

/// Six times the volume of a tetrahedron, from its vectors from the last corner. Seen from there,
/// the others are clockwise.
#[inline]
pub fn determinant3<T: Number>([a, b, c]: &[[T; 3]; 3]) -> T {
    dot(*a, cross(*c, *b))
}
