//! Point location against its definition, on triangulations of every kind.

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::watch::{IDLE, Watch};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::locate::{Batch, Kept, Located, Locator, along, coordinates, find, nearest};
use delone_predicates::{Sign, orient2d};
use proptest::prelude::*;

type Rows = Vec<[i32; 3]>;

fn delaunay(points: &[Point2]) -> Option<(Rows, Rows)> {
    let made = triangulate(points, Method::Auto, 1, &Watch::idle()).ok()?;
    Some((made.arrays.simplices, made.arrays.neighbors))
}

/// The triangle across each edge, by definition.
fn neighbors_of(simplices: &[[i32; 3]]) -> Rows {
    let edge = |s: &[i32; 3], k: usize| (s[(k + 1) % 3], s[(k + 2) % 3]);
    let beyond = |s: &[i32; 3], k: usize| {
        let (u, v) = edge(s, k);
        let found = simplices
            .iter()
            .position(|t| (0..3).any(|l| edge(t, l) == (v, u)));
        found.map_or(-1, |t| t as i32)
    };
    simplices
        .iter()
        .map(|s| std::array::from_fn(|k| beyond(s, k)))
        .collect()
}

/// Flips edges of strictly convex quadrilaterals, selected by `choices`.
fn flip(points: &[Point2], simplices: &mut Rows, choices: &[u32]) {
    let at = |v: i32| points[v as usize];
    for &choice in choices {
        let (t, k) = (choice as usize / 3 % simplices.len(), choice as usize % 3);
        let beyond = neighbors_of(simplices)[t][k];
        if beyond < 0 {
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|i| simplices[t][(k + i) % 3]);
        let far = simplices[beyond as usize];
        let Some(&d) = far.iter().find(|&&v| v != b && v != c) else {
            continue;
        };
        if orient2d(at(a), at(b), at(d)) == Sign::Positive
            && orient2d(at(a), at(d), at(c)) == Sign::Positive
        {
            simplices[t] = [a, b, d];
            simplices[beyond as usize] = [a, d, c];
        }
    }
}

fn holds(points: &[Point2], triangle: &[i32; 3], q: Point2) -> bool {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .all(|(u, v)| orient2d(u, v, q) != Sign::Negative)
}

/// The result of `find`, by definition.
fn first_holder(points: &[Point2], simplices: &[[i32; 3]], q: Point2) -> i32 {
    let found = simplices.iter().position(|t| holds(points, t, q));
    found.map_or(-1, |t| t as i32)
}

fn check(points: &[Point2], simplices: &[[i32; 3]], queries: &[Point2]) {
    let neighbors = neighbors_of(simplices);
    let given = Given {
        points,
        simplices,
        neighbors: &neighbors,
    };
    let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
    let locator = Locator::new(given, &kept, &IDLE);
    let expected: Vec<i32> = queries
        .iter()
        .map(|&q| first_holder(points, simplices, q))
        .collect();
    for workers in [1, 3] {
        let batch = Batch {
            locator,
            queries,
            workers,
            watch: &Watch::idle(),
        };
        assert_eq!(find(&batch).expect("triangles"), expected);
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
fn lattice() -> impl Strategy<Value = (Vec<Point2>, Vec<Point2>)> {
    let scale = prop_oneof![
        Just(1.0),
        Just(2f64.powi(-1000)),
        Just(2f64.powi(1000)),
        Just(5e-324)
    ];
    let point = (0..12i32, 0..12i32);
    let points = prop::collection::vec(point, 3..40);
    let queries = prop::collection::vec((-4..28i32, -4..28i32), 1..80);
    (scale, points, queries).prop_map(|(scale, points, queries)| {
        let place = |(x, y): (i32, i32), step: f64| [f64::from(x) * step, f64::from(y) * step];
        let points = points.into_iter().map(|p| place(p, 2.0 * scale)).collect();
        let queries = queries.into_iter().map(|p| place(p, scale)).collect();
        (points, queries)
    })
}

proptest! {
    #[test]
    fn the_first_holder_is_found_on_every_tiling(
        (points, queries) in lattice(),
        flips in prop::collection::vec(any::<u32>(), 0..60),
    ) {
        if let Some((mut simplices, _)) = delaunay(&points) {
            check(&points, &simplices, &queries);
            flip(&points, &mut simplices, &flips);
            check(&points, &simplices, &queries);
        }
    }

    #[test]
    fn holes_and_pinched_vertices_hide_no_triangle(
        (points, queries) in lattice(),
        keep in prop::collection::vec(any::<bool>(), 1..20),
    ) {
        if let Some((simplices, _)) = delaunay(&points) {
            let kept = simplices.into_iter().zip(keep.iter().cycle());
            let some: Rows = kept.filter(|(_, keep)| **keep).map(|(t, _)| t).collect();
            check(&points, &some, &queries);
        }
    }

    #[test]
    fn the_nearest_vertex_is_the_first_of_the_nearest((points, queries) in lattice()) {
        let Some((simplices, neighbors)) = delaunay(&points) else { return Ok(()) };
        let given = Given { points: &points, simplices: &simplices, neighbors: &neighbors };
        let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
        let locator = Locator::new(given, &kept, &IDLE);
        let batch = Batch { locator, queries: &queries, workers: 2, watch: &Watch::idle() };
        let found = nearest(&batch).expect("vertices");
        // Small integers in units of the scale, so that distances are exact.
        let unit = queries.iter().chain(&points).flatten().filter(|x| **x != 0.0);
        let unit = unit.fold(f64::MAX, |least, x| least.min(x.abs()));
        let whole = |p: Point2| p.map(|x| (x / unit * 12.0).round() as i64);
        for (q, v) in queries.iter().map(|&q| whole(q)).zip(found) {
            let distance = |p: &Point2| {
                let p = whole(*p);
                (p[0] - q[0]).pow(2) + (p[1] - q[1]).pow(2)
            };
            let least = points.iter().map(distance).min();
            let first = points.iter().position(|p| Some(distance(p)) == least);
            prop_assert_eq!(first, Some(v as usize));
        }
    }

    #[test]
    fn segments_meet_each_triangle_once_and_contain_both_ends(
        (points, ends) in lattice(),
        flips in prop::collection::vec(any::<u32>(), 0..60),
    ) {
        let Some((mut simplices, _)) = delaunay(&points) else { return Ok(()) };
        flip(&points, &mut simplices, &flips);
        let neighbors = neighbors_of(&simplices);
        let given = Given { points: &points, simplices: &simplices, neighbors: &neighbors };
        let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
        let locator = Locator::new(given, &kept, &IDLE);
        for pair in ends.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let met = along(&locator, a, b).expect("triangles");
            let mut sorted = met.clone();
            sorted.sort_unstable();
            sorted.dedup();
            prop_assert_eq!(sorted.len(), met.len(), "{:?} {:?}", a, b);
            let inside = |q| first_holder(&points, &simplices, q) >= 0;
            if inside(a) && inside(b) {
                let ends = [(met.first(), a), (met.last(), b)];
                for (t, q) in ends {
                    let t = simplices[*t.expect("a triangle") as usize];
                    prop_assert!(holds(&points, &t, q), "{:?} {:?}", a, b);
                }
            }
            // A triangle that an edge strictly separates from the segment is not met.
            for &t in &met {
                let corners = simplices[t as usize].map(|v| points[v as usize]);
                let sides = corners.map(|p| orient2d(a, b, p));
                let off = a != b && (sides == [Sign::Positive; 3] || sides == [Sign::Negative; 3]);
                prop_assert!(!off, "{:?} {:?}", a, b);
            }
        }
    }
}

#[test]
fn a_walk_that_cycles_becomes_straight() {
    // The visibility walk does not terminate on this pinwheel (after L. De Floriani et al., 1991).
    let turn = |r: f64, i: usize, phase: f64| {
        let angle = (i as f64 + phase) * std::f64::consts::TAU / 6.0;
        [r * angle.cos(), r * angle.sin()]
    };
    let mut points: Vec<Point2> = (0..6).map(|i| turn(1.0, i, 0.0)).collect();
    points.extend((0..6).map(|i| turn(4.0, i, 1.2)));
    points.push([0.0, 0.0]);
    let mut simplices = Vec::new();
    for i in 0..6 {
        let j = (i + 1) % 6;
        simplices.push([12, i, j]);
        simplices.push([i, i + 6, j]);
        simplices.push([j, i + 6, j + 6]);
    }
    let queries: Vec<Point2> = (0..40 * 40)
        .map(|i| [f64::from(i % 40) / 4.0 - 5.0, f64::from(i / 40) / 4.0 - 5.0])
        .collect();
    check(&points, &simplices, &queries);
}

#[test]
fn nearest_points_of_the_hull_are_projections() {
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [2.0, 0.0]];
    let (simplices, neighbors) = delaunay(&points).expect("a square");
    let given = Given {
        points: &points,
        simplices: &simplices,
        neighbors: &neighbors,
    };
    let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
    let queries = [
        [1.0, -3.0],
        [3.0, -1e300],
        [9.0, 9.0],
        [5.0, 1.0],
        [-1.0, -2.0],
        [f64::NAN, 1.0],
    ];
    let batch = Batch {
        locator: Locator::new(given, &kept, &IDLE),
        queries: &queries,
        workers: 1,
        watch: &Watch::idle(),
    };
    let found = coordinates(&batch).expect("places");
    assert_eq!(found.triangle, [-1; 6]);
    let near = |i: usize| {
        let [u, v] = [0, 1].map(|k| points[found.edge[2 * i + k] as usize]);
        [0, 1].map(|k| u[k] + found.along[i] * (v[k] - u[k]))
    };
    let expected = [[1.0, 0.0], [3.0, 0.0], [4.0, 4.0], [4.0, 1.0], [0.0, 0.0]];
    for (i, p) in expected.into_iter().enumerate() {
        assert_eq!(near(i), p, "{:?}", queries[i]);
    }
    assert_eq!(&found.edge[10..], [-1, -1]);
    assert!(found.along[5].is_nan() && found.weights.iter().all(|w| w.is_nan()));
}
