//! Nanoseconds per query of location and interpolation, minimum of several runs:
//! `cargo run --release -p delone-core --example queries -- 1000000 1000000 3 find`.
//! The environment may set WORKERS.

use std::time::Instant;

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::memory::with_room;
use delone_core::base::watch::{IDLE, Watch};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::locate::{Batch, Kept, Locator, find, nearest};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: usize| {
        let given = arguments.next().and_then(|a| a.parse().ok());
        given.unwrap_or(default)
    };
    let (n, count, runs) = (number(1_000_000), number(1_000_000), number(3));
    let workers = std::env::var("WORKERS").ok();
    let workers = workers.and_then(|w| w.parse().ok()).unwrap_or(1);
    let mut points = random(n, 1);
    if std::env::var("SORTED").is_ok() {
        let rows = delone_core::order::order_of(&points, 1, &Watch::idle())
            .expect("an order")
            .concat();
        points = rows.into_iter().map(|row| points[row as usize]).collect();
    }
    let made = triangulate(&points, Method::Auto, 2, &Watch::idle()).expect("a triangulation");
    let given = Given {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let start = Instant::now();
    let kept = Kept::of(&given, &Watch::idle()).expect("a locator");
    println!("locator {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    let locator = Locator::new(given, &kept, &IDLE);
    let sets = [("random", random(count, 2)), ("raster", raster(count))];
    for (set, queries) in &sets {
        let tell = |name: &str, work: &dyn Fn()| {
            let time = |_| {
                let start = spent();
                work();
                (spent() - start) / queries.len() as f64
            };
            let best = (0..runs).map(time).fold(f64::INFINITY, f64::min);
            println!("{set:8} {name:12} {best:8.1} ns");
        };
        let batch = Batch {
            locator,
            queries,
            workers,
            watch: &Watch::idle(),
        };
        tell("order", &|| {
            delone_core::order::order_of(queries, workers, &Watch::idle()).expect("an order");
        });
        tell("find", &|| {
            find(&batch).expect("triangles");
        });
        tell("nearest", &|| {
            nearest(&batch).expect("vertices");
        });
        tell("one by one", &|| {
            for q in queries.iter().take(queries.len() / 10) {
                std::hint::black_box(locator.locate(*q).expect("a place"));
            }
        });
    }
}

fn random(n: usize, seed: u64) -> Vec<Point2> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let mixed = (x ^ (x >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        (mixed >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut points = with_room(n).expect("memory");
    points.extend((0..n).map(|_| [next(), next()]));
    points
}

fn raster(n: usize) -> Vec<Point2> {
    let side = n.isqrt();
    let at = |i: usize| (i as f64 + 0.5) / side as f64;
    let mut points = with_room(side * side).expect("memory");
    points.extend((0..side * side).map(|i| [at(i % side), at(i / side)]));
    points
}

/// The CPU time of this thread in nanoseconds, where available; else the wall time.
fn spent() -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let told = told.and_then(|s| s.split(' ').next()?.parse().ok());
    told.unwrap_or_else(|| {
        let now = std::time::SystemTime::now();
        now.duration_since(std::time::UNIX_EPOCH)
            .map_or(0.0, |d| d.as_secs_f64() * 1e9)
    })
}
