//! Delone's core, spade and delaunator on one file of points, in turns.
//!
//! `delone-peers RUNS FILE` reads the file's little-endian doubles, x and y in turn, and prints a line
//! for each run: peer, seconds, triangles. Timed is the call from a slice of points to finished
//! triangles: what each library asks for as input (its own point type, a vector that it may keep) is
//! made before the clock starts. The corners of the first run's triangles go beside the file, as
//! doubles, for the judge. `benchmarks/crates.py` makes the files and the table.

use std::env;
use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::time::{Duration, Instant};

use delone_core::delaunay2::{Method, triangulate};
use delone_core::watch::Watch;
use spade::{DelaunayTriangulation, Triangulation};

type Points = Vec<[f64; 2]>;
type Spade = DelaunayTriangulation<spade::Point2<f64>>;

/// The time of the call, and the triangles by their coordinates, taken out after it.
struct Outcome {
    time: Duration,
    triangles: Vec<[[f64; 2]; 3]>,
}

type Call = fn(&Points) -> Result<Outcome, Box<dyn Error>>;

const PEERS: [(&str, Call); 5] = [
    ("delone", |points| delone(points, 1)),
    ("delone, 2 workers", |points| delone(points, 2)),
    ("spade bulk_load", spade_bulk_load),
    ("spade bulk_load_stable", spade_bulk_load_stable),
    ("delaunator", delaunator_triangulate),
];

fn delone(points: &Points, workers: usize) -> Result<Outcome, Box<dyn Error>> {
    let start = Instant::now();
    let answer = triangulate(black_box(points), Method::Auto, workers, &Watch::idle())?;
    let time = start.elapsed();
    let corners = |t: &[i32; 3]| t.map(|v| points[v as usize]);
    Ok(Outcome {
        time,
        triangles: answer.arrays.simplices.iter().map(corners).collect(),
    })
}

fn spade_outcome(time: Duration, answer: &Spade) -> Outcome {
    let triangles = answer
        .inner_faces()
        .map(|face| face.positions().map(|p| [p.x, p.y]))
        .collect();
    Outcome { time, triangles }
}

fn spade_points(points: &Points) -> Vec<spade::Point2<f64>> {
    points
        .iter()
        .map(|&[x, y]| spade::Point2::new(x, y))
        .collect()
}

fn spade_bulk_load(points: &Points) -> Result<Outcome, Box<dyn Error>> {
    let given = spade_points(points);
    let start = Instant::now();
    let answer = Spade::bulk_load(black_box(given))?;
    Ok(spade_outcome(start.elapsed(), &answer))
}

fn spade_bulk_load_stable(points: &Points) -> Result<Outcome, Box<dyn Error>> {
    let given = spade_points(points);
    let start = Instant::now();
    let answer = Spade::bulk_load_stable(black_box(given))?;
    Ok(spade_outcome(start.elapsed(), &answer))
}

fn delaunator_triangulate(points: &Points) -> Result<Outcome, Box<dyn Error>> {
    let given: Vec<_> = points
        .iter()
        .map(|&[x, y]| delaunator::Point { x, y })
        .collect();
    let start = Instant::now();
    let answer = delaunator::triangulate(black_box(&given));
    let time = start.elapsed();
    // Its triangles turn right; the judge wants them to turn left.
    let corners = |t: &[usize]| [points[t[0]], points[t[2]], points[t[1]]];
    Ok(Outcome {
        time,
        triangles: answer.triangles.chunks_exact(3).map(corners).collect(),
    })
}

fn read(file: &str) -> std::io::Result<Points> {
    let bytes = fs::read(file)?;
    let number = |b: &[u8]| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
    Ok(bytes
        .chunks_exact(16)
        .map(|row| [number(&row[..8]), number(&row[8..])])
        .collect())
}

fn write(file: &str, triangles: &[[[f64; 2]; 3]]) -> std::io::Result<()> {
    let numbers = triangles.as_flattened().as_flattened();
    fs::write(
        file,
        numbers
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<u8>>(),
    )
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().collect();
    let [_, runs, file] = &arguments[..] else {
        return Err("usage: delone-peers RUNS FILE".into());
    };
    let points = read(file)?;
    for run in 0..runs.parse()? {
        for (name, call) in PEERS {
            match call(&points) {
                Ok(Outcome { time, triangles }) => {
                    println!("{name}\t{}\t{}", time.as_secs_f64(), triangles.len());
                    if run == 0 {
                        write(&format!("{file}.{name}"), &triangles)?;
                    }
                }
                Err(error) => println!("{name}\tfailed\t{error}"),
            }
        }
    }
    Ok(())
}
