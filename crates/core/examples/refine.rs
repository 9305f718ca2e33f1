//! Times the refinement of a fractal ring: refine [SEGMENTS [TRIANGLES [DEGREES]]]

use std::time::Instant;

use delone_core::base::watch::Watch;
use delone_core::constrained::{Options, components, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::refine::{Task, refine};

/// A Koch curve over a heptagon, `2^levels` segments per side.
fn ring(sides: u32, levels: u32) -> Vec<[f64; 2]> {
    let corner = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(sides);
    let mut points: Vec<[f64; 2]> = (0..sides)
        .map(|i| [corner(i).cos(), corner(i).sin()])
        .collect();
    for _ in 0..levels {
        let mut finer = Vec::with_capacity(2 * points.len());
        for (i, &[x, y]) in points.iter().enumerate() {
            let [u, v] = points[(i + 1) % points.len()];
            let out = if i % 2 == 0 { 0.19 } else { -0.19 };
            finer.push([x, y]);
            finer.push([(x + u) / 2.0 + out * (v - y), (y + v) / 2.0 - out * (u - x)]);
        }
        points = finer;
    }
    points
}

fn main() {
    let argument = |i: usize, default: f64| {
        let given = std::env::args().nth(i).and_then(|a| a.parse().ok());
        given.unwrap_or(default)
    };
    let levels = (argument(1, 28_672.0) / 7.0).log2().round() as u32;
    let (triangles, degrees) = (argument(2, 1e6), argument(3, 30.0));
    let points = ring(7, levels);
    let n = points.len() as u32;
    let segments: Vec<[u32; 2]> = (0..n).map(|i| [i, (i + 1) % n]).collect();
    let options = Options {
        split: false,
        conforming: false,
        max_vertices: 0,
        method: Method::Auto,
        workers: 1,
    };
    let start = Instant::now();
    let base = constrain(&points, &segments, options, &Watch::idle()).expect("a ring");
    let labels =
        components(&base.arrays.neighbors, &base.constrained, &Watch::idle()).expect("labels");
    let outer: std::collections::HashSet<i32> = (base.arrays.neighbors.iter().enumerate())
        .flat_map(|(t, n)| (0..3).map(move |k| (t, k, n[k])))
        .filter(|&(t, k, n)| n < 0 && !base.constrained[t][k])
        .map(|(t, ..)| labels[t])
        .collect();
    let labels: Vec<i32> = labels
        .iter()
        .map(|l| if outer.contains(l) { -1 } else { 0 })
        .collect();
    let built = start.elapsed();
    let frozen = vec![false; segments.len()];
    let area = 2.9 / triangles * 1.6;
    for _ in 0..3 {
        let start = Instant::now();
        let task = Task {
            points: &points,
            simplices: &base.arrays.simplices,
            neighbors: None,
            labels: &labels,
            areas: &vec![area; labels.len()],
            segments: &segments,
            lines: None,
            frozen: &frozen,
            min_angle: degrees,
            circles: false,
            sizes_yield: false,
            max_vertices: 20_000_000,
        };
        let made = refine(task, &Watch::idle()).expect("a mesh");
        let time = start.elapsed();
        println!(
            "{} segments, base {built:.1?}: {} triangles in {time:.1?}, {:.0} ns each, {:?}",
            n,
            made.simplices.len(),
            time.as_secs_f64() * 1e9 / made.simplices.len() as f64,
            made.counts,
        );
    }
}
