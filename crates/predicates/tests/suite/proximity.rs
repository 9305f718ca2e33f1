//! The predicates of proximity graphs, against integers without limit.

use crate::oracle::{integers, sign_of};
use delone_predicates::Sign;
use delone_predicates::proximity::{angle, arcs, lune, shorter, spheres};
use num_bigint::BigInt;
use proptest::array::uniform3;
use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
use proptest::prelude::*;

type Vector = Vec<BigInt>;

/// Any finite double, or a small integer times a power of two, so that ties happen.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        (-3..=3_i32).prop_map(f64::from),
        (-3..=3_i32, -1070..1000_i32).prop_map(|(x, e)| f64::from(x) * 2.0_f64.powi(e)),
        -1.0..1.0_f64,
    ]
}

/// Four points: all of small integers, of one power of two, or of anything.
fn points() -> impl Strategy<Value = [[f64; 3]; 4]> {
    let small = uniform3((-6..=6_i32).prop_map(f64::from));
    let near = uniform3((1..6_i32).prop_map(|x| 1e6 + f64::from(x) * 0.125));
    let any = || uniform3(coordinate());
    prop_oneof![
        [small.clone(), small.clone(), small.clone(), small],
        [near.clone(), near.clone(), near.clone(), near],
        [any(), any(), any(), any()],
    ]
}

/// A parameter from 1 to 2, often a short fraction.
fn beta() -> impl Strategy<Value = f64> {
    prop_oneof![
        (0..=8_i32).prop_map(|k| 1.0 + f64::from(k) / 8.0),
        1.0..=2.0_f64,
        Just(1.25),
        Just(5.0 / 3.0),
    ]
}

fn minus(a: &[BigInt], b: &[BigInt]) -> Vector {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[BigInt], b: &[BigInt]) -> BigInt {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn squared(a: &[BigInt], b: &[BigInt]) -> BigInt {
    let v = minus(a, b);
    dot(&v, &v)
}

/// `beta` times 2^52.
fn whole(beta: f64) -> BigInt {
    BigInt::from((beta * 2.0_f64.powi(52)) as u64)
}

proptest! {
    #[test]
    fn angles_and_lengths_are_exact([a, b, c, d] in points()) {
        let i = integers(&[a, b, c, d]);
        let right = dot(&minus(&i[0], &i[1]), &minus(&i[2], &i[1]));
        prop_assert_eq!(angle(a, b, c), sign_of(&right));
        let longer = squared(&i[3], &i[2]) - squared(&i[1], &i[0]);
        prop_assert_eq!(shorter(a, b, c, d), sign_of(&longer));
        prop_assert_eq!(shorter(c, d, b, a), -shorter(a, b, c, d));
        prop_assert_eq!(shorter(a, b, b, a), Sign::Zero);
    }

    #[test]
    fn lunes_are_exact([a, b, p, _] in points(), beta in beta()) {
        let i = integers(&[a, b, p]);
        let (u, w) = (minus(&i[2], &i[0]), minus(&i[1], &i[0]));
        let det = whole(beta) * dot(&u, &w) - (dot(&u, &u) << 52);
        prop_assert_eq!(lune(a, b, p, beta), sign_of(&det));
    }

    #[test]
    fn the_lunes_of_1_and_2_are_balls([a, b, p, _] in points()) {
        prop_assert_eq!(lune(a, b, p, 1.0), -angle(a, p, b));
        prop_assert_eq!(lune(a, b, p, 2.0), shorter(p, b, a, b));
    }

    #[test]
    fn arcs_are_exact([a, b, p, _] in points(), beta in beta()) {
        let flat = |p: [f64; 3]| [p[0], p[1]];
        let (a, b, p) = (flat(a), flat(b), flat(p));
        prop_assume!(p != a && p != b && a != b);
        let i = integers(&[a, b, p]);
        let (u, v) = (minus(&i[0], &i[2]), minus(&i[1], &i[2]));
        let (along, across) = (dot(&u, &v), &u[0] * &v[1] - &u[1] * &v[0]);
        let (beta_squared, one) = (whole(beta) * whole(beta), BigInt::from(1) << 104);
        let rest = &across * &across * (beta_squared - &one) - &along * &along * one;
        let obtuse = sign_of(&-along);
        let expected = match obtuse {
            Sign::Positive => Sign::Positive,
            Sign::Zero if beta > 1.0 => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Negative => sign_of(&rest),
        };
        prop_assert_eq!(arcs(a, b, p, beta), expected);
    }

    #[test]
    fn spheres_are_exact([a, c, b, d] in points()) {
        prop_assume!(a != c && b != d);
        let i = integers(&[a, c, b, d]);
        let (ac, bd) = (squared(&i[1], &i[0]), squared(&i[3], &i[2]));
        let rest = squared(&i[2], &i[0]) - &ac - &bd;
        let expected = if rest < BigInt::from(0) {
            Sign::Positive
        } else {
            sign_of(&(ac * bd * 4 - &rest * &rest))
        };
        prop_assert_eq!(spheres(a, c, b, d), expected);
        prop_assert_eq!(spheres(b, d, a, c), expected);
    }

    #[test]
    fn touching_spheres_touch(
        a in uniform3(-1000..1000_i32),
        step in uniform3(-9..=9_i32),
        r in 1..50_i32,
        s in 1..50_i32,
    ) {
        prop_assume!(step != [0; 3]);
        // All on one line, so that radii and distance are multiples of the step.
        let at = |k: i32| [0, 1, 2].map(|i| f64::from(a[i] + k * step[i]));
        prop_assert_eq!(spheres(at(0), at(-r), at(r + s), at(r + 2 * s)), Sign::Zero);
        prop_assert_eq!(spheres(at(0), at(-r), at(r + s + 1), at(r + 2 * s + 1)), Sign::Negative);
    }
}

#[test]
fn circles_through_lattice_points() {
    // A chord of 8 in circles of radius 5: beta is 10 / 8.
    let (a, b) = ([-4.0, 3.0], [4.0, 3.0]);
    for p in [[0.0, -5.0], [3.0, -4.0], [-5.0, 0.0], [0.0, 11.0]] {
        assert_eq!(arcs(a, b, p, 1.25), Sign::Zero);
        assert_eq!(arcs(a, b, p, 1.25 - f64::EPSILON), Sign::Negative);
        assert_eq!(arcs(a, b, p, 1.25 + f64::EPSILON), Sign::Positive);
    }
}
