//! Properties that hold for all finite doubles: an exchange of two points changes the sign, equal
//! points give zero, a reflection changes the sign.

use crate::oracle::{INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};
use crate::tier::cases;
use delone_predicates::Sign;
use proptest::array::uniform;
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

fn points<const D: usize, const N: usize>() -> impl Strategy<Value = [[f64; D]; N]> {
    uniform::<_, N>(uniform::<_, D>(coordinate()))
}

fn holds<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    points: [[f64; D]; N],
    (i, j): (usize, usize),
) -> Result<(), TestCaseError> {
    let sign = (predicate.whole)(points);
    prop_assert_eq!(sign, (predicate.oracle)(&points));
    prop_assert_eq!(sign, (predicate.exact)(points));
    let mut swapped = points;
    swapped.swap(i, j);
    prop_assert_eq!(
        (predicate.whole)(swapped),
        if i == j { sign } else { -sign }
    );
    let mut equal = points;
    equal[i] = points[j];
    prop_assert!(i == j || (predicate.whole)(equal) == Sign::Zero);
    let reflected = points.map(|mut p| {
        p[0] = -p[0];
        p
    });
    prop_assert_eq!((predicate.whole)(reflected), -sign);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(166, 2000)))]

    #[test]
    fn orient2d(p in points::<2, 3>(), i in 0..3_usize, j in 0..3_usize) {
        holds(&ORIENT2D, p, (i, j))?;
    }

    #[test]
    fn incircle(p in points::<2, 4>(), i in 0..4_usize, j in 0..4_usize) {
        holds(&INCIRCLE, p, (i, j))?;
    }

    #[test]
    fn orient3d(p in points::<3, 4>(), i in 0..4_usize, j in 0..4_usize) {
        holds(&ORIENT3D, p, (i, j))?;
    }

    #[test]
    fn insphere(p in points::<3, 5>(), i in 0..5_usize, j in 0..5_usize) {
        holds(&INSPHERE, p, (i, j))?;
    }
}

#[test]
fn signs_multiply_and_convert() {
    let all = [Sign::Negative, Sign::Zero, Sign::Positive];
    for a in all {
        assert_eq!(i8::from(-a), -i8::from(a));
        assert_eq!(a.flip_if(true), -a);
        assert_eq!(a.flip_if(false), a);
        assert_eq!(Sign::of(f64::from(i8::from(a))), a);
        assert_eq!(Sign::from(i8::from(a).cmp(&0)), a);
        for b in all {
            assert_eq!(i8::from(a * b), i8::from(a) * i8::from(b));
        }
    }
    assert_eq!(Sign::of(f64::NAN), Sign::Zero);
}
