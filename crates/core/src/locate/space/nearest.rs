//! The nearest vertex for each 3-D query of a batch.

use delone_predicates::nearer3;

use super::Batch;
use crate::base::error::Result;
use crate::locate::Output;

/// For each query the nearest vertex, the first row of several; -1 if the query is not finite.
pub fn nearest(batch: &Batch) -> Result<Vec<i32>> {
    let sites = batch.locator.sites()?;
    let found = Output::<i32>::filled(batch.queries.len(), -1, batch.watch)?;
    batch.along(
        || None,
        |last, row, q| {
            found.set(row, sites.nearest(q, last, nearer3));
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}
