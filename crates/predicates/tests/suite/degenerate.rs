//! Sets that are degenerate exactly: on one line, circle, plane or sphere of integers, also scaled and
//! translated without rounding.

use crate::oracle::points::{Random, circle_of_integers, power_of_two, shaken, sphere_of_integers};
use crate::oracle::{Answers, INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};
use delone_predicates::Sign;

/// Checks the points as they are, scaled, translated and shaken.
fn variants<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    points: [[f64; D]; N],
    random: &mut Random,
    answers: &mut Answers,
) {
    assert_eq!(predicate.check(points, answers), Sign::Zero, "{points:?}");
    let factor = power_of_two(random.integer(-1074, 900));
    let scaled = points.map(|p| p.map(|x| x * factor));
    assert_eq!(predicate.check(scaled, answers), Sign::Zero, "{scaled:?}");
    let offset = [(); D].map(|()| random.integer(-1 << 50, 1 << 50) as f64);
    let moved = points.map(|p| std::array::from_fn(|k| p[k] + offset[k]));
    assert_eq!(predicate.check(moved, answers), Sign::Zero, "{moved:?}");
    let both = moved.map(|p| p.map(|x| x * factor));
    assert_eq!(predicate.check(both, answers), Sign::Zero, "{both:?}");
    predicate.check(moved.map(|p| shaken(p, 1, random)), answers);
    predicate.check(points.map(|p| shaken(p, 2, random)), answers);
}

#[test]
fn all_of_a_small_grid() {
    let grid: Vec<[f64; 2]> = (0..9)
        .map(|i| [f64::from(i % 3), f64::from(i / 3)])
        .collect();
    let mut answers = Answers::default();
    for &a in &grid {
        for &b in &grid {
            for &c in &grid {
                ORIENT2D.check([a, b, c], &mut answers);
                for &d in &grid {
                    INCIRCLE.check([a, b, c, d], &mut answers);
                }
            }
        }
    }
    assert_eq!(answers.lattice, answers.cases, "a grid is a lattice");
}

#[test]
fn all_of_a_cube() {
    let cube: Vec<[f64; 3]> = (0..8)
        .map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)])
        .collect();
    let mut answers = Answers::default();
    for &a in &cube {
        for &b in &cube {
            for &c in &cube {
                for &d in &cube {
                    ORIENT3D.check([a, b, c, d], &mut answers);
                    let e = cube[answers.cases % 8];
                    INSPHERE.check([a, b, c, d, e], &mut answers);
                }
            }
        }
    }
    assert_eq!(answers.lattice, answers.cases, "a grid is a lattice");
}

#[test]
fn collinear() {
    let (mut random, mut answers) = (Random(31), Answers::default());
    for _ in 0..1000 {
        let [x, y, u, v] = [(); 4].map(|()| random.integer(-100, 100) as f64);
        let on = |t: f64| [x + t * u, y + t * v];
        let points = [(); 3].map(|()| on(random.integer(-9, 9) as f64));
        variants(&ORIENT2D, points, &mut random, &mut answers);
        let points = [(); 4].map(|()| on(random.integer(-9, 9) as f64));
        variants(&INCIRCLE, points, &mut random, &mut answers);
    }
    assert!(answers.scaled > 0);
}

#[test]
fn cocircular() {
    let circle = circle_of_integers(1105);
    assert_eq!(circle.len(), 108);
    let (mut random, mut answers) = (Random(32), Answers::default());
    for _ in 0..2000 {
        let points = [(); 4].map(|()| random.pick(&circle));
        variants(&INCIRCLE, points, &mut random, &mut answers);
    }
    assert!(answers.scaled > 0);
}

#[test]
fn cocircular_beyond_the_lattice() {
    // Mirror images share a circle around the origin, whatever their bits.
    let (mut random, mut answers) = (Random(33), Answers::default());
    for _ in 0..500 {
        for spread in [30, 100, 400, 1000] {
            let [x, y] = [random.any(-spread, 0), random.any(-spread, spread)];
            let points = [[x, y], [-x, y], [-x, -y], [y, x]];
            assert_eq!(INCIRCLE.check(points, &mut answers), Sign::Zero);
            INCIRCLE.check(points.map(|p| shaken(p, 1, &mut random)), &mut answers);
        }
    }
    assert!(answers.lattice < answers.cases / 2, "{answers:?}");
}

#[test]
fn coplanar() {
    let (mut random, mut answers) = (Random(34), Answers::default());
    for _ in 0..1000 {
        let frame = [(); 9].map(|()| random.integer(-30, 30) as f64);
        let points = [(); 4].map(|()| {
            let [s, t] = [(); 2].map(|()| random.integer(-5, 5) as f64);
            std::array::from_fn(|k| frame[k] + s * frame[3 + k] + t * frame[6 + k])
        });
        variants(&ORIENT3D, points, &mut random, &mut answers);
    }
    assert!(answers.scaled > 0);
}

#[test]
fn cospherical() {
    let sphere = sphere_of_integers(41 * 41);
    let (mut random, mut answers) = (Random(35), Answers::default());
    for _ in 0..1000 {
        let points = [(); 5].map(|()| random.pick(&sphere));
        variants(&INSPHERE, points, &mut random, &mut answers);
    }
    assert!(answers.scaled > 0);
}

#[test]
fn cospherical_beyond_the_lattice() {
    let (mut random, mut answers) = (Random(36), Answers::default());
    for _ in 0..300 {
        for spread in [30, 100, 400, 1000] {
            let [x, y, z] = [(); 3].map(|()| random.any(-spread, 0));
            let points = [[x, y, z], [-x, y, z], [y, x, -z], [z, -x, y], [-y, -z, -x]];
            assert_eq!(INSPHERE.check(points, &mut answers), Sign::Zero);
            INSPHERE.check(points.map(|p| shaken(p, 1, &mut random)), &mut answers);
        }
    }
    assert!(answers.lattice < answers.cases / 2, "{answers:?}");
}
