//! Runs one job on fixed input, to count its instructions: `counts JOB`; without a job, the names
//! of all. `benchmarks/counts.py` runs it under callgrind, which collects inside of [`counted`].
//!
//! Inputs are made by arithmetic alone, without a mathematical library: they are the same bits on
//! every system. One thread does all the work.

use std::error::Error;
use std::hint::black_box;

use delone_core::arrays::Given;
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay2::{Method, triangulate};
use delone_core::delaunay3;
use delone_core::locate::{Batch, Kept, Locator, find};
use delone_core::watch::{IDLE, Watch};
use delone_core::{Point2, Point3};

type Outcome = Result<(), Box<dyn Error>>;
type Job = fn() -> Outcome;

/// A job with its name; its points are few, as callgrind takes fifty times as long.
const JOBS: [(&str, Job); 7] = [
    ("uniform", || planar(&uniform(20_000))),
    ("lattice", || planar(&lattice(100))),
    ("clusters", || planar(&clusters(10_000))),
    ("constrained", constrained),
    ("find", finding),
    ("space", || spatial(&uniform(3_000))),
    ("voxels", || spatial(&voxels(12))),
];

fn main() -> Outcome {
    let Some(name) = std::env::args().nth(1) else {
        JOBS.iter().for_each(|(name, _)| println!("{name}"));
        return Ok(());
    };
    let found = JOBS.iter().find(|(job, _)| *job == name);
    let (_, job) = found.ok_or_else(|| format!("no job {name}"))?;
    job()
}

/// What callgrind counts.
#[inline(never)]
fn counted<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    black_box(work())
}

fn planar(points: &[Point2]) -> Outcome {
    counted(|| triangulate(points, Method::Auto, 1, &Watch::idle()))?;
    Ok(())
}

fn spatial(points: &[Point3]) -> Outcome {
    counted(|| delaunay3::triangulate(points, 1, &Watch::idle()))?;
    Ok(())
}

/// A closed line through points of a circle of rational coordinates, and points around it.
fn constrained() -> Outcome {
    let corners = 1_000u32;
    let corner = |i: u32| {
        // Half of the circle by its rational parametrization, then its mirror image.
        let t = f64::from(i % (corners / 2)) / f64::from(corners / 4) - 1.0;
        let side = if i < corners / 2 { 0.3 } else { -0.3 };
        let square = 1.0 + t * t;
        [
            0.5 + side * 2.0 * t / square,
            0.5 + side * (1.0 - t * t) / square,
        ]
    };
    let mut points: Vec<Point2> = (0..corners).map(corner).collect();
    points.extend(uniform::<2>(4_000));
    let segments: Vec<[u32; 2]> = (0..corners).map(|i| [i, (i + 1) % corners]).collect();
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: 100_000,
        method: Method::Auto,
        workers: 1,
    };
    counted(|| constrain(&points, &segments, options, &Watch::idle()))?;
    Ok(())
}

/// Location of points in a triangulation of others.
fn finding() -> Outcome {
    let watch = &Watch::idle();
    let points = uniform(5_000);
    let queries: Vec<Point2> = uniform(15_000).split_off(5_000);
    let made = triangulate(&points, Method::Auto, 1, watch)?;
    let given = Given {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let kept = Kept::of(&given, watch)?;
    let batch = Batch {
        locator: Locator::new(given, &kept, &IDLE),
        queries: &queries,
        workers: 1,
        watch,
    };
    counted(|| find(&batch))?;
    Ok(())
}

fn uniform<const D: usize>(n: usize) -> Vec<[f64; D]> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        // G. Marsaglia's xorshift with a product.
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [(); D].map(|()| random())).collect()
}

fn lattice(side: u32) -> Vec<Point2> {
    (0..side * side)
        .map(|i| [i % side, i / side].map(f64::from))
        .collect()
}

fn voxels(side: u32) -> Vec<Point3> {
    (0..side * side * side)
        .map(|i| [i % side, i / side % side, i / side / side].map(f64::from))
        .collect()
}

/// Ten clusters, each ten times as dense as the one before.
fn clusters(n: usize) -> Vec<Point2> {
    let scale = |i: usize| 0.1f64.powi(i as i32 % 10);
    let points = uniform(n).into_iter().enumerate();
    points
        .map(|(i, p)| p.map(|x| scale(i) * x + (i % 10) as f64))
        .collect()
}
