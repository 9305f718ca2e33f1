//! Batches of point queries in 2-D and 3-D: their order, and their distribution over threads.

use super::locator::{Dimension, Located, Locator};
use super::range::is_finite;
use super::walker::Walker;
use super::{Output, Plane};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::order::order_of;

/// The fewest queries that are sorted: below, each walk starts from the tree.
const FEW: usize = 32;
/// The fewest queries that are worth a thread, times 2^D: in 3-D each takes longer.
const SHARE: usize = 1 << 13;
/// Pairs of successive queries that are sampled to tell whether their order is good.
const PROBES: usize = 256;
/// Queries that are gathered ahead of the walk, between two checks for interruption.
const GATHER: usize = 1 << 9;

/// The queries of one call; 2-D by default.
pub struct Batch<'a, P: Dimension<D, N> = Plane, const D: usize = 2, const N: usize = 3> {
    /// The triangulation.
    pub locator: Locator<'a, P, D, N>,
    /// The points to locate.
    pub queries: &'a [[f64; D]],
    /// The number of threads.
    pub workers: usize,
    /// Checked for interruption.
    pub watch: &'a Watch<'a>,
}

impl<P: Dimension<D, N>, const D: usize, const N: usize> Batch<'_, P, D, N> {
    /// Locates each finite query, in an order and on threads of its own choice; `visit` gets the
    /// state of its part of the queries, the row, the query and its location. Returns the states.
    pub fn each<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, [f64; D], Located<N>) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        if self.locator.given.simplices.is_empty() {
            return Ok(Vec::new());
        }
        let walker = || (Walker::new(&self.locator), state());
        let visit = |(walker, state): &mut (Walker<P, D, N>, S), row, q| {
            visit(state, row, q, walker.go(q)?)
        };
        let ends = self.along(walker, visit)?;
        Ok(ends.into_iter().map(|(_, state)| state).collect())
    }

    /// The same without locating the queries.
    pub fn along<S: Send>(
        &self,
        state: impl Fn() -> S + Sync,
        visit: impl Fn(&mut S, usize, [f64; D]) -> Result<()> + Sync,
    ) -> Result<Vec<S>> {
        let (queries, workers) = (self.queries, self.workers);
        if queries.len() <= FEW || is_in_good_order(queries) {
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
            // Independent loads: gathering ahead hides cache misses.
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

/// For each query the first simplex that contains it, boundary included, or -1 if it is outside or
/// not finite.
pub fn find<P: Dimension<D, N>, const D: usize, const N: usize>(
    batch: &Batch<P, D, N>,
) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1, batch.watch)?;
    batch.each(
        || (),
        |(), row, _, at| {
            if let Located::Inside(place) = at {
                found.set(row, place.simplex as i32);
            }
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}

/// Whether most queries are about as near to the previous one as if sorted along the curve: rows of
/// a raster, slices of a grid, tracks.
fn is_in_good_order<const D: usize>(queries: &[[f64; D]]) -> bool {
    let step = (queries.len() - 1).div_ceil(PROBES).max(1);
    let probes = || queries.windows(2).step_by(step);
    let finite = probes().map(|w| w[0]).filter(is_finite);
    let side = Extent::of(finite).side();
    let n = queries.len() as f64;
    let near = 4.0 * side / if D == 2 { n.sqrt() } else { n.cbrt() };
    let is_near = |w: &&[[f64; D]]| (0..D).all(|k| (w[1][k] - w[0][k]).abs() <= near);
    10 * probes().filter(is_near).count() >= 9 * probes().count()
}
