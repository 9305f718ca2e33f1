//! Inputs close to the worst that the heads of the predicates' files speak of: with an error bound or a
//! width that is too small, some of these get the wrong sign. Bounds are found out below 2 u of the 4 u
//! of `orient2d`, 6 u of the 8 u of `orient3d`, and 3 u of the 16 u of `insphere`; `filter.rs` finds
//! that of `incircle` out below 3 u.

use crate::oracle::points::{Random, power_of_two, ulps};
use crate::oracle::{Answers, INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// The double `steps` above 1.0, with steps such that rounding a product of two such doubles makes an
/// error of nearly half a unit: 2^26 is where the product of the steps comes to one unit.
fn above_one(random: &mut Random) -> f64 {
    ulps(1.0, random.integer(1 << 25, 1 << 27))
}

/// Moves one coordinate to the double after which the sign changes; `None` where it is the same for
/// all doubles up to 2^29 steps away.
fn last_before_zero<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    mut points: [[f64; D]; N],
    [i, k]: [usize; 2],
) -> Option<[[f64; D]; N]> {
    let start = points[i][k];
    let mut sign_at = |steps: i64| {
        points[i][k] = ulps(start, steps);
        (predicate.integer)(points)
    };
    let (mut low, mut high) = (-1_i64 << 29, 1_i64 << 29);
    let first = sign_at(low);
    if first == sign_at(high) {
        return None;
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if sign_at(middle) == first {
            low = middle;
        } else {
            high = middle;
        }
    }
    points[i][k] = ulps(start, low);
    Some(points)
}

/// Asserts that all stages are right about the doubles around each zero.
fn around_zeros<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    cases: usize,
    which: [usize; 2],
    draw: impl Fn(&mut Random) -> [[f64; D]; N],
) {
    let mut random = Random(51);
    let mut found = 0;
    for _ in 0..cases {
        let Some(zero) = last_before_zero(predicate, draw(&mut random), which) else {
            continue;
        };
        found += 1;
        for steps in -2..=3 {
            let mut points = zero;
            points[which[0]][which[1]] = ulps(points[which[0]][which[1]], steps);
            let right = (predicate.integer)(points);
            for (name, stage) in predicate.partial {
                if let Some(sign) = stage(points) {
                    assert_eq!(sign, right, "{name}: {points:?}");
                }
            }
        }
    }
    assert!(found > cases / 2, "{found} of {cases}");
}

/// The origin is a little more than half a unit below zero: differences round up, which makes what is
/// positive larger and what is negative smaller in size. The two products have the one or the other.
#[test]
fn orient2d_where_all_roundings_add_up() {
    around_zeros(&ORIENT2D, 4000, [2, 0], |random| {
        let low = -U * (1.0 + random.unit() / 64.0);
        let [p, q, r, s] = [(); 4].map(|()| above_one(random));
        [[low, low], [p, -r], [-s, q]]
    });
}

/// As in the plane, for two of the six monomials; the zeros of the others become half a unit, so that
/// the sums round as well.
#[test]
fn orient3d_where_all_roundings_add_up() {
    around_zeros(&ORIENT3D, 40_000, [1, 2], |random| {
        let low = -U * (1.0 + random.unit() / 64.0);
        let [p, q, r, s, t, v] = [(); 6].map(|()| above_one(random));
        [[low; 3], [p, 0.0, -s], [-t, q, 0.0], [0.0, -v, r]]
    });
}

/// Points a few doubles off a sphere through the origin, which is half a unit off itself.
#[test]
fn insphere_where_roundings_add_up() {
    around_zeros(&INSPHERE, 4000, [3, 2], |random| {
        let low = [(); 3].map(|()| random.pick(&[-U, U]) * (1.0 + random.unit() / 64.0));
        let [p, q, r, s, t, v] = [(); 6].map(|()| above_one(random));
        let sign = random.pick(&[1.0, -1.0]);
        random.pick(&[
            [
                [p, 0.0, 0.0],
                [0.0, q, 0.0],
                [0.0, 0.0, sign * r],
                [s, t, sign * v],
                low,
            ],
            [[p, 0.0, q], [0.0, r, s], [t, v, 0.0], [1.0, 1.0, 1.0], low],
        ])
    });
}

/// Integers of any number of bits in every octant around one at zero: determinants as large as the
/// bits allow, two to sixteen times those of points on one side of it.
fn largest_determinants<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    origin: usize,
    cases: usize,
) {
    let mut random = Random(52);
    for bits in 1..=53 {
        let largest = power_of_two(bits) - 1.0;
        let mut answers = Answers::default();
        for _ in 0..cases {
            let mut points = [(); N].map(|()| [(); D].map(|()| random.pick(&[largest, -largest])));
            points[origin] = [0.0; D];
            if random.one_in(4) {
                points[(origin + 1) % N][0] = random.pick(&[0.0, 1.0, 1.0 - largest]);
            }
            predicate.check(points, &mut answers);
        }
        assert_eq!(answers.lattice, answers.cases, "{bits} bits");
    }
}

#[test]
fn orient2d_of_largest_determinants() {
    largest_determinants(&ORIENT2D, 0, 40);
}

#[test]
fn orient3d_of_largest_determinants() {
    largest_determinants(&ORIENT3D, 0, 40);
}

#[test]
fn incircle_of_largest_determinants() {
    largest_determinants(&INCIRCLE, 3, 40);
}

#[test]
fn insphere_of_largest_determinants() {
    largest_determinants(&INSPHERE, 4, 60);
}
