//! 3-D hulls: around all points, with extreme points only, the same for every order of the rows.

use std::collections::BTreeSet;

use crate::tier::cases;
use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::hull::{Hull3, hull2, hull3};
use delone_predicates::{Point2, Sign, orient2d, orient3d};
use proptest::prelude::*;

fn made(points: &[Point3]) -> Option<Hull3> {
    hull3(points, &Watch::idle()).expect("a hull")
}

/// Checks the guarantees of a hull by predicates; returns its facets as coordinates.
fn check(points: &[Point3]) -> BTreeSet<Vec<[u64; 3]>> {
    let Some(hull) = made(points) else {
        assert!(is_flat(points), "{points:?}");
        return BTreeSet::new();
    };
    let at = |v: u32| points[v as usize];
    for (t, beyond) in hull.simplices.iter().zip(&hull.neighbors) {
        let [a, b, c] = t.map(at);
        for &p in points {
            assert_ne!(orient3d(a, b, c, p), Sign::Positive, "{points:?}");
        }
        for (k, &other) in beyond.iter().enumerate() {
            let there = hull.simplices[other as usize];
            assert!((0..3).all(|l| there.contains(&t[l]) == (l != k)));
        }
    }
    // A sphere: v - e + f = 2, where 2 e = 3 f.
    let vertices: BTreeSet<u32> = hull.simplices.as_flattened().iter().copied().collect();
    assert_eq!(2 * vertices.len(), hull.simplices.len() + 4, "{points:?}");
    let mut facets = BTreeSet::new();
    for (i, ends) in (0..).zip(hull.starts.windows(2)) {
        let facet = &hull.polygons[ends[0] as usize..ends[1] as usize];
        assert_eq!(
            hull.facet.iter().filter(|&&f| f == i).count(),
            facet.len() - 2
        );
        let [a, b, c] = [0, 1, 2].map(|k| at(facet[k]));
        let flat = |&v: &u32| orient3d(a, b, c, at(v)) == Sign::Zero;
        assert!(facet.iter().all(flat), "{points:?}");
        // Other points of the plane are not corners: strictly convex, no collinear corners.
        let n = facet.len();
        for k in 0..n {
            let [p, q, r] = [k, k + 1, k + 2].map(|j| at(facet[j % n]));
            assert!(!in_line(p, q, r), "{points:?}");
        }
        facets.insert(
            facet
                .iter()
                .map(|&v| at(v).map(|x| (x + 0.0).to_bits()))
                .collect(),
        );
    }
    // No two facets are in one plane.
    for t in 0..hull.simplices.len() {
        for k in 0..3 {
            let other = hull.neighbors[t][k] as usize;
            let [a, b, c] = hull.simplices[t].map(at);
            let tied = hull.simplices[other]
                .iter()
                .all(|&v| orient3d(a, b, c, at(v)) == Sign::Zero);
            assert_eq!(tied, hull.facet[t] == hull.facet[other]);
        }
    }
    facets
}

fn in_line(a: Point3, b: Point3, c: Point3) -> bool {
    let seen = |p: Point3, i: usize, j: usize| [p[i], p[j]];
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| orient2d(seen(a, i, j), seen(b, i, j), seen(c, i, j)) == Sign::Zero)
}

fn is_flat(points: &[Point3]) -> bool {
    let Some(&a) = points.first() else {
        return true;
    };
    let Some(&b) = points.iter().find(|&&b| b != a) else {
        return true;
    };
    let Some(&c) = points.iter().find(|&&c| !in_line(a, b, c)) else {
        return true;
    };
    points.iter().all(|&d| orient3d(a, b, c, d) == Sign::Zero)
}

/// Few distances, so that there are many ties, at scales up to the ends of the range; or any
/// doubles.
fn sets() -> impl Strategy<Value = Vec<Point3>> {
    let scale = prop_oneof![Just(1.0), Just(5e-324), Just(2f64.powi(1020)), Just(1e-3)];
    let lattice = prop::collection::vec([-3..4i32, -3..4i32, -2..3i32], 0..50);
    let any = prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO;
    let mixed = prop::collection::vec([any, any, any], 0..24);
    prop_oneof![
        (scale, lattice).prop_map(|(scale, points)| {
            let place = |p: [i32; 3]| p.map(|x| f64::from(x) * scale);
            points.into_iter().map(place).collect()
        }),
        mixed,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(42, 512)))]

    #[test]
    fn hulls_are_right_and_the_same_for_every_order(points in sets(), by in any::<u64>()) {
        let facets = check(&points);
        let mut turned = points.clone();
        if !turned.is_empty() {
            turned.rotate_left(by as usize % points.len());
            turned.reverse();
            turned.extend_from_within(..points.len() / 3);
        }
        prop_assert_eq!(check(&turned), facets);
    }
}

fn hash(i: u64) -> u64 {
    let h = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (h ^ h >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

fn unit(i: u64) -> f64 {
    (hash(i) >> 11) as f64 / (1u64 << 53) as f64
}

/// Many points: points inside are skipped in bulk, and all that are skipped must be inside.
#[test]
fn large_sets() {
    let cube: Vec<Point3> = (0..20_000)
        .map(|i| [0, 1, 2].map(|k| unit(3 * i + k)))
        .collect();
    let ball: Vec<Point3> = cube
        .iter()
        .map(|p| p.map(|x| 2.0 * x - 1.0))
        .filter(|p| p.iter().map(|x| x * x).sum::<f64>() < 1.0)
        .collect();
    let grid: Vec<Point3> = (0..8000)
        .map(|i| [i % 20, i / 20 % 20, i / 400].map(f64::from))
        .collect();
    let far: Vec<Point3> = cube.iter().map(|p| p.map(|x| 1e300 * (x - 0.5))).collect();
    let thin: Vec<Point3> = cube.iter().map(|p| [p[0], p[1], 1e-200 * p[2]]).collect();
    for points in [cube, ball, grid, far, thin] {
        let hull = made(&points).expect("a volume");
        let vertices: BTreeSet<u32> = hull.simplices.as_flattened().iter().copied().collect();
        let some: Vec<Point3> = vertices.iter().map(|&v| points[v as usize]).collect();
        // The hull of the extreme points has all of them as vertices, and no point is beyond it.
        let again = made(&some).expect("a volume");
        let count = again
            .simplices
            .as_flattened()
            .iter()
            .collect::<BTreeSet<_>>();
        assert_eq!(count.len(), vertices.len());
        for t in &hull.simplices {
            let [a, b, c] = t.map(|v| points[v as usize]);
            let beyond = |p: &&Point3| orient3d(a, b, c, **p) == Sign::Positive;
            assert_eq!(points.iter().find(beyond), None);
        }
    }
}

#[test]
fn chains_in_the_plane_are_convex() {
    let points: Vec<Point2> = (0..500)
        .map(|i| [hash(i) % 9, hash(7 * i) % 9].map(|x| x as f64))
        .collect();
    let (vertices, _) = hull2(&points, &Watch::idle()).unwrap();
    let n = vertices.len();
    for k in 0..n {
        let [a, b, c] = [k, k + 1, k + 2].map(|j| points[vertices[j % n] as usize]);
        assert_eq!(orient2d(a, b, c), Sign::Positive);
        assert!(points.iter().all(|&p| orient2d(a, b, p) != Sign::Negative));
    }
}
