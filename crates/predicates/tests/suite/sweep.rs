//! The comparisons of the sweep against integers without limit.

use crate::oracle::points::power_of_two;
use crate::oracle::{integers, sign_of};
use crate::tier::cases;
use delone_predicates::sweep::{
    CircleEnd, circle_end_abscissa, circle_ends, front, integer_ends, lattice_ends,
};
use delone_predicates::{Point2, Sign, orient2d};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

/// Any finite double.
fn double() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(|b| {
        let x = f64::from_bits(b);
        if x.is_finite() {
            x
        } else {
            f64::from_bits(b & !(1 << 62))
        }
    })
}

/// Coordinates of many kinds: small integers, all exponents, near one.
fn points<const N: usize>() -> impl Strategy<Value = [Point2; N]> {
    let many = |x: BoxedStrategy<f64>| prop::array::uniform(prop::array::uniform2(x));
    prop_oneof![
        many((-3..4i32).prop_map(f64::from).boxed()),
        many((-3000..4000i32).prop_map(f64::from).boxed()),
        many((-1000..1000i64).prop_map(|i| (i << 40) as f64).boxed()),
        many(
            (-3..4i32)
                .prop_map(|i| 1.0 + f64::from(i) * f64::EPSILON)
                .boxed()
        ),
        many((-3..4i32).prop_map(|i| f64::from(i) * 1e-320).boxed()),
        many((0.0..1.0).boxed()),
        many(
            (0..6i32, 0.0..1.0)
                .prop_map(|(i, x)| f64::from(i) + x * 1e-15)
                .boxed()
        ),
        many(double().boxed()),
    ]
}

/// The triple turned right, or nothing where it is collinear.
fn right([a, b, c]: [Point2; 3]) -> Option<[Point2; 3]> {
    match orient2d(a, b, c) {
        Sign::Negative => Some([a, b, c]),
        Sign::Positive => Some([c, b, a]),
        Sign::Zero => None,
    }
}

/// The numbers of the end (n + sqrt l) / (2 d) of the circle through three points, seen from 0.
fn circle(p: &[Vec<BigInt>]) -> (BigInt, BigInt, BigInt) {
    let minus = |i: usize, j: usize| [&p[i][0] - &p[j][0], &p[i][1] - &p[j][1]];
    let length = |v: &[BigInt; 2]| &v[0] * &v[0] + &v[1] * &v[1];
    let (u, v, w) = (minus(0, 1), minus(2, 1), minus(2, 0));
    let d = &u[0] * &v[1] - &u[1] * &v[0];
    assert!(d.is_positive());
    let n = length(&u) * &v[1] - length(&v) * &u[1] + BigInt::from(2) * &d * &p[1][0];
    (d, n, length(&u) * length(&v) * length(&w))
}

/// The sign of a + sqrt p - sqrt q, by integer square roots of numbers that are scaled up until the
/// sum is zero or far from it.
fn sum(a: &BigInt, p: &BigInt, q: &BigInt) -> Sign {
    // The product of the four conjugates is an integer: if it is zero, one of them is; if not,
    // each is at least the inverse of the cube of their bound.
    let conjugates = {
        let s = p + q - a * a;
        &s * &s - BigInt::from(4) * p * q
    };
    let size = a.bits() + p.bits().div_ceil(2) + q.bits().div_ceil(2) + 4;
    let scale = if conjugates.is_zero() {
        size + 8
    } else {
        4 * size
    };
    let root = |x: &BigInt| (x << (2 * scale)).sqrt();
    let near = (a << scale) + root(p) - root(q);
    if near.abs() <= BigInt::from(2) {
        Sign::Zero
    } else {
        sign_of(&near)
    }
}

fn ends(s: [Point2; 3], t: [Point2; 3]) -> Sign {
    let all = integers(&[s[0], s[1], s[2], t[0], t[1], t[2]]);
    let ((d1, n1, l1), (d2, n2, l2)) = (circle(&all[..3]), circle(&all[3..]));
    sum(
        &(&n1 * &d2 - &n2 * &d1),
        &(&d2 * &d2 * l1),
        &(&d1 * &d1 * l2),
    )
}

fn check_ends(s: [Point2; 3], t: [Point2; 3]) -> Result<bool, TestCaseError> {
    let right = ends(s, t);
    prop_assert_eq!(circle_ends(s, t), right);
    prop_assert_eq!(circle_ends(t, s), -right);
    prop_assert_eq!(integer_ends(s, t), right);
    if let Some(sign) = lattice_ends(s, t) {
        prop_assert_eq!(sign, right);
    }
    if let Some(sign) = CircleEnd::of(s).minus(&CircleEnd::of(t)) {
        prop_assert_eq!(sign, right);
    }
    Ok(right.is_zero())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(166, 2000)))]

    #[test]
    fn parabolas(mut all in points::<3>()) {
        all.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]));
        let [a, b, q] = all;
        let p = integers(&[a, b, q]);
        let minus = |i: usize| [&p[2][0] - &p[i][0], &p[2][1] - &p[i][1]];
        let length = |v: &[BigInt; 2]| &v[0] * &v[0] + &v[1] * &v[1];
        let (u, v) = (minus(0), minus(1));
        let right = sign_of(&(length(&u) * &v[0] - length(&v) * &u[0]));
        prop_assert_eq!(front(a, b, q), right);
        prop_assert_eq!(front(b, a, q), -right);
    }

    #[test]
    fn ends_of_circles([a, b, c, e, f, g] in points::<6>()) {
        if let (Some(s), Some(t)) = (right([a, b, c]), right([e, f, g])) {
            check_ends(s, t)?;
        }
    }

    #[test]
    fn circles_that_share_points([a, b, c, d] in points::<4>()) {
        if let (Some(s), Some(t)) = (right([a, b, c]), right([b, c, d])) {
            check_ends(s, t)?;
            // Moved vertically: a tie where nothing was rounded.
            let up = t.map(|[x, y]| [x, y + 4.0]);
            if let Some(up) = right(up) {
                check_ends(s, up)?;
                check_ends(t, up)?;
            }
        }
    }

    #[test]
    fn ends_and_abscissas([a, b, c, q] in points::<4>()) {
        check_abscissa([a, b, c], q[0])?;
    }

    /// Abscissas of a few subnormal units make ends that are far below the circle's size.
    #[test]
    fn ends_in_thin_columns(
        xs in [-9..=9_i64, -9..=9, -9..=9, -9..=9],
        ys in points::<3>(),
        unit in -1074..=-900_i64,
    ) {
        let x = |i: usize| xs[i] as f64 * power_of_two(unit);
        let triple = [0, 1, 2].map(|i| [x(i), ys[i][1]]);
        check_abscissa(triple, x(3))?;
        if let (Some(s), Some(t)) = (right(triple), right([0, 1, 2].map(|i| [x(3 - i), ys[i][0]]))) {
            check_ends(s, t)?;
        }
    }
}

fn check_abscissa(triple: [Point2; 3], x: f64) -> Result<(), TestCaseError> {
    let Some(s) = right(triple) else {
        return Ok(());
    };
    let all = integers(&[s[0], s[1], s[2], [x, 0.0]]);
    let (d, n, l) = circle(&all[..3]);
    let right = sum(&(n - BigInt::from(2) * d * &all[3][0]), &l, &BigInt::zero());
    prop_assert_eq!(circle_end_abscissa(s, x), right);
    if let Some(sign) = CircleEnd::of(s).minus_abscissa(x) {
        prop_assert_eq!(sign, right);
    }
    Ok(())
}

#[test]
fn equal_ends_of_unlike_circles_are_ties() {
    // Radii 5 and 25 about points 20 apart.
    let s = [[3.0, -4.0], [-5.0, 0.0], [3.0, 4.0]];
    let t = [[15.0, 20.0], [-25.0, 0.0], [15.0, -20.0]].map(|[x, y]| [x - 20.0, y + 100.0]);
    let [s, t] = [s, t].map(|t| right(t).unwrap());
    assert_eq!(ends(s, t), Sign::Zero);
    assert!(check_ends(s, t).unwrap());
    assert_eq!(circle_end_abscissa(s, 5.0), Sign::Zero);
    // Radii sqrt 2 and sqrt 8 with centres apart by their difference are no tie in rational points.
    let u = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    let v = [[-2.0, -2.0], [-2.0, 2.0], [2.0, 2.0]].map(|[x, y]| [x - 1.0, y]);
    let [u, v] = [u, v].map(|t| right(t).unwrap());
    assert!(!check_ends(u, v).unwrap());
}
