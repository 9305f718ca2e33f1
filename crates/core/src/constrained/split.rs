//! Splits crossing segments: each crossing becomes a vertex.
//!
//! A crossing is computed from the two given segments and rounded once; the crossings are vertices
//! before the first segment is inserted. The points that round to a vertex are its *pixel*. As in
//! snap rounding (J. D. Hobby, "Practical segment intersection with finite precision output",
//! Computational Geometry 13, 1999) a segment that crosses others passes through its crossings and
//! through every vertex whose pixel it meets, in the order in which it meets them. A segment that
//! crosses no other stays straight, except that it passes through crossings of others whose pixel
//! it meets: next to such a point, less than a unit in the last place away, it would leave a sliver
//! that no input asked for. Points of the input that are not exactly on it stay beside it. On a
//! grid with pixels of one size nothing would cross any longer. Doubles are denser toward zero, so
//! two pieces may still cross. Then, as in iterated snap rounding (D. Halperin and E. Packer,
//! Computational Geometry 23, 2002), one is rerouted through an end of the other whose pixel it
//! meets, or both are split where they cross, until no pieces cross.
//!
//! # Guarantees
//!
//! The result is planar at every step, however coordinates round: a piece is an edge or it is
//! queued. And the process terminates: where two pieces cross, the point, rounded to the nearest
//! doubles, lies in the box of each, since the corners of a box are doubles, and so does an end of
//! one whose pixel the other meets. It is not both ends of a piece, so each piece that is split has
//! parts with strictly smaller boxes, of finitely many doubles. Each piece stays in the box of its
//! segment, and within a few units in the last place of it. A limit on vertices stops an input that
//! needs too many.

use std::cmp::Ordering;
use std::collections::HashMap;

use delone_predicates::{Point2, lexicographic, orient2d};

use super::densest::densest_segments;
use super::inserted::Inserted;
use super::intersection::intersection;
use super::marked::Marked;
use super::near::{Seen, passes};
use super::segment::{Cavity, Met, Step};
use crate::base::error::{Error, Result};
use crate::base::watch::{Pace, Watch};
use crate::mesh::plane::{next, prev};
use crate::order;

/// Pieces, or changes of what covers them, between two checks for interruption.
const WATCH_EVERY: usize = 1 << 10;
/// Crossed triangles that take as long as a piece.
const TRIANGLES: usize = 8;

/// A segment's index in the order, doubled, plus one if the piece runs against it.
type Cover = u32;

/// A piece that is queued for insertion.
struct Job {
    ends: [u32; 2],
    covers: Vec<Cover>,
}

/// The loop of splits.
pub struct Splitter<'a> {
    pub(super) marked: &'a mut Marked,
    /// The segments as pairs of vertices, by row.
    given: &'a [[u32; 2]],
    /// Those with a positive length and their rows, in an order that depends on their coordinates.
    segments: Vec<([u32; 2], u32)>,
    /// Vertices of the input.
    own: usize,
    limit: usize,
    cavity: Cavity,
    jobs: Vec<Job>,
    /// What covers each marked edge, directed from its smaller vertex.
    pieces: HashMap<[u32; 2], Vec<Cover>>,
    through: Vec<[u32; 2]>,
    crossings: Vec<[u32; 3]>,
    pub(super) pace: Pace<'a>,
}

fn reversed(covers: &[Cover]) -> Vec<Cover> {
    covers.iter().map(|c| c ^ 1).collect()
}

impl<'a> Splitter<'a> {
    /// For the segments `given`, none of which is in `marked` yet; at most `limit` vertices may be
    /// added.
    pub fn new(
        marked: &'a mut Marked,
        given: &'a [[u32; 2]],
        limit: usize,
        watch: &'a Watch<'a>,
    ) -> Result<Self> {
        Ok(Self {
            own: marked.count,
            segments: in_order(marked, given, watch)?,
            marked,
            given,
            limit,
            cavity: Cavity::default(),
            jobs: Vec::new(),
            pieces: HashMap::with_capacity(given.len()),
            through: Vec::new(),
            crossings: Vec::new(),
            pace: Pace::new(watch, WATCH_EVERY),
        })
    }

    /// Takes over segments that were inserted without a split.
    pub fn adopt(&mut self, inserted: Inserted) -> Result<()> {
        let mut place = vec![0; self.given.len()];
        for (i, (_, row)) in (0..).zip(&self.segments) {
            place[*row as usize] = i;
        }
        for (ends, row) in inserted.pieces {
            let i = place[row as usize];
            let against = self.segments[i as usize].0 != self.given[row as usize];
            self.add(ends, &[2 * i + Cover::from(against)])?;
        }
        self.through = inserted.through;
        self.crossings = inserted.crossings;
        Ok(())
    }

    /// Inserts all segments. Those in `pairs` cross at the vertices `meets`. `is_rounded` tells
    /// which vertices are not points of the input.
    pub fn run(
        &mut self,
        pairs: &[[u32; 2]],
        meets: &[u32],
        is_rounded: impl Fn(u32) -> bool,
    ) -> Result<()> {
        let mut own: Vec<[u32; 2]> = Vec::with_capacity(2 * pairs.len());
        for (&[s, t], &w) in pairs.iter().zip(meets) {
            own.extend([[s, w], [t, w]]);
            self.crossings.push([s, t, w]);
        }
        order::sort(&mut own, self.pace.watch())?;
        let mut seen = Seen::default();
        for i in 0..self.segments.len() {
            self.pace.spend(1)?;
            let ([a, b], row) = self.segments[i];
            let first = own.partition_point(|o| o[0] < row);
            let meets = own[first..].iter().take_while(|o| o[0] == row);
            let meets = meets.map(|o| o[1]).collect();
            let stops = route(
                self.marked,
                [a, b],
                row,
                meets,
                &is_rounded,
                &mut self.through,
                &mut seen,
            )?;
            self.pace.spend(seen.visited / TRIANGLES)?;
            for pair in stops.windows(2).rev() {
                self.enqueue([pair[0], pair[1]], &[2 * i as Cover])?;
            }
            self.insert_queued()?;
        }
        Ok(())
    }

    /// Inserts the queued pieces.
    pub(super) fn insert_queued(&mut self) -> Result<()> {
        while let Some(job) = self.jobs.pop() {
            self.pace.spend(1)?;
            self.insert_job(job)?;
            self.pace.spend(self.cavity.size() / TRIANGLES)?;
        }
        Ok(())
    }

    /// The result of the insertion.
    pub fn finish(mut self) -> Result<Inserted> {
        Ok(Inserted {
            pieces: self.all_pieces()?,
            repeated: true,
            sorted: false,
            through: self.through,
            crossings: self.crossings,
        })
    }

    fn insert_job(&mut self, job: Job) -> Result<()> {
        let [a, b] = job.ends;
        match self.marked.join(a, b, &mut self.cavity)? {
            Step::Crossed(_) => self.resolve(job),
            Step::Joined { from, to, .. } => {
                let far = a ^ b ^ from;
                if to != far {
                    let ends = if from == a { [to, b] } else { [a, to] };
                    self.jobs.push(Job {
                        ends,
                        covers: job.covers.clone(),
                    });
                }
                let ends = if from == a { [a, to] } else { [to, b] };
                self.add(ends, &job.covers)
            }
        }
    }

    /// Splits a queued piece, which a marked edge blocks: at the vertices exactly on it, or at the
    /// first such edge. Which one that is does not depend on the end from which it was inserted,
    /// which is chosen by degree.
    fn resolve(&mut self, job: Job) -> Result<()> {
        let [a, b] = job.ends;
        let (mut stops, mut first) = (Vec::new(), None);
        self.marked.trace(a, b, |mesh, met| match met {
            Met::Vertex(v) => stops.push(v),
            Met::Across(e) if mesh.is_marked(e) => first = first.or(Some(e)),
            _ => {}
        })?;
        if stops.is_empty() {
            let none = || Error::Internal(format!("nothing blocks the piece {a} {b}"));
            return self.repair(first.ok_or_else(none)?, job);
        }
        stops.insert(0, a);
        stops.push(b);
        for ends in stops.windows(2).rev() {
            self.enqueue([ends[0], ends[1]], &job.covers)?;
        }
        Ok(())
    }

    fn add(&mut self, [u, v]: [u32; 2], covers: &[Cover]) -> Result<()> {
        self.pace.spend(1)?;
        let (key, covers) = if u < v {
            ([u, v], covers.to_vec())
        } else {
            ([v, u], reversed(covers))
        };
        let all = self.pieces.entry(key).or_default();
        all.extend(covers);
        all.sort_unstable();
        all.dedup();
        Ok(())
    }

    /// Whether an edge is a piece of a segment.
    pub(super) fn is_piece(&self, [u, v]: [u32; 2]) -> bool {
        self.pieces.contains_key(&[u.min(v), u.max(v)])
    }

    /// Removes a piece and returns what covers it from `u` to `v`.
    fn take(&mut self, [u, v]: [u32; 2]) -> Result<Vec<Cover>> {
        let covers = self.pieces.remove(&[u.min(v), u.max(v)]);
        let covers = covers.ok_or_else(|| Error::Internal(format!("no piece joins {u} {v}")))?;
        Ok(if u < v { covers } else { reversed(&covers) })
    }

    /// Splits a queued piece and the marked edge `e` that blocks it: at an end of one whose pixel
    /// the other meets, or else where they cross.
    fn repair(&mut self, e: u32, job: Job) -> Result<()> {
        let mesh = self.marked.patch();
        let (u, v) = (mesh.vertex(next(e)), mesh.vertex(prev(e)));
        let [a, b] = job.ends;
        let [p, q, r, s] = [a, b, u, v].map(|v| self.marked.at(v));
        let ends = [(r, s, p), (r, s, q), (p, q, r), (p, q, s)];
        let passed = ends.into_iter().filter(|&(r, s, p)| passes(r, s, p));
        let x = passed.map(|e| e.2).min_by(|p, q| lexicographic(*p, *q));
        let x = x.unwrap_or_else(|| intersection(p, q, r, s));
        let w = self.split_piece([u, v], x, e)?;
        for ends in [[w, b], [a, w]] {
            self.enqueue(ends, &job.covers)?;
        }
        Ok(())
    }

    /// Splits the piece u v, which is the edge `e`, at the point `x`. Returns the vertex there: u
    /// or v themselves if x is one of them.
    pub(super) fn split_piece(&mut self, [u, v]: [u32; 2], x: Point2, e: u32) -> Result<u32> {
        let (w, parted) = self.marked.vertex_at(x, e)?;
        let found = self.marked.count - self.own;
        if found > self.limit {
            let rows = self
                .all_pieces()?
                .into_iter()
                .map(|piece| piece.1)
                .collect();
            let at = |v| self.marked.at(v);
            return Err(Error::Budget {
                what: "added vertices",
                limit: self.limit,
                found,
                densest: densest_segments(rows, self.given, at, Some(x)),
            });
        }
        if let Some([p, q]) = parted {
            let covers = self.take([p, q])?;
            self.add([p, w], &covers)?;
            self.add([w, q], &covers)?;
        }
        let same = parted.is_some_and(|other| other == [u, v] || other == [v, u]);
        if w != u && w != v && !same {
            let covers = self.take([u, v])?;
            self.unmark(u, v)?;
            for ends in [[w, v], [u, w]] {
                self.enqueue(ends, &covers)?;
            }
        }
        Ok(w)
    }

    fn enqueue(&mut self, ends: [u32; 2], covers: &[Cover]) -> Result<()> {
        self.pace.spend(1)?;
        if ends[0] != ends[1] {
            self.jobs.push(Job {
                ends,
                covers: covers.to_vec(),
            });
        }
        Ok(())
    }

    /// Makes the edge u v unconstrained again.
    fn unmark(&mut self, u: u32, v: u32) -> Result<()> {
        let e = self.marked.edge(u, v)?;
        self.marked.patch().mark(e, false);
        self.marked.stack.push(e);
        self.marked.legalize()
    }

    /// All pieces, directed as their rows are, in no particular order.
    fn all_pieces(&mut self) -> Result<Vec<([u32; 2], u32)>> {
        let mut all = Vec::new();
        // Drained one by one, since freeing them all at once would take long without a check.
        for ([u, v], covers) in self.pieces.drain() {
            self.pace.spend(1)?;
            for cover in covers {
                let (ends, row) = self.segments[cover as usize / 2];
                let with = (cover % 2 == 0) == (ends == self.given[row as usize]);
                all.push((if with { [u, v] } else { [v, u] }, row));
            }
        }
        Ok(all)
    }
}

/// The vertices that a segment passes through, in order, its ends included: where it meets others,
/// the vertices exactly on it, which go to `through` with its row, and those whose pixel it meets,
/// points of the input only if it meets another segment.
pub(super) fn route(
    marked: &mut Marked,
    [a, b]: [u32; 2],
    row: u32,
    meets: Vec<u32>,
    is_rounded: impl Fn(u32) -> bool,
    through: &mut Vec<[u32; 2]>,
    seen: &mut Seen,
) -> Result<Vec<u32>> {
    let [p, q] = [a, b].map(|v| marked.at(v));
    let snaps = !meets.is_empty();
    let mut stops = marked.stops([a, b], &meets, |w| snaps || is_rounded(w), seen)?;
    stops.extend(meets.into_iter().filter(|&w| w != a && w != b));
    for &w in &stops {
        if orient2d(p, q, marked.at(w)).is_zero() {
            through.push([row, w]);
        }
    }
    stops.extend([a, b]);
    stops.sort_by(|&v, &w| in_direction([p, q], marked.at(v), marked.at(w)));
    stops.dedup();
    Ok(stops)
}

/// The order of two rounded points of the segment from p to q. They are monotone in both coordinates,
/// though perhaps not strictly: the first decides, or the second where the first is constant.
pub(crate) fn in_direction([p, q]: [Point2; 2], v: Point2, w: Point2) -> Ordering {
    let along = |k: usize| {
        let (v, w) = if p[k] <= q[k] { (v, w) } else { (w, v) };
        v[k].partial_cmp(&w[k]).unwrap_or(Ordering::Equal)
    };
    along(0).then_with(|| along(1))
}

/// The segments of positive length, each from its lexicographically smaller end, sorted by their
/// ends.
fn in_order(marked: &Marked, segments: &[[u32; 2]], watch: &Watch) -> Result<Vec<([u32; 2], u32)>> {
    let at = |v: u32| marked.at(v);
    let real = (0u32..).zip(segments).filter(|(_, s)| s[0] != s[1]);
    let directed = |(row, &[a, b]): (u32, &[u32; 2])| match lexicographic(at(a), at(b)).is_lt() {
        true => ([a, b], row),
        false => ([b, a], row),
    };
    let mut order: Vec<_> = real.map(directed).collect();
    order::sort_by(&mut order, watch, |(s, i), (t, j)| {
        let by = |k: usize| lexicographic(at(s[k]), at(t[k]));
        by(0).then_with(|| by(1)).then(i.cmp(j))
    })?;
    Ok(order)
}
