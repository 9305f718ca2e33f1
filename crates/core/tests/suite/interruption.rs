//! Long calls check for interruption often enough, and end when interrupted.

use std::sync::atomic::{AtomicUsize, Ordering};

use delone_core::Point2;
use delone_core::base::arrays::{Given, Tetrahedra, Triangles};
use delone_core::base::error::{Error, Result};
use delone_core::base::watch::{IDLE, Watch};
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay::plane::lawson::lawson;
use delone_core::delaunay::plane::validate::validate;
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::delaunay::space as delaunay3;
use delone_core::interpolate::space as interpolate3;
use delone_core::interpolate::{self, Field, Kind, Method as Left, Order, global_gradients};
use delone_core::locate::space as locate3;
use delone_core::locate::{self, Batch, Kept, Locator};
use delone_core::regular::space as regular3;
use delone_core::regular::{PeriodicFindings, Wrapped, validate_periodic};
use delone_core::{hull, measure, order, regular};

/// More tasks than any of these calls has.
const TASKS: usize = 100;

/// How often `work` checks for interruption. It must end after each check that interrupts it,
/// though each remaining task may check once more.
fn checks<T>(work: impl Fn(&Watch) -> Result<T>) -> usize {
    let run = |after: usize| {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
        let outcome = work(&Watch::new(&stop)).map(drop);
        (outcome, asked.into_inner())
    };
    let (outcome, all) = run(usize::MAX);
    assert_eq!(outcome, Ok(()));
    for after in [0, 1, all / 3, all / 2, all - 1] {
        let (outcome, asked) = run(after);
        assert_eq!(outcome, Err(Error::Interrupted), "{after} of {all}");
        assert!(asked <= after + 1 + TASKS, "{asked} for {after} of {all}");
    }
    all
}

fn scattered<const D: usize>(n: usize) -> Vec<[f64; D]> {
    let mut x = 5u64;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [0; D].map(|_| next())).collect()
}

fn circle(n: usize) -> Vec<Point2> {
    let angle = |i: usize| i as f64 / n as f64 * std::f64::consts::TAU;
    (0..n).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
}

/// One worker, so that the number of checks is deterministic.
fn plane(points: &[Point2], work: impl Fn(&Batch) -> Result<()>, queries: &[Point2]) -> usize {
    let made = triangulate(points, Method::Auto, 1, &IDLE).unwrap();
    let given = Triangles {
        points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let kept = Kept::of(&given, &IDLE).unwrap();
    let run = |watch: &Watch| {
        work(&Batch {
            locator: Locator::new(given, &kept, watch),
            queries,
            workers: 1,
            watch,
        })
    };
    // The boundary is built once.
    run(&IDLE).unwrap();
    checks(run)
}

#[test]
fn one_query_among_very_many_neighbors() {
    let points = circle(3000);
    let values = vec![0.0; points.len()];
    for kind in [Kind::Sibson, Kind::Laplace] {
        let found = plane(
            &points,
            |batch| {
                let field = Field::new(&batch.locator.given, &values, None, 1)?;
                interpolate::natural_values(batch, kind, field, &[], Order::Value).map(drop)
            },
            &[[0.1, 0.2]],
        );
        // One lot of output and of queries, and then about one check per hundred neighbors.
        assert!(found > 3000 / 400, "{found}");
    }
}

#[test]
fn one_query_among_very_many_neighbors_in_3d() {
    let lifted = |p: [f64; 2]| {
        let (sin, cos) = (p[0] * std::f64::consts::TAU).sin_cos();
        let z = 2.0 * p[1] - 1.0;
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    };
    let points: Vec<_> = scattered(1500).into_iter().map(lifted).collect();
    let made = delaunay3::triangulate(&points, 1, &IDLE).unwrap();
    let given = Tetrahedra {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let kept = locate3::Kept::of(&given, &IDLE).unwrap();
    let queries = [[0.1, 0.2, 0.3]; 20];
    let found = checks(|watch| {
        interpolate3::natural(&locate3::Batch {
            locator: locate3::Locator::new(given, &kept, watch),
            queries: &queries,
            workers: 1,
            watch,
        })
    });
    assert!(found > 10, "{found}");
}

#[test]
fn holes_with_very_many_corners() {
    let mut points = circle(2000);
    points.push([0.0, 0.0]);
    let made = triangulate(&points, Method::Auto, 1, &IDLE).unwrap();
    let given = Triangles {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let left = Left::Natural(Kind::Sibson);
    let found = checks(|watch| interpolate::leave_one_out(given, left, 1, watch));
    assert!(found > 10, "{found}");
}

#[test]
fn queries_that_are_sorted() {
    let points = scattered::<2>(1 << 12);
    let queries = scattered::<2>(1 << 19);
    let found = plane(&points, |batch| locate::find(batch).map(drop), &queries);
    // Each lot of 512, two lots for each of three digits twice, and output.
    assert!(found > (1 << 10) + 16, "{found}");
    let alone = checks(|watch| order::order_of(&queries, 1, watch));
    assert!(alone > 16, "{alone}");
}

#[test]
fn a_large_triangulation_and_its_diagram() {
    let points = scattered::<2>(300_000);
    let found = checks(|watch| triangulate(&points, Method::Auto, 1, watch));
    // Distributing points, insertions, and writing triangles.
    assert!(
        found > 300_000 / 64 + 300_000 / 4096 + 600_000 / (1 << 14),
        "{found}"
    );
    let made = triangulate(&points, Method::Auto, 1, &IDLE).unwrap();
    let simplices = &made.arrays.simplices;
    let given = Triangles {
        points: &points,
        simplices,
        neighbors: &made.arrays.neighbors,
    };
    assert!(checks(|watch| validate(given, watch)) > 300_000 / 64);
    assert!(checks(|watch| lawson(&points, simplices, false, watch)) > 300_000 / 64);
    assert!(checks(|watch| Kept::of(&given, watch)) > 5);
    let edges = measure::edges2(simplices, given.neighbors, points.len(), 1, &IDLE).unwrap();
    assert!(
        checks(|watch| measure::edges2(simplices, given.neighbors, points.len(), 1, watch)) > 40
    );
    assert!(checks(|watch| measure::around(&edges, points.len(), watch)) > 40);
    let (indptr, indices) = measure::around(&edges, points.len(), &IDLE).unwrap();
    let around = interpolate::Adjacency::new(points.len(), &indptr, &indices).unwrap();
    let values = vec![1.0; points.len()];
    let field = Field::of_rows(points.len(), &values, None, 1).unwrap();
    let found = checks(|watch| global_gradients(&points, around, field, 1e-6, None, 9, 1, watch));
    assert!(found > 20, "{found}");
}

#[test]
fn proofs_of_regular_triangulations() {
    let points = scattered::<2>(200_000);
    let weights: Vec<f64> = scattered::<1>(200_000)
        .iter()
        .map(|w| 1e-5 * w[0])
        .collect();
    let made = regular::regular(&points, &weights, 1, &IDLE)
        .unwrap()
        .triangles;
    let given = Given {
        points: &points,
        simplices: &made.simplices,
        neighbors: &made.neighbors,
    };
    let found = checks(|watch| regular::validate(given, &weights, watch));
    // Lots of triangles, and of steps to hidden points.
    assert!(
        found > checks(|watch| order::arrange(&points, 1, watch)) + 20,
        "{found}"
    );
    let report = regular::validate(given, &weights, &IDLE).unwrap();
    assert_eq!(report.0, Default::default());
    let solid = scattered::<3>(20_000);
    let weights = &weights[..20_000];
    let made = regular3::regular(&solid, weights, 1, &IDLE)
        .unwrap()
        .tetrahedra;
    let given = Given {
        points: &solid,
        simplices: &made.simplices,
        neighbors: &made.neighbors,
    };
    assert!(checks(|watch| regular3::validate(given, weights, watch)) > 20);
}

#[test]
fn proofs_of_periodic_triangulations() {
    // A lattice, each square cut from its smallest corner.
    let n = 300;
    let square = |i: i32, j: i32| i.rem_euclid(n) * n + j.rem_euclid(n);
    let (mut points, mut simplices, mut offsets) = (Vec::new(), Vec::new(), Vec::new());
    let (mut neighbors, mut partners) = (Vec::new(), Vec::new());
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        points.push([f64::from(i), f64::from(j)]);
        let (x, y) = (i32::from(i == n - 1), i32::from(j == n - 1));
        let far = square(i + 1, j + 1);
        simplices.push([square(i, j), square(i + 1, j), far]);
        simplices.push([square(i, j), far, square(i, j + 1)]);
        offsets.push([0, 0, x, 0, x, y]);
        offsets.push([0, 0, x, y, 0, y]);
        let right = 2 * square(i + 1, j) + 1;
        let own = 2 * square(i, j);
        let below = 2 * square(i, j - 1) + 1;
        neighbors.push([right, own + 1, below]);
        partners.push([3 * right + 1, 3 * (own + 1) + 2, 3 * below]);
        let (above, left) = (2 * square(i, j + 1), 2 * square(i - 1, j));
        neighbors.push([above, left, own]);
        partners.push([3 * above + 2, 3 * left, 3 * own + 1]);
    }
    let given = Wrapped {
        points: &points,
        weights: &[],
        periods: [f64::from(n); 2],
        simplices: &simplices,
        offsets: &offsets,
        neighbors: &neighbors,
        partners: &partners,
    };
    let report = validate_periodic(given, &IDLE).unwrap();
    assert_eq!(report, PeriodicFindings::default());
    let found = checks(|watch| validate_periodic(given, watch));
    // Offsets, triangles and areas, each in lots.
    assert!(found > 3 * (180_000 >> 14), "{found}");
}

#[test]
fn segments_that_cross() {
    let n = 100;
    let line = |i: usize| {
        let x = 0.5 + i as f64;
        [[[x, -1.0], [x, n as f64]], [[-1.0, x], [n as f64, x]]]
    };
    let points: Vec<Point2> = (0..n).flat_map(line).flatten().collect();
    let segments: Vec<[u32; 2]> = (0..2 * n as u32).map(|i| [2 * i, 2 * i + 1]).collect();
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: 1 << 20,
        method: Method::Auto,
        workers: 1,
    };
    let found = checks(|watch| constrain(&points, &segments, options, watch));
    // Pieces between n^2 crossings are queued and inserted.
    assert!(found > 10 * n * n / 1024, "{found}");
}

#[test]
fn hulls_of_very_many_points() {
    let flat = circle(200_000);
    assert!(checks(|watch| hull::hull2(&flat, watch)) > 8);
    let points = scattered::<3>(600_000);
    assert!(checks(|watch| hull::hull3(&points, watch)) > 16);
}
