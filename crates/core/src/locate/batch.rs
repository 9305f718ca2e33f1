//! Batches of queries, in the plane and in space: in which order, and by which threads.

use super::{Kept, Locator, Output};
use crate::error::Result;
use crate::memory::with_room;
use crate::order::order_of;
use crate::parallel;
use crate::points::Extent;
use crate::watch::Watch;

/// Fewest queries that are put in order: below, each walk starts from the tree.
const FEW: usize = 32;
/// Fewest queries that a thread is worth, times 2^D: in space each takes longer.
const SHARE: usize = 1 << 13;
/// Pairs of successive queries that are looked at to tell whether they come in a good order.
const PROBES: usize = 256;
/// Queries that are gathered ahead of the walk; before each lot the watch is asked.
const GATHER: usize = 1 << 9;

/// Queries of one call; of the plane, if nothing else is said.
pub struct Batch<'a, K = Kept, const D: usize = 2, const N: usize = 3> {
    /// Where to look.
    pub locator: Locator<'a, K, D, N>,
    /// What for.
    pub queries: &'a [[f64; D]],
    /// How many threads may work.
    pub workers: usize,
    /// Asked now and then whether to stop.
    pub watch: &'a Watch<'a>,
}

/// How a batch goes from query to query, with what is kept for a triangulation.
pub trait Walks<const D: usize, const N: usize>: Sized + Sync {
    /// Where a point is.
    type Located;

    /// What tells where a query is, and remembers it for the next.
    fn walker(
        locator: &Locator<Self, D, N>,
    ) -> impl FnMut([f64; D]) -> Result<Self::Located> + Send;

    /// The simplex that holds what is there, or -1.
    fn holder(at: &Self::Located) -> i32;
}

impl<K: Walks<D, N>, const D: usize, const N: usize> Batch<'_, K, D, N> {
    /// Goes to each finite query, in an order and by threads of its own choice; `visit` gets the
    /// state of its part of the queries, the row, the query and where that is. Returns the states.
    pub fn each<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, [f64; D], K::Located) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        if self.locator.given.simplices.is_empty() {
            return Ok(Vec::new());
        }
        let walker = || (K::walker(&self.locator), state());
        let ends = self.along(walker, |(go, state), row, q| visit(state, row, q, go(q)?))?;
        Ok(ends.into_iter().map(|(_, state)| state).collect())
    }

    /// The same without going anywhere.
    pub fn along<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, [f64; D]) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        let (queries, workers) = (self.queries, self.workers);
        if queries.len() <= FEW || comes_in_order(queries) {
            let share = queries.len().div_ceil(4 * workers.max(1)).max(SHARE >> D);
            let tasks = (0..).step_by(share).zip(queries.chunks(share)).collect();
            let ends = parallel::map(workers, tasks, |(first, part): (usize, &[_])| {
                let mut state = state();
                for (first, lot) in (first..).step_by(GATHER).zip(part.chunks(GATHER)) {
                    self.lot((first..).zip(lot), &mut state, &visit)?;
                }
                Ok(state)
            });
            return ends.into_iter().collect();
        }
        let parts = order_of(queries, workers, self.watch)?;
        let ends = parallel::map(workers, parts, |rows| {
            // Loads that do not wait for each other: gathering ahead hides that they miss the cache.
            let mut gathered = with_room(GATHER)?;
            let mut state = state();
            for lot in rows.chunks(GATHER) {
                gathered.clear();
                gathered.extend(lot.iter().map(|&row| queries[row as usize]));
                let rows = lot.iter().map(|&row| row as usize);
                self.lot(rows.zip(&gathered), &mut state, &visit)?;
            }
            Ok(state)
        });
        ends.into_iter().collect()
    }

    fn lot<'q, S>(
        &self,
        queries: impl Iterator<Item = (usize, &'q [f64; D])>,
        state: &mut S,
        visit: &impl Fn(&mut S, usize, [f64; D]) -> Result<()>,
    ) -> Result<()> {
        self.watch.check()?;
        for (row, &q) in queries {
            if is_finite(&q) {
                visit(state, row, q)?;
            }
        }
        Ok(())
    }
}

/// For each query the first simplex that holds it, boundary included, or -1: outside, or not finite.
pub fn find<K: Walks<D, N>, const D: usize, const N: usize>(
    batch: &Batch<K, D, N>,
) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1, batch.watch)?;
    batch.each(
        || (),
        |(), row, _, at| {
            found.set(row, K::holder(&at));
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}

/// Whether most queries are about as near to the one before as an order along the curve would make
/// them: rows of a raster, slices of a grid, tracks.
fn comes_in_order<const D: usize>(queries: &[[f64; D]]) -> bool {
    let step = (queries.len() - 1).div_ceil(PROBES).max(1);
    let probes = || queries.windows(2).step_by(step);
    let finite = probes().map(|w| w[0]).filter(is_finite);
    let side = Extent::of(finite).side();
    let n = queries.len() as f64;
    let near = 4.0 * side / if D == 2 { n.sqrt() } else { n.cbrt() };
    let is_near = |w: &&[[f64; D]]| (0..D).all(|k| (w[1][k] - w[0][k]).abs() <= near);
    10 * probes().filter(is_near).count() >= 9 * probes().count()
}

/// Whether the point is one.
pub fn is_finite<const D: usize>(q: &[f64; D]) -> bool {
    q.iter().all(|x| x.is_finite())
}

/// The square of a distance, rounded.
pub fn squared<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum()
}
