//! Delone's core, spade and delaunator on one file of points, in turns.
//!
//! `delone-peers RUNS FILE [PEER]` reads the file's little-endian doubles, x and y in turn, and prints a
//! line for each run: peer, seconds, triangles; all peers take turns unless one is named. Timed is the call from a slice of points to finished
//! triangles: what each library asks for as input (its own point type, a vector that it may keep) is
//! made before the clock starts. The corners of the first run's triangles go beside the file, as
//! doubles, for the judge. `benchmarks/crates.py` makes the files and the table.

use std::env;
use std::hint::black_box;
use std::time::{Duration, Instant};

use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::{Method, triangulate};
use delone_peers::{Failure, Outcome, Peer, Points, compete, points};
use spade::{DelaunayTriangulation, Triangulation};

type Spade = DelaunayTriangulation<spade::Point2<f64>>;

const PEERS: [Peer<Points>; 5] = [
    ("delone", |points| delone(points, 1)),
    ("delone, 2 workers", |points| delone(points, 2)),
    ("spade bulk_load", spade_bulk_load),
    ("spade bulk_load_stable", spade_bulk_load_stable),
    ("delaunator", delaunator_triangulate),
];

fn delone(points: &Points, workers: usize) -> Result<Outcome, Failure> {
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

fn spade_bulk_load(points: &Points) -> Result<Outcome, Failure> {
    let given = spade_points(points);
    let start = Instant::now();
    let answer = Spade::bulk_load(black_box(given))?;
    Ok(spade_outcome(start.elapsed(), &answer))
}

fn spade_bulk_load_stable(points: &Points) -> Result<Outcome, Failure> {
    let given = spade_points(points);
    let start = Instant::now();
    let answer = Spade::bulk_load_stable(black_box(given))?;
    Ok(spade_outcome(start.elapsed(), &answer))
}

fn delaunator_triangulate(points: &Points) -> Result<Outcome, Failure> {
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

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().collect();
    let [_, runs, file, which @ ..] = &arguments[..] else {
        return Err("usage: delone-peers RUNS FILE [PEER]".into());
    };
    let wanted = |peer: &&Peer<Points>| which.is_empty() || which.iter().any(|name| name == peer.0);
    let peers: Vec<_> = PEERS.iter().filter(wanted).copied().collect();
    compete(&peers, &points(file)?, runs.parse()?, file)
}
