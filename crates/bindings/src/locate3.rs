//! Point location on arrays of tetrahedra.

use delone_core::interpolate3::natural;
use delone_core::locate3::{Kept, coordinates, find, nearest, within};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, shaped};
use crate::interpolate::Points;
use crate::locator::Space;

/// `(simplex, weights, beside, face, shares)`.
type Places = (Column<i32>, Table<f64>, Column<i32>, Table<i32>, Table<f64>);

/// `(indptr, indices, weights, simplex)`.
type Neighbours3 = (Column<i64>, Column<i32>, Column<f64>, Column<i32>);

/// A triangulation in space for many calls.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator3(Space);

#[pymethods]
impl Locator3 {
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
    ) -> PyResult<Self> {
        Space::new(&points, &simplices, &neighbors, Kept::of).map(Self)
    }

    /// For each query the first tetrahedron that holds it, or -1.
    fn find(&self, xi: Points<'_>, workers: usize) -> PyResult<Column<i32>> {
        self.0.column(&xi, workers, find)
    }

    /// Tetrahedra with barycentric coordinates.
    fn within(
        &self,
        py: Python<'_>,
        xi: Points<'_>,
        workers: usize,
    ) -> PyResult<(Column<i32>, Table<f64>)> {
        let (found, n) = self.0.batch(&xi, workers, within)?;
        let weights = shaped(py, found.weights, [n, 4])?;
        Ok((column(py, found.simplex), weights))
    }

    /// Tetrahedra with barycentric coordinates, and outside the nearest boundary point.
    fn locate(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> PyResult<Places> {
        let (found, n) = self.0.batch(&xi, workers, coordinates)?;
        Ok((
            column(py, found.simplex),
            shaped(py, found.weights, [n, 4])?,
            column(py, found.beside),
            shaped(py, found.face, [n, 3])?,
            shaped(py, found.shares, [n, 3])?,
        ))
    }

    /// Laplace weights of natural neighbours, as compressed rows, and the tetrahedra of queries.
    fn laplace(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> PyResult<Neighbours3> {
        let ((found, simplex), _) = self.0.batch(&xi, workers, natural)?;
        Ok((
            column(py, found.indptr),
            column(py, found.indices),
            column(py, found.weights),
            column(py, simplex),
        ))
    }

    /// The nearest vertex to each query; of a Delaunay triangulation.
    fn nearest(&self, xi: Points<'_>, workers: usize) -> PyResult<Column<i32>> {
        self.0.column(&xi, workers, nearest)
    }
}
