//! 3-D point location against its definition, on triangulations and on parts of them.

use crate::tier::cases;
use delone_core::Point3;
use delone_core::base::watch::{IDLE, Watch};
use delone_core::delaunay::space::triangulate;
use delone_core::locate::space::{
    Batch, Kept, Located, Locator, Tetrahedra, coordinates, find, nearest,
};
use delone_predicates::{Sign, nearer3, orient3d};
use proptest::prelude::*;

type Rows = Vec<[i32; 4]>;

/// The tetrahedron across each face, by definition.
fn neighbors_of(simplices: &[[i32; 4]]) -> Rows {
    let across = |s: &[i32; 4], k: usize| {
        let face = |t: &[i32; 4]| (0..4).all(|l| l == k || t.contains(&s[l]));
        let found = simplices.iter().position(|t| t != s && face(t));
        found.map_or(-1, |t| t as i32)
    };
    simplices
        .iter()
        .map(|s| std::array::from_fn(|k| across(s, k)))
        .collect()
}

fn holds(points: &[Point3], simplex: &[i32; 4], q: Point3) -> bool {
    (0..4).all(|k| {
        let mut corners = simplex.map(|v| points[v as usize]);
        corners[k] = q;
        let [a, b, c, d] = corners;
        orient3d(a, b, c, d) != Sign::Negative
    })
}

fn check(points: &[Point3], simplices: &[[i32; 4]], queries: &[Point3]) {
    let neighbors = neighbors_of(simplices);
    let given = Tetrahedra {
        points,
        simplices,
        neighbors: &neighbors,
    };
    let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
    let locator = Locator::new(given, &kept, &IDLE);
    let first = |q: Point3| simplices.iter().position(|t| holds(points, t, q));
    let expected: Vec<i32> = queries
        .iter()
        .map(|&q| first(q).map_or(-1, |t| t as i32))
        .collect();
    let mut used: Vec<i32> = simplices.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let closest: Vec<i32> = queries
        .iter()
        .map(|&q| {
            let at = |v: i32| points[v as usize];
            used.iter().copied().fold(-1, |best, v| {
                if best < 0 || nearer3(q, at(v), at(best)) == Sign::Positive {
                    v
                } else {
                    best
                }
            })
        })
        .collect();
    for workers in [1, 3] {
        let batch = Batch {
            locator,
            queries,
            workers,
            watch: &Watch::idle(),
        };
        assert_eq!(find(&batch).expect("tetrahedra"), expected);
        assert_eq!(nearest(&batch).expect("vertices"), closest);
        let places = coordinates(&batch).expect("places");
        assert_eq!(places.simplex, expected);
        for (row, &t) in expected.iter().enumerate() {
            let outside = t < 0 && !simplices.is_empty();
            assert_eq!(places.beside[row] >= 0, outside);
            assert_eq!(places.weights[4 * row].is_nan(), t < 0);
            if outside {
                let there = places.beside[row] as usize;
                let face = &places.face[3 * row..3 * row + 3];
                assert!(face.iter().all(|v| simplices[there].contains(v)));
                let corner = simplices[there].iter().position(|v| !face.contains(v));
                assert_eq!(neighbors[there][corner.expect("a corner")], -1);
            }
        }
    }
    for (&q, &t) in queries.iter().zip(&expected) {
        let found = match locator.locate(q).expect("a place") {
            Some(Located::Inside(place)) => place.simplex as i32,
            _ => -1,
        };
        assert_eq!(found, t, "{q:?} alone");
    }
}

/// Points of a lattice of some size and scale, and queries on and between them.
fn lattice() -> impl Strategy<Value = (Vec<Point3>, Vec<Point3>)> {
    let scale = prop_oneof![
        Just(1.0),
        Just(2f64.powi(-1000)),
        Just(2f64.powi(1018)),
        Just(5e-324)
    ];
    let point = [0..5i32, 0..5i32, 0..5i32];
    let points = prop::collection::vec(point, 5..30);
    let query = [-3..12i32, -3..12i32, -3..12i32];
    let queries = prop::collection::vec(query, 1..60);
    (scale, points, queries).prop_map(|(scale, points, queries)| {
        let place = |p: [i32; 3], step: f64| p.map(|x| f64::from(x) * step);
        let points = points.into_iter().map(|p| place(p, 2.0 * scale)).collect();
        let queries = queries.into_iter().map(|p| place(p, scale)).collect();
        (points, queries)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(21, 256)))]

    #[test]
    fn triangulations((points, queries) in lattice()) {
        if let Ok(made) = triangulate(&points, 1, &Watch::idle()) {
            check(&points, &made.arrays.simplices, &queries);
        }
    }

    #[test]
    fn parts_of_triangulations((points, queries) in lattice(), seed in any::<u64>()) {
        if let Ok(made) = triangulate(&points, 1, &Watch::idle()) {
            // Removes about a third: holes, notches, parts that touch at an edge or a vertex.
            let mut state = seed;
            let mut stays = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                state >> 33 > u64::from(u32::MAX) / 6
            };
            let left: Rows = made.arrays.simplices.into_iter().filter(|_| stays()).collect();
            check(&points, &left, &queries);
        }
    }
}

#[test]
fn queries_that_are_not_finite_have_no_location() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    check(&points, &[[0, 1, 2, 3]], &[[0.1; 3], [0.0; 3], [2.0; 3]]);
    let given = Tetrahedra {
        points: &points,
        simplices: &[[0, 1, 2, 3]],
        neighbors: &[[-1; 4]],
    };
    let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
    let locator = Locator::new(given, &kept, &IDLE);
    let queries = [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0]];
    assert_eq!(locator.locate(queries[0]).expect("no place"), None);
    let batch = Batch {
        locator,
        queries: &queries,
        workers: 1,
        watch: &Watch::idle(),
    };
    assert_eq!(find(&batch).expect("places"), [-1, -1]);
    assert_eq!(nearest(&batch).expect("places"), [-1, -1]);
    assert_eq!(coordinates(&batch).expect("places").beside, [-1, -1]);
}
