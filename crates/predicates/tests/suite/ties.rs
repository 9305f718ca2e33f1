//! Canonical ties: against an explicit perturbation by small rational numbers, under permutations, and
//! by what they are for: one triangulation of cocircular and cospherical points.

use std::cmp::Ordering;

use crate::oracle::points::{Random, circle_of_integers, shaken, sphere_of_integers};
use delone_predicates::{
    Point2, Point3, Sign, incircle, incircle_canonical, insphere_canonical, lexicographic,
    orient2d, orient3d, tie_flips,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed};

fn sorted<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
    let mut points = points.to_vec();
    points.sort_by(|&a, &b| lexicographic(a, b));
    points.dedup();
    points
}

/// The sphere predicate with heights |p|^2 - 2^-60(rank + 1), for integer points below 2^9: all
/// cofactors are integers below 2^60.
fn perturbed<const D: usize, const N: usize>(points: [[f64; D]; N]) -> Sign {
    let order = sorted(&points);
    let number = |x: f64| BigRational::from_float(x).expect("finite");
    let rows: Vec<Vec<BigRational>> = points
        .iter()
        .map(|p| {
            let rank = order.iter().position(|q| q == p).expect("of these points");
            let epsilon = BigRational::new(BigInt::one(), BigInt::one() << (60 * (rank + 1)));
            let height: BigRational = p.iter().map(|&x| number(x) * number(x)).sum();
            let mut row = vec![BigRational::one()];
            row.extend(p.iter().map(|&x| number(x)));
            row.push(height - epsilon);
            row
        })
        .collect();
    match determinant(&rows) {
        det if det.is_positive() => Sign::Negative,
        det if det.is_negative() => Sign::Positive,
        _ => Sign::Zero,
    }
}

fn determinant(rows: &[Vec<BigRational>]) -> BigRational {
    let Some((first, rest)) = rows.split_first() else {
        return BigRational::one();
    };
    let minor = |k: usize| {
        let rows: Vec<_> = rest
            .iter()
            .map(|r| [&r[..k], &r[k + 1..]].concat())
            .collect();
        determinant(&rows)
    };
    first
        .iter()
        .enumerate()
        .fold(BigRational::from(BigInt::ZERO), |sum, (k, x)| {
            if k % 2 == 0 {
                sum + x * minor(k)
            } else {
                sum - x * minor(k)
            }
        })
}

/// All orders of 0..n, with their parity.
fn permutations(n: usize) -> Vec<(Vec<usize>, bool)> {
    if n == 0 {
        return vec![(Vec::new(), false)];
    }
    let shorter = permutations(n - 1);
    let insert = |at: usize, (order, odd): &(Vec<usize>, bool)| {
        let mut order = order.clone();
        order.insert(at, n - 1);
        (order, odd ^ ((n - 1 - at) % 2 == 1))
    };
    (0..n)
        .flat_map(|at| {
            shorter
                .iter()
                .map(move |p| insert(at, p))
                .collect::<Vec<_>>()
        })
        .collect()
}

fn in_plane([a, b, c, d]: [Point2; 4]) -> Sign {
    incircle_canonical(a, b, c, d)
}

fn in_space([a, b, c, d, e]: [Point3; 5]) -> Sign {
    insphere_canonical(a, b, c, d, e)
}

/// Consistency under all permutations.
fn consistent<const D: usize, const N: usize>(
    predicate: fn([[f64; D]; N]) -> Sign,
    points: [[f64; D]; N],
    orders: &[(Vec<usize>, bool)],
) -> Sign {
    let sign = predicate(points);
    for (order, odd) in orders {
        let permuted = std::array::from_fn(|i| points[order[i]]);
        assert_eq!(
            predicate(permuted),
            sign.flip_if(*odd),
            "{points:?} as {order:?}"
        );
    }
    sign
}

#[test]
fn grids_agree_with_small_rationals() {
    let orders = permutations(4);
    let mut random = Random(51);
    let mut ties = 0;
    for _ in 0..2000 {
        let points = [(); 4].map(|()| [(); 2].map(|()| random.integer(-1, 2) as f64));
        let sign = consistent(in_plane, points, &orders);
        assert_eq!(sign, perturbed(points), "{points:?}");
        let [a, b, c, d] = points;
        ties += usize::from(incircle(a, b, c, d) == Sign::Zero && sign != Sign::Zero);
        let collinear = orient2d(a, b, c).is_zero()
            && orient2d(a, b, d).is_zero()
            && orient2d(a, c, d).is_zero()
            && orient2d(b, c, d).is_zero();
        assert_eq!(
            sign.is_zero(),
            collinear || sorted(&points).len() < 4,
            "{points:?}"
        );
    }
    assert!(ties > 50);
}

#[test]
fn spatial_grids_agree_with_small_rationals() {
    let orders = permutations(5);
    let mut random = Random(52);
    let mut ties = 0;
    for case in 0..600 {
        let most = if case % 2 == 0 { 1 } else { 2 };
        let points = [(); 5].map(|()| [(); 3].map(|()| random.integer(0, most) as f64));
        let sign = consistent(in_space, points, &orders);
        assert_eq!(sign, perturbed(points), "{points:?}");
        let coplanar = (0..5).all(|k| {
            let o = |i: usize| points[(k + i) % 5];
            orient3d(o(1), o(2), o(3), o(4)).is_zero()
        });
        assert_eq!(
            sign.is_zero(),
            coplanar || sorted(&points).len() < 5,
            "{points:?}"
        );
        ties += usize::from(!sign.is_zero() && crate::oracle::sphere(&points).is_zero());
    }
    assert!(ties > 50);
}

#[test]
fn near_ties_follow_the_determinant() {
    let circle = circle_of_integers(1105);
    let sphere = sphere_of_integers(41 * 41);
    let mut random = Random(53);
    for _ in 0..2000 {
        let points = [(); 4].map(|()| shaken(random.pick(&circle), 1, &mut random));
        let sign = crate::oracle::sphere(&points);
        assert!(sign.is_zero() || in_plane(points) == sign);
        let points = [(); 5].map(|()| shaken(random.pick(&sphere), 1, &mut random));
        let sign = crate::oracle::sphere(&points);
        assert!(sign.is_zero() || in_space(points) == sign);
    }
}

#[test]
fn a_cocircular_polygon_is_a_fan() {
    let mut polygon = circle_of_integers(65);
    polygon.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    let smallest = sorted(&polygon)[0];
    let start = polygon
        .iter()
        .position(|&p| p == smallest)
        .expect("of the polygon");
    polygon.rotate_left(start);
    for pair in polygon[1..].windows(2) {
        for &d in &polygon {
            let sign = incircle_canonical(smallest, pair[0], pair[1], d);
            let corner = [smallest, pair[0], pair[1]].contains(&d);
            assert_eq!(sign, if corner { Sign::Zero } else { Sign::Negative });
        }
    }
}

#[test]
fn flips_agree_with_the_perturbed_circle() {
    let circle = circle_of_integers(65);
    let mut cases = 0;
    for &u in &circle {
        for &v in &circle {
            for &p in circle
                .iter()
                .filter(|&&p| orient2d(u, v, p) == Sign::Positive)
            {
                for &q in circle
                    .iter()
                    .filter(|&&q| orient2d(u, v, q) == Sign::Negative)
                {
                    let conflict = incircle_canonical(u, v, p, q) == Sign::Positive;
                    assert_eq!(tie_flips(u, v, p, q), conflict, "{u:?} {v:?} {p:?} {q:?}");
                    assert_eq!(tie_flips(v, u, q, p), conflict);
                    cases += 1;
                }
            }
        }
    }
    assert!(cases > 10_000);
}

/// Six times the volume of all tetrahedra whose perturbed sphere is empty. They cover the hull once
/// exactly if the perturbation is consistent.
fn covered(points: &[Point3]) -> f64 {
    let n = points.len();
    let mut volume = 0.0;
    for i in 0..n {
        for j in 0..i {
            for k in 0..j {
                for l in 0..k {
                    let [a, b, c, d] = [i, j, k, l].map(|v| points[v]);
                    let orientation = orient3d(a, b, c, d);
                    let empty = |&e: &Point3| {
                        insphere_canonical(a, b, c, d, e) * orientation != Sign::Positive
                    };
                    if orientation != Sign::Zero && points.iter().all(empty) {
                        let [b, c, d] = [b, c, d].map(|p| [0, 1, 2].map(|x| p[x] - a[x]));
                        let minor = |x: usize, y: usize| c[x] * d[y] - c[y] * d[x];
                        let det = b[0] * minor(1, 2) - b[1] * minor(0, 2) + b[2] * minor(0, 1);
                        volume += det.abs();
                    }
                }
            }
        }
    }
    volume
}

#[test]
fn cospherical_points_are_triangulated_once() {
    let grid = |side: u32| -> Vec<Point3> {
        (0..side.pow(3))
            .map(|i| [i % side, i / side % side, i / side.pow(2)].map(f64::from))
            .collect()
    };
    assert_eq!(covered(&grid(2)), 6.0);
    assert_eq!(covered(&grid(3)), 48.0);
    // The octahedron and the cuboctahedron, of volumes 4/3 and 20/3.
    assert_eq!(covered(&sphere_of_integers(1)), 8.0);
    assert_eq!(covered(&sphere_of_integers(2)), 40.0);
}

#[test]
fn zeros_of_both_signs_are_one_coordinate() {
    assert_eq!(lexicographic([0.0, 1.0], [-0.0, 1.0]), Ordering::Equal);
    assert_eq!(
        lexicographic([-0.0, 1.0, 2.0], [0.0, 1.0, 1.0]),
        Ordering::Greater
    );
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let negative = [[-0.0, -0.0], [1.0, -0.0], [1.0, 1.0], [-0.0, 1.0]];
    assert_eq!(in_plane(square), in_plane(negative));
    assert_eq!(
        in_plane([square[0], square[1], square[2], negative[0]]),
        Sign::Zero
    );
}

#[test]
fn what_is_not_finite_does_not_panic() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for index in 0..15 {
            let mut points = [[0.0; 3]; 5];
            points[index / 3][index % 3] = bad;
            assert_eq!(in_space(points), Sign::Zero);
            let plane = [0, 1, 2, 3].map(|i| [points[i][0], points[i][1] + i as f64]);
            let _ = in_plane(plane);
        }
    }
}
