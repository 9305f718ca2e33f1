//! Constrained Delaunay triangulations: every segment is a chain of edges, and all other edges are
//! Delaunay where segments do not block the view; ties are broken by coordinates. One set of points and
//! segments has one such triangulation.
//!
//! The points are triangulated in bulk; then each segment that is not there makes way for itself.

mod components;
pub(crate) mod conforming;
mod crowd;
mod edges;
pub mod intersection;
mod laid;
pub(crate) mod marked;
pub mod pairs;
mod polygon;
mod present;
mod reroute;
mod ring;
mod segment;
mod split;
mod subsegments;

use delone_predicates::{Point2, lexicographic, orient2d};

pub use self::components::components;
pub use self::polygon::{Filled, Rule, polygon};
pub use self::ring::simple_ring;
pub use self::subsegments::Subsegments;

use self::laid::Laid;
use self::marked::Marked;
use self::present::mark_present;
use self::segment::{Cavity, Step};
use self::split::Splitter;
use crate::arrays::Arrays;
use crate::delaunay2::{Built, Clock, Method, Stage, mesh};
use crate::error::{Crowd, Error, Result};
use crate::memory::{filled, push, with_room};
use crate::mesh2::export;
use crate::order;
use crate::watch::{Pace, Watch};

/// Segments between two looks at the watch.
const WATCH_EVERY: usize = 1 << 10;
/// Triangles that a segment crosses and that take as long as the rest of it.
const TRIANGLES: usize = 8;

/// Pairs of segments that may cross for each vertex that may be added, and more of them in any case.
const PAIRS: usize = 8;
const MORE_PAIRS: usize = 1 << 20;

/// What a caller may choose.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Whether segments that cross are split there; else they are an error.
    pub split: bool,
    /// Whether vertices are added until the circle on each subsegment is empty.
    pub conforming: bool,
    /// Most vertices that may be added.
    pub max_vertices: usize,
    /// How the points are triangulated.
    pub method: Method,
    /// How many threads may work.
    pub workers: usize,
}

/// A constrained Delaunay triangulation in the rows of the input, added vertices behind them.
#[derive(Debug)]
pub struct Constrained {
    /// Vertices that the input does not have.
    pub added: Vec<Point2>,
    /// Triangles and their neighbours; they tile the hull.
    pub arrays: Arrays<3>,
    /// For each triangle and corner, whether the edge opposite is a subsegment.
    pub constrained: Vec<[bool; 3]>,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// The edges that the segments have become.
    pub subsegments: Subsegments,
    /// Segments whose ends are one point.
    pub zero: Vec<u32>,
    /// `[row, vertex]`: vertices of the input inside segments, ascending.
    pub through: Vec<[u32; 2]>,
    /// `[row, row, vertex]`: segments that crossed, and where they meet now, ascending.
    pub crossings: Vec<[u32; 3]>,
    /// Where the time went.
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
    let laid = work.lay(input, watch)?;
    clock.lap("segments");
    work.finish(input.len(), laid, clock, watch)
}

/// A triangulation that gets its segments.
struct Work<'a> {
    segments: &'a [[u32; 2]],
    options: Options,
    marked: Marked,
    /// For each vertex its row: the first in the input, or one behind it.
    rows: Vec<u32>,
    /// Crossings, which are vertices behind the input.
    met: Vec<Point2>,
    duplicates: Vec<[u32; 2]>,
    /// The segments as vertices.
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

    /// Lays all segments. Where two of them cross, that is an error, or they are split: few of them
    /// in place, many by starting anew with the crossings among the points.
    fn lay(&mut self, input: &[Point2], watch: &Watch) -> Result<Laid> {
        let Options {
            conforming,
            max_vertices: limit,
            split,
            ..
        } = self.options;
        let few = if split { self.few() } else { 0 };
        let laid = match self.lay_all(few, watch)? {
            Some((laid, waiting)) if waiting.is_empty() => Some(laid),
            Some((laid, waiting)) if split => self.reroute(input, laid, &waiting, watch)?,
            _ if !split => return Err(self.crossing_error(input, watch)?),
            _ => None,
        };
        let mut splitter = if let Some(laid) = laid {
            if !conforming {
                return Ok(laid);
            }
            let mut splitter = Splitter::new(&mut self.marked, &self.ends, limit, watch)?;
            splitter.adopt(laid)?;
            splitter
        } else {
            let found = self.crossings(input, watch)?;
            let meets = self.start_anew(input, &found, watch)?;
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

    /// Marks the segments that are edges, and lays the others row by row. Returns the rows that are
    /// crossed by what was laid before, which wait; nothing where there are more than `few`.
    fn lay_all(&mut self, few: usize, watch: &Watch) -> Result<Option<(Laid, Vec<u32>)>> {
        let present = mark_present(&mut self.marked, &self.ends, watch)?;
        let mut laid = Laid {
            pieces: with_room(self.ends.len())?,
            repeated: present.repeated,
            sorted: true,
            ..Laid::default()
        };
        let mut waiting = Vec::new();
        let mut cavity = Cavity::default();
        let mut pace = Pace::new(watch, WATCH_EVERY * TRIANGLES);
        for (row, &[mut a, mut b]) in (0u32..).zip(&self.ends) {
            pace.spend(1)?;
            if present.holds([a, b]) {
                push(&mut laid.pieces, ([a, b], row))?;
                continue;
            }
            let mut back = Vec::new();
            while a != b {
                let step = self.marked.join(a, b, &mut cavity)?;
                pace.spend(TRIANGLES + cavity.size())?;
                let Step::Joined { from, to, again } = step else {
                    waiting.push(row);
                    break;
                };
                laid.repeated |= again;
                if to != a ^ b ^ from {
                    push(&mut laid.through, [row, to])?;
                }
                if from == a {
                    push(&mut laid.pieces, ([a, to], row))?;
                    a = to;
                } else {
                    push(&mut back, ([to, b], row))?;
                    b = to;
                }
            }
            for piece in back.into_iter().rev() {
                push(&mut laid.pieces, piece)?;
            }
            if waiting.len() > few {
                return Ok(None);
            }
        }
        Ok(Some((laid, waiting)))
    }

    /// The error that names all pairs that cross.
    fn crossing_error(&self, input: &[Point2], watch: &Watch) -> Result<Error> {
        let Crossings { pairs, points } = self.crossings(input, watch)?;
        Ok(Error::Crossing { pairs, points })
    }

    /// All pairs of segments that cross, but for those that do in a point of the input.
    fn crossings(&self, input: &[Point2], watch: &Watch) -> Result<Crossings> {
        // Many pairs may cross in one point.
        let limit = self.options.max_vertices;
        let most = limit.saturating_mul(PAIRS).saturating_add(MORE_PAIRS);
        let pairs = pairs::crossing_pairs_above(input, self.segments, most, watch)?;
        if pairs.len() > most {
            return Err(Error::Budget {
                what: "pairs of crossing segments",
                limit,
                found: pairs.len(),
                crowd: self.crowd_of(&pairs, input),
            });
        }
        self.meetings(input, pairs, watch)
    }

    /// The segments that cross most others.
    fn crowd_of(&self, pairs: &[[u32; 2]], input: &[Point2]) -> Crowd {
        let rows = pairs.as_flattened().to_vec();
        crowd::crowd(rows, self.segments, |row| input[row as usize], None)
    }

    /// Where `pairs` cross, but for those that do in a point of the input.
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
    fn start_anew(
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
        // Crossings that are no vertex yet come behind the input, without gaps.
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
                crowd: self.crowd_of(&found.pairs, input),
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

    /// Puts pieces in the order of their rows and along them.
    fn sort(&self, pieces: &mut [([u32; 2], u32)], watch: &Watch) -> Result<()> {
        let at = |v: u32| self.marked.at(v);
        order::sort_by(pieces, watch, |(s, i), (t, j)| {
            i.cmp(j).then_with(|| {
                // Along its row a coordinate never turns back; where it stays, the other tells.
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

    /// The vertices behind the `n` points of the input; those that are new get their rows.
    fn added(&mut self, n: usize) -> Vec<Point2> {
        let later = &self.marked.points[self.rows.len()..self.marked.count];
        let added = [&self.met[..], later].concat();
        let first = (n + self.met.len()) as u32;
        self.rows.extend((first..).take(later.len()));
        added
    }

    /// Everything in rows of the input, of `n` points.
    fn finish(
        mut self,
        n: usize,
        laid: Laid,
        mut clock: Clock,
        watch: &Watch,
    ) -> Result<Constrained> {
        let workers = self.options.workers;
        let mut pieces = laid.pieces;
        if !laid.sorted {
            self.sort(&mut pieces, watch)?;
        }
        let added = self.added(n);
        let rows = self.rows;
        let row_of = |v: u32| rows[v as usize];
        let ghost = self.marked.close(watch)?;
        let (arrays, constrained) =
            export::marked_arrays(self.marked.mesh, ghost, &rows, workers, watch)?;
        let mut through = laid.through;
        through.iter_mut().for_each(|t| t[1] = row_of(t[1]));
        through.retain(|t| (t[1] as usize) < n);
        order::sort(&mut through, watch)?;
        through.dedup();
        let mut crossings = laid.crossings;
        crossings.iter_mut().for_each(|c| c[2] = row_of(c[2]));
        order::sort(&mut crossings, watch)?;
        crossings.dedup();
        pieces.iter_mut().for_each(|p| p.0 = p.0.map(row_of));
        let zero = (0u32..).zip(&self.ends).filter(|(_, e)| e[0] == e[1]);
        let zero = zero.map(|(row, _)| row).collect();
        let subsegments = Subsegments::of(&pieces, laid.repeated, watch)?;
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

/// Segments that cross, and where, rounded.
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
