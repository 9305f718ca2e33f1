//! Milliseconds per stage of a constrained triangulation, median and minimum of several runs:
//! `cargo run --release -p delone-core --example constrained -- FILE 5`. FILE contains points as
//! pairs of doubles, and FILE.segments pairs of their rows, 32 bits each, little-endian, as written
//! by `python benchmarks/constrained.py --write FOLDER`. The environment may set WORKERS, METHOD,
//! SPLIT and CONFORMING.

use std::env;
use std::error::Error;
use std::fs;
use std::time::Instant;

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay::plane::Method;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let file = arguments.next().ok_or("usage: constrained FILE [RUNS]")?;
    let runs: usize = arguments.next().map_or(Ok(5), |runs| runs.parse())?;
    let (points, segments) = (points(&file)?, segments(&format!("{file}.segments"))?);
    let setting = |name| env::var(name).ok();
    let options = Options {
        split: setting("SPLIT").is_some(),
        conforming: setting("CONFORMING").is_some(),
        max_vertices: 4_000_000,
        method: setting("METHOD")
            .and_then(|m| Method::named(&m))
            .unwrap_or(Method::Auto),
        workers: setting("WORKERS").and_then(|w| w.parse().ok()).unwrap_or(1),
    };
    let mut table: Vec<(&str, Vec<f64>)> = Vec::new();
    for run in 0..runs {
        let start = Instant::now();
        let made = constrain(&points, &segments, options, &Watch::idle())?;
        let total = start.elapsed();
        let stages = made.stages.iter().copied().chain([("total", total)]);
        for (i, (name, time)) in stages.enumerate() {
            if run == 0 {
                table.push((name, Vec::new()));
            }
            table[i].1.push(time.as_secs_f64() * 1e3);
        }
        if run == 0 {
            let (n, s, added) = (points.len(), segments.len(), made.added.len());
            let triangles = made.arrays.simplices.len();
            println!("{n} points, {s} segments: {triangles} triangles, {added} vertices added");
        }
    }
    for (name, times) in &mut table {
        times.sort_by(f64::total_cmp);
        print!("  {name} {:.1} ({:.1})", times[times.len() / 2], times[0]);
    }
    println!();
    Ok(())
}

fn points(file: &str) -> std::io::Result<Vec<Point2>> {
    let number = |b: &[u8]| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
    let row = |row: &[u8]| [number(&row[..8]), number(&row[8..])];
    Ok(fs::read(file)?.chunks_exact(16).map(row).collect())
}

fn segments(file: &str) -> std::io::Result<Vec<[u32; 2]>> {
    let number = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let row = |row: &[u8]| [number(&row[..4]), number(&row[4..])];
    Ok(fs::read(file)?.chunks_exact(8).map(row).collect())
}
