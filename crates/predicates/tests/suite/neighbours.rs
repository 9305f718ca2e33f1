//! Points moved by single doubles around degenerate positions, where floating point is at its worst.

use crate::oracle::points::{Random, shaken, ulps};
use crate::oracle::{Answers, INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};

/// Moves one coordinate pair of point `which` over 16 x 16 neighbours.
fn sweep<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    points: [[f64; D]; N],
    which: usize,
    answers: &mut Answers,
) {
    for i in -8..8 {
        for j in -8..8 {
            let mut moved = points;
            moved[which][0] = ulps(moved[which][0], i);
            moved[which][D - 1] = ulps(moved[which][D - 1], j);
            predicate.check(moved, answers);
        }
    }
}

/// Filter, lattice and expansion answer some of these, but not all; some are zero.
fn assert_mixed(answers: Answers) {
    println!("{answers:?}");
    for answered in [
        answers.filter,
        answers.lattice,
        answers.expansion,
        answers.zeros,
    ] {
        assert!(0 < answered && answered < answers.cases, "{answers:?}");
    }
}

#[test]
fn orient2d_near_a_line() {
    let mut answers = Answers::default();
    let lines = [
        [[0.5, 0.5], [12.0, 12.0], [24.0, 24.0]],
        [
            [0.5, 0.5],
            [17.3, 17.3],
            [24.000_000_000_000_05, 24.000_000_000_000_053],
        ],
        [[1e-3, 1e-3], [0.1, 0.1], [0.3, 0.3]],
        [[1e-12, 0.0], [0.1, 0.3], [0.2, 0.6]],
        [
            [500_000.0, 5_400_000.0],
            [500_100.1, 5_400_300.3],
            [500_200.2, 5_400_600.6],
        ],
        [[-1.0, -1e-20], [0.0, 0.0], [1.0, 1e-20]],
    ];
    for points in lines {
        for which in 0..3 {
            sweep(&ORIENT2D, points, which, &mut answers);
        }
    }
    assert_mixed(answers);
}

#[test]
fn incircle_near_a_circle() {
    let mut answers = Answers::default();
    let (sine, cosine) = 0.3_f64.sin_cos();
    let circles = [
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [cosine, -sine]],
        [[0.6, 0.8], [-0.8, 0.6], [-0.6, -0.8], [0.8, -0.6]],
        [[1e-20, 1.0], [-1.0, 1e-20], [-1e-20, -1.0], [1.0, -1e-20]],
        [
            [500_003.0, 4e6],
            [500_000.0, 4e6 + 3.0],
            [499_997.0, 4e6],
            [500_000.0, 4e6 - 3.0],
        ],
        [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3], [0.4, 0.4]],
    ];
    for points in circles {
        for which in 0..4 {
            sweep(&INCIRCLE, points, which, &mut answers);
        }
    }
    assert_mixed(answers);
}

#[test]
fn orient3d_near_a_plane() {
    let mut answers = Answers::default();
    let planes = [
        [
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 0.25, 0.25],
        ],
        [
            [0.1, 0.1, 0.1],
            [0.2, 0.2, 0.7],
            [0.3, 0.3, 0.4],
            [0.9, 0.9, 1e-19],
        ],
        [
            [1e6, 2e6, 0.3],
            [1e6 + 0.1, 2e6, 0.3],
            [1e6, 2e6 + 0.1, 0.3],
            [1e6, 2e6, 0.3],
        ],
    ];
    for points in planes {
        for which in 0..4 {
            sweep(&ORIENT3D, points, which, &mut answers);
        }
    }
    assert_mixed(answers);
}

#[test]
fn insphere_near_a_sphere() {
    let mut answers = Answers::default();
    let spheres = [
        [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0],
            [0.6, 0.0, 0.8],
        ],
        [
            [0.1, 0.1, 0.1],
            [0.2, 0.1, 0.1],
            [0.1, 0.2, 0.1],
            [0.1, 0.1, 0.2],
            [0.2, 0.2, 0.2],
        ],
        [
            [0.9, 0.1, 0.2],
            [0.2, 0.8, 0.1],
            [0.3, 0.1, 0.7],
            [-0.9, 0.2, 0.1],
            [1e-16, 0.8, 0.8],
        ],
        [
            [3.0, 1e-19, 0.0],
            [0.0, 3.0, 0.0],
            [0.0, 0.0, 3.0],
            [1.0, 2.0, 2.0],
            [2.0, 1.0, 2.0],
        ],
    ];
    for points in spheres {
        for which in 0..5 {
            sweep(&INSPHERE, points, which, &mut answers);
        }
    }
    assert_mixed(answers);
}

/// All points of random degenerate sets move at once.
fn shake<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    cases: usize,
    mut degenerate: impl FnMut(&mut Random) -> [[f64; D]; N],
) {
    let (mut random, mut answers) = (Random(11), Answers::default());
    for _ in 0..cases {
        let points = degenerate(&mut random);
        let most = random.pick(&[0, 1, 2, 4]);
        predicate.check(points.map(|p| shaken(p, most, &mut random)), &mut answers);
    }
    println!("{answers:?}");
    assert!(answers.filter < answers.cases * 3 / 4, "{answers:?}");
    assert!(answers.expansion > 0 && answers.lattice > 0, "{answers:?}");
}

#[test]
fn shaken_lines() {
    shake(&ORIENT2D, 20_000, |random| {
        let (slope, offset) = (random.any(-5, 5), random.any(-5, 5));
        [(); 3]
            .map(|()| random.any(-3, 3))
            .map(|t| [t, slope * t + offset])
    });
}

#[test]
fn shaken_circles() {
    shake(&INCIRCLE, 20_000, |random| {
        let (centre, radius) = ([random.any(-5, 20), random.any(-5, 5)], random.any(-5, 5));
        [(); 4].map(|()| {
            let (sine, cosine) = (7.0 * random.unit()).sin_cos();
            [centre[0] + radius * cosine, centre[1] + radius * sine]
        })
    });
}

#[test]
fn shaken_planes() {
    shake(&ORIENT3D, 10_000, |random| {
        let [u, v] = [(); 2].map(|()| random.any(-3, 3));
        [(); 4].map(|()| {
            let [x, y] = [(); 2].map(|()| random.any(-4, 4));
            [x, y, u * x + v * y]
        })
    });
}

#[test]
fn shaken_spheres() {
    shake(&INSPHERE, 5_000, |random| {
        let radius = random.any(-5, 5);
        [(); 5].map(|()| {
            let p = [(); 3].map(|()| random.unit() - 0.5);
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            p.map(|x| radius * x / length)
        })
    });
}
