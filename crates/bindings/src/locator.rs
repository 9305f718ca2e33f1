//! Triangulations that are kept for many calls: the common part of `Locator2` and `Locator3`.

use delone_core::base::error::Result;
use delone_core::base::watch::Watch;
use delone_core::locate::space;
use delone_core::locate::{self, Batch, Cache, Dimension, Locator};
use numpy::{Element, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, column, rows};
use crate::errors::Outcome;
use crate::given::{Held, answered, checked};
use crate::signals::watched;

/// Arrays that never change, and the core's index over them, such as a tree of starting points.
pub struct Tiling<P: Dimension<D, N>, const D: usize, const N: usize> {
    pub held: Held,
    kept: Cache<P, D, N>,
}

/// Triangles.
pub type Plane = Tiling<locate::Plane, 2, 3>;
/// Tetrahedra.
pub type Space = Tiling<space::Space, 3, 4>;

impl<P: Dimension<D, N>, const D: usize, const N: usize> Tiling<P, D, N> {
    /// Checks the arrays and builds the index.
    pub fn new(
        points: &PyReadonlyArray2<'_, f64>,
        simplices: &PyReadonlyArray2<'_, i32>,
        neighbors: &PyReadonlyArray2<'_, i32>,
    ) -> Outcome<Self> {
        let py = points.py();
        let given = checked(points, simplices, neighbors)?;
        let kept = watched(py, |watch| Cache::of(&given, watch))?;
        Ok(Self {
            held: Held::new(points, simplices, neighbors),
            kept,
        })
    }

    /// Calls `work` with a locator for `count` queries, without the GIL unless there are few.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&Locator<P, D, N>, &Watch) -> Result<T> + Send,
    ) -> Outcome<T> {
        let lent = self.held.lend(py)?;
        let given = lent.given()?;
        answered(py, count, |watch| {
            work(&Locator::new(given, &self.kept, watch), watch)
        })
    }

    /// Calls `work` with a batch of queries; also returns their number.
    pub fn batch<T: Send>(
        &self,
        xi: &PyReadonlyArray2<'_, f64>,
        workers: usize,
        work: impl FnOnce(&Batch<P, D, N>) -> Result<T> + Send,
    ) -> Outcome<(T, usize)> {
        let py = xi.py();
        let queries = rows(xi, "xi")?;
        let found = self.run(py, queries.len(), |&locator, watch| {
            work(&Batch {
                locator,
                queries,
                workers,
                watch,
            })
        })?;
        Ok((found, queries.len()))
    }

    /// Calls `work`, which returns one number per query.
    pub fn column<T: Element + Send>(
        &self,
        xi: &PyReadonlyArray2<'_, f64>,
        workers: usize,
        work: impl FnOnce(&Batch<P, D, N>) -> Result<Vec<T>> + Send,
    ) -> Outcome<Column<T>> {
        let (found, _) = self.batch(xi, workers, work)?;
        Ok(column(xi.py(), found))
    }
}
