//! Weighted edges: each weight is the distance of two points, compared exactly.

use std::cmp::Ordering;

use delone_predicates::Sign;
use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::proximity::shorter;
use num_bigint::BigInt;

use crate::base::wide::{lowest, ratio, root, scaled};
use crate::graphs::{certainly_above, squared};

/// A distance: its square, rounded, and the two points that it lies between.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The square, rounded.
    pub square: f64,
    /// The points.
    pub between: [u32; 2],
}

/// An edge, whose weight may be the distance of two other points.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// The points that it joins.
    pub ends: [u32; 2],
    /// Its weight.
    pub span: Span,
}

impl Span {
    /// The distance of two points.
    #[inline]
    pub fn of<const D: usize>(points: &[[f64; D]], a: u32, b: u32) -> Self {
        Self {
            square: squared(points[a as usize], points[b as usize]),
            between: [a, b],
        }
    }

    /// The order by length.
    #[inline]
    pub fn compare<const D: usize>(&self, other: &Self, points: &[[f64; D]]) -> Ordering {
        if certainly_above(other.square, self.square) {
            return Ordering::Less;
        }
        if certainly_above(self.square, other.square) {
            return Ordering::Greater;
        }
        if self.between == other.between {
            return Ordering::Equal;
        }
        let ([a, b], [c, d]) = (self.points(points), other.points(points));
        as_order(shorter(a, b, c, d))
    }

    /// The order of the length and a number from 0 on.
    pub fn compare_number<const D: usize>(&self, number: f64, points: &[[f64; D]]) -> Ordering {
        let mut end = [0.0; D];
        if number == f64::INFINITY {
            return Ordering::Less;
        }
        end[0] = number;
        let [a, b] = self.points(points);
        as_order(shorter(a, b, [0.0; D], end))
    }

    /// The length, correctly rounded; infinite if it exceeds the range of doubles.
    pub fn length<const D: usize>(&self, points: &[[f64; D]]) -> f64 {
        let [a, b] = self.points(points);
        length(a, b)
    }

    #[inline]
    fn points<const D: usize>(&self, points: &[[f64; D]]) -> [[f64; D]; 2] {
        self.between.map(|v| points[v as usize])
    }
}

/// Whether the first length is less, by the sign of the second minus the first.
#[inline]
fn as_order(sign: Sign) -> Ordering {
    match sign {
        Sign::Positive => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Negative => Ordering::Greater,
    }
}

/// The distance of two points, correctly rounded, so that equal distances are equal doubles.
///
/// The sum of squares in double-double arithmetic has at most 3 products (9 u^2 each) and 2 sums (4
/// u^2), and one Newton step from the rounded root leaves u^2 / 8 more: below 32 u^2 in all. Where
/// twice that does not change the rounded sum of the root and its correction, it is right.
fn length<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    const U: f64 = f64::EPSILON / 2.0;
    if a == b {
        return 0.0;
    }
    if is_safe(&[a, b]) {
        let square = (1..D).fold(Pair::difference(a[0], b[0]).square(), |sum, k| {
            sum + Pair::difference(a[k], b[k]).square()
        });
        let first = square.hi.sqrt();
        let rest = square - Pair { hi: first, lo: 0.0 }.square();
        let more = (rest.hi + rest.lo) / (2.0 * first);
        let slack = 64.0 * U * U * first;
        let found = first + (more - slack);
        if found == first + (more + slack) {
            return found;
        }
    }
    let low = lowest(&[a, b], &[]);
    let square: BigInt = (0..D)
        .map(|k| scaled(a[k], low) - scaled(b[k], low))
        .map(|x| &x * &x)
        .sum();
    // A last bit represents all that follow.
    let floor = root(&square);
    let sticky = u8::from(&floor * &floor != square << 128);
    ratio(&(2 * floor + sticky), &(BigInt::from(1) << 65), low).unwrap_or(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_rounded_once() {
        let tiny = f64::EPSILON / 2.0;
        assert_eq!(length([0.0, 0.0], [3.0, 4.0]), 5.0);
        assert_eq!(length([0.0, 0.0], [1.0, 1.0]), 2f64.sqrt());
        // Halfway between two doubles, and a little above.
        assert_eq!(length([1.0, 0.0], [-tiny, 0.0]), 1.0);
        let above = 1.0 + f64::EPSILON;
        assert_eq!(length([1.0, tiny * tiny], [-tiny, 0.0]), above);
        assert_eq!(length([1.0, 1e-300], [-tiny, 0.0]), above);
        assert_eq!(length([0.0, 5e-324], [0.0, 0.0]), 5e-324);
        assert_eq!(length([1e308, 0.0], [-1e308, 0.0]), f64::INFINITY);
        assert_eq!(length([3e300, 0.0, 4e300], [0.0; 3]), 5e300);
        assert_eq!(
            length([1.0, 8.0], [0.0, 0.0]),
            length([7.0, 0.0], [0.0, 4.0])
        );
    }
}
