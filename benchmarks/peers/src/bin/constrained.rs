//! Delone's core or spade on points and segments.
//!
//! `constrained RUNS FILE PEER [split]` reads points as `delone-peers` does and pairs of their rows, 32
//! bits each, from `FILE.segments`. Segments may cross only with `split`. Timed is the call from
//! points and segments to finished triangles; what each library asks for as input is made before the
//! clock starts. `benchmarks/constrained.py` makes the files and the tables.

use std::env;
use std::hint::black_box;
use std::time::{Duration, Instant};

use delone_core::base::watch::Watch;
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_peers::{Failure, Outcome, Peer, Points, compete, points, segments};
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Triangulation};

type Spade = ConstrainedDelaunayTriangulation<spade::Point2<f64>>;

const MOST_ADDED: usize = 4_000_000;

struct Lines {
    points: Points,
    segments: Vec<[u32; 2]>,
}

const PEERS: [Peer<Lines>; 5] = [
    ("delone", |lines| delone(lines, 1, false)),
    ("delone, 2 workers", |lines| delone(lines, 2, false)),
    ("delone, no segments", delone_unconstrained),
    ("spade bulk_load_cdt", spade_bulk_load_cdt),
    ("spade bulk_load", spade_bulk_load),
];

const SPLITTING: [Peer<Lines>; 2] = [
    ("delone", |lines| delone(lines, 1, true)),
    ("spade add_constraint_and_split", spade_splitting),
];

fn delone(lines: &Lines, workers: usize, split: bool) -> Result<Outcome, Failure> {
    let Lines { points, segments } = lines;
    let options = Options {
        split,
        conforming: false,
        max_vertices: MOST_ADDED,
        method: Method::Auto,
        workers,
    };
    let start = Instant::now();
    let answer = constrain(black_box(points), segments, options, &Watch::idle())?;
    let time = start.elapsed();
    let all: Points = points.iter().chain(&answer.added).copied().collect();
    Ok(outcome(time, &all, &answer.arrays.simplices))
}

fn delone_unconstrained(lines: &Lines) -> Result<Outcome, Failure> {
    let start = Instant::now();
    let answer = triangulate(black_box(&lines.points), Method::Auto, 1, &Watch::idle())?;
    let time = start.elapsed();
    Ok(outcome(time, &lines.points, &answer.arrays.simplices))
}

fn outcome(time: Duration, points: &Points, simplices: &[[i32; 3]]) -> Outcome {
    let corners = |t: &[i32; 3]| t.map(|v| points[v as usize]);
    Outcome {
        time,
        triangles: simplices.iter().map(corners).collect(),
    }
}

fn spade_outcome(time: Duration, answer: &Spade) -> Outcome {
    let triangles = answer
        .inner_faces()
        .map(|face| face.positions().map(|p| [p.x, p.y]))
        .collect();
    Outcome { time, triangles }
}

fn spade_points(points: &Points) -> Vec<spade::Point2<f64>> {
    let point = |&[x, y]: &[f64; 2]| spade::Point2::new(x, y);
    points.iter().map(point).collect()
}

fn spade_bulk_load_cdt(lines: &Lines) -> Result<Outcome, Failure> {
    let given = spade_points(&lines.points);
    let edges: Vec<_> = lines
        .segments
        .iter()
        .map(|s| s.map(|v| v as usize))
        .collect();
    let start = Instant::now();
    let answer = Spade::bulk_load_cdt(black_box(given), edges)?;
    Ok(spade_outcome(start.elapsed(), &answer))
}

/// A point that knows its row, for the bulk load that gives vertices an order of its own.
struct Numbered {
    position: spade::Point2<f64>,
    row: usize,
}

impl HasPosition for Numbered {
    type Scalar = f64;

    fn position(&self) -> spade::Point2<f64> {
        self.position
    }
}

/// For each row the first row of the same point.
fn first_rows(points: &Points) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        points[a]
            .partial_cmp(&points[b])
            .expect("numbers")
            .then(a.cmp(&b))
    });
    let mut first: Vec<usize> = (0..points.len()).collect();
    for two in order.windows(2) {
        if points[two[0]] == points[two[1]] {
            first[two[1]] = first[two[0]];
        }
    }
    first
}

/// Segments one by one after the faster bulk load. Which rows are one point is known before the
/// clock starts, as it does not say which of them it keeps.
fn spade_bulk_load(lines: &Lines) -> Result<Outcome, Failure> {
    let first = first_rows(&lines.points);
    let rows = spade_points(&lines.points).into_iter().enumerate();
    let given = rows
        .map(|(row, position)| Numbered { position, row })
        .collect();
    let start = Instant::now();
    let mut answer = ConstrainedDelaunayTriangulation::<Numbered>::bulk_load(black_box(given))?;
    let mut vertex = vec![FixedVertexHandle::from_index(0); first.len()];
    for v in answer.vertices() {
        vertex[first[v.data().row]] = v.fix();
    }
    for segment in &lines.segments {
        let [a, b] = segment.map(|v| vertex[first[v as usize]]);
        if a != b {
            answer.add_constraint(a, b);
        }
    }
    let time = start.elapsed();
    let faces = answer.inner_faces();
    let triangles = faces
        .map(|face| face.positions().map(|p| [p.x, p.y]))
        .collect();
    Ok(Outcome { time, triangles })
}

/// Its bulk load does not split: segments follow one by one. The points must be distinct.
fn spade_splitting(lines: &Lines) -> Result<Outcome, Failure> {
    let given = spade_points(&lines.points);
    let start = Instant::now();
    let mut answer = Spade::bulk_load_cdt(black_box(given), Vec::new())?;
    if answer.num_vertices() != lines.points.len() {
        return Err("points repeat".into());
    }
    for segment in &lines.segments {
        let [a, b] = segment.map(|v| FixedVertexHandle::from_index(v as usize));
        answer.add_constraint_and_split(a, b, |crossing| crossing);
    }
    Ok(spade_outcome(start.elapsed(), &answer))
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().collect();
    let [_, runs, file, peer, split @ ..] = &arguments[..] else {
        return Err("usage: constrained RUNS FILE PEER [split]".into());
    };
    let lines = Lines {
        points: points(file)?,
        segments: segments(&format!("{file}.segments"))?,
    };
    let peers: &[Peer<Lines>] = if split.is_empty() { &PEERS } else { &SPLITTING };
    let wanted: Vec<_> = peers
        .iter()
        .filter(|(name, _)| name == peer)
        .copied()
        .collect();
    compete(&wanted, &lines, runs.parse()?, file)
}
