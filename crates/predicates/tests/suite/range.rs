//! The whole range of doubles: subnormals, `f64::MAX`, mixtures, and the edges of each size class.

use crate::oracle::points::{Random, power_of_two, ulps};
use crate::oracle::{Answers, INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};

/// Runs `test` for each predicate with a number of cases in proportion to its cost.
macro_rules! for_each_predicate {
    ($($test:ident: $cases:expr;)+) => {
        $(mod $test {
            use super::*;

            #[test]
            fn of_orient2d() {
                super::$test(&ORIENT2D, $cases);
            }

            #[test]
            fn of_incircle() {
                super::$test(&INCIRCLE, $cases / 2);
            }

            #[test]
            fn of_orient3d() {
                super::$test(&ORIENT3D, $cases / 2);
            }

            #[test]
            fn of_insphere() {
                super::$test(&INSPHERE, $cases / 4);
            }
        })+
    };
}

for_each_predicate! {
    mixed_exponents: 600;
    extreme_values: 6000;
    lattice_widths: 100;
    integer_widths: 40;
    shifted_exponents: 200;
}

/// Exponents uniform in windows of all sizes.
fn mixed_exponents<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let mut random = Random(21);
    let mut total = Answers::default();
    for (low, high) in [
        (-3, 3),
        (-60, 60),
        (-160, 189),
        (-170, 199),
        (-300, -150),
        (-1074, -1000),
        (-1074, -700),
        (1000, 1023),
        (150, 600),
        (-400, 400),
        (-1074, 1023),
    ] {
        let mut answers = Answers::default();
        for _ in 0..cases {
            predicate.check(
                [(); N].map(|()| [(); D].map(|()| random.any(low, high))),
                &mut answers,
            );
            let sparse = [(); N].map(|()| [(); D].map(|()| random.sparse(low, high)));
            predicate.check(sparse, &mut answers);
        }
        total.scaled += answers.scaled;
        total.zeros += answers.zeros;
    }
    assert!(total.scaled > 0 && total.zeros > 0, "{total:?}");
}

/// The corners of the range, which fill the size classes and overflow everything else.
fn extreme_values<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let tiny = f64::from_bits(1);
    let values = [
        0.0,
        tiny,
        f64::MIN_POSITIVE,
        1e-320,
        1e-300,
        1.0,
        1e300,
        1e308,
        f64::MAX,
    ];
    let mut random = Random(22);
    let mut answers = Answers::default();
    for case in 0..cases {
        // Half of the cases draw from a few values, so that degenerate ones are frequent.
        let few = if case % 2 == 0 {
            [random.pick(&values), f64::MAX]
        } else {
            [0.0, tiny]
        };
        let mut draw = || {
            let x = if case % 4 < 2 {
                random.pick(&few)
            } else {
                random.pick(&values)
            };
            let x = if random.one_in(2) { x } else { -x };
            if random.one_in(4) {
                ulps(x, random.integer(-2, 2))
            } else {
                x
            }
        };
        predicate.check([(); N].map(|()| [(); D].map(|()| draw())), &mut answers);
    }
    assert!(answers.zeros > 0 && answers.scaled > 0, "{answers:?}");
}

/// Integers at the edge of each size of the lattice stage: most differences are 2^bits - 1 or zero.
fn lattice_widths<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let mut random = Random(23);
    for bits in 1..=64 {
        let low = -power_of_two(bits - 1);
        let high = if bits < 55 {
            -1.0 - low
        } else {
            ulps(-low, -1)
        };
        let mut answers = Answers::default();
        for _ in 0..cases {
            let mut draw = || match random.one_in(8) {
                true => random.pick(&[0.0, 1.0, -low, -high, low + 1.0]),
                false => random.pick(&[low, high]),
            };
            predicate.check([(); N].map(|()| [(); D].map(|()| draw())), &mut answers);
        }
        assert!(
            bits > 50 || answers.lattice == answers.cases,
            "{bits} bits: {answers:?}"
        );
    }
}

/// Coordinates at the edge of each size class of wide integers: the width, from the lowest bit to the
/// highest, at the classes' limits of 125, 317 and 765 bits, and all that doubles have.
fn integer_widths<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let mut random = Random(24);
    for limit in [61, 125, 317, 765, 2097] {
        for width in limit - 2..=2098.min(limit + 2) {
            for low in [-1074, -300, 1023 - width] {
                let top = low + width;
                if top > 1024 || low < -1074 {
                    continue;
                }
                let largest = ulps(2.0, -1) * power_of_two(top - 1);
                let unit = power_of_two(low);
                let values = [largest, -largest, ulps(largest, -1), -largest, unit, -unit];
                let mut answers = Answers::default();
                for _ in 0..cases {
                    let mut points = [(); N].map(|()| [(); D].map(|()| random.pick(&values)));
                    points[N - 1][0] = unit;
                    points[0][D - 1] = largest;
                    predicate.check(points, &mut answers);
                }
            }
        }
    }
}

/// A power of two changes no sign.
fn shifted_exponents<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let mut random = Random(25);
    let mut answers = Answers::default();
    for case in 0..cases {
        let points = [(); N].map(|()| {
            [(); D].map(|()| match case % 2 {
                0 => random.integer(-2, 2) as f64,
                _ => random.integer(-1_000_000, 1_000_000) as f64 / 1024.0,
            })
        });
        let sign = predicate.check(points, &mut answers);
        for exponent in [
            -1064, -990, -900, -537, -268, -214, -100, 7, 190, 255, 500, 1002,
        ] {
            let scaled = points.map(|p| p.map(|x| x * power_of_two(exponent)));
            assert_eq!(
                predicate.check(scaled, &mut answers),
                sign,
                "2^{exponent} {points:?}"
            );
        }
    }
    assert!(answers.zeros > 0, "{answers:?}");
}

#[test]
fn what_is_not_finite_gives_zero() {
    fn each<const D: usize, const N: usize>(predicate: &Predicate<D, N>) {
        let mut random = Random(26);
        for bad in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for index in 0..D * N {
                for others in 0..10 {
                    let mut points = [(); N].map(|()| {
                        [(); D].map(|()| match others {
                            0 => 0.0,
                            1 => f64::MAX,
                            2 => bad,
                            _ => random.any(-1074, 1023),
                        })
                    });
                    points[index / D][index % D] = bad;
                    assert!((predicate.whole)(points).is_zero(), "{points:?}");
                    assert!((predicate.exact)(points).is_zero(), "{points:?}");
                    assert!((predicate.integer)(points).is_zero(), "{points:?}");
                    for (name, stage) in predicate.partial {
                        assert!(stage(points).is_none(), "{name}: {points:?}");
                    }
                }
            }
        }
    }
    each(&ORIENT2D);
    each(&INCIRCLE);
    each(&ORIENT3D);
    each(&INSPHERE);
}
