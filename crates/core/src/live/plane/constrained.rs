//! Edits of a triangulation with segments: points and segments are added, removed and moved.
//!
//! # Why every order of edits ends in the same triangles
//!
//! A set of points and segments that cross only at vertices has one constrained triangulation: the one
//! in which no edge but a marked one must be flipped (see `constrained`). Each edit ends in it:
//!
//! - *A point* empties its cavity as without segments, but not past marked edges. A point on a
//!   marked edge splits it: both parts are marked.
//! - *A vertex* is removed if no segment ends at it. If segments run straight through it, the two
//!   marked edges there become one. The hole is filled with any triangles, and flips do the rest
//!   (see `ears`).
//! - *A segment* becomes a chain of edges from vertex to vertex: edges that cross it are flipped until
//!   none does, and flips do the rest. When it is removed, edges that no other segment runs along
//!   are unmarked, and flips do the rest.
//!
//! # Crossings
//!
//! A crossing is rounded, so segments bend there, and may then meet others. Such segments are
//! *crossed*. Edits that touch none of them work as above. An edit of one, or one that makes a new
//! crossing, takes out all that cross it, directly or not, with their crossings (see `detach`), and
//! puts them back where they cross now (see `reinsert`). So a crossing vertex is removed with the
//! segments that cross there.
//!
//! Where rounding makes more than the segments themselves meet, all points and segments are
//! triangulated again by `constrained`: a point in the range of rounding of a crossed segment, or a
//! crossing in that of a segment to which it does not belong.
//!
//! # All or nothing
//!
//! What an edit replaces is recorded, and an error puts it back (see `atomic`). So each step of an edit
//! makes room in that record before it changes anything.

use std::ops::Range;

use delone_predicates::{Point2, lexicographic, orient2d};

use super::Plane;
use super::marks::{CROSSED, Reach, STRAIGHT};
use super::segments::Detached;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::passes;
use crate::live::kernel::Constraints;
use crate::live::store::Place;
use crate::live::store::Removed;
use crate::mesh::plane::half_edges;
use crate::order::{order_of, sort};

/// Edits between two checks for interruption.
const LOT: usize = 1 << 6;

/// How an edit that has not failed ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is done.
    Done,
    /// All is triangulated again.
    Rebuild,
}

/// Continues if the edit is done.
macro_rules! done {
    ($outcome:expr) => {
        if $outcome == Outcome::Rebuild {
            return Ok(Outcome::Rebuild);
        }
    };
}

/// What an edit leaves: rows, ascending, with their points, and how many rows were ever inserted.
pub struct Input {
    /// The points.
    pub points: Vec<Point2>,
    /// Their rows, ascending.
    pub rows: Vec<u32>,
    /// The number of the next row.
    pub total: usize,
}

impl Plane {
    /// Whether there are segments.
    pub fn has_segments(&self) -> bool {
        self.segments.live() > 0
    }

    /// Chooses whether crossings are split.
    pub fn split_crossings(&mut self, split: bool) {
        self.segments.split = split;
    }

    /// Whether crossings are split.
    pub fn splits_crossings(&self) -> bool {
        self.segments.split
    }

    /// Inserts segments between rows and returns their numbers. On any error nothing has changed.
    pub fn insert_segments(
        &mut self,
        ends: &[[i64; 2]],
        workers: usize,
        watch: &Watch,
    ) -> Result<Range<usize>> {
        for &row in ends.as_flattened() {
            self.require_point(row)?;
        }
        let first = self.segments.total();
        self.atomically(|plane| {
            let mut pace = Pace::new(watch, LOT);
            let mut detached = Detached::default();
            for pair in ends {
                pace.spend(1)?;
                let segment = plane.segments.insert(pair.map(|row| row as u32))?;
                plane.mesh.has_segments = true;
                if !plane.link_segment(segment)? {
                    detached.segments.insert(segment);
                }
            }
            plane.finish(Outcome::Done, detached, None, workers, watch)
        })?;
        Ok(first..first + ends.len())
    }

    /// Removes segments, each named once. On any error nothing has changed.
    pub fn remove_segments(
        &mut self,
        numbers: &[i64],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        self.atomically(|plane| {
            let mut pace = Pace::new(watch, LOT);
            let mut outcome = Outcome::Done;
            let mut detached = Detached::default();
            for &number in numbers {
                pace.spend(1)?;
                if plane.segments.ends(number).is_none() {
                    let message = format!("segment {number} is not there");
                    return Err(Error::Shape(message));
                }
                outcome = plane.take_segment(number as u32, outcome, &mut detached)?;
            }
            plane.finish(outcome, detached, None, workers, watch)
        })
    }

    /// Inserts segments with known numbers, ascending, where there have been `total` ever, into a
    /// triangulation without any; crossings at known places get their rows again.
    pub fn adopt_segments(
        &mut self,
        known: &[(u32, [u32; 2])],
        total: usize,
        places: &[(u32, Point2)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        for &row in known.iter().flat_map(|(_, ends)| ends) {
            self.require_point(i64::from(row))?;
        }
        let mut old = with_room(places.len())?;
        old.extend(places.iter().map(|&(row, p)| (p, row)));
        crate::order::sort_by(&mut old, watch, |a, b| lexicographic(a.0, b.0))?;
        self.atomically(|plane| {
            plane.segments.insert_known(known, total)?;
            let input = plane.present(|_, p| Some(p))?;
            plane.rebuild_all(input, &old, workers, watch)
        })
    }

    /// Inserts points among segments.
    pub(super) fn insert_among(
        &mut self,
        input: &[Point2],
        whole: bool,
        workers: usize,
        watch: &Watch,
    ) -> Result<Range<usize>> {
        let first = self.rows.total();
        self.atomically(|plane| {
            let mut targets = filled(input.len(), 0u32)?;
            let mut outcome = if whole {
                Outcome::Rebuild
            } else {
                Outcome::Done
            };
            let mut pace = Pace::new(watch, LOT);
            for i in order_of(input, 1, watch)?.into_iter().flatten() {
                if outcome == Outcome::Rebuild {
                    break;
                }
                pace.spend(1)?;
                let p = input[i as usize].map(|x| x + 0.0);
                match plane.add_vertex(p, watch)? {
                    Some(v) => targets[i as usize] = v,
                    None => outcome = Outcome::Rebuild,
                }
            }
            if outcome == Outcome::Done {
                return plane.attach_all(&targets);
            }
            let mut after = plane.present(|_, p| Some(p))?;
            for (row, p) in (after.total..).zip(input) {
                push(&mut after.rows, row as u32)?;
                push(&mut after.points, *p)?;
            }
            after.total += input.len();
            plane.finish(outcome, Detached::default(), Some(after), workers, watch)
        })?;
        Ok(first..first + input.len())
    }

    /// Removes rows, each of which is present and named once, with their vertices, and on request
    /// with the segments that end there, whose numbers are returned, ascending.
    pub(super) fn remove_among(
        &mut self,
        pairs: &[(u32, u32)],
        also_segments: bool,
        whole: bool,
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<i64>> {
        let mut numbers = Vec::new();
        for &(_, row) in pairs {
            self.require_point(i64::from(row))?;
            for (segment, _) in self.segments.at(row) {
                if !also_segments {
                    let message = format!("row {row} is an end of segment {segment}");
                    return Err(Error::Shape(message));
                }
                push(&mut numbers, i64::from(segment))?;
            }
        }
        sort(&mut numbers, watch)?;
        numbers.dedup();
        self.atomically(|plane| {
            let mut pace = Pace::new(watch, LOT);
            let mut outcome = if whole {
                Outcome::Rebuild
            } else {
                Outcome::Done
            };
            let mut detached = Detached::default();
            // The segments first: a vertex is removed only if no segment ends there.
            for &number in &numbers {
                pace.spend(1)?;
                outcome = plane.take_segment(number as u32, outcome, &mut detached)?;
            }
            // Then the points: a vertex leaves the mesh with its last row.
            for &(v, row) in pairs {
                if outcome == Outcome::Rebuild {
                    break;
                }
                pace.spend(1)?;
                plane.room()?;
                if plane.rows.is_single(row) {
                    outcome = plane.drop_vertex(v)?;
                    if outcome == Outcome::Done {
                        plane.detach(row, v);
                        plane.mesh.free_site(v);
                    }
                } else {
                    plane.detach(row, v);
                }
            }
            // Segments that crossed these go back last, when everything to be removed is out of the
            // way.
            if outcome == Outcome::Done {
                return plane.finish(outcome, detached, None, workers, watch);
            }
            // Otherwise what remains is triangulated again.
            let mut gone = with_room(pairs.len())?;
            gone.extend(pairs.iter().map(|pair| pair.1));
            sort(&mut gone, watch)?;
            let kept = |row: u32, p| gone.binary_search(&row).is_err().then_some(p);
            let after = plane.present(kept)?;
            plane.finish(outcome, detached, Some(after), workers, watch)
        })?;
        Ok(numbers)
    }

    /// Takes a present segment out of the mesh, if that still matters, and out of the list.
    fn take_segment(
        &mut self,
        segment: u32,
        so_far: Outcome,
        detached: &mut Detached,
    ) -> Result<Outcome> {
        self.room()?;
        let outcome = match so_far {
            Outcome::Done => self.unlink_segment(segment, detached)?,
            Outcome::Rebuild => Outcome::Rebuild,
        };
        detached.segments.remove(&segment);
        self.segments.remove(segment);
        Ok(outcome)
    }

    /// Moves rows: `moves` has the vertex, the row and the new point of each.
    pub(super) fn relocate_among(
        &mut self,
        moves: &[(u32, u32, Point2)],
        whole: bool,
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        for &(_, row, _) in moves {
            self.require_point(i64::from(row))?;
        }
        self.atomically(|plane| {
            let mut places: Vec<(u32, Point2)> = with_room(moves.len())?;
            places.extend(moves.iter().map(|&(_, row, p)| (row, p)));
            crate::order::sort_by(&mut places, watch, |a, b| a.0.cmp(&b.0))?;
            let mut pace = Pace::new(watch, LOT);
            // All segments that move are removed first: halfway they may cross others.
            let mut moved = Vec::new();
            for &(row, _) in &places {
                for (segment, _) in plane.segments.at(row) {
                    push(&mut moved, segment)?;
                }
            }
            sort(&mut moved, watch)?;
            moved.dedup();
            let mut outcome = if whole {
                Outcome::Rebuild
            } else {
                Outcome::Done
            };
            let mut detached = Detached::default();
            for &segment in &moved {
                pace.spend(1)?;
                plane.room()?;
                if outcome == Outcome::Done {
                    outcome = plane.unlink_segment(segment, &mut detached)?;
                }
                plane.segments.unlist(segment);
            }
            // Then the points move, one after the other.
            for &(_, row, p) in moves {
                pace.spend(1)?;
                plane.room()?;
                if outcome == Outcome::Done {
                    outcome = plane.relocate_vertex(row, p, watch)?;
                }
            }
            // Segments go back at their new ends; those that something blocks wait for the others.
            for &segment in &moved {
                pace.spend(1)?;
                plane.room()?;
                plane.segments.list(segment);
                if outcome == Outcome::Done
                    && (detached.segments.contains(&segment) || !plane.link_segment(segment)?)
                {
                    detached.segments.insert(segment);
                }
            }
            if outcome == Outcome::Done && !detached.segments.is_empty() {
                outcome = plane.reinsert_segments(&mut detached, watch)?;
            }
            if outcome == Outcome::Done {
                return Ok(());
            }
            // Otherwise all is triangulated again, with the rows at their new places.
            let place = |row: u32, p| match places.binary_search_by_key(&row, |at| at.0) {
                Ok(i) => Some(places[i].1),
                Err(_) => Some(p),
            };
            let after = plane.present(place)?;
            plane.finish(outcome, detached, Some(after), workers, watch)
        })
    }

    /// Checks that a row is present, and is not a crossing.
    fn require_point(&self, row: i64) -> Result<()> {
        if self.rows.vertex(row).is_none() {
            return Err(Error::Shape(format!("row {row} is not there")));
        }
        if self.is_crossing(row as u32) {
            return Err(Error::Shape(format!("row {row} is a crossing of segments")));
        }
        Ok(())
    }

    /// The numbers of the segments, ascending, and their rows.
    pub fn segments(&self) -> Result<(Vec<i64>, Vec<[i64; 2]>)> {
        self.segments.listed()
    }

    /// The number of the next segment.
    pub fn segments_total(&self) -> usize {
        self.segments.total()
    }

    /// Two segments and the row of the vertex where they cross, for each crossing, ascending. If
    /// there are several rows at the vertex, this is the smallest, so it changes when that row is
    /// removed.
    pub fn crossings(&self) -> Result<Vec<[u32; 3]>> {
        let known = &self.segments.crossed.crossings;
        let mut crossings = with_room(known.len())?;
        crossings.extend(
            known
                .iter()
                .map(|&[s, t, v]| [s, t, self.mesh.sites[v as usize].head]),
        );
        crossings.sort_unstable();
        Ok(crossings)
    }

    /// The rows of vertices that only crossings need, ascending.
    pub fn crossing_rows(&self) -> &[u32] {
        &self.segments.crossed.rows
    }

    /// The segments that end at a row.
    pub fn segments_at(&self, row: u32) -> impl Iterator<Item = u32> + '_ {
        self.segments.at(row).map(|(segment, _)| segment)
    }

    /// Whether a segment is present.
    pub fn has_segment(&self, number: i64) -> bool {
        self.segments.ends(number).is_some()
    }

    /// Whether a row is a vertex that only crossings need.
    pub fn is_crossing(&self, row: u32) -> bool {
        self.segments.crossed.rows.binary_search(&row).is_ok()
    }

    /// The vertex of a present row.
    pub fn vertex(&self, row: u32) -> u32 {
        self.rows.vertex(i64::from(row)).unwrap_or_default()
    }

    /// Inserts a vertex at `p`, or finds it; `None` if all must be triangulated again.
    fn add_vertex(&mut self, p: Point2, watch: &Watch) -> Result<Option<u32>> {
        if self.mesh.is_flat() || self.is_near_crossing(p) {
            return Ok(None);
        }
        let t = match self.mesh.place(p, watch)? {
            Place::At(v) => return Ok(Some(v)),
            Place::In(t) => t,
        };
        let on = half_edges(t).find(|&e| {
            let [u, v] = self.mesh.ends(e);
            self.mesh.mark(e) != 0 && orient2d(self.mesh.at(u), self.mesh.at(v), p).is_zero()
        });
        let Some(e) = on else {
            return self.create(p, t, &mut Pace::new(watch, LOT)).map(Some);
        };
        if self.mesh.mark(e) == CROSSED {
            return Ok(None);
        }
        let [u, w] = self.mesh.ends(e);
        self.mesh.set_mark(e, 0);
        let v = self.create(p, t, &mut Pace::new(watch, LOT))?;
        self.mesh.add_mark(u, v, STRAIGHT)?;
        self.mesh.add_mark(v, w, STRAIGHT)?;
        Ok(Some(v))
    }

    /// Whether the rounding of a crossed segment reaches `p`.
    pub fn is_near_crossing(&self, p: Point2) -> bool {
        let at = |row: u32| self.mesh.at(self.vertex(row));
        let crossed = self.segments.crossed.segments.iter();
        let ends = crossed.filter_map(|&s| self.segments.ends(i64::from(s)));
        ends.map(|ends| ends.map(at))
            .any(|[r, s]| passes(r, s, p) || p == r || p == s)
    }

    /// Removes a vertex at which no segment ends from the mesh; its site stays.
    fn drop_vertex(&mut self, v: u32) -> Result<Outcome> {
        if self.mesh.is_flat() {
            return Ok(Outcome::Rebuild);
        }
        let marked = self.mesh.marked_at(v)?;
        let joined = match marked[..] {
            [] => None,
            [(u, STRAIGHT), (w, STRAIGHT)] => Some((u, w)),
            _ => return Ok(Outcome::Rebuild),
        };
        if let Some((u, w)) = joined {
            self.mesh.remove_mark(u, v)?;
            self.mesh.remove_mark(v, w)?;
        }
        if self.mesh.unlink(v, false)? != Removed::Done {
            return Ok(Outcome::Rebuild);
        }
        match joined {
            Some((u, w)) => self.link_vertices(u, w),
            None => Ok(Outcome::Done),
        }
    }

    /// Moves a row whose segments are unlinked.
    fn relocate_vertex(&mut self, row: u32, p: Point2, watch: &Watch) -> Result<Outcome> {
        let v = self.vertex(row);
        if self.mesh.is_flat() || self.is_near_crossing(p) {
            return Ok(Outcome::Rebuild);
        }
        if self.mesh.at(v) == p {
            return Ok(Outcome::Done);
        }
        if self.rows.is_single(row) {
            if self.mesh.marked_at(v)?.is_empty() && self.mesh.shift(v, p)? {
                return Ok(Outcome::Done);
            }
            done!(self.drop_vertex(v)?);
            self.detach(row, v);
            self.mesh.free_site(v);
        } else {
            self.detach(row, v);
        }
        match self.add_vertex(p, watch)? {
            Some(target) => {
                self.attach(row, target);
                Ok(Outcome::Done)
            }
            None => Ok(Outcome::Rebuild),
        }
    }

    /// Marks the edges of a segment that is in the list; `false` if another one is in the way.
    pub fn link_segment(&mut self, segment: u32) -> Result<bool> {
        let ends = self.segments.ends(i64::from(segment)).unwrap_or_default();
        let [a, b] = ends.map(|row| self.vertex(row));
        if a == b || self.mesh.is_flat() {
            return Ok(true);
        }
        if !self.touched(a, b).is_empty() || self.mesh.blocker(a, b)?.is_some() {
            return Ok(false);
        }
        Ok(self.link_vertices(a, b)? == Outcome::Done)
    }

    /// Makes the segment between two vertices a chain of marked edges.
    pub fn link_vertices(&mut self, mut a: u32, b: u32) -> Result<Outcome> {
        while a != b {
            match self.mesh.reach(a, b)? {
                Reach::Vertex(next) => a = next,
                Reach::Blocked => return Ok(Outcome::Rebuild),
            }
        }
        Ok(Outcome::Done)
    }

    /// The present rows, without crossings, with the points that `place` gives them.
    pub fn present(&self, place: impl Fn(u32, Point2) -> Option<Point2>) -> Result<Input> {
        let mut input = Input {
            points: with_room(self.len())?,
            rows: with_room(self.len())?,
            total: self.rows.total(),
        };
        for (row, v) in self.rows.iter().filter(|&(row, _)| !self.is_crossing(row)) {
            if let Some(p) = place(row, self.mesh.at(v)) {
                input.rows.push(row);
                input.points.push(p);
            }
        }
        Ok(input)
    }
}

/// Whether p and q are strictly on different sides of the line through r and s.
pub fn are_apart(r: Point2, s: Point2, p: Point2, q: Point2) -> bool {
    let [one, other] = [orient2d(r, s, p), orient2d(r, s, q)];
    one != other && !one.is_zero() && !other.is_zero()
}
