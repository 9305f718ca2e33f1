//! Constrained Delaunay triangulations: each segment is a chain of edges; the other edges are
//! Delaunay as far as segments permit.
//!
//! An edge that is not a subsegment is Delaunay with respect to the vertices that segments do not hide
//! from it. Ties are broken by coordinates, so one set of points and segments has exactly one such
//! triangulation. All points are triangulated first; then each segment that is not yet an edge is
//! inserted.

mod components;
pub(crate) mod conforming;
mod densest;
mod edges;
pub(crate) mod inserted;
pub mod intersection;
pub(crate) mod marked;
mod near;
pub mod nesting;
pub mod pairs;
mod polygon;
mod present;
mod reroute;
mod ring;
pub(crate) mod segment;
pub(crate) mod sites;
mod split;
mod subsegments;

use delone_predicates::{Point2, lexicographic, orient2d};

pub use self::components::{components, numbered_by_smallest};
pub(crate) use self::near::{Band, is_near, passes};
pub use self::polygon::{Filled, Rule, polygon};
pub use self::ring::simple_ring;
pub(crate) use self::split::in_direction;
pub use self::subsegments::Subsegments;

use self::inserted::Inserted;
use self::marked::Marked;
use self::split::Splitter;
use crate::base::arrays::Arrays;
use crate::base::error::{Densest, Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::delaunay::plane::{Built, Method, mesh};
use crate::delaunay::{Clock, Stage};
use crate::mesh::plane::export;
use crate::order;

/// Segments between two checks for interruption.
const WATCH_EVERY: usize = 1 << 10;
/// Crossed triangles that take as long as the rest of the insertion of a segment.
const TRIANGLES: usize = 8;

/// Limit on pairs of segments that may cross: this many for each vertex that may be added, plus a
/// constant.
const PAIRS: usize = 8;
const MORE_PAIRS: usize = 1 << 20;

/// Options of the caller.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Whether crossing segments are split where they cross; otherwise they are an error.
    pub split: bool,
    /// Whether vertices are added until each subsegment's diametral circle is empty.
    pub conforming: bool,
    /// The limit on added vertices.
    pub max_vertices: usize,
    /// How the points are triangulated.
    pub method: Method,
    /// The number of threads.
    pub workers: usize,
}

/// A constrained Delaunay triangulation in the rows of the input, with added vertices after them.
#[derive(Debug)]
pub struct Constrained {
    /// Vertices that the input does not have.
    pub added: Vec<Point2>,
    /// Triangles and their neighbors; they tile the hull.
    pub arrays: Arrays<3>,
    /// For each triangle and corner, whether the edge opposite is a subsegment.
    pub constrained: Vec<[bool; 3]>,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// The edges that the segments consist of.
    pub subsegments: Subsegments,
    /// Segments whose ends coincide.
    pub zero: Vec<u32>,
    /// `[row, vertex]`: vertices of the input inside segments, ascending.
    pub through: Vec<[u32; 2]>,
    /// `[row, row, vertex]`: pairs of segments that crossed, and the vertex where they do,
    /// ascending.
    pub crossings: Vec<[u32; 3]>,
    /// The times of the stages.
    pub stages: Vec<Stage>,
}

/// The constrained Delaunay triangulation of `input` with the `segments`, pairs of its rows.
pub fn constrain(
    input: &[Point2],
    segments: &[[u32; 2]],
    options: Options,
    watch: &Watch,
) -> Result<Constrained> {
    let mut clock = Clock::start();
    let mut work = Work::start(input, segments, options, watch, &mut clock)?;
    let inserted = work.insert_segments(input, watch)?;
    clock.lap("segments");
    work.finish(input.len(), inserted, clock, watch)
}

/// A triangulation into which segments are inserted.
struct Work<'a> {
    segments: &'a [[u32; 2]],
    options: Options,
    marked: Marked,
    /// The row of each vertex: the first in the input, or one after the input.
    rows: Vec<u32>,
    /// The crossings: vertices after the input.
    met: Vec<Point2>,
    duplicates: Vec<[u32; 2]>,
    /// The segments as pairs of vertices.
    ends: Vec<[u32; 2]>,
}

impl<'a> Work<'a> {
    fn start(
        input: &[Point2],
        segments: &'a [[u32; 2]],
        options: Options,
        watch: &Watch,
        clock: &mut Clock,
    ) -> Result<Self> {
        let built = mesh(input, options.method, options.workers, watch, clock)?;
        let place = places(&built, input.len())?;
        let mut ends = with_room(segments.len())?;
        ends.extend(segments.iter().map(|s| s.map(|row| place[row as usize])));
        let marked = Marked::new(built.mesh, built.points, watch)?;
        clock.lap("marks");
        Ok(Self {
            segments,
            options,
            marked,
            rows: built.rows,
            met: Vec::new(),
            duplicates: built.duplicates,
            ends,
        })
    }

    /// Inserts all segments. If some cross, that is an error, or they are split: a few in place; if
    /// there are many, the triangulation starts again with the crossings among the points.
    fn insert_segments(&mut self, input: &[Point2], watch: &Watch) -> Result<Inserted> {
        let Options {
            conforming,
            max_vertices: limit,
            split,
            ..
        } = self.options;
        let few = if split { self.few() } else { 0 };
        let inserted = match inserted::insert_all(&mut self.marked, &self.ends, few, watch)? {
            Some((inserted, waiting)) if waiting.is_empty() => Some(inserted),
            Some((inserted, waiting)) if split => self.reroute(input, inserted, &waiting, watch)?,
            _ if !split => return Err(self.crossing_error(input, watch)?),
            _ => None,
        };
        let mut splitter = if let Some(inserted) = inserted {
            if !conforming {
                return Ok(inserted);
            }
            let mut splitter = Splitter::new(&mut self.marked, &self.ends, limit, watch)?;
            splitter.adopt(inserted)?;
            splitter
        } else {
            let found = self.crossings(input, watch)?;
            let meets = self.start_again(input, &found, watch)?;
            let mut splitter = Splitter::new(&mut self.marked, &self.ends, limit, watch)?;
            let rows = &self.rows;
            let is_rounded = |w: u32| {
                rows.get(w as usize)
                    .is_none_or(|&r| r as usize >= input.len())
            };
            splitter.run(&found.pairs, &meets, is_rounded)?;
            splitter
        };
        if conforming {
            splitter.conform()?;
        }
        splitter.finish()
    }

    /// The error that names all pairs that cross.
    fn crossing_error(&self, input: &[Point2], watch: &Watch) -> Result<Error> {
        let Crossings { pairs, points } = self.crossings(input, watch)?;
        Ok(Error::Crossing { pairs, points })
    }

    /// All pairs of segments that cross, except at points of the input.
    fn crossings(&self, input: &[Point2], watch: &Watch) -> Result<Crossings> {
        // Many pairs may cross in one point, so pairs have a limit of their own.
        let limit = self.options.max_vertices;
        let most = limit.saturating_mul(PAIRS).saturating_add(MORE_PAIRS);
        let pairs = pairs::crossing_pairs_above(input, self.segments, most, watch)?;
        if pairs.len() > most {
            return Err(Error::Budget {
                what: "pairs of crossing segments",
                limit,
                found: pairs.len(),
                densest: self.densest_of(&pairs, input),
            });
        }
        self.meetings(input, pairs, watch)
    }

    /// The segments that cross the most other segments.
    fn densest_of(&self, pairs: &[[u32; 2]], input: &[Point2]) -> Densest {
        let rows = pairs.as_flattened().to_vec();
        densest::densest_segments(rows, self.segments, |row| input[row as usize], None)
    }

    /// The points where `pairs` cross, except points of the input.
    fn meetings(&self, input: &[Point2], pairs: Vec<[u32; 2]>, watch: &Watch) -> Result<Crossings> {
        let at = |row: u32| self.segments[row as usize].map(|v| input[v as usize]);
        let mut points = with_room(pairs.len())?;
        let mut exact = Vec::new();
        for (i, &[s, t]) in pairs.iter().enumerate() {
            if i.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            let ([a, b], [c, d]) = (at(s), at(t));
            let x = intersection::intersection(a, b, c, d);
            points.push(x);
            if orient2d(a, b, x).is_zero() && orient2d(c, d, x).is_zero() {
                push(&mut exact, (x, i))?;
            }
        }
        order::sort_by(&mut exact, watch, |(p, i), (q, j)| {
            lexicographic(*p, *q).then(i.cmp(j))
        })?;
        let mut given = filled(if exact.is_empty() { 0 } else { pairs.len() }, false)?;
        let mut pace = Pace::new(watch, WATCH_EVERY * TRIANGLES);
        for p in input.iter().filter(|_| !exact.is_empty()) {
            pace.spend(1)?;
            let first = exact.partition_point(|(q, _)| lexicographic(*q, *p).is_lt());
            for (_, i) in exact[first..].iter().take_while(|(q, _)| q == p) {
                given[*i] = true;
            }
        }
        let mut found = Crossings {
            pairs: with_room(pairs.len())?,
            points: with_room(pairs.len())?,
        };
        for (i, (pair, x)) in pairs.into_iter().zip(points).enumerate() {
            pace.spend(1)?;
            if !given.get(i).is_some_and(|given| *given) {
                found.pairs.push(pair);
                found.points.push(x);
            }
        }
        Ok(found)
    }

    /// Triangulates the input and the crossings. Returns the vertex of each crossing.
    fn start_again(
        &mut self,
        input: &[Point2],
        found: &Crossings,
        watch: &Watch,
    ) -> Result<Vec<u32>> {
        let Options {
            method, workers, ..
        } = self.options;
        let n = input.len();
        let all = [input, &found.points].concat();
        let built = mesh(&all, method, workers, watch, &mut Clock::start())?;
        let place = places(&built, all.len())?;
        for (ends, s) in self.ends.iter_mut().zip(self.segments) {
            *ends = s.map(|row| place[row as usize]);
        }
        // Crossings that are not vertices yet get consecutive rows after the input.
        let mut behind: Vec<u32> = built
            .rows
            .iter()
            .copied()
            .filter(|r| *r as usize >= n)
            .collect();
        order::sort(&mut behind, watch)?;
        if behind.len() > self.options.max_vertices {
            return Err(Error::Budget {
                what: "added vertices",
                limit: self.options.max_vertices,
                found: behind.len(),
                densest: self.densest_of(&found.pairs, input),
            });
        }
        self.met = behind.iter().map(|&row| all[row as usize]).collect();
        self.rows = built.rows;
        for row in self.rows.iter_mut().filter(|row| **row as usize >= n) {
            let rank = behind.partition_point(|r| r < row);
            *row = (n + rank) as u32;
        }
        self.marked = Marked::new(built.mesh, built.points, watch)?;
        Ok(place[n..].to_vec())
    }

    /// Sorts pieces by row, and along the segment of each row.
    fn sort(&self, pieces: &mut [([u32; 2], u32)], watch: &Watch) -> Result<()> {
        let at = |v: u32| self.marked.at(v);
        order::sort_by(pieces, watch, |(s, i), (t, j)| {
            i.cmp(j).then_with(|| {
                // Along a segment each coordinate is monotone; if one is constant, the other
                // decides.
                let [a, b] = self.ends[*i as usize].map(at);
                let by = |p: u32, q: u32, k: usize| {
                    let along = at(p)[k].total_cmp(&at(q)[k]);
                    if a[k] <= b[k] { along } else { along.reverse() }
                };
                let order = |end: usize| by(s[end], t[end], 0).then(by(s[end], t[end], 1));
                order(0).then_with(|| order(1))
            })
        })
    }

    /// The vertices after the `n` points of the input; new ones get their rows.
    fn added(&mut self, n: usize) -> Vec<Point2> {
        let later = &self.marked.points[self.rows.len()..self.marked.count];
        let added = [&self.met[..], later].concat();
        let first = (n + self.met.len()) as u32;
        self.rows.extend((first..).take(later.len()));
        added
    }

    /// Converts everything to rows of the input, of `n` points.
    fn finish(
        mut self,
        n: usize,
        inserted: Inserted,
        mut clock: Clock,
        watch: &Watch,
    ) -> Result<Constrained> {
        let workers = self.options.workers;
        let mut pieces = inserted.pieces;
        if !inserted.sorted {
            self.sort(&mut pieces, watch)?;
        }
        let added = self.added(n);
        let rows = self.rows;
        let row_of = |v: u32| rows[v as usize];
        let ghost = self.marked.close(watch)?;
        let (arrays, constrained) =
            export::marked_arrays(self.marked.mesh, ghost, &rows, workers, watch)?;
        let mut through = inserted.through;
        // Vertices that the caller has are rows of the input; crossings are listed apart.
        through.iter_mut().for_each(|t| t[1] = row_of(t[1]));
        through.retain(|t| (t[1] as usize) < n);
        order::sort(&mut through, watch)?;
        through.dedup();
        let mut crossings = inserted.crossings;
        crossings.iter_mut().for_each(|c| c[2] = row_of(c[2]));
        order::sort(&mut crossings, watch)?;
        crossings.dedup();
        pieces.iter_mut().for_each(|p| p.0 = p.0.map(row_of));
        let zero = (0u32..).zip(&self.ends).filter(|(_, e)| e[0] == e[1]);
        let zero = zero.map(|(row, _)| row).collect();
        let subsegments = Subsegments::of(&pieces, inserted.repeated, watch)?;
        clock.lap("export");
        Ok(Constrained {
            added,
            arrays,
            constrained,
            duplicates: self.duplicates,
            subsegments,
            zero,
            through,
            crossings,
            stages: clock.stages,
        })
    }
}

/// Pairs of segments that cross, and the crossings, rounded.
#[derive(Debug)]
struct Crossings {
    pairs: Vec<[u32; 2]>,
    points: Vec<Point2>,
}

/// The vertex of each of `n` rows.
fn places(built: &Built, n: usize) -> Result<Vec<u32>> {
    let mut place = filled(n, 0u32)?;
    for (v, &row) in (0..).zip(&built.rows) {
        place[row as usize] = v;
    }
    for &[row, first] in &built.duplicates {
        place[row as usize] = place[first as usize];
    }
    Ok(place)
}
