//! The foot of a query on a triangle in 3-D, exactly: interior, edge or corner, and its corner
//! weights.
//!
//! Signs of polynomials decide, in three stages: plain doubles, double-double arithmetic, integers.
//! The weights are quotients of the same polynomials, so they keep their digits however far away
//! the query is.

use std::array::from_fn;
use std::ops::{Add, Mul, Sub};

use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::{Point3, Sign};
use num_bigint::BigInt;

use crate::base::vector::{Ring, dot_of};
use crate::base::wide::{lowest, ratio, scaled, sign};

/// Error bounds of polynomials of degree 4 in differences, relative to the sum of the magnitudes of
/// all terms: at most 16 consecutive roundings, of 2^-53 and at most 2^-101.
const PLAIN: f64 = 1.0 / (1_u64 << 48) as f64;
const PAIRED: f64 = 1.0 / (1_u128 << 95) as f64;
/// Error bound of weights in double-double arithmetic.
const FINE: f64 = 1.0 / (1_u64 << 54) as f64;

/// Where on a triangle the nearest point is, by its corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Foot {
    /// The interior.
    Face,
    /// The open edge from a corner to the next.
    Edge(usize),
    /// A corner.
    Corner(usize),
}

/// A triangle, counterclockwise seen from one side, and a query.
#[derive(Debug)]
pub struct Triangle {
    corners: [Point3; 3],
    q: Point3,
    /// Whether double-double arithmetic neither overflows nor underflows.
    safe: bool,
}

impl Triangle {
    pub fn new(corners: [Point3; 3], q: Point3) -> Self {
        let [a, b, c] = corners;
        let safe = is_safe(&[a, b, c, q]);
        Self { corners, q, safe }
    }

    /// Finds where the nearest point is.
    pub fn foot(&self) -> Foot {
        let sides: [Sign; 3] = from_fn(|k| self.side(k));
        if sides == [Sign::Positive; 3] {
            return Foot::Face;
        }
        let on_edge = |k: usize| {
            let next = (k + 1) % 3;
            sides[k] != Sign::Positive
                && self.along(k, next) == Sign::Positive
                && self.along(next, k) == Sign::Positive
        };
        if let Some(k) = (0..3).find(|&k| on_edge(k)) {
            return Foot::Edge(k);
        }
        // Otherwise the foot is a corner: the query is beyond the ends of both its edges.
        let ahead = |k: usize, to: usize| self.along(k, (k + to) % 3) == Sign::Positive;
        let corner = (0..2).find(|&k| !ahead(k, 1) && !ahead(k, 2));
        Foot::Corner(corner.unwrap_or(2))
    }

    /// On which side of the edge from corner `k` to the next the query is, as seen along the
    /// normal: positive is the side of the triangle.
    pub fn side(&self, k: usize) -> Sign {
        self.decide(&Side, [k, (k + 1) % 3, (k + 2) % 3])
    }

    /// Whether the query lies ahead, as seen from one corner toward another.
    pub fn along(&self, from: usize, to: usize) -> Sign {
        self.decide(&Along, [from, to, to])
    }

    /// The weights of the corners in the nearest point, rounded.
    pub fn shares(&self, foot: Foot) -> [f64; 3] {
        let mut shares = [0.0; 3];
        match foot {
            Foot::Face => {
                // The value of an edge's side is the weight of the opposite corner.
                let edges = [0, 1, 2].map(|k| [k, (k + 1) % 3, (k + 2) % 3]);
                let found = self.quotients(&Side, edges);
                (0..3).for_each(|k| shares[(k + 2) % 3] = found[k]);
            }
            Foot::Edge(k) => {
                let next = (k + 1) % 3;
                let ways = [[k, next, next], [next, k, k]];
                [shares[next], shares[k]] = self.quotients(&Along, ways);
            }
            Foot::Corner(k) => shares[k] = 1.0,
        }
        shares
    }

    /// The squared distance of the nearest point, as a quotient, in the unit 2^(2 `low`); all
    /// coordinates are multiples of 2^`low`.
    pub fn square(&self, foot: Foot, low: i64) -> (BigInt, BigInt) {
        let of = |roles: [usize; 3]| {
            let [e, f, q] = self.relative(roles, |a, b| scaled(a, low) - scaled(b, low));
            (dot_of(&e, &e), dot_of(&f, &f), dot_of(&e, &f), e, f, q)
        };
        match foot {
            Foot::Corner(k) => {
                let (.., q) = of([k, k, k]);
                (dot_of(&q, &q), BigInt::from(1))
            }
            Foot::Edge(k) => {
                let next = (k + 1) % 3;
                let (square, .., e, _, q) = of([k, next, next]);
                let along = dot_of(&e, &q);
                (dot_of(&q, &q) * &square - &along * &along, square)
            }
            Foot::Face => {
                let (ee, ff, ef, e, f, q) = of([0, 1, 2]);
                let minor = |i: usize, j: usize| &e[i] * &f[j] - &e[j] * &f[i];
                let height = dot_of(&[minor(1, 2), minor(2, 0), minor(0, 1)], &q);
                (&height * &height, ee * ff - &ef * &ef)
            }
        }
    }

    pub fn corners(&self) -> [Point3; 3] {
        self.corners
    }

    fn decide<F: Formula>(&self, formula: &F, roles: [usize; 3]) -> Sign {
        if self.safe {
            let size = formula
                .of(self.relative(roles, |a, b| Size((a - b).abs())))
                .0;
            let plain = formula.of(self.relative(roles, |a, b| a - b));
            if plain.abs() > PLAIN * size {
                return Sign::of(plain);
            }
            let paired = formula.of(self.relative(roles, Pair::difference)).hi;
            if paired.abs() > PAIRED * size {
                return Sign::of(paired);
            }
        }
        sign(&self.wide(formula, roles))
    }

    /// Nonnegative values over their sum.
    fn quotients<F: Formula, const N: usize>(
        &self,
        formula: &F,
        roles: [[usize; 3]; N],
    ) -> [f64; N] {
        if self.safe {
            let size = |roles| {
                formula
                    .of(self.relative(roles, |a, b| Size((a - b).abs())))
                    .0
            };
            let lost = PAIRED * roles.map(size).iter().sum::<f64>();
            let paired = |roles| formula.of(self.relative(roles, Pair::difference)).hi;
            let values = roles.map(|roles| paired(roles).max(0.0));
            let sum: f64 = values.iter().sum();
            if lost <= FINE * sum {
                return values.map(|x| x / sum);
            }
        }
        let values = roles.map(|roles| self.wide(formula, roles));
        let sum: BigInt = values.iter().sum();
        values.map(|x| ratio(&x, &sum, 0).unwrap_or(f64::NAN))
    }

    /// A value in integers, in a unit that is the same for all roles.
    #[cold]
    #[inline(never)]
    fn wide<F: Formula>(&self, formula: &F, roles: [usize; 3]) -> BigInt {
        let [a, b, c] = self.corners;
        let low = lowest(&[a, b, c, self.q], &[]);
        formula.of(self.relative(roles, |a, b| scaled(a, low) - scaled(b, low)))
    }

    /// Two corners and the query relative to the first.
    fn relative<T>(&self, roles: [usize; 3], minus: impl Fn(f64, f64) -> T) -> [[T; 3]; 3] {
        let [from, to, other] = roles.map(|i| self.corners[i]);
        [to, other, self.q].map(|p| from_fn(|k| minus(p[k], from[k])))
    }
}

/// The sum of the magnitudes of all terms.
#[derive(Debug, Clone, Copy)]
struct Size(f64);

impl Add for Size {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Size {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "magnitudes add up")]
    fn sub(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Mul for Size {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

/// A polynomial in two corners and the query relative to a third corner.
trait Formula {
    fn of<T: Ring>(&self, relative: [[T; 3]; 3]) -> T;
}

/// The vector to the query times the vector to a corner.
struct Along;

impl Formula for Along {
    fn of<T: Ring>(&self, [to, _, q]: [[T; 3]; 3]) -> T {
        dot_of(&to, &q)
    }
}

/// (e x q) . (e x f), with e the edge and f the vector to the third corner.
struct Side;

impl Formula for Side {
    fn of<T: Ring>(&self, [e, f, q]: [[T; 3]; 3]) -> T {
        dot_of(&e, &e) * dot_of(&q, &f) - dot_of(&e, &f) * dot_of(&q, &e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Point3; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn above_beside_and_at_a_corner() {
        for scale in [1.0, 5e-324, 2f64.powi(1020)] {
            let foot = |q: Point3| {
                let corners = CORNERS.map(|p| p.map(|x| x * scale));
                let triangle = Triangle::new(corners, q.map(|x| x * scale));
                (triangle.foot(), triangle.shares(triangle.foot()))
            };
            assert_eq!(foot([1.0, 1.0, -3.0]), (Foot::Face, [0.5, 0.25, 0.25]));
            assert_eq!(foot([1.0, -5.0, 0.0]), (Foot::Edge(0), [0.75, 0.25, 0.0]));
            assert_eq!(foot([3.0, 3.0, 1.0]), (Foot::Edge(1), [0.0, 0.5, 0.5]));
            assert_eq!(foot([-1.0, 1.0, 1.0]), (Foot::Edge(2), [0.75, 0.0, 0.25]));
            assert_eq!(foot([-1.0, -1.0, -1.0]), (Foot::Corner(0), [1.0, 0.0, 0.0]));
            assert_eq!(foot([9.0, -1.0, -1.0]), (Foot::Corner(1), [0.0, 1.0, 0.0]));
            assert_eq!(foot([-1.0, 9.0, -1.0]), (Foot::Corner(2), [0.0, 0.0, 1.0]));
        }
    }

    #[test]
    fn no_digits_are_lost_far_above() {
        for far in [1e18, 1e300] {
            let triangle = Triangle::new(CORNERS, [1.0, 1.0, far]);
            assert_eq!(triangle.foot(), Foot::Face);
            assert_eq!(triangle.shares(Foot::Face), [0.5, 0.25, 0.25]);
            let beside = Triangle::new(CORNERS, [1.0, -1e-300, far]);
            assert_eq!(beside.foot(), Foot::Edge(0));
        }
    }
}
