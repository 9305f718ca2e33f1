//! Batches of queries: in which order, from where each walk starts, and by which threads.

use delone_predicates::Point3;

use super::tiling::Side;
use super::{Located, Locator, Star, is_finite};
use crate::error::Result;
use crate::order::order_of;
use crate::parallel;
use crate::watch::Watch;

/// Queries between two looks at the watch.
const WATCH_EVERY: usize = 1 << 12;
/// Fewest queries that are put in order: below, each walk starts from the tree.
const FEW: usize = 32;
/// Fewest queries that a thread is worth.
const SHARE: usize = 1 << 10;
/// Pairs of successive queries that are looked at to tell whether they come in a good order.
const PROBES: usize = 256;
/// How far, in lengths of an edge of the last tetrahedron, a walk goes; from further on the tree of
/// starts is cheaper. Squared; each step costs more than in the plane.
const REACH: f64 = 16.0;

/// Queries of one call.
#[derive(Clone, Copy)]
pub struct Batch<'a> {
    /// Where to look.
    pub locator: Locator<'a>,
    /// What for.
    pub queries: &'a [Point3],
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
        visit: impl Fn(&mut S, usize, Point3, Located) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        if self.locator.given.simplices.is_empty() {
            return Ok(Vec::new());
        }
        let walker = || (Walker::new(&self.locator), state());
        let ends = self.along(walker, |(walker, state), row, q| {
            visit(state, row, q, walker.go(q)?)
        })?;
        Ok(ends.into_iter().map(|(_, state)| state).collect())
    }

    /// The same without going anywhere.
    pub fn along<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, Point3) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        let queries = self.queries;
        if queries.len() <= FEW || comes_in_order(queries) {
            let share = queries.len().div_ceil(4 * self.workers.max(1)).max(SHARE);
            let tasks = (0..).step_by(share).zip(queries.chunks(share)).collect();
            let ends = parallel::map(self.workers, tasks, |(first, part)| {
                self.part((first..).zip(part.iter().copied()), state(), &visit)
            });
            return ends.into_iter().collect();
        }
        let parts = order_of(queries, self.workers)?;
        self.watch.check()?;
        let ends = parallel::map(self.workers, parts, |rows| {
            let rows = rows.iter().map(|&row| row as usize);
            self.part(rows.map(|row| (row, queries[row])), state(), &visit)
        });
        ends.into_iter().collect()
    }

    fn part<S>(
        &self,
        queries: impl Iterator<Item = (usize, Point3)>,
        mut state: S,
        visit: &impl Fn(&mut S, usize, Point3) -> Result<()>,
    ) -> Result<S> {
        for (i, (row, q)) in queries.enumerate() {
            if i % WATCH_EVERY == 0 {
                self.watch.check()?;
            }
            if is_finite(q) {
                visit(&mut state, row, q)?;
            }
        }
        Ok(state)
    }
}

/// Walks from query to query; where the next one is far, from the tree of starts. What is outside is mostly
/// told without a walk: beyond the box of all points, or beyond the boundary face where the last walk
/// has left a convex body, which is as good a proof for each point on that side of its plane.
struct Walker<'a> {
    locator: &'a Locator<'a>,
    star: Star,
    near: usize,
    last: Point3,
    reach: f64,
    beyond: Option<Side>,
}

impl<'a> Walker<'a> {
    fn new(locator: &'a Locator<'a>) -> Self {
        Self {
            locator,
            star: Star::default(),
            near: 0,
            last: [f64::NAN; 3],
            reach: 0.0,
            beyond: None,
        }
    }

    #[inline]
    fn go(&mut self, q: Point3) -> Result<Located> {
        let beyond = |side| self.locator.is_beyond(side, q);
        if self.locator.is_far(q) || self.beyond.is_some_and(beyond) {
            return Ok(Located::Outside(self.beyond));
        }
        // False for NaN, at first and where squares overflow: then the tree knows the start.
        let close = squared(q, self.last) <= self.reach;
        if !close {
            self.near = self.locator.near(q);
        }
        let at = self.locator.locate_from(self.near, q, &mut self.star)?;
        (self.near, self.beyond) = match at {
            Located::Inside(place) => (place.simplex, None),
            Located::Outside(side) => (side.map_or(self.near, |side| side.simplex), side),
        };
        let [a, b, ..] = self.locator.given.corners(self.near);
        (self.last, self.reach) = (q, REACH * squared(a, b));
        Ok(at)
    }
}

fn squared(p: Point3, q: Point3) -> f64 {
    (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum()
}

/// Whether most queries are about as near to the one before as an order along the curve would make
/// them: slices of a grid, tracks.
fn comes_in_order(queries: &[Point3]) -> bool {
    let step = (queries.len() - 1).div_ceil(PROBES).max(1);
    let probes = || queries.windows(2).step_by(step);
    let mut side = 0.0;
    for k in 0..3 {
        let coordinates = || probes().map(|w| w[0][k]).filter(|x| x.is_finite());
        let max = coordinates().fold(f64::NEG_INFINITY, f64::max);
        let min = coordinates().fold(f64::INFINITY, f64::min);
        side = f64::max(side, max - min);
    }
    let near = 4.0 * side / (queries.len() as f64).cbrt();
    let is_near = |w: &&[Point3]| (0..3).all(|k| (w[1][k] - w[0][k]).abs() <= near);
    10 * probes().filter(is_near).count() >= 9 * probes().count()
}
