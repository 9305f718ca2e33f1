//! Computes one result for each simplex, on all workers.

use crate::error::Result;
use crate::memory::{Zero, zeroed};
use crate::parallel;
use crate::watch::Watch;

/// Simplices per task.
const SHARE: usize = 1 << 14;
/// Simplices whose corners are gathered before the first of them is measured: the loads are
/// independent.
const BATCH: usize = 64;

/// The results of `measure` for the corners of each simplex, whose vertices are rows of `points`.
pub fn each<R: Zero + Send, const D: usize, const N: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; N]],
    workers: usize,
    watch: &Watch,
    measure: impl Fn([[f64; D]; N]) -> R + Sync,
) -> Result<Vec<R>> {
    let mut found = zeroed(simplices.len())?;
    let tasks = found.chunks_mut(SHARE).zip(simplices.chunks(SHARE));
    let done = parallel::map(workers, tasks.collect(), |(found, simplices)| {
        watch.check()?;
        let mut corners = [[[0.0; D]; N]; BATCH];
        for (found, simplices) in found.chunks_mut(BATCH).zip(simplices.chunks(BATCH)) {
            for (corners, simplex) in corners.iter_mut().zip(simplices) {
                *corners = simplex.map(|v| points[v as usize]);
            }
            for (found, corners) in found.iter_mut().zip(&corners) {
                *found = measure(*corners);
            }
        }
        Ok(())
    });
    done.into_iter().collect::<Result<()>>()?;
    Ok(found)
}
