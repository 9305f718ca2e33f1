//! The class `Locator2`; its methods are in `locate`.

use delone_core::Point2;
use delone_core::error::Result;
use delone_core::locate::{Batch, Kept, Locator};
use delone_core::watch::Watch;
use pyo3::prelude::*;

use crate::errors::raise;
use crate::given::{Held, answered};

/// A triangulation for many calls: its arrays, which never change, and a tree of starts.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator2 {
    pub held: Held,
    pub kept: Kept,
}

impl Locator2 {
    /// Calls `work` with a locator for `count` queries, without the GIL unless they are few.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&Locator, &Watch) -> Result<T> + Send,
    ) -> PyResult<T> {
        let lent = self.held.lend(py)?;
        let given = lent.given().map_err(|e| raise(py, &e))?;
        let locator = Locator::new(given, &self.kept);
        answered(py, count, |watch| work(&locator, watch))
    }

    /// Calls `work` with a batch of queries.
    pub fn batch<T: Send>(
        &self,
        py: Python<'_>,
        queries: &[Point2],
        workers: usize,
        work: impl FnOnce(&Batch) -> Result<T> + Send,
    ) -> PyResult<T> {
        self.run(py, queries.len(), |locator, watch| {
            work(&Batch {
                locator: *locator,
                queries,
                workers,
                watch,
            })
        })
    }
}
