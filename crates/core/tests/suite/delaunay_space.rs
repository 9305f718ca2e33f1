//! 3-D triangulations: valid, canonical, the same for every order and number of workers.

use std::collections::BTreeSet;

use crate::tier::cases;
use delone_core::Point3;
use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::validate::{Findings3, validate};
use delone_core::delaunay::space::{Triangulation3, triangulate};
use proptest::prelude::*;

fn made(points: &[Point3], workers: usize) -> Triangulation3 {
    triangulate(points, workers, &Watch::idle()).expect("a triangulation")
}

fn findings(points: &[Point3], made: &Triangulation3) -> Findings3 {
    let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
    let given = Given {
        points,
        simplices,
        neighbors,
    };
    validate(given, &Watch::idle()).expect("a report")
}

type Corners = [[u64; 3]; 4];

/// Tetrahedra as coordinates.
fn tetrahedra(points: &[Point3], made: &Triangulation3) -> BTreeSet<Corners> {
    let corners = |t: &[i32; 4]| {
        let mut corners = t.map(|v| points[v as usize].map(|x| (x + 0.0).to_bits()));
        corners.sort_unstable();
        corners
    };
    made.arrays.simplices.iter().map(corners).collect()
}

/// A multiplicative hash in place of a random number.
fn hash(i: u64) -> u64 {
    let h = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (h ^ h >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

fn scattered(n: u64, side: f64) -> Vec<Point3> {
    let unit = |i: u64| (hash(i) >> 11) as f64 / (1u64 << 53) as f64;
    (0..n)
        .map(|i| [0, 1, 2].map(|k| side * unit(3 * i + k)))
        .collect()
}

fn shuffled(points: &[Point3], seed: u64) -> Vec<Point3> {
    let mut keyed: Vec<(u64, Point3)> = (0..)
        .map(|i| hash(i ^ seed << 32))
        .zip(points.iter().copied())
        .collect();
    keyed.sort_unstable_by_key(|&(key, _)| key);
    keyed.into_iter().map(|(_, p)| p).collect()
}

/// The tetrahedra, valid and the same for some orders of the rows; `None` if the points are
/// degenerate.
fn agreed(points: &[Point3]) -> BTreeSet<Corners> {
    let twice: Vec<Point3> = points.iter().rev().chain(points).copied().collect();
    let orders = [
        points.to_vec(),
        shuffled(points, 1),
        shuffled(points, 2),
        twice,
    ];
    let mut sets = orders
        .iter()
        .map(|points| match triangulate(points, 1, &Watch::idle()) {
            Ok(made) => {
                let found = findings(points, &made);
                assert_eq!(found, Findings3::default(), "{points:?}");
                tetrahedra(points, &made)
            }
            Err(Error::TooFewInSpace { .. } | Error::Collinear { .. } | Error::Coplanar { .. }) => {
                BTreeSet::new()
            }
            Err(other) => panic!("{other} for {points:?}"),
        });
    let first = sets.next().expect("some orders");
    assert!(sets.all(|set| set == first), "{points:?}");
    first
}

fn lattice(sides: [u32; 3]) -> Vec<Point3> {
    let [a, b, c] = sides;
    let cell = |i: u32| [i / (b * c), i / c % b, i % c].map(f64::from);
    (0..a * b * c).map(cell).collect()
}

#[test]
fn lattices_are_canonical_and_valid() {
    for a in 2..5 {
        for b in 2..5 {
            for c in 2..5 {
                let made = agreed(&lattice([a, b, c]));
                assert!(made.len() as u32 >= 5 * (a - 1) * (b - 1) * (c - 1));
            }
        }
    }
    agreed(&lattice([1, 4, 4]));
    agreed(&lattice([10, 10, 10]));
}

#[test]
fn cospherical_points_are_canonical_and_valid() {
    // All integer points at distance 3, 9 and 33 from the origin.
    for square in [9, 81, 1089] {
        let side = 33i32;
        let axis = || -side..=side;
        let all = axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])));
        let on = all.filter(|[x, y, z]| x * x + y * y + z * z == square);
        let points: Vec<Point3> = on.map(|p| p.map(f64::from)).collect();
        assert!(points.len() > 20);
        agreed(&points);
        let mut with_center = points;
        with_center.push([0.0; 3]);
        agreed(&with_center);
    }
}

#[test]
fn points_near_a_sphere_are_valid() {
    let sphere: Vec<Point3> = scattered(3000, 2.0)
        .into_iter()
        .map(|p| {
            let q = p.map(|x| x - 1.0);
            let r = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| x / r)
        })
        .collect();
    agreed(&sphere);
}

#[test]
fn magnitudes_may_be_mixed() {
    let mut points: Vec<Point3> = Vec::new();
    for (i, s) in [5e-324, 1e-310, 1e-300, 1e-9, 1.0, 1e9, 1e300, f64::MAX]
        .into_iter()
        .enumerate()
    {
        let offset = 6 * i as u64;
        points.extend((0..6).map(|j| {
            [0, 1, 2].map(|k| s * [(-1.0), 0.0, 1.0, 0.5][(hash(offset + 64 * j + k) % 4) as usize])
        }));
    }
    agreed(&points);
    for scale in [1e-320, 1e-310, 1e-250, 1e-30, 1e30, 1e250, 8e307] {
        let scaled = |p: Point3| p.map(|x| x * scale);
        agreed(
            &lattice([3, 3, 3])
                .into_iter()
                .map(scaled)
                .collect::<Vec<_>>(),
        );
        agreed(
            &scattered(200, 1.0)
                .into_iter()
                .map(scaled)
                .collect::<Vec<_>>(),
        );
    }
}

#[test]
fn many_points_are_valid_for_any_number_of_workers() {
    let clusters: Vec<Point3> = scattered(20_000, 1.0)
        .into_iter()
        .zip(0..)
        .map(|(p, i)| [0, 1, 2].map(|k| p[k] * 1e-4 + (hash(i % 7 + 99 * k as u64) % 9) as f64))
        .collect();
    // The largest is more than a block.
    let sets = [scattered(600_000, 1.0), lattice([30, 31, 29]), clusters];
    for points in sets {
        let one = made(&points, 1);
        assert_eq!(findings(&points, &one), Findings3::default());
        for workers in [2, 3, 8, 64] {
            let many = made(&points, workers);
            assert_eq!(one.arrays.simplices, many.arrays.simplices);
            assert_eq!(one.arrays.neighbors, many.arrays.neighbors);
            assert_eq!(one.duplicates, many.duplicates);
        }
    }
}

#[test]
fn quadratic_triangulations_get_their_room() {
    // Each pair of consecutive points on one line forms a tetrahedron with each pair on the other.
    let line = |i: u32| {
        let x = f64::from(i / 2) / 64.0;
        if i.is_multiple_of(2) {
            [x, 0.0, 0.0]
        } else {
            [0.5, x - 0.75, 1.0]
        }
    };
    let points: Vec<Point3> = (0..240).map(line).collect();
    let one = made(&points, 1);
    assert_eq!(findings(&points, &one), Findings3::default());
    assert_eq!(one.arrays.simplices.len(), 119 * 119);
    agreed(&points);
}

#[test]
fn degenerate_inputs_are_distinguished() {
    let error = |points: &[Point3]| triangulate(points, 1, &Watch::idle()).expect_err("none");
    let line = [[2.0; 3], [0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]];
    let chain = vec![1, 2, 0, 4];
    assert_eq!(error(&line), Error::Collinear { chain });
    let chain = vec![1, 2, 0];
    assert_eq!(error(&line[..4]), Error::TooFewInSpace { chain });
    assert_eq!(error(&[]), Error::TooFewInSpace { chain: vec![] });
    let plane = [
        [1.0, 0.0, 1.0],
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 1.0],
        [1.0, 1.0, 2.0],
        [0.0, 1.0, 1.0],
    ];
    let chain = vec![1, 2, 0, 3];
    assert_eq!(error(&plane), Error::Coplanar { chain });
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let mut points = scattered(100, 1.0);
    points[7][2] = f64::NAN;
    points[9][0] = f64::INFINITY;
    let error = triangulate(&points, 1, &Watch::idle()).expect_err("NaN");
    let rows = vec![7, 9];
    assert_eq!(error, Error::NonFinite { rows, count: 2 });
}

#[test]
fn an_interruption_ends_the_work() {
    let points = scattered(100_000, 1.0);
    let error = triangulate(&points, 2, &Watch::new(&|| true)).expect_err("stopped");
    assert_eq!(error, Error::Interrupted);
}

#[test]
fn validation_finds_each_kind_of_fault() {
    let points = scattered(50, 1.0);
    let faulty = |change: &dyn Fn(&mut Triangulation3)| {
        let mut made = made(&points, 1);
        change(&mut made);
        findings(&points, &made)
    };
    let turned = faulty(&|m| m.arrays.simplices[3].swap(0, 1));
    assert!(turned.orientation.contains(&3) && !turned.neighbors.is_empty());
    let unlinked = faulty(&|m| m.arrays.neighbors[3].rotate_left(1));
    assert!(!unlinked.neighbors.is_empty());
    let twice = faulty(&|m| {
        m.arrays.simplices.push(m.arrays.simplices[0]);
        m.arrays.neighbors.push(m.arrays.neighbors[0]);
    });
    assert_eq!(twice.facets.len(), 4);
    let opened = faulty(&|m| {
        // Removes a tetrahedron in the interior.
        let t = m
            .arrays
            .neighbors
            .iter()
            .position(|n| !n.contains(&-1))
            .expect("one");
        let last = m.arrays.simplices.len() - 1;
        for n in &mut m.arrays.neighbors {
            *n = n.map(|u| match u as usize {
                u if u == t => -1,
                u if u == last => t as i32,
                _ => u,
            });
        }
        m.arrays.simplices.swap_remove(t);
        m.arrays.neighbors.swap_remove(t);
    });
    assert!(!opened.hull.is_empty());
    let fewer = made(&points[..49], 1);
    let found = findings(&points, &fewer);
    assert_eq!(found.missing, [49]);
}

#[test]
fn validation_distinguishes_ties_from_faults() {
    // An octahedron about its other axis: four tetrahedra around an edge.
    let points = [
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
    ];
    let right = made(&points, 1);
    assert_eq!(right.arrays.simplices.len(), 4);
    assert!(
        right
            .arrays
            .simplices
            .iter()
            .all(|t| t.contains(&0) && t.contains(&1))
    );
    let ring = [[0, 2], [2, 1], [1, 3], [3, 0]];
    let simplices = ring.map(|[a, b]| [4, 5, a, b]);
    let neighbors = [1, 2, 3, 4].map(|i| [-1, -1, i % 4, (i + 2) % 4]);
    let given = Given {
        points: &points,
        simplices: &simplices,
        neighbors: &neighbors,
    };
    let found = validate(given, &Watch::idle()).expect("a report");
    assert_eq!(found.orientation, Vec::<u32>::new());
    assert_eq!((found.neighbors, found.hull), (vec![], vec![]));
    assert!(found.delaunay.is_empty() && !found.ties.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(333, 4000)))]

    #[test]
    fn lattices_where_ties_are_everywhere(
        side in 2..5i32,
        cells in prop::collection::vec((0..4i32, 0..4i32, 0..4i32), 0..40),
    ) {
        let point = |(x, y, z): (i32, i32, i32)| [x % side, y % side, z % side].map(f64::from);
        agreed(&cells.into_iter().map(point).collect::<Vec<_>>());
    }

    #[test]
    fn points_within_ulps_of_a_plane(
        steps in prop::collection::vec((0..8i64, 0..8i64, -2..3i64), 4..30),
        slope in 0.1..10.0f64,
    ) {
        let near = |x: f64, ulps: i64| f64::from_bits((x.to_bits() as i64 + ulps) as u64);
        let point = |(i, j, ulps): (i64, i64, i64)| {
            let [x, y] = [i, j].map(|i| 1.0 + i as f64 / 16.0);
            [x, y, near(x * slope + y, ulps)]
        };
        agreed(&steps.into_iter().map(point).collect::<Vec<_>>());
    }

}

proptest! {
    // The spheres of such doubles are compared by integers of hundreds of limbs.
    #![proptest_config(ProptestConfig::with_cases(cases(20, 200)))]

    #[test]
    fn doubles_of_every_size(bits in prop::collection::vec(any::<[u64; 3]>(), 4..16)) {
        let finite = |b: u64| {
            let x = f64::from_bits(b);
            if x.is_finite() { x } else { f64::from_bits(b & !(1 << 62)) }
        };
        agreed(&bits.into_iter().map(|p| p.map(finite)).collect::<Vec<_>>());
    }
}
