//! Costs of edits of a live triangulation of uniform points, in microseconds per point, beside those of
//! a build: `cargo run --release -p delone-core --example live -- 1000000 100000`. A batch has at most
//! a tenth of the points, of which there are at least 100.

use std::time::Instant;

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::live::plane::Plane;

/// Uniform points in the unit square.
fn scattered(n: usize, seed: u64) -> Vec<Point2> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next()]).collect()
}

/// Runs `work` and prints its time for each of `count` items.
fn timed<T>(name: &str, count: usize, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let time = start.elapsed().as_secs_f64() * 1e6;
    println!(
        "{name:36} {:9.3} us each  {:10.3} ms",
        time / count as f64,
        time / 1e3
    );
    result
}

/// The smallest number of points.
const LEAST: usize = 100;
/// One in this many points, at most, is in a batch: batches of rows that are shifted by less share no
/// row.
const STEP: usize = 10;

/// Every `total / count`-th row.
fn sampled(total: usize, count: usize) -> Vec<i64> {
    (0..count).map(|i| (i * (total / count)) as i64).collect()
}

fn main() {
    let mut arguments = std::env::args()
        .skip(1)
        .map_while(|a| a.parse::<usize>().ok());
    let n = arguments.next().unwrap_or(1_000_000).max(LEAST);
    let m = arguments.next().unwrap_or(100_000).clamp(1, n / STEP);
    let watch = Watch::idle();
    let points = scattered(n, 1);
    let more = scattered(m, 2);
    for _ in 0..3 {
        let made = timed("build", n, || triangulate(&points, Method::Auto, 1, &watch));
        drop(made);
        let mut live = timed("live build", n, || Plane::new(&points, 1, &watch).unwrap());
        timed("insert a batch", m, || {
            live.insert(&more, 1, &watch).unwrap()
        });
        let rows = sampled(n, m);
        timed("remove a batch", m, || {
            live.remove(&rows, 1, &watch).unwrap()
        });
        let spacing = (n as f64).sqrt().recip();
        let rows: Vec<i64> = sampled(n, m).into_iter().map(|row| row + 1).collect();
        let moved = |by: f64| -> Vec<Point2> {
            let near = |(row, d): (&i64, Point2)| {
                [0, 1].map(|k| points[*row as usize][k] + by * spacing * (d[k] - 0.5))
            };
            rows.iter().zip(scattered(m, 3)).map(near).collect()
        };
        let (near, far) = (moved(0.1), moved(8.0));
        timed("move a batch by a tenth", m, || {
            live.relocate(&rows, &near, 1, &watch).unwrap()
        });
        timed("move a batch by several spacings", m, || {
            live.relocate(&rows, &far, 1, &watch).unwrap()
        });
        let one = 100_000.min(n / STEP);
        let there = scattered(one, 5);
        timed("insert one by one, anywhere", one, || {
            for &p in &there {
                live.insert(&[p], 1, &watch).unwrap();
            }
        });
        let line: Vec<Point2> = (0..one)
            .map(|i| [0.3 + i as f64 * spacing * 0.3 % 0.4, 0.4 + i as f64 * 1e-7])
            .collect();
        timed("nearest one by one, anywhere", one, || {
            for &q in &there {
                live.nearest(&[q], &watch).unwrap();
            }
        });
        timed("insert one by one, near", one, || {
            for &p in &line {
                live.insert(&[p], 1, &watch).unwrap();
            }
        });
        let rows = sampled(n, one).into_iter().map(|row| row + 2);
        timed("remove one by one, anywhere", one, || {
            for row in rows {
                live.remove(&[row], 1, &watch).unwrap();
            }
        });
        let mut last = timed("first snapshot", 1, || live.state(&watch).unwrap());
        let corner = |seed| {
            scattered(1000, seed)
                .into_iter()
                .map(|p| p.map(|x| 0.5 + x * 0.02))
        };
        for (name, new) in [
            (
                "snapshot after 1000 in one place",
                corner(6).collect::<Vec<_>>(),
            ),
            ("snapshot after 1000 scattered", scattered(1000, 7)),
        ] {
            live.insert(&new, 1, &watch).unwrap();
            let state = timed(name, 1, || live.state(&watch).unwrap());
            println!("{:36} {:9.3} MB", "", state.own_bytes(&last) as f64 / 1e6);
            last = state;
        }
        timed("changes, first", 1, || live.changes(&watch).unwrap());
        live.insert(&corner(8).collect::<Vec<_>>(), 1, &watch)
            .unwrap();
        let changes = timed("changes after 1000", 1, || live.changes(&watch).unwrap());
        println!("{} gone, {} new", changes.gone.len(), changes.new.len());
        timed("restore 1000 scattered", 1, || {
            live.restore(&last, &watch).unwrap()
        });
        timed("export", live.len(), || live.export(&watch).unwrap());
        println!();
    }
}
