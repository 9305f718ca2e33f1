//! The bounds of the filters against integers: none is exceeded, and none is much too large.
//!
//! A wrong sign requires a near tie whose rounding errors all have the same sign. Random ties come
//! nowhere near the bounds, so only luck would reveal a bound that is too small. Therefore these
//! tests measure errors, not signs. Directions are the computed ones, and the true ones are as far
//! from them as the bound of their error allows, each coordinate on the side where the determinant
//! changes most. Each test states what share of its bound the largest error reaches, so a bound
//! reduced to less than that share fails.

use delone_predicates::Point3;
use delone_predicates::sphere::{Unit, stages};
use num_bigint::BigInt;

use super::kernel::{circle_bound, cross, dot, turn_bound};
use crate::base::wide::{ratio, scaled};

/// Integers are in units of 2^-LOW.
const LOW: i64 = -1100;
/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// Closer heads prove nothing, because their determinant is below its bound.
const LEAST: f64 = 3.0 * U;

struct Random(u64);

impl Random {
    /// From -1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Directions about `spread` apart, in any part of the sphere.
    fn near<const N: usize>(&mut self, spread: f64) -> [Unit; N] {
        let mut middle = || [(); 3].map(|()| self.next());
        let place = middle();
        [(); N].map(|()| {
            let step = middle();
            Unit::of([0, 1, 2].map(|k| place[k] + spread * step[k]))
        })
    }
}

fn spreads() -> impl Iterator<Item = f64> {
    (0..60).map(|k| (-f64::from(k)).exp2())
}

fn integers(v: Point3) -> [BigInt; 3] {
    v.map(|x| scaled(x, LOW))
}

fn minus(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

fn determinant(rows: &[[BigInt; 3]; 3]) -> BigInt {
    crate::base::wide::determinant(rows.each_ref())
}

/// Where true directions may be, as far from the computed ones as `radius` allows.
///
/// `heads` are the directions without their tails, in which the signs of minors are computed, and
/// `known` what is known of them.
fn pushed<const N: usize>(
    heads: [Point3; N],
    known: [[BigInt; 3]; N],
    radius: impl Fn(f64) -> f64,
    slopes: [Point3; N],
    side: f64,
) -> [[BigInt; 3]; N] {
    std::array::from_fn(|i| {
        [0, 1, 2].map(|k| {
            let way = side * slopes[i][k].signum();
            &known[i][k] + scaled(way * radius(heads[i][k]), LOW)
        })
    })
}

/// How the determinant of the differences of three directions from the last one changes with each.
fn circle_slopes([a, b, c, d]: [Point3; 4]) -> [Point3; 4] {
    let less = |a: Point3| [0, 1, 2].map(|k| a[k] - d[k]);
    let [p, q, r] = [a, b, c].map(less);
    let rows = [cross(q, r), cross(r, p), cross(p, q)];
    let all = [0, 1, 2].map(|k| -(rows[0][k] + rows[1][k] + rows[2][k]));
    [rows[0], rows[1], rows[2], all]
}

/// The error of `found` as a fraction of `bound`, for three factors.
fn share(found: &BigInt, exact: &BigInt, bound: f64, factors: i64) -> f64 {
    let error = (found << ((factors - 1) * -LOW) as u64) - exact;
    let bound = scaled(bound, LOW) << ((factors - 1) * -LOW) as u64;
    ratio(&error, &bound, 0).unwrap_or(f64::INFINITY).abs()
}

fn sizes<const N: usize>(rows: [Point3; N]) -> [f64; N] {
    rows.map(|p| p[0].abs() + p[1].abs() + p[2].abs())
}

/// The largest share over many directions and both sides, and whether it is within the bound.
fn largest(seed: u64, mut shares: impl FnMut(&mut Random, f64, f64) -> f64) -> f64 {
    let mut random = Random(seed);
    let mut most = 0.0_f64;
    for spread in spreads() {
        for _ in 0..200 {
            for side in [-1.0, 1.0] {
                most = most.max(shares(&mut random, spread, side));
            }
        }
    }
    assert!(most <= 1.0, "an error is {most} times its bound");
    most
}

/// Half the distance to the next double, as a tail may be.
fn half_step(x: f64) -> f64 {
    0.5 * (x.abs().next_up() - x.abs())
}

/// The error of a direction as a pair: 2^-100.9 of each coordinate.
fn pair_error(x: f64) -> f64 {
    33.0 * U * U * x.abs()
}

#[test]
fn heads_and_circles() {
    let most = largest(1, |random, spread, side| {
        let heads = random.near::<4>(spread).map(|unit| unit.hi);
        let d = heads[3];
        let [p, q, r] = [0, 1, 2].map(|i| [0, 1, 2].map(|k| heads[i][k] - d[k]));
        let found = dot(cross(p, q), r);
        let [s, t, w] = sizes([p, q, r]);
        if s.min(t).min(w) <= LEAST {
            return 0.0;
        }
        let known = heads.map(integers);
        let [a, b, c, d] = pushed(heads, known, half_step, circle_slopes(heads), side);
        let exact = determinant(&[minus(&a, &d), minus(&b, &d), minus(&c, &d)]);
        share(&scaled(found, LOW), &exact, circle_bound(s, t, w), 3)
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}

#[test]
fn heads_and_turns() {
    let most = largest(2, |random, spread, side| {
        let heads = random.near::<3>(spread).map(|unit| unit.hi);
        let [a, b, p] = heads;
        let rows = [a, b].map(|a| [0, 1, 2].map(|k| a[k] - p[k]));
        let found = dot(cross(rows[0], rows[1]), p);
        let [s, t] = sizes(rows);
        if s.min(t) <= LEAST {
            return 0.0;
        }
        let known = heads.map(integers);
        let slopes = [cross(b, p), cross(p, a), cross(a, b)];
        let exact = determinant(&pushed(heads, known, half_step, slopes, side));
        share(&scaled(found, LOW), &exact, turn_bound(s, t), 3)
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}

/// The exact sums of heads and tails.
fn sums<const N: usize>(units: &[Unit; N]) -> [[BigInt; 3]; N] {
    units.map(|unit| {
        let (hi, lo) = (integers(unit.hi), integers(unit.lo));
        [0, 1, 2].map(|k| &hi[k] + &lo[k])
    })
}

#[test]
fn pairs_and_circles() {
    let most = largest(3, |random, spread, side| {
        let units = random.near::<4>(spread);
        let (found, bound) = stages::by_pairs(units.each_ref());
        if bound == f64::INFINITY {
            return 0.0;
        }
        let heads = units.map(|unit| unit.hi);
        let [a, b, c, d] = pushed(heads, sums(&units), pair_error, circle_slopes(heads), side);
        let exact = -determinant(&[minus(&a, &d), minus(&b, &d), minus(&c, &d)]);
        share(&scaled(found, LOW), &exact, bound, 3)
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}

#[test]
fn double_double_and_circles() {
    let most = largest(4, |random, spread, side| {
        let units = random.near::<4>(spread);
        let (found, bound) = stages::by_double_double(units.each_ref());
        if bound == f64::INFINITY {
            return 0.0;
        }
        let heads = units.map(|unit| unit.hi);
        let [a, b, c, d] = pushed(heads, sums(&units), pair_error, circle_slopes(heads), side);
        let exact = -determinant(&[minus(&a, &d), minus(&b, &d), minus(&c, &d)]);
        share(
            &(scaled(found.hi, LOW) + scaled(found.lo, LOW)),
            &exact,
            bound,
            3,
        )
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}

#[test]
fn pairs_and_turns() {
    let most = largest(5, |random, spread, side| {
        let units = random.near::<3>(spread);
        let (found, bound) = stages::orient_by_pairs(units.each_ref());
        if bound == f64::INFINITY {
            return 0.0;
        }
        let heads = units.map(|unit| unit.hi);
        let [a, b, c] = heads;
        let slopes = [cross(b, c), cross(c, a), cross(a, b)];
        let exact = determinant(&pushed(heads, sums(&units), pair_error, slopes, side));
        share(&scaled(found, LOW), &exact, bound, 3)
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}

#[test]
fn differences_and_distances() {
    let most = largest(6, |random, spread, side| {
        let units = random.near::<3>(spread);
        let (found, bound) = stages::by_differences(units.each_ref());
        let heads = units.map(|unit| unit.hi);
        let [q, a, b] = heads;
        let slopes = [[0, 1, 2].map(|k| a[k] - b[k]), q, q.map(|x| -x)];
        let [q, a, b] = pushed(heads, sums(&units), pair_error, slopes, side);
        let steps = minus(&a, &b);
        let exact = (0..3).map(|k| &steps[k] * &q[k]).sum::<BigInt>();
        share(&scaled(found, LOW), &exact, bound, 2)
    });
    assert!(
        most > 0.25,
        "the bound is far from the largest error, {most} of it"
    );
}
