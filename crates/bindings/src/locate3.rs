//! Point location on arrays of tetrahedra.

use delone_core::Point3;
use delone_core::error::{Error, Result};
use delone_core::interpolate3::natural;
use delone_core::locate3::{Batch, Kept, Locator, Tetrahedra, coordinates, find, nearest, within};
use delone_core::watch::Watch;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{column, in_range, rows, shaped};
use crate::errors::{attached, detached, raise};
use crate::triangulation::watched;

/// Queries below which a call keeps the GIL: it is over before another thread could run.
const FEW: usize = 16;

/// A triangulation in space for many calls: its arrays, which never change, and a tree of starts.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator3 {
    points: Py<PyArray2<f64>>,
    simplices: Py<PyArray2<i32>>,
    neighbors: Py<PyArray2<i32>>,
    kept: Kept,
}

/// `(simplex, weights, beside, face, shares)`.
type Places = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

/// `(indptr, indices, weights, simplex)`.
type Neighbours3 = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

/// Borrowed arrays whose indices have been checked, which takes a look at each.
pub fn checked3<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Tetrahedra<'a>> {
    let given = borrowed(points, simplices, neighbors)?;
    if given.neighbors.len() != given.simplices.len() {
        return Err(Error::Shape(
            "neighbors and simplices differ in length".into(),
        ));
    }
    in_range(given.simplices, 0, given.points.len(), "simplices")?;
    in_range(given.neighbors, -1, given.simplices.len(), "neighbors")?;
    Ok(given)
}

fn borrowed<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Tetrahedra<'a>> {
    Ok(Tetrahedra {
        points: rows(points, "points")?,
        simplices: rows(simplices, "simplices")?,
        neighbors: rows(neighbors, "neighbors")?,
    })
}

impl Locator3 {
    /// Calls `work` with a locator for `count` queries, without the GIL unless they are few.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&Locator, &Watch) -> Result<T> + Send,
    ) -> PyResult<T> {
        let points = self.points.bind(py).try_readonly()?;
        let simplices = self.simplices.bind(py).try_readonly()?;
        let neighbors = self.neighbors.bind(py).try_readonly()?;
        let given = borrowed(&points, &simplices, &neighbors).map_err(|e| raise(py, &e))?;
        let locator = Locator::new(given, &self.kept);
        if count <= FEW {
            return attached(py, || work(&locator, &Watch::idle()));
        }
        watched(py, |watch| work(&locator, watch))
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
        let given = checked3(&points, &simplices, &neighbors).map_err(|e| raise(py, &e))?;
        let kept = detached(py, || Kept::of(&given))?;
        Ok(Self {
            points: (*points).clone().unbind(),
            simplices: (*simplices).clone().unbind(),
            neighbors: (*neighbors).clone().unbind(),
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
