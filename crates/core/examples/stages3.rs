//! Nanoseconds per point and stage of 3-D triangulations of generated points, median and minimum:
//! `cargo run --release -p delone-core --example stages3 -- 1000000 5 uniform grid`.
//! The environment may set WORKERS, a list such as `1,2` whose entries alternate, and CHECK
//! (validates the first run).

use std::time::Instant;

use delone_core::Point3;
use delone_core::base::arrays::Given;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::triangulate;
use delone_core::delaunay::space::validate::{Findings3, validate};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let n = arguments
        .next()
        .and_then(|a| a.parse().ok())
        .unwrap_or(1_000_000);
    let runs: usize = arguments.next().and_then(|a| a.parse().ok()).unwrap_or(5);
    let setting = |name| std::env::var(name).ok();
    let workers = setting("WORKERS").unwrap_or_else(|| "1".into());
    let workers: Vec<usize> = workers.split(',').filter_map(|w| w.parse().ok()).collect();
    let mut sets: Vec<String> = arguments.collect();
    if sets.is_empty() {
        sets = [
            "uniform", "grid", "sphere", "clusters", "kuzmin", "gaussian",
        ]
        .map(String::from)
        .to_vec();
    }
    for set in sets {
        let points = make(&set, n);
        let mut tables: Vec<Vec<Vec<(&str, f64)>>> = vec![Vec::new(); workers.len()];
        for run in 0..runs {
            for (&workers, table) in workers.iter().zip(&mut tables) {
                table.push(stages(&points, workers));
            }
            if run == 0 && setting("CHECK").is_some() {
                check(&points, workers[0]);
            }
        }
        for (workers, table) in workers.iter().zip(&mut tables) {
            let total = |run: &Vec<(&str, f64)>| run.last().map_or(0.0, |&(_, t)| t);
            table.sort_by(|a, b| total(a).total_cmp(&total(b)));
            let least = table.first().map_or(0.0, total);
            print!("{set:8} {:9} {workers} workers", points.len());
            // The stages of the run in the middle.
            for (name, time) in &table[table.len() / 2] {
                print!("  {name} {time:.0}");
            }
            println!(" ({least:.0}) ns");
        }
    }
}

fn stages(points: &[Point3], workers: usize) -> Vec<(&'static str, f64)> {
    let start = Instant::now();
    let made = triangulate(points, workers, &Watch::idle()).expect("a triangulation");
    let total = start.elapsed();
    let stages = made.stages.iter().copied().chain([("total", total)]);
    let each = |time: std::time::Duration| time.as_secs_f64() * 1e9 / points.len() as f64;
    stages.map(|(name, time)| (name, each(time))).collect()
}

fn check(points: &[Point3], workers: usize) {
    let made = triangulate(points, workers, &Watch::idle()).expect("a triangulation");
    let given = Given {
        points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let found = validate(given, &Watch::idle()).expect("a report");
    assert_eq!(found, Findings3::default());
}

fn make(set: &str, n: usize) -> Vec<Point3> {
    let mut state = 0x9e3779b97f4a7c15u64;
    let mut random = move || {
        // xorshift64*, enough for points
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545f4914f6cdd1d) >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut normal = {
        let mut random = random;
        move || {
            let (u, v): (f64, f64) = (random(), random());
            (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
        }
    };
    let mut direction = || {
        let p = [normal(), normal(), normal()];
        let r = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
        (p, p.map(|x| x / r))
    };
    let side = (n as f64).cbrt().round() as usize;
    match set {
        // Rows in a scattered order, by a step that is coprime to any count.
        "grid" => (0..side * side * side)
            .map(|i| i * 1_000_003 % (side * side * side))
            .map(|i| [i % side, i / side % side, i / side / side].map(|x| x as f64))
            .collect(),
        "utm" => (0..n)
            .map(|_| [0, 1, 2].map(|k| [5e5, 4.5e6, 300.0][k] + (random() * 1e6).round() / 1e3))
            .collect(),
        "sphere" => (0..n).map(|_| direction().1).collect(),
        "gaussian" => (0..n).map(|_| direction().0).collect(),
        "kuzmin" => (0..n)
            .map(|_| {
                let u = random();
                let r = (1.0 / ((1.0 - u) * (1.0 - u)) - 1.0).sqrt();
                direction().1.map(|x| x * r)
            })
            .collect(),
        "clusters" => {
            let centers: Vec<Point3> = (0..20).map(|_| [random(), random(), random()]).collect();
            (0..n)
                .map(|i| {
                    let (c, p) = (centers[i % 20], direction().0);
                    [0, 1, 2].map(|k| c[k] + 0.01 * p[k])
                })
                .collect()
        }
        _ => (0..n).map(|_| [random(), random(), random()]).collect(),
    }
}
