//! Retriangulates all points and segments if segments cross.
//!
//! Crossings are rounded, and what that leads to is decided by `constrained` (see its `split`).
//! Here its pieces become marked edges, its added vertices get rows, and the segments that are no
//! longer straight are listed.

use std::sync::Arc;

use delone_predicates::{Point2, lexicographic, orient2d};

use super::constrained::{Input, Outcome};
use super::marks::{CROSSED, Reach};
use super::segments::{Crossed, Detached};
use super::{Plane, build};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::{Constrained, Options, constrain};
use crate::delaunay::plane::Method;
use crate::order::{sort, sort_by};

/// The most vertices that crossings may add.
const MOST_CROSSINGS: usize = 4_000_000;

/// Segments, or pieces of them, between two checks for interruption.
const LOT: usize = 1 << 6;

impl Plane {
    /// Ends an edit, if necessary by a triangulation of all points and segments.
    pub fn finish(
        &mut self,
        mut outcome: Outcome,
        mut detached: Detached,
        after: Option<Input>,
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        if outcome == Outcome::Done && !detached.segments.is_empty() {
            outcome = self.reinsert_segments(&mut detached, watch)?;
        }
        if outcome == Outcome::Rebuild {
            let input = match after {
                Some(input) => input,
                None => self.present(|_, p| Some(p))?,
            };
            let old = self.crossings_by_place(detached.places, watch)?;
            self.rebuild_all(input, &old, workers, watch)?;
        }
        self.mesh.has_segments = self.has_segments();
        Ok(())
    }

    /// Triangulates points, and inserts all segments. Crossings that stay in place keep their rows.
    pub fn rebuild_all(
        &mut self,
        input: Input,
        old: &[(Point2, u32)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        self.replace(&input, workers, watch)?;
        self.segments.crossed = Arc::default();
        let mut pace = Pace::new(watch, LOT);
        let mut all = with_room(self.segments.live())?;
        all.extend(self.segments.iter());
        for &(segment, _) in &all {
            pace.spend(1)?;
            if !self.link_segment(segment)? {
                return self.untangle(input, &all, old, workers, watch);
            }
        }
        Ok(())
    }

    /// Replaces the mesh by that of points without segments.
    fn replace(&mut self, input: &Input, workers: usize, watch: &Watch) -> Result<()> {
        let made = build::built(&input.points, &input.rows, input.total, workers, watch)?;
        self.substitute(made);
        self.mesh.has_segments = self.has_segments();
        Ok(())
    }

    /// The crossings, and the removed ones, by their coordinates.
    fn crossings_by_place(
        &self,
        mut places: Vec<(Point2, u32)>,
        watch: &Watch,
    ) -> Result<Vec<(Point2, u32)>> {
        let rows = &self.segments.crossed.rows;
        make_room(&mut places, rows.len())?;
        places.extend(
            rows.iter()
                .map(|&row| (self.mesh.at(self.vertex(row)), row)),
        );
        sort_by(&mut places, watch, |a, b| lexicographic(a.0, b.0))?;
        Ok(places)
    }

    /// Splits segments where they cross. Crossings keep their rows where they stay in place.
    fn untangle(
        &mut self,
        mut input: Input,
        all: &[(u32, [u32; 2])],
        old: &[(Point2, u32)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let mut place = filled(input.total, 0u32)?;
        for (i, &row) in (0u32..).zip(&input.rows) {
            place[row as usize] = i;
        }
        let mut ends = with_room(all.len())?;
        ends.extend(
            all.iter()
                .map(|(_, rows)| rows.map(|row| place[row as usize])),
        );
        let options = Options {
            split: self.segments.split,
            conforming: false,
            max_vertices: MOST_CROSSINGS,
            method: Method::Auto,
            workers,
        };
        let number = |i: u32| all[i as usize].0;
        let made = match constrain(&input.points, &ends, options, watch) {
            Err(Error::Crossing { mut pairs, points }) => {
                pairs.iter_mut().for_each(|pair| *pair = pair.map(number));
                return Err(Error::Crossing { pairs, points });
            }
            made => made?,
        };
        // The rows of the vertices of `made`: those of the input, then those of crossings.
        let mut rows = with_room(input.rows.len() + made.added.len())?;
        rows.extend_from_slice(&input.rows);
        for &p in &made.added {
            let known = old.binary_search_by(|at| lexicographic(at.0, p));
            let row = match known {
                Ok(i) => old[i].1,
                Err(_) => {
                    input.total += 1;
                    input.total as u32 - 1
                }
            };
            rows.push(row);
        }
        let mut crossed = crossed(&made, &input, &ends)?;
        crossed.segments.iter_mut().for_each(|i| *i = number(*i));
        crossed.rows.extend_from_slice(&rows[input.rows.len()..]);
        sort(&mut crossed.rows, watch)?;
        let mut sorted: Vec<(u32, usize)> = with_room(rows.len())?;
        sorted.extend(rows.iter().copied().zip(0..));
        sort(&mut sorted, watch)?;
        let given = input.points.len();
        let at = |i: usize| match i < given {
            true => input.points[i],
            false => made.added[i - given],
        };
        let with_crossings = Input {
            points: sorted.iter().map(|&(_, i)| at(i)).collect(),
            rows: sorted.iter().map(|&(row, _)| row).collect(),
            total: input.total,
        };
        self.replace(&with_crossings, workers, watch)?;
        for &[s, t, v] in &made.crossings {
            let v = self.vertex(rows[v as usize]);
            push(&mut crossed.crossings, [number(s), number(t), v])?;
        }
        crossed.crossings.sort_unstable();
        self.link_pieces(&made, &rows, &mut crossed, number, watch)?;
        self.segments.crossed = Arc::new(crossed);
        Ok(())
    }

    /// Marks the pieces of segments, which no longer cross.
    fn link_pieces(
        &mut self,
        made: &Constrained,
        rows: &[u32],
        crossed: &mut Crossed,
        number: impl Fn(u32) -> u32,
        watch: &Watch,
    ) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        let pieces = &made.subsegments;
        for (i, ends) in pieces.ends.iter().enumerate() {
            pace.spend(1)?;
            let [a, b] = ends.map(|v| self.vertex(rows[v as usize]));
            if self.mesh.reach(a, b)? != Reach::Vertex(b) {
                return Err(Error::Internal(
                    "a piece of a segment is not an edge".into(),
                ));
            }
            let sources = pieces.start[i] as usize..pieces.start[i + 1] as usize;
            let before = crossed.edges.len();
            for &s in &pieces.source[sources] {
                let segment = number(s as u32);
                if crossed.segments.binary_search(&segment).is_ok() {
                    push(&mut crossed.edges, (segment, [a, b]))?;
                }
            }
            if crossed.edges.len() > before {
                self.mesh.add_mark(a, b, CROSSED)?;
            }
        }
        sort(&mut crossed.edges, watch)
    }
}

/// The segments that cross others, or whose pieces do not run straight through points of the input.
fn crossed(made: &Constrained, input: &Input, ends: &[[u32; 2]]) -> Result<Crossed> {
    let mut is_crossed = filled(ends.len(), false)?;
    for &[s, t, _] in &made.crossings {
        is_crossed[s as usize] = true;
        is_crossed[t as usize] = true;
    }
    let pieces = &made.subsegments;
    for (i, piece) in pieces.ends.iter().enumerate() {
        for &s in &pieces.source[pieces.start[i] as usize..pieces.start[i + 1] as usize] {
            let [a, b] = ends[s as usize].map(|i| input.points[i as usize]);
            let is_straight = piece.iter().all(|&v| {
                let p = input.points.get(v as usize);
                p.is_some_and(|&p| orient2d(a, b, p).is_zero())
            });
            is_crossed[s as usize] |= !is_straight;
        }
    }
    let mut crossed = Crossed::default();
    for (i, _) in (0u32..).zip(is_crossed).filter(|(_, crossed)| *crossed) {
        push(&mut crossed.segments, i)?;
    }
    Ok(crossed)
}
