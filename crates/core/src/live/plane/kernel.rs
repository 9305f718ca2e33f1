//! The operations of a live triangulation that are specific to 2-D.

use std::ops::Range;

use delone_predicates::{Point2, Sign, nearer, orient2d};

use super::mesh::{INFINITE, Mesh};
use super::segments::Segments;
use super::{Plane, build};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::points::LIMIT2;
use crate::base::watch::{Pace, Watch};
use crate::live::kernel::{Built, Kernel, Move};
use crate::live::store::{Place, Removed};
use crate::locate::barycentric_weights;
use crate::mesh::plane::{Code, half_edge, next, triangle};

/// Shares of the vertices among segments, whose rebuild costs more, while an insertion or a removal costs as
/// much. A point that moves far is removed and inserted.
const SHARES_AMONG: [usize; 3] = [1, 3, 2];

/// Records between two checks for interruption.
const LOT: usize = 1 << 16;

impl Kernel<2, 3> for Mesh {
    type Segments = Segments;

    const LIMIT: usize = LIMIT2;
    const RECORDS: usize = 2;
    const SHARES: [usize; 3] = [3, 3, 1];

    fn built(
        points: &[Point2],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Built<Self>> {
        build::built(points, rows, total, workers, watch)
    }

    #[inline]
    fn record_of(code: Code) -> u32 {
        triangle(code)
    }

    fn record_at(near: Code) -> u32 {
        triangle(near)
    }

    /// The smallest row first.
    fn arrange(rows: &mut [i64; 3]) {
        while rows[0] > rows[1] || rows[0] > rows[2] {
            rows.rotate_left(1);
        }
    }

    #[inline]
    fn nearer(q: Point2, a: Point2, b: Point2) -> Sign {
        nearer(q, a, b)
    }

    fn weights([a, b, c]: [Point2; 3], q: Point2) -> [f64; 3] {
        let on = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)].map(Sign::is_zero);
        barycentric_weights([a, b, c], on, q)
    }

    fn spans(&self, line: &[u32], p: Point2) -> bool {
        let [a, .., b] = *line else {
            return false;
        };
        !orient2d(self.at(a), self.at(b), p).is_zero()
    }

    #[inline]
    fn find(&mut self, q: Point2, watch: &Watch) -> Result<u32> {
        self.find(q, watch)
    }

    #[inline]
    fn place(&mut self, q: Point2, watch: &Watch) -> Result<Place> {
        self.place(q, watch)
    }

    fn insert(&mut self, v: u32, seed: u32, _pace: &mut Pace) -> Result<()> {
        self.insert(v, seed)
    }

    fn unlink(&mut self, v: u32, always: bool, _pace: &mut Pace) -> Result<Removed> {
        self.unlink(v, always)
    }

    fn shift(&mut self, v: u32, p: Point2) -> Result<bool> {
        self.shift(v, p)
    }

    fn rename(&mut self, _v: u32) -> Result<()> {
        Ok(())
    }

    fn set_head(&mut self, v: u32, head: u32) {
        self.set_head(v, head);
    }

    fn around(&mut self, v: u32, list: &mut Vec<u32>, pace: &mut Pace) -> Result<()> {
        list.clear();
        let first: Code = self.sites[v as usize].near;
        let mut corner = first;
        loop {
            pace.spend(1)?;
            debug_assert!(self.is_live(triangle(corner)));
            let neighbor = self.vertex(next(corner));
            if neighbor != INFINITE {
                push(list, neighbor)?;
            }
            corner = self.turn(corner);
            if corner == first {
                return Ok(());
            }
        }
    }

    fn check(&self) -> std::result::Result<(), String> {
        self.check()
    }

    fn prepare(&mut self, is_dense: bool) {
        self.strolled = if is_dense { isize::MIN / 2 } else { 0 };
    }

    fn nearest_among(&self, t: u32, q: Point2, pace: &mut Pace) -> Result<Option<i64>> {
        match self.has_segments {
            true => self.nearest_among_segments(t, q, pace).map(Some),
            false => Ok(None),
        }
    }

    fn constrained(&self, watch: &Watch) -> Result<Vec<[bool; 3]>> {
        if !self.has_segments {
            return Ok(Vec::new());
        }
        let mut marked = with_room(self.counts.simplices as usize)?;
        let mut pace = Pace::new(watch, LOT);
        for t in 0..self.records.len() as u32 {
            pace.spend(1)?;
            if self.is_live(t) && !self.corners(t).contains(&INFINITE) {
                marked.push([0, 1, 2].map(|k| self.mark(half_edge(t, k)) != 0));
            }
        }
        Ok(marked)
    }

    fn follow(&mut self, segments: &Segments) {
        self.has_segments = segments.live() > 0;
    }

    fn insert_among(
        plane: &mut Plane,
        points: &[Point2],
        workers: usize,
        watch: &Watch,
    ) -> Result<Option<Range<usize>>> {
        if !plane.has_segments() {
            return Ok(None);
        }
        let whole = !plane.is_incremental(points.len(), SHARES_AMONG[0]);
        plane.insert_among(points, whole, workers, watch).map(Some)
    }

    fn remove_among(
        plane: &mut Plane,
        pairs: &[(u32, u32)],
        workers: usize,
        watch: &Watch,
    ) -> Result<Option<()>> {
        if !plane.has_segments() {
            return Ok(None);
        }
        let whole = !plane.is_incremental(pairs.len(), SHARES_AMONG[1]);
        plane.remove_among(pairs, false, whole, workers, watch)?;
        Ok(Some(()))
    }

    fn relocate_among(
        plane: &mut Plane,
        moves: &[Move<2>],
        workers: usize,
        watch: &Watch,
    ) -> Result<Option<()>> {
        if !plane.has_segments() {
            return Ok(None);
        }
        let whole = !plane.is_incremental(moves.len(), SHARES_AMONG[2]);
        plane.relocate_among(moves, whole, workers, watch).map(Some)
    }
}

impl Plane {
    /// Removes rows and the segments that end there, whose numbers are returned, ascending. On any
    /// error nothing has changed.
    pub fn remove_with_segments(
        &mut self,
        rows: &[i64],
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<i64>> {
        let pairs = self.by_vertex(rows, watch)?;
        if self.has_segments() {
            let whole = !self.is_incremental(pairs.len(), SHARES_AMONG[1]);
            return self.remove_among(&pairs, true, whole, workers, watch);
        }
        self.remove_alone(&pairs, workers, watch)?;
        Ok(Vec::new())
    }
}
