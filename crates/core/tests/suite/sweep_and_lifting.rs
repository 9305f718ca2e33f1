//! The sweep and the lifted hull at their limits: many simultaneous points, long fronts, cocircular
//! points, stars of high degree.

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_core::delaunay::plane::{Method, triangulate};

const METHODS: [Method; 2] = [Method::Sweep, Method::Lifting];

/// A number in [0, 1) by a multiplicative hash.
fn random(i: u32) -> f64 {
    let h = (u64::from(i) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let h = (h ^ h >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (h >> 11) as f64 / (1u64 << 53) as f64
}

fn made(n: u32, point: impl Fn(u32) -> Point2) {
    let points: Vec<Point2> = (0..n).map(point).collect();
    let expected = triangulate(&points, Method::Auto, 1, &Watch::idle()).expect("a triangulation");
    for method in METHODS {
        let made = triangulate(&points, method, 1, &Watch::idle()).expect("a triangulation");
        let given = Given {
            points: &points,
            simplices: &made.arrays.simplices,
            neighbors: &made.arrays.neighbors,
        };
        let found = validate(given, &Watch::idle()).expect("a report");
        assert_eq!(found, Findings::default(), "{method:?}");
        assert_eq!(made.arrays.simplices.len(), expected.arrays.simplices.len());
    }
}

/// The direction of a random angle.
fn direction(i: u32) -> Point2 {
    let (sin, cos) = (std::f64::consts::TAU * random(i)).sin_cos();
    [cos, sin]
}

#[test]
fn lines_of_points() {
    for apex in [[-1.0, 0.5], [1.0, 0.5], [1.0, -7.0], [-1.0, 9.0]] {
        made(500, |i| if i == 0 { apex } else { [0.0, random(i)] });
        made(500, |i| {
            if i == 0 {
                [apex[1], apex[0]]
            } else {
                [random(i), 0.0]
            }
        });
    }
    made(1000, |i| [random(i), f64::from(i % 10) * 0.1]);
    made(1000, |i| [f64::from(i % 10) * 0.1, random(i)]);
    made(1000, |i| [f64::from(i / 2), f64::from(i % 2) * 300.0]);
    made(1000, |i| [f64::from(i % 2) * 300.0, f64::from(i / 2)]);
    made(1001, |i| {
        let t = random(i) - 0.5;
        if i % 2 == 0 { [t, 0.0] } else { [0.0, t] }
    });
    made(1000, |i| {
        [random(i), 0.7 * random(i) + 1e-16 * f64::from(i % 7)]
    });
}

#[test]
fn circles_with_and_without_a_hub() {
    made(1000, direction);
    made(1000, |i| if i == 0 { [0.0, 0.0] } else { direction(i) });
    made(1000, |i| {
        direction(i).map(|x| x * (1.0 + 1e-9 * random(i + 1000)))
    });
    // x^2 + y^2 = 5^2 13^2 17 has 72 solutions: exactly cocircular points.
    let lattice: Vec<Point2> = (-268i64..=268)
        .filter_map(|x| {
            let rest = 71825 - x * x;
            let y = (rest as f64).sqrt().round() as i64;
            (y * y == rest).then_some([x as f64, y as f64])
        })
        .flat_map(|[x, y]| [[x, y], [x, -y]])
        .collect();
    assert_eq!(lattice.len(), 72);
    made(lattice.len() as u32, |i| lattice[i as usize]);
    made(lattice.len() as u32 + 1, |i| {
        lattice.get(i as usize).copied().unwrap_or([0.0, 0.0])
    });
}

#[test]
fn parabolas_and_spirals() {
    made(1000, |i| [random(i) - 0.5, (random(i) - 0.5).powi(2)]);
    made(1000, |i| [(random(i) - 0.5).powi(2), random(i) - 0.5]);
    made(1000, |i| {
        let (t, turn) = (f64::from(i), std::f64::consts::TAU * f64::from(i) / 50.0);
        [t * turn.cos(), t * turn.sin()]
    });
}

#[test]
fn sizes_of_every_kind() {
    let exponents = |i: u32| (2000.0 * (random(i) - 0.5)).exp2();
    made(200, |i| [exponents(i), exponents(i + 1000)]);
    for size in [1e300, f64::MAX, 1e-300, 1e-318] {
        made(500, |i| {
            [random(i), random(i + 500)].map(|x| size * (x - 0.5) * 2.0)
        });
    }
    made(400, |i| {
        [f64::from(i % 20), f64::from(i / 20)].map(|x| x * 5e-324)
    });
}

#[test]
fn an_interruption_ends_the_work() {
    let points: Vec<Point2> = (0..20_000)
        .map(|i| [random(i), random(i + 50_000)])
        .collect();
    for method in METHODS {
        let calls = std::sync::atomic::AtomicUsize::new(0);
        let stop = || calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed) >= 8;
        let error = triangulate(&points, method, 1, &Watch::new(&stop)).expect_err("stopped");
        assert_eq!(error, Error::Interrupted, "{method:?}");
    }
}
