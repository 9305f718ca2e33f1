//! Computes one result for each simplex, on all workers.

use crate::base::error::Result;
use crate::base::memory::{Zero, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Simplices per task.
pub(super) const SHARE: usize = 1 << 14;
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

/// The same for several numbers for each simplex, each in a column of its own.
pub fn columns<const C: usize, const D: usize, const N: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; N]],
    workers: usize,
    watch: &Watch,
    measure: impl Fn([[f64; D]; N]) -> [f64; C] + Sync,
) -> Result<[Vec<f64>; C]> {
    let mut found = [const { Vec::new() }; C];
    for column in &mut found {
        *column = zeroed(simplices.len())?;
    }
    let mut parts = found.each_mut().map(|column| column.chunks_mut(SHARE));
    let tasks = simplices.chunks(SHARE).map(|simplices| {
        let parts = parts.each_mut().map(|part| part.next().unwrap_or_default());
        (parts, simplices)
    });
    let done = parallel::map(workers, tasks.collect(), |(mut parts, simplices)| {
        watch.check()?;
        let mut corners = [[[0.0; D]; N]; BATCH];
        for (lot, simplices) in simplices.chunks(BATCH).enumerate() {
            for (corners, simplex) in corners.iter_mut().zip(simplices) {
                *corners = simplex.map(|v| points[v as usize]);
            }
            for (k, corners) in corners.iter().enumerate().take(simplices.len()) {
                for (part, value) in parts.iter_mut().zip(measure(*corners)) {
                    part[lot * BATCH + k] = value;
                }
            }
        }
        Ok(())
    });
    done.into_iter().collect::<Result<()>>()?;
    Ok(found)
}
