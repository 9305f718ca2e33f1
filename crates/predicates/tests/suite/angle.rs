//! The angle against integers without limit.

use crate::oracle::{integers, sign_of};
use crate::tier::cases;
use delone_predicates::{Point2, Sign, angle};
use proptest::prelude::*;

fn right(a: Point2, p: Point2, b: Point2) -> Sign {
    let v = integers(&[a, p, b]);
    let product = |k: usize| (&v[0][k] - &v[1][k]) * (&v[2][k] - &v[1][k]);
    sign_of(&(product(0) + product(1)))
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-4..5_i32).prop_map(f64::from),
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        (-9..9_i64).prop_map(|i| f64::from_bits((1.0_f64.to_bits() as i64 + i) as u64)),
        (-9..9_i32).prop_map(|i| f64::from(i) * 5e-324),
        (0..4_000_000_i32).prop_map(|i| 5e5 + f64::from(i) * 1e-3),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(666, 8000)))]

    #[test]
    fn angles(c in prop::array::uniform6(coordinate())) {
        let [a, p, b] = [[c[0], c[1]], [c[2], c[3]], [c[4], c[5]]];
        prop_assert_eq!(angle(a, p, b), right(a, p, b));
        prop_assert_eq!(angle(b, p, a), right(a, p, b));
        // A turn by a right angle is exact and changes nothing.
        let turned = [a, p, b].map(|[x, y]| [-y, x]);
        prop_assert_eq!(angle(turned[0], turned[1], turned[2]), right(a, p, b));
    }
}

#[test]
fn right_angles_far_from_the_origin_are_right() {
    let [x, y] = [4.5e5 + 0.125, 5.4e6];
    let [a, p, b] = [[x + 3.0, y + 4.0], [x, y], [x - 4.0, y + 3.0]];
    assert_eq!(angle(a, p, b), Sign::Zero);
    assert_eq!(angle(a, p, [b[0], b[1].next_up()]), Sign::Positive);
    assert_eq!(angle(a, p, [b[0], b[1].next_down()]), Sign::Negative);
}
