//! Which of two points is nearer, against integers without limit.

use crate::oracle::{integers, sign_of};
use delone_predicates::{Point2, Point3, Sign, nearer, nearer3};
use proptest::array::{uniform2, uniform3};
use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
use proptest::prelude::*;

/// Any finite double, or a small integer times a power of two, so that ties happen.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        (-3..=3_i32).prop_map(f64::from),
        (-3..=3_i32, -1070..1000_i32).prop_map(|(x, e)| f64::from(x) * 2.0_f64.powi(e)),
        -1.0..1.0_f64,
    ]
}

fn expected(o: Point2, a: Point2, b: Point2) -> Sign {
    let rows = integers(&[o, a, b]);
    let squared = |p: &[num_bigint::BigInt]| {
        let (x, y) = (&p[0] - &rows[0][0], &p[1] - &rows[0][1]);
        &x * &x + &y * &y
    };
    sign_of(&(squared(&rows[2]) - squared(&rows[1])))
}

fn expected3(o: Point3, a: Point3, b: Point3) -> Sign {
    let rows = integers(&[o, a, b]);
    let squared = |p: &[num_bigint::BigInt]| -> num_bigint::BigInt {
        let differences = p.iter().zip(&rows[0]).map(|(x, o)| x - o);
        differences.map(|d| &d * &d).sum()
    };
    sign_of(&(squared(&rows[2]) - squared(&rows[1])))
}

proptest! {
    #[test]
    fn the_sign_is_exact_in_space(
        o in uniform3(coordinate()),
        a in uniform3(coordinate()),
        b in uniform3(coordinate()),
    ) {
        prop_assert_eq!(nearer3(o, a, b), expected3(o, a, b));
        prop_assert_eq!(nearer3(o, b, a), -nearer3(o, a, b));
        prop_assert_eq!(nearer3(o, a, a), Sign::Zero);
    }

    #[test]
    fn points_of_one_sphere_differ_by_less_than_a_double(
        centre in uniform3(-1e6..1e6_f64),
        turn in 0..4usize,
        shift in uniform3(-2..=2_i64),
    ) {
        let at = |p: Point3| [0, 1, 2].map(|k| centre[k] + p[k]);
        let a = at([2.0, 3.0, 6.0]);
        let b = at([[3.0, -6.0, 2.0], [-2.0, -3.0, -6.0], [6.0, 2.0, 3.0], [0.0, 7.0, 0.0]][turn]);
        let b = [0, 1, 2].map(|k| crate::oracle::points::ulps(b[k], shift[k]));
        prop_assert_eq!(nearer3(centre, a, b), expected3(centre, a, b));
    }

    #[test]
    fn the_sign_is_exact(
        o in uniform2(coordinate()),
        a in uniform2(coordinate()),
        b in uniform2(coordinate()),
    ) {
        prop_assert_eq!(nearer(o, a, b), expected(o, a, b));
        prop_assert_eq!(nearer(o, b, a), -nearer(o, a, b));
        prop_assert_eq!(nearer(o, a, a), Sign::Zero);
    }

    #[test]
    fn points_of_one_circle_differ_by_less_than_a_double(
        centre in uniform2(-1e6..1e6_f64),
        turn in 0..4usize,
        shift in uniform2(-2..=2_i64),
    ) {
        // (3, 4) and its turns are equally far; one unit in the last place is seen.
        let at = |x: f64, y: f64| [centre[0] + x, centre[1] + y];
        let a = at(3.0, 4.0);
        let [x, y] = [[4.0, -3.0], [-3.0, -4.0], [-4.0, 3.0], [0.0, 5.0]][turn];
        let b = at(x, y);
        let b = [crate::oracle::points::ulps(b[0], shift[0]), crate::oracle::points::ulps(b[1], shift[1])];
        prop_assert_eq!(nearer(centre, a, b), expected(centre, a, b));
    }
}

#[test]
fn what_is_not_finite_is_no_nearer() {
    assert_eq!(nearer([0.0; 2], [f64::NAN, 0.0], [1.0, 0.0]), Sign::Zero);
}
