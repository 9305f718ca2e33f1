//! Point location on arrays of tetrahedra.

use delone_core::Point3;
use delone_core::error::Result;
use delone_core::interpolate3::natural;
use delone_core::locate3::{Batch, Kept, Locator, coordinates, find, nearest, within};
use delone_core::watch::Watch;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{column, rows, shaped};
use crate::errors::{detached, raise};
use crate::given::{Held, answered, checked};

/// A triangulation in space for many calls: its arrays, which never change, and a tree of starts.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator3 {
    held: Held,
    kept: Kept,
}

/// `(simplex, weights, beside, face, shares)`.
type Places = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

/// `(indptr, indices, weights, simplex)`.
type Neighbours3 = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

impl Locator3 {
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
        queries: &[Point3],
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

#[pymethods]
impl Locator3 {
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
    ) -> PyResult<Self> {
        let given = checked(&points, &simplices, &neighbors).map_err(|e| raise(py, &e))?;
        let kept = detached(py, || Kept::of(&given))?;
        Ok(Self {
            held: Held::new(&points, &simplices, &neighbors),
            kept,
        })
    }

    /// For each query the first tetrahedron that holds it, or -1.
    fn find(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> PyResult<Py<PyAny>> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let found = self.batch(py, queries, workers, find)?;
        Ok(column(py, found))
    }

    /// Tetrahedra with barycentric coordinates.
    fn within(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> PyResult<(Py<PyAny>, Py<PyAny>)> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let found = self.batch(py, queries, workers, within)?;
        let weights = shaped(py, found.weights, [queries.len(), 4])?;
        Ok((column(py, found.simplex), weights))
    }

    /// Tetrahedra with barycentric coordinates, and outside the nearest boundary point.
    fn locate(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> PyResult<Places> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let n = queries.len();
        let found = self.batch(py, queries, workers, coordinates)?;
        Ok((
            column(py, found.simplex),
            shaped(py, found.weights, [n, 4])?,
            column(py, found.beside),
            shaped(py, found.face, [n, 3])?,
            shaped(py, found.shares, [n, 3])?,
        ))
    }

    /// Laplace weights of natural neighbours, as compressed rows, and the tetrahedra of queries.
    fn laplace(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> PyResult<Neighbours3> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let (found, simplex) = self.batch(py, queries, workers, natural)?;
        Ok((
            column(py, found.indptr),
            column(py, found.indices),
            column(py, found.weights),
            column(py, simplex),
        ))
    }

    /// The nearest vertex to each query; of a Delaunay triangulation.
    fn nearest(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> PyResult<Py<PyAny>> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let found = self.batch(py, queries, workers, nearest)?;
        Ok(column(py, found))
    }
}
