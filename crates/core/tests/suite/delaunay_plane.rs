//! Whole triangulations: valid, canonical, the same for every method, order and number of workers.

use std::collections::BTreeSet;

use crate::tier::cases;
use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_core::delaunay::plane::{Method, Triangulation, triangulate};
use proptest::prelude::*;

fn made(points: &[Point2], method: Method, workers: usize) -> Triangulation {
    triangulate(points, method, workers, &Watch::idle()).expect("a triangulation")
}

fn findings(points: &[Point2], made: &Triangulation) -> Findings {
    let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
    validate(
        Given {
            points,
            simplices,
            neighbors,
        },
        &Watch::idle(),
    )
    .expect("a report")
}

/// Triangles as coordinates, each from its smallest vertex on.
fn triangles(points: &[Point2], made: &Triangulation) -> BTreeSet<[[u64; 2]; 3]> {
    let bits = |v: i32| points[v as usize].map(|x| (x + 0.0).to_bits());
    let turned = |t: &[i32; 3]| {
        let [a, b, c] = t.map(bits);
        [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .min()
            .expect("three")
    };
    made.arrays.simplices.iter().map(turned).collect()
}

fn methods() -> impl Iterator<Item = Method> {
    Method::NAMES.iter().map(|&(_, m)| m)
}

/// All methods agree on `points`, or all reject them.
fn agree(points: &[Point2]) -> Result<(), TestCaseError> {
    let mut sets = Vec::new();
    let mut shuffled: Vec<(u64, Point2)> = (0..).map(hash).zip(points.iter().copied()).collect();
    shuffled.sort_unstable_by_key(|&(key, _)| key);
    let shuffled: Vec<Point2> = shuffled.into_iter().map(|(_, p)| p).collect();
    // Each point twice: reversed, then in any order.
    let twice: Vec<Point2> = points.iter().rev().chain(&shuffled).copied().collect();
    for method in methods() {
        for points in [points, &shuffled, &twice] {
            match triangulate(points, method, 1, &Watch::idle()) {
                Ok(made) => {
                    prop_assert_eq!(findings(points, &made), Findings::default());
                    sets.push(triangles(points, &made));
                }
                Err(Error::TooFew { .. } | Error::Collinear { .. }) => sets.push(BTreeSet::new()),
                Err(other) => prop_assert!(false, "{other}"),
            }
        }
    }
    prop_assert!(sets.windows(2).all(|w| w[0] == w[1]));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1666, 20000)))]

    #[test]
    fn lattices_where_ties_are_everywhere(
        side in 3..7i32,
        cells in prop::collection::vec((0..6i32, 0..6i32), 0..40),
    ) {
        let point = |(x, y): (i32, i32)| [f64::from(x % side), f64::from(y % side)];
        agree(&cells.into_iter().map(point).collect::<Vec<_>>())?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(333, 4000)))]

    #[test]
    fn points_within_ulps_of_a_line(
        steps in prop::collection::vec((0..50i64, -2..3i64), 3..30),
        slope in 0.1..10.0f64,
    ) {
        let near = |x: f64, ulps: i64| f64::from_bits((x.to_bits() as i64 + ulps) as u64);
        let point = |(i, ulps): (i64, i64)| {
            let x = 1.0 + i as f64 / 16.0;
            [x, near(x * slope, ulps)]
        };
        agree(&steps.into_iter().map(point).collect::<Vec<_>>())?;
    }
}

proptest! {
    // The sweep compares circles of any two sizes by integers of hundreds of limbs.
    #![proptest_config(ProptestConfig::with_cases(cases(50, 600)))]

    #[test]
    fn doubles_of_every_size(bits in prop::collection::vec(any::<(u64, u64)>(), 3..20)) {
        let finite = |b: u64| {
            let x = f64::from_bits(b);
            if x.is_finite() { x } else { f64::from_bits(b & !(1 << 62)) }
        };
        agree(&bits.into_iter().map(|(x, y)| [finite(x), finite(y)]).collect::<Vec<_>>())?;
    }
}

/// A multiplicative hash in place of a random number.
fn hash(i: u64) -> u64 {
    let h = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (h ^ h >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

fn scattered(n: u64, side: f64) -> Vec<Point2> {
    let unit = |h: u64| (h >> 11) as f64 / (1u64 << 53) as f64;
    (0..n)
        .map(|i| [side * unit(hash(2 * i)), side * unit(hash(2 * i + 1))])
        .collect()
}

#[test]
fn several_blocks_are_one_triangulation_for_any_number_of_workers() {
    let lattice = |p: Point2| p.map(f64::floor);
    for points in [
        scattered(300_000, 1.0),
        scattered(300_000, 500.0).into_iter().map(lattice).collect(),
        scattered(300_000, 1e-3)
            .into_iter()
            .map(|[x, _]| [x.sin(), x.cos()])
            .collect(),
    ] {
        let one = made(&points, Method::Auto, 1);
        assert_eq!(findings(&points, &one), Findings::default());
        for workers in [2, 3, 8, 64] {
            let many = made(&points, Method::Auto, workers);
            assert_eq!(one.arrays.simplices, many.arrays.simplices);
            assert_eq!(one.arrays.neighbors, many.arrays.neighbors);
            assert_eq!(one.duplicates, many.duplicates);
        }
        let other = made(&points, Method::DivideConquer, 2);
        assert_eq!(triangles(&points, &one), triangles(&points, &other));
    }
}

/// Bowyer-Watson and divide and conquer agree on `points`, and their triangles are valid.
fn methods_agree(points: &[Point2]) {
    let [inserted, cut] = [Method::BowyerWatson, Method::DivideConquer].map(|m| made(points, m, 1));
    assert_eq!(findings(points, &cut), Findings::default());
    assert_eq!(triangles(points, &inserted), triangles(points, &cut));
}

#[test]
fn nested_cells_are_split() {
    // Clusters of 30 points at 30 places, 300 times smaller each time: all in one cell of the first key.
    let mut points = Vec::new();
    for (i, p) in (0i32..).zip(scattered(30, 1.0)) {
        let scale = 300f64.powi(-i);
        let own = scattered(30 + i as u64, 0.3 * scale).into_iter();
        points.extend(own.map(|q| [p[0] * scale + q[0], p[1] * scale + q[1]]));
    }
    methods_agree(&points);
    // Each point halves the remaining cell: deeper than the keys of cells.
    let halves = (0..900).map(|i| 0.5f64.powi(i));
    methods_agree(&halves.clone().map(|x| [x, x * x]).collect::<Vec<_>>());
    let thirds = halves.flat_map(|x| [[x, x / 3.0], [x / 3.0, x], [-x, x]]);
    methods_agree(&thirds.collect::<Vec<_>>());
}

#[test]
fn cuts_hold_at_the_ends_of_the_range_and_in_lattices() {
    for scale in [1e-320, 1e-160, 1e-61, 1e60, 1e76, 1e150, 1e307] {
        methods_agree(&scattered(2000, scale));
        let lattice = scattered(2000, 17.0).into_iter();
        let lattice: Vec<_> = lattice.map(|p| p.map(|x| x.floor() * scale)).collect();
        methods_agree(&lattice);
    }
    // Repeated rows move the border between coarse and fine keys.
    let points = scattered(40_000, 1.0);
    methods_agree(&points.iter().chain(&points).copied().collect::<Vec<_>>());
    // Columns of equal x, and small sets of every size.
    for n in 3..70 {
        methods_agree(&scattered(n, 1.0));
        let columns = scattered(n, 4.0).into_iter().map(|[x, y]| [x.floor(), y]);
        methods_agree(&columns.chain([[0.5, 9.0]]).collect::<Vec<_>>());
    }
}

#[test]
fn blocks_of_duplicates_and_of_lines_are_merged() {
    // A block of one point, collinear blocks, and a few other points.
    let mut points = vec![[0.5, 0.5]; 200_000];
    points.extend(scattered(1000, 1.0));
    let one = made(&points, Method::Auto, 2);
    assert_eq!(findings(&points, &one), Findings::default());
    assert_eq!(one.duplicates.len(), 199_999);
    let mut points: Vec<Point2> = (0..300_000u32)
        .map(|i| [f64::from(i % 3), f64::from(i / 3)])
        .collect();
    points.push([-1.0, 0.25]);
    let one = made(&points, Method::Auto, 2);
    assert_eq!(findings(&points, &one), Findings::default());
}

#[test]
fn degenerate_input_names_its_chain() {
    let points = [[2.0, 2.0], [0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
    for method in methods() {
        let error = triangulate(&points, method, 1, &Watch::idle()).expect_err("no triangle");
        assert_eq!(
            error,
            Error::Collinear {
                chain: vec![1, 2, 0]
            }
        );
        let error = triangulate(&points[..2], method, 1, &Watch::idle()).expect_err("two points");
        assert_eq!(error, Error::TooFew { chain: vec![1, 0] });
    }
    let line: Vec<Point2> = (0..200_000u32)
        .map(|i| [f64::from(i), 2.0 * f64::from(i)])
        .collect();
    let error = triangulate(&line, Method::Auto, 2, &Watch::idle()).expect_err("a line");
    assert_eq!(
        error,
        Error::Collinear {
            chain: (0..200_000).collect()
        }
    );
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let mut points = scattered(100, 1.0);
    points[7][1] = f64::NAN;
    points[9][0] = f64::INFINITY;
    let error = triangulate(&points, Method::Auto, 1, &Watch::idle()).expect_err("NaN");
    assert_eq!(
        error,
        Error::NonFinite {
            rows: vec![7, 9],
            count: 2
        }
    );
}

#[test]
fn an_interruption_ends_the_work() {
    let points = scattered(100_000, 1.0);
    let error = triangulate(&points, Method::Auto, 2, &Watch::new(&|| true)).expect_err("stopped");
    assert_eq!(error, Error::Interrupted);
}

#[test]
fn validation_finds_each_kind_of_fault() {
    let points = scattered(50, 1.0);
    let right = made(&points, Method::Auto, 1);
    let faulty = |change: &dyn Fn(&mut Triangulation)| {
        let mut made = made(&points, Method::Auto, 1);
        change(&mut made);
        findings(&points, &made)
    };
    assert!(
        !faulty(&|m| m.arrays.simplices[3].swap(0, 1))
            .orientation
            .is_empty()
    );
    assert!(
        !faulty(&|m| m.arrays.neighbors[3].rotate_left(1))
            .neighbors
            .is_empty()
    );
    let twice = faulty(&|m| {
        m.arrays.simplices.push(m.arrays.simplices[0]);
        m.arrays.neighbors.push(m.arrays.neighbors[0]);
    });
    assert_eq!(twice.facets.len(), 3);
    assert_eq!(
        twice.count,
        [[right.arrays.simplices.len() as u32, twice.count[0][1]]]
    );
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.4, 0.4]];
    // The other diagonal of the square, and a point that is not a vertex.
    let simplices = [[0, 1, 3], [1, 2, 3]];
    let neighbors = [[1, -1, -1], [-1, 0, -1]];
    let given = Given {
        points: &square,
        simplices: &simplices,
        neighbors: &neighbors,
    };
    let found = validate(given, &Watch::idle()).expect("a report");
    assert_eq!((found.missing, found.ties), (vec![4], vec![[0, 1]]));
}

#[test]
fn validation_names_vertices_that_repeat_an_earlier_row() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-0.0, 0.0]];
    let with = |first: i32| {
        let given = Given {
            points: &points,
            simplices: &[[first, 1, 2]],
            neighbors: &[[-1; 3]],
        };
        validate(given, &Watch::idle()).expect("a report")
    };
    assert_eq!(with(0), Findings::default());
    let repeats = vec![3];
    assert_eq!(
        with(3),
        Findings {
            repeats,
            ..Findings::default()
        }
    );
}
