//! Batches of queries: in which order, from where each walk starts, and by which threads.

use std::sync::atomic::{AtomicI32, AtomicU64, Ordering};

use delone_predicates::Point2;

use super::tiling::Side;
use super::{Located, Locator, Star, is_finite};
use crate::error::Result;
use crate::memory::with_room;
use crate::order::order_of;
use crate::parallel;
use crate::points::Extent;
use crate::watch::Watch;

/// Queries between two looks at the watch.
const WATCH_EVERY: usize = 1 << 12;
/// Fewest queries that are put in order: below, each walk starts from the tree.
const FEW: usize = 32;
/// Fewest queries that a thread is worth.
const SHARE: usize = 1 << 11;
/// Steps between queries that are looked at to tell whether they come in a good order.
const PROBES: usize = 256;
/// Queries that are gathered ahead of the walk.
const GATHER: usize = 1 << 9;
/// How far, in lengths of an edge of the last triangle, a walk goes; from further on the tree of
/// starts is cheaper: its depth costs about as much as a dozen triangles. Squared.
const REACH: f64 = 64.0;

/// Queries of one call.
#[derive(Clone, Copy)]
pub struct Batch<'a> {
    /// Where to look.
    pub locator: Locator<'a>,
    /// What for.
    pub queries: &'a [Point2],
    /// How many threads may work.
    pub workers: usize,
    /// Asked now and then whether to stop.
    pub watch: &'a Watch<'a>,
}

impl Batch<'_> {
    /// Goes to each finite query, in an order and by threads of its own choice; `visit` gets the
    /// state of its part of the queries, the row, the query and where that is. Returns the states.
    pub fn each<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, Point2, Located) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        let Self {
            locator,
            queries,
            workers,
            watch,
        } = *self;
        if locator.given.simplices.is_empty() {
            return Ok(Vec::new());
        }
        if queries.len() <= FEW || comes_in_order(queries) {
            let share = queries.len().div_ceil(4 * workers.max(1)).max(SHARE);
            let tasks = (0..).step_by(share).zip(queries.chunks(share)).collect();
            let ends = parallel::map(workers, tasks, |(first, part)| {
                let rows = (first..).zip(part.iter().copied());
                let mut state = state();
                Walker::new(&locator, watch).walk(rows, &mut state, &visit)?;
                Ok(state)
            });
            return ends.into_iter().collect();
        }
        let parts = order_of(queries, workers)?;
        watch.check()?;
        let ends = parallel::map(workers, parts, |rows| {
            // Loads that do not wait for each other: gathering ahead hides that they miss the cache.
            let mut gathered = with_room(GATHER)?;
            let mut walker = Walker::new(&locator, watch);
            let mut state = state();
            for run in rows.chunks(GATHER) {
                gathered.clear();
                gathered.extend(run.iter().map(|&row| queries[row as usize]));
                let rows = run.iter().map(|&row| row as usize);
                walker.walk(rows.zip(gathered.iter().copied()), &mut state, &visit)?;
            }
            Ok(state)
        });
        ends.into_iter().collect()
    }
}

/// Whether most queries are about as near to the one before as an order along the curve would make
/// them: rows of a raster, tracks.
fn comes_in_order(queries: &[Point2]) -> bool {
    let step = (queries.len() - 1).div_ceil(PROBES).max(1);
    let probes = || queries.windows(2).step_by(step);
    let finite = probes().map(|w| w[0]).filter(|&p| is_finite(p));
    let side = Extent::of(finite).side();
    let near = 4.0 * side / (queries.len() as f64).sqrt();
    let is_near =
        |w: &&[Point2]| (w[1][0] - w[0][0]).abs() <= near && (w[1][1] - w[0][1]).abs() <= near;
    let count = probes().count();
    10 * probes().filter(is_near).count() >= 9 * count
}

/// Walks from query to query.
struct Walker<'a> {
    locator: &'a Locator<'a>,
    watch: &'a Watch<'a>,
    star: Star,
    near: usize,
    last: Point2,
    reach: f64,
    walked: usize,
}

impl<'a> Walker<'a> {
    fn new(locator: &'a Locator<'a>, watch: &'a Watch<'a>) -> Self {
        Self {
            locator,
            watch,
            star: Star::default(),
            near: 0,
            last: [f64::NAN; 2],
            reach: 0.0,
            walked: 0,
        }
    }

    fn walk<S>(
        &mut self,
        queries: impl Iterator<Item = (usize, Point2)>,
        state: &mut S,
        visit: &impl Fn(&mut S, usize, Point2, Located) -> Result<()>,
    ) -> Result<()> {
        for (row, q) in queries {
            self.walked += 1;
            if self.walked.is_multiple_of(WATCH_EVERY) {
                self.watch.check()?;
            }
            if is_finite(q) {
                let at = self.go(q)?;
                visit(state, row, q, at)?;
            }
        }
        Ok(())
    }

    #[inline]
    fn go(&mut self, q: Point2) -> Result<Located> {
        let (x, y) = (q[0] - self.last[0], q[1] - self.last[1]);
        // False for NaN, at first and where squares overflow: then the tree knows where to start.
        let close = x * x + y * y <= self.reach;
        if !close {
            self.near = self.locator.near(q);
        }
        let at = self.locator.locate_from(self.near, q, &mut self.star)?;
        self.near = match at {
            Located::Inside(place) => place.triangle,
            Located::Outside(Side { triangle, .. }) => triangle,
        };
        let [a, b, _] = self.locator.given.corners(self.near);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        self.reach = REACH * (x * x + y * y);
        self.last = q;
        Ok(at)
    }
}

/// Numbers that threads write to rows of their own, in any order.
pub struct Output<T: Word> {
    cells: Vec<T::Cell>,
}

/// A number of one word.
pub trait Word: Copy {
    /// The same, to be shared.
    type Cell: Send + Sync;
    /// A cell with the number.
    fn cell(self) -> Self::Cell;
    /// Puts the number into a cell.
    fn put(self, cell: &Self::Cell);
    /// The number in a cell.
    fn take(cell: Self::Cell) -> Self;
}

// Rows are written once and read after the threads have ended: no order is needed, and the cells
// are as fast as plain numbers.
impl Word for i32 {
    type Cell = AtomicI32;
    fn cell(self) -> AtomicI32 {
        AtomicI32::new(self)
    }
    #[inline]
    fn put(self, cell: &AtomicI32) {
        cell.store(self, Ordering::Relaxed);
    }
    #[inline]
    fn take(cell: AtomicI32) -> Self {
        cell.into_inner()
    }
}

impl Word for f64 {
    type Cell = AtomicU64;
    fn cell(self) -> AtomicU64 {
        AtomicU64::new(self.to_bits())
    }
    #[inline]
    fn put(self, cell: &AtomicU64) {
        cell.store(self.to_bits(), Ordering::Relaxed);
    }
    #[inline]
    fn take(cell: AtomicU64) -> Self {
        Self::from_bits(cell.into_inner())
    }
}

impl<T: Word> Output<T> {
    /// `n` times the same number.
    pub fn filled(n: usize, value: T) -> Result<Self> {
        let mut cells = with_room(n)?;
        cells.extend((0..n).map(|_| value.cell()));
        Ok(Self { cells })
    }

    /// Writes one number.
    #[inline]
    pub fn set(&self, i: usize, value: T) {
        value.put(&self.cells[i]);
    }

    /// Writes the numbers from `i` on.
    #[inline]
    pub fn set_all(&self, i: usize, values: &[T]) {
        for (cell, value) in self.cells[i..i + values.len()].iter().zip(values) {
            value.put(cell);
        }
    }

    /// The numbers.
    pub fn into_vec(self) -> Vec<T> {
        self.cells.into_iter().map(T::take).collect()
    }
}
