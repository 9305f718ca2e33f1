//! Nanoseconds per point and stage, median and minimum of several runs, on generated points:
//! `cargo run --release -p delone-core --example stages -- 1000000 5 uniform grid`.
//! The environment may set WORKERS, METHOD and CHECK (validates the first run).

use std::time::Instant;

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::validate::validate;
use delone_core::delaunay::plane::{Method, triangulate};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let n = arguments
        .next()
        .and_then(|a| a.parse().ok())
        .unwrap_or(1_000_000);
    let runs: usize = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(5);
    let setting = |name| std::env::var(name).ok();
    let workers = setting("WORKERS").and_then(|w| w.parse().ok()).unwrap_or(1);
    let method = setting("METHOD")
        .and_then(|m| Method::named(&m))
        .unwrap_or(Method::Auto);
    let mut sets: Vec<String> = arguments.collect();
    if sets.is_empty() {
        sets = ["uniform", "utm", "grid", "kuzmin", "circle"]
            .map(String::from)
            .to_vec();
    }
    for set in sets {
        let points = make(&set, n);
        let n = points.len() as f64;
        let mut table: Vec<(&str, Vec<f64>)> = Vec::new();
        for run in 0..runs {
            let start = Instant::now();
            let made = triangulate(&points, method, workers, &Watch::idle());
            let made = made.expect("a triangulation");
            let total = start.elapsed();
            let stages = made.stages.iter().copied().chain([("total", total)]);
            for (i, (name, time)) in stages.enumerate() {
                if run == 0 {
                    table.push((name, Vec::new()));
                }
                table[i].1.push(time.as_secs_f64() * 1e9 / n);
            }
            if run == 0 && setting("CHECK").is_some() {
                let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
                let given = Given {
                    points: &points,
                    simplices,
                    neighbors,
                };
                let found = validate(given, &Watch::idle()).expect("a report");
                assert_eq!(found, Default::default());
            }
        }
        print!("{set:8} {n:9}");
        for (name, times) in &mut table {
            times.sort_by(f64::total_cmp);
            print!("  {name} {:6.1} ({:5.1})", times[times.len() / 2], times[0]);
        }
        println!(" ns");
    }
}

fn make(set: &str, n: usize) -> Vec<Point2> {
    let mut state = 0x9e3779b97f4a7c15u64;
    let mut random = move || {
        // xorshift64*, enough for points
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545f4914f6cdd1d) >> 11) as f64 / (1u64 << 53) as f64
    };
    let side = (n as f64).sqrt() as usize;
    match set {
        "grid" => (0..side * side)
            .map(|i| [(i % side) as f64, (i / side) as f64])
            .collect(),
        "utm" => (0..n)
            .map(|_| {
                let mm = |x: f64| (x * 1e6).round() / 1e3;
                [500_000.0 + mm(random()), 4_500_000.0 + mm(random())]
            })
            .collect(),
        "kuzmin" => (0..n)
            .map(|_| {
                let (u, angle) = (random(), std::f64::consts::TAU * random());
                let r = (1.0 / ((1.0 - u) * (1.0 - u)) - 1.0).sqrt();
                [r * angle.cos(), r * angle.sin()]
            })
            .collect(),
        "circle" => (0..n.div_ceil(10).max(3))
            .map(|_| {
                let angle = std::f64::consts::TAU * random();
                [angle.cos(), angle.sin()]
            })
            .collect(),
        _ => (0..n).map(|_| [random(), random()]).collect(),
    }
}
