//! The exact affine frame of a simplex: det, det A^-1 and det A^-1 b as integers, once for each simplex
//! that needs them. After that each test is a scalar product: det P = det |d|^2 - (det A^-1 b) . d,
//! det l_i = column i of (det A^-1) . d.
//!
//! By the fraction-free elimination of E. H. Bareiss (1968), whose entries are minors of the matrix
//! [A | b | I]; b holds squares of lengths, less differences of weights. With differences below 2^bits,
//! Hadamard's inequality bounds minors of D rows by D^(D / 2) 2^(D bits). An entry of b is a sum of at most
//! nine terms below 2^(2 bits), also in a flat, where the squares of the coordinates that are not axes are
//! weights. Expanded along b, a minor is below 9 D (D - 1)^((D - 1) / 2) 2^((D + 1) bits). Both are below
//! 2^[`minor_bits`], which has `bits` to spare, at least two.
//!
//! Where these are not machine integers but differences are, `limbs` does the same on the stack.

use std::ops::{Div, Mul, Sub};

use num_bigint::BigInt;

use super::limbs::{self, Eliminated, Limbs};

/// Points as integers of one unit.
pub trait Integers {
    /// The number of coordinates.
    fn dimension(&self) -> usize;

    /// Differences are below 2^bits units.
    fn bits(&self) -> u32;

    /// Coordinate k of `p - o` in units, if all differences are machine integers.
    fn small(&self, p: u32, o: u32, k: usize) -> Option<i64>;

    /// Coordinate k of `p - o` in units.
    fn wide(&self, p: u32, o: u32, k: usize) -> BigInt;

    /// Whether differences are machine integers.
    fn is_small(&self) -> bool;

    /// The weight of `p` less that of `o`, in squared units, if differences are machine integers. Its
    /// magnitude is below 2^(2 bits).
    fn small_weight(&self, _p: u32, _o: u32) -> i128 {
        0
    }

    /// The same, however large.
    fn wide_weight(&self, _p: u32, _o: u32) -> BigInt {
        BigInt::ZERO
    }
}

/// The integers of a simplex, with a positive determinant.
pub struct Frame {
    numbers: Numbers,
    dimension: usize,
    /// Whether the determinant of the differences was positive.
    pub positive: bool,
}

enum Numbers {
    Small(Solved<i128>),
    Limbs(Limbs),
    Wide(Solved<BigInt>),
}

/// What elimination leaves.
struct Solved<T> {
    determinant: T,
    /// det A^-1 b.
    lifted: Vec<T>,
    /// det A^-1, row by row.
    adjoint: Vec<T>,
    positive: bool,
}

/// Minors of [A | b | I] of differences below 2^bits are below 2^this, and so is D + 1 times the
/// determinant of the lifted points, but for bits + 4.
fn minor_bits(d: u32, bits: u32) -> u32 {
    let log = u32::BITS - d.leading_zeros();
    d * (bits + log.div_ceil(2)) + 2 * bits + log
}

impl Frame {
    /// The frame of `corners`, the first of which is the origin. `None` if they lie in a flat.
    pub fn new(sites: &impl Integers, corners: &[u32]) -> Option<Self> {
        let d = sites.dimension();
        let minor = minor_bits(d as u32, sites.bits());
        let small = |i: usize, k: usize| sites.small(corners[i + 1], corners[0], k);
        let weight = |i: usize| sites.small_weight(corners[i + 1], corners[0]);
        // A step of the elimination computes the difference of two products of minors.
        let products = 2 * minor + 1;
        let numbers = if sites.is_small() && products < 63 {
            let solved =
                eliminate::<i64>(d, |i, k| small(i, k).unwrap_or(0), |i| weight(i) as i64)?;
            Numbers::Small(solved.map(i128::from))
        } else if sites.is_small() && products < 127 {
            let at = |i: usize, k: usize| small(i, k).unwrap_or(0).into();
            Numbers::Small(eliminate::<i128>(d, at, weight)?)
        } else {
            let few = sites.is_small() && d <= limbs::MOST;
            let solved = few.then(|| {
                let at = |i: usize, k: usize| small(i, k).unwrap_or(0);
                limbs::eliminate(d, sites.bits(), at, weight)
            });
            match solved {
                Some(Eliminated::Flat) => return None,
                Some(Eliminated::Done(solved)) => Numbers::Limbs(solved),
                Some(Eliminated::TooLong) | None => Numbers::Wide(eliminate::<BigInt>(
                    d,
                    |i, k| sites.wide(corners[i + 1], corners[0], k),
                    |i| sites.wide_weight(corners[i + 1], corners[0]),
                )?),
            }
        };
        let positive = match &numbers {
            Numbers::Small(solved) => solved.positive,
            Numbers::Limbs(solved) => solved.positive,
            Numbers::Wide(solved) => solved.positive,
        };
        Some(Self {
            numbers,
            dimension: d,
            positive,
        })
    }

    /// The determinant, which is positive.
    pub fn determinant(&self) -> BigInt {
        match &self.numbers {
            Numbers::Small(s) => s.determinant.into(),
            Numbers::Limbs(s) => s.determinant(),
            Numbers::Wide(s) => s.determinant.clone(),
        }
    }

    /// The determinant times twice component `k` of the center, from the first corner.
    pub fn lifted(&self, k: usize) -> BigInt {
        match &self.numbers {
            Numbers::Small(s) => s.lifted[k].into(),
            Numbers::Limbs(s) => s.lifted(k),
            Numbers::Wide(s) => s.lifted[k].clone(),
        }
    }

    /// The determinant times entry `k, i` of the inverse of the differences.
    pub fn adjoint(&self, k: usize, i: usize) -> BigInt {
        match &self.numbers {
            Numbers::Small(s) => s.adjoint[k * self.dimension + i].into(),
            Numbers::Limbs(s) => s.adjoint(k, i),
            Numbers::Wide(s) => s.adjoint[k * self.dimension + i].clone(),
        }
    }

    /// The determinant times the barycentric coordinate of corner `i` at `p`, where `o` is the first
    /// corner.
    pub fn share(&self, sites: &impl Integers, o: u32, i: usize, p: u32) -> BigInt {
        let columns = if i == 0 { 0..self.dimension } else { i - 1..i };
        let mut sum = BigInt::ZERO;
        for k in 0..self.dimension {
            let x = sites.wide(p, o, k);
            for c in columns.clone() {
                sum += self.adjoint(k, c) * &x;
            }
        }
        if i == 0 {
            self.determinant() - sum
        } else {
            sum
        }
    }

    /// The sign of the power of `p` where `o` is the first corner: negative inside.
    pub fn power(&self, sites: &impl Integers, o: u32, p: u32) -> i32 {
        match &self.numbers {
            Numbers::Small(s) => {
                let mut sum = -s.determinant * sites.small_weight(p, o);
                for k in 0..self.dimension {
                    let x = i128::from(sites.small(p, o, k).unwrap_or(0));
                    sum += x * (s.determinant * x - s.lifted[k]);
                }
                sum.signum() as i32
            }
            Numbers::Limbs(s) => s.power(
                |k| sites.small(p, o, k).unwrap_or(0),
                sites.small_weight(p, o),
            ),
            Numbers::Wide(s) => {
                let mut sum = -&s.determinant * sites.wide_weight(p, o);
                for k in 0..self.dimension {
                    let x = sites.wide(p, o, k);
                    sum += &x * (&s.determinant * &x - &s.lifted[k]);
                }
                sign(&sum)
            }
        }
    }

    /// The sign of the barycentric coordinate of corner `i` at `p`.
    pub fn coordinate(&self, sites: &impl Integers, o: u32, i: usize, p: u32) -> i32 {
        let columns = if i == 0 { 0..self.dimension } else { i - 1..i };
        match &self.numbers {
            Numbers::Small(s) => {
                let mut sum = 0i128;
                for k in 0..self.dimension {
                    let x = i128::from(sites.small(p, o, k).unwrap_or(0));
                    sum += columns
                        .clone()
                        .map(|c| s.adjoint[k * self.dimension + c] * x)
                        .sum::<i128>();
                }
                let value = if i == 0 { s.determinant - sum } else { sum };
                value.signum() as i32
            }
            Numbers::Limbs(s) => s.coordinate(i, |k| sites.small(p, o, k).unwrap_or(0)),
            Numbers::Wide(s) => {
                let mut sum = BigInt::ZERO;
                for k in 0..self.dimension {
                    let x = sites.wide(p, o, k);
                    for c in columns.clone() {
                        sum += &s.adjoint[k * self.dimension + c] * &x;
                    }
                }
                sign(&if i == 0 { &s.determinant - sum } else { sum })
            }
        }
    }
}

fn sign(x: &BigInt) -> i32 {
    x.cmp(&BigInt::ZERO) as i32
}

impl<T> Solved<T> {
    fn map<S>(self, to: impl Fn(T) -> S) -> Solved<S> {
        Solved {
            determinant: to(self.determinant),
            lifted: self.lifted.into_iter().map(&to).collect(),
            adjoint: self.adjoint.into_iter().map(&to).collect(),
            positive: self.positive,
        }
    }
}

/// [A | b | I] -> [det I | det A^-1 b | det A^-1], with the signs of a positive determinant. `None` if
/// A is singular. `at` has the entries of A; b has the squares of its rows less what `weight` has.
fn eliminate<T>(
    d: usize,
    at: impl Fn(usize, usize) -> T,
    weight: impl Fn(usize) -> T,
) -> Option<Solved<T>>
where
    T: Clone + From<i64> + PartialOrd,
    for<'a> &'a T: Mul<&'a T, Output = T> + Sub<&'a T, Output = T> + Div<&'a T, Output = T>,
{
    let (zero, one, width) = (T::from(0), T::from(1), 2 * d + 1);
    let mut rows: Vec<Vec<T>> = (0..d).map(|_| vec![zero.clone(); width]).collect();
    for (i, row) in rows.iter_mut().enumerate() {
        for k in 0..d {
            row[k] = at(i, k);
            let negative = &zero - &(&row[k] * &row[k]);
            row[d] = &row[d] - &negative;
        }
        row[d] = &row[d] - &weight(i);
        row[d + 1 + i] = one.clone();
    }
    let (mut previous, mut positive) = (one, true);
    for k in 0..d {
        let pivot = (k..d).find(|&r| rows[r][k] != zero)?;
        if pivot != k {
            rows.swap(k, pivot);
            positive = !positive;
        }
        let of_pivot = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k {
                let factor = row[k].clone();
                for j in 0..width {
                    // The division has no remainder: the result is a minor.
                    let cross = &(&of_pivot[k] * &row[j]) - &(&factor * &of_pivot[j]);
                    row[j] = &cross / &previous;
                }
            }
        }
        previous = of_pivot[k].clone();
    }
    let negative = previous < zero;
    let signed = |x: &T| if negative { &zero - x } else { x.clone() };
    Some(Solved {
        determinant: signed(&previous),
        lifted: rows.iter().map(|row| signed(&row[d])).collect(),
        adjoint: rows
            .iter()
            .flat_map(|row| row[d + 1..].iter().map(signed))
            .collect(),
        positive: positive ^ negative,
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::sets::Random;
    use super::*;

    /// Points with weights, as machine integers or not.
    #[derive(Clone)]
    struct Given {
        points: Vec<Vec<i64>>,
        weights: Vec<i128>,
        bits: u32,
        small: bool,
    }

    impl Integers for Given {
        fn dimension(&self) -> usize {
            self.points[0].len()
        }

        fn bits(&self) -> u32 {
            self.bits
        }

        fn small(&self, p: u32, o: u32, k: usize) -> Option<i64> {
            let at = |q: u32| self.points[q as usize][k];
            self.small.then(|| at(p) - at(o))
        }

        fn wide(&self, p: u32, o: u32, k: usize) -> BigInt {
            let at = |q: u32| BigInt::from(self.points[q as usize][k]);
            at(p) - at(o)
        }

        fn is_small(&self) -> bool {
            self.small
        }

        fn small_weight(&self, p: u32, o: u32) -> i128 {
            self.weights[p as usize] - self.weights[o as usize]
        }

        fn wide_weight(&self, p: u32, o: u32) -> BigInt {
            self.small_weight(p, o).into()
        }
    }

    /// A simplex and two points, whose differences are below 2^bits.
    fn drawn(r: &mut Random, d: usize, bits: u32, kind: usize) -> Given {
        let half = (1i64 << (bits - 1)) - 1;
        let mut coordinate = |i: usize| {
            let sign = r.integer(0, 1) as i64 * 2 - 1;
            match kind {
                // Corners of the largest cube; scattered; with zeros at the end; nearly in a lattice.
                0 => sign * half,
                1 => sign * (r.unit() * half as f64) as i64,
                2 => (r.integer(-1, 1) as i64) << (bits - 2),
                3 if i == 0 => half,
                3 => (r.integer(-3, 3) as i64 * half) / 3 - r.integer(0, 1) as i64 * sign,
                _ => r.integer(-1, 1) as i64,
            }
        };
        let points: Vec<Vec<i64>> = (0..d + 3)
            .map(|i| (0..d).map(|_| coordinate(i).clamp(-half, half)).collect())
            .collect();
        let most = (1i128 << (2 * bits - 1)) - 1;
        let weights = (0..d + 3).map(|i| match (kind + i) % 3 {
            0 => most,
            1 => -most,
            _ => (r.unit() * 1e9) as i128 & most,
        });
        Given {
            weights: weights.collect(),
            points,
            bits,
            small: true,
        }
    }

    /// Integers of some limbs, and those of any length, give the same numbers and signs.
    #[test]
    fn limbs_are_as_good_as_integers_of_any_length() {
        let mut r = Random::new(4);
        let (mut flat, mut few, mut long, mut zeros) = (0, 0, 0, 0);
        for (d, bits, kind) in (2..=8).flat_map(|d| {
            [3, 9, 13, 24, 31, 40, 57, 61]
                .into_iter()
                .flat_map(move |bits| (0..15).map(move |kind| (d, bits, kind % 5)))
        }) {
            let given = drawn(&mut r, d, bits, kind);
            let corners: Vec<u32> = (0..=d as u32).collect();
            let made = Frame::new(&given, &corners);
            let mut wide = given.clone();
            wide.small = false;
            let expected = Frame::new(&wide, &corners);
            let (Some(made), Some(expected)) = (&made, &expected) else {
                assert!(made.is_none() && expected.is_none(), "{:?}", given.points);
                flat += 1;
                continue;
            };
            match made.numbers {
                Numbers::Limbs(_) => few += 1,
                Numbers::Wide(_) => long += 1,
                Numbers::Small(_) => {}
            }
            assert_eq!(made.positive, expected.positive);
            assert_eq!(made.determinant(), expected.determinant());
            assert!(made.determinant() > BigInt::ZERO);
            for k in 0..d {
                assert_eq!(made.lifted(k), expected.lifted(k), "{d}-D {bits} {kind}");
                for i in 0..d {
                    assert_eq!(
                        made.adjoint(k, i),
                        expected.adjoint(k, i),
                        "{d}-D {bits} {kind}"
                    );
                }
            }
            for p in 0..d as u32 + 3 {
                let sign = expected.power(&wide, 0, p);
                assert_eq!(made.power(&given, 0, p), sign, "{d}-D {bits} {kind}");
                for i in 0..=d {
                    let side = expected.coordinate(&wide, 0, i, p);
                    assert_eq!(
                        made.coordinate(&given, 0, i, p),
                        side,
                        "{d}-D {bits} {kind}"
                    );
                    zeros += usize::from(side == 0);
                }
            }
        }
        for count in [flat, few, long, zeros] {
            assert!(count > 10, "{flat} {few} {long} {zeros}");
        }
    }
}
