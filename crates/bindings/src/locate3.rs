//! Point location on arrays of tetrahedra.

use delone_core::base::memory::with_room;
use delone_core::interpolate::space::natural;
use delone_core::locate::space::{Distances, coordinates, find, nearest, within};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, rows, shaped};
use crate::errors::Outcome;
use crate::given::answered;
use crate::interpolate::{NaturalWeights, Points};
use crate::locator::Space;
use crate::signals::watched;

/// Locations of queries in tetrahedra.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Location3 {
    /// The tetrahedron that contains each query, -1 outside, (q,).
    pub simplex: Column<i32>,
    /// Weights of its corners, NaN outside, (q, 4).
    pub weights: Table<f64>,
    /// Outside, the tetrahedron at the nearest point of the boundary; else -1, (q,).
    pub beside: Column<i32>,
    /// Outside, the boundary face with that point; else -1, (q, 3).
    pub face: Table<i32>,
    /// Outside, the weights of its corners; else NaN, (q, 3).
    pub shares: Table<f64>,
}

/// A 3-D triangulation that is kept for many calls.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator3(Space);

#[pymethods]
impl Locator3 {
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
    ) -> Outcome<Self> {
        Space::new(&points, &simplices, &neighbors).map(Self)
    }

    /// For each query, the first tetrahedron that contains it, or -1.
    fn find(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.column(&xi, workers, find)
    }

    /// Tetrahedra with barycentric coordinates.
    fn within(
        &self,
        py: Python<'_>,
        xi: Points<'_>,
        workers: usize,
    ) -> Outcome<(Column<i32>, Table<f64>)> {
        let (found, n) = self.0.batch(&xi, workers, within)?;
        let weights = shaped(py, found.weights, [n, 4])?;
        Ok((column(py, found.simplex), weights))
    }

    /// Tetrahedra with barycentric coordinates, and outside the nearest boundary point.
    fn locate(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> Outcome<Location3> {
        let (found, n) = self.0.batch(&xi, workers, coordinates)?;
        Ok(Location3 {
            simplex: column(py, found.simplex),
            weights: shaped(py, found.weights, [n, 4])?,
            beside: column(py, found.beside),
            face: shaped(py, found.face, [n, 3])?,
            shares: shaped(py, found.shares, [n, 3])?,
        })
    }

    /// Laplace weights of natural neighbors, as compressed rows, and the tetrahedra of queries.
    fn laplace(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> Outcome<NaturalWeights> {
        let ((found, simplex), _) = self.0.batch(&xi, workers, natural)?;
        Ok(NaturalWeights {
            indptr: column(py, found.indptr),
            indices: column(py, found.indices),
            weights: column(py, found.weights),
            slopes: None,
            simplex: column(py, simplex),
        })
    }

    /// The nearest vertex to each query, in a Delaunay triangulation.
    fn nearest(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.column(&xi, workers, nearest)
    }
}

/// Triangles in 3-D, in a tree: distances from the nearest one.
#[pyclass(frozen, module = "delone._core")]
pub struct Distances3(Distances);

#[pymethods]
impl Distances3 {
    /// Of triangles, (m, 3); with repeated vertices they are segments and points.
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, i32>,
    ) -> Outcome<Self> {
        let py = points.py();
        let points = rows::<f64, 3>(&points, "points")?;
        let triangles = rows::<i32, 3>(&triangles, "triangles")?;
        in_range(triangles, 0, points.len(), "triangles")?;
        let corners = watched(py, |watch| {
            let mut corners = with_room(triangles.len())?;
            corners.extend(triangles.iter().map(|t| t.map(|v| points[v as usize])));
            Distances::over(corners, watch)
        })?;
        Ok(Self(corners))
    }

    /// The distance of each query from the nearest triangle, rounded.
    fn of(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> Outcome<Column<f64>> {
        let queries = rows::<f64, 3>(&xi, "xi")?;
        let found = answered(py, queries.len(), |watch| {
            self.0.of(queries, workers, watch)
        })?;
        Ok(column(py, found))
    }
}
