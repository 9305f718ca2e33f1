//! The oracle: determinants of integers without limit, expanded as the textbook writes them; and the
//! description of a predicate with all its stages that the tests run against it.

#![allow(dead_code)] // Each test binary uses its part.

pub mod directions;
pub mod points;

use delone_predicates::{Sign, stages};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

/// The double `x` in units of 2^-1074.
pub fn units(x: f64) -> BigInt {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as u32;
    let fraction = bits & ((1 << 52) - 1);
    let magnitude = match field {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | 1 << 52) << (field - 1),
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

/// The points as integers: all coordinates times one power of two.
pub fn integers<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> Vec<Vec<BigInt>> {
    let rows: Vec<Vec<BigInt>> = points
        .iter()
        .map(|p| p.iter().map(|&x| units(x)).collect())
        .collect();
    let zeros = rows
        .iter()
        .flatten()
        .filter_map(BigInt::trailing_zeros)
        .min()
        .unwrap_or(0);
    rows.into_iter()
        .map(|p| p.into_iter().map(|x| x >> zeros).collect())
        .collect()
}

/// The determinant, by expansion along the first row.
pub fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    let Some((first, rest)) = rows.split_first() else {
        return BigInt::from(1);
    };
    let mut sum = BigInt::zero();
    for (column, factor) in first
        .iter()
        .enumerate()
        .filter(|(_, factor)| !factor.is_zero())
    {
        let minor: Vec<Vec<BigInt>> = rest
            .iter()
            .map(|row| [&row[..column], &row[column + 1..]].concat())
            .collect();
        let term = factor * determinant(&minor);
        if column % 2 == 0 {
            sum += term
        } else {
            sum -= term
        }
    }
    sum
}

/// The sign of an integer.
pub fn sign_of(value: &BigInt) -> Sign {
    match (value.is_positive(), value.is_negative()) {
        (true, _) => Sign::Positive,
        (_, true) => Sign::Negative,
        _ => Sign::Zero,
    }
}

/// The orientation of D + 1 points: positive for the origin and the unit points in their order.
pub fn orientation<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> Sign {
    let mut rows = integers(points);
    for row in &mut rows {
        row.insert(0, BigInt::from(1));
    }
    sign_of(&determinant(&rows))
}

/// Whether the last of D + 2 points is inside the sphere of the others (positively oriented).
pub fn sphere<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> Sign {
    let mut rows = integers(points);
    for row in &mut rows {
        let height: BigInt = row.iter().map(|x| x * x).sum();
        row.insert(0, BigInt::from(1));
        row.push(height);
    }
    // Raising the last point increases the determinant by the orientation of the others.
    -sign_of(&determinant(&rows))
}

/// A predicate over `N` points of dimension `D`, its stages and its oracle.
#[derive(Clone, Copy)]
pub struct Predicate<const D: usize, const N: usize> {
    pub whole: Whole<D, N>,
    pub exact: Whole<D, N>,
    pub oracle: fn(&[[f64; D]; N]) -> Sign,
    pub integer: Whole<D, N>,
    /// Name and function of the stages that may decline.
    pub partial: [(&'static str, Stage<D, N>); 4],
}

/// A function that always answers.
pub type Whole<const D: usize, const N: usize> = fn([[f64; D]; N]) -> Sign;

/// A stage that may decline to answer.
pub type Stage<const D: usize, const N: usize> = fn([[f64; D]; N]) -> Option<Sign>;

/// How often the stages that may decline have answered.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answers {
    pub filter: usize,
    pub lattice: usize,
    pub expansion: usize,
    pub scaled: usize,
    pub zeros: usize,
    pub cases: usize,
}

impl Answers {
    fn count(&mut self, stage: usize) {
        *[
            &mut self.filter,
            &mut self.lattice,
            &mut self.expansion,
            &mut self.scaled,
        ][stage] += 1;
    }
}

impl<const D: usize, const N: usize> Predicate<D, N> {
    /// Asserts that each stage that answers, and the whole, are right about `points`.
    pub fn check(&self, points: [[f64; D]; N], answers: &mut Answers) -> Sign {
        let right = (self.oracle)(&points);
        assert_eq!((self.whole)(points), right, "{points:?}");
        assert_eq!((self.exact)(points), right, "exact stages: {points:?}");
        assert_eq!((self.integer)(points), right, "integer: {points:?}");
        for (k, (name, stage)) in self.partial.iter().enumerate() {
            if let Some(sign) = stage(points) {
                assert_eq!(sign, right, "{name}: {points:?}");
                answers.count(k);
            }
        }
        answers.zeros += usize::from(right.is_zero());
        answers.cases += 1;
        right
    }
}

macro_rules! predicate {
    ($constant:ident, $name:ident, $exact:ident, $oracle:ident, $d:literal, [$($p:ident),+]) => {
        pub const $constant: Predicate<$d, { [$(stringify!($p)),+].len() }> = Predicate {
            whole: |[$($p),+]| delone_predicates::$name($($p),+),
            exact: |[$($p),+]| delone_predicates::$exact($($p),+),
            oracle: $oracle,
            integer: |[$($p),+]| stages::$name::integer($($p),+),
            partial: [
                ("filter", |[$($p),+]| stages::$name::filter($($p),+)),
                ("lattice", |[$($p),+]| stages::$name::lattice($($p),+)),
                ("expansion", |[$($p),+]| stages::$name::expansion($($p),+)),
                ("scaled", |[$($p),+]| stages::$name::scaled($($p),+)),
            ],
        };
    };
}

predicate!(
    ORIENT2D,
    orient2d,
    orient2d_exact,
    orientation,
    2,
    [a, b, c]
);
predicate!(
    ORIENT3D,
    orient3d,
    orient3d_exact,
    orientation,
    3,
    [a, b, c, d]
);
predicate!(INCIRCLE, incircle, incircle_exact, sphere, 2, [a, b, c, d]);
predicate!(
    INSPHERE,
    insphere,
    insphere_exact,
    sphere,
    3,
    [a, b, c, d, e]
);
