//! Measures of simplices: edges and faces, centers, sizes, shapes.

use delone_core::error::Result;
use delone_core::measure;
use delone_core::watch::Watch;
use numpy::{PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, rows, shaped, table};
use crate::errors::Outcome;
use crate::given::simplices_of;
use crate::signals::watched;

/// Every edge of triangles once: the smaller vertex first, rows ascending.
#[pyfunction]
pub fn edges2(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> Outcome<Table<i32>> {
    let (simplices, neighbors) = (
        simplices_of(&simplices, npoints)?,
        rows(&neighbors, "neighbors")?,
    );
    let found = watched(py, |watch| {
        measure::edges2(simplices, neighbors, npoints, workers, watch)
    })?;
    table(py, found)
}

/// Every edge of tetrahedra once: the smaller vertex first, rows ascending.
#[pyfunction]
pub fn edges3(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> Outcome<Table<i32>> {
    let simplices = simplices_of(&simplices, npoints)?;
    let found = watched(py, |watch| {
        measure::edges3(simplices, npoints, workers, watch)
    })?;
    table(py, found)
}

/// Every face of tetrahedra once: vertices and rows ascending.
#[pyfunction]
pub fn faces3(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> Outcome<Table<i32>> {
    let (simplices, neighbors) = (
        simplices_of(&simplices, npoints)?,
        rows(&neighbors, "neighbors")?,
    );
    let found = watched(py, |watch| {
        measure::faces3(simplices, neighbors, npoints, workers, watch)
    })?;
    table(py, found)
}

/// The neighbors of each vertex along the edges of `edges2` or `edges3`: `(indptr, indices)`.
#[pyfunction]
pub fn around(
    py: Python<'_>,
    edges: PyReadonlyArray2<'_, i32>,
    npoints: usize,
) -> Outcome<(Column<i32>, Column<i32>)> {
    let edges: &[[i32; 2]] = rows(&edges, "edges")?;
    let (starts, found) = watched(py, |watch| measure::around(edges, npoints, watch))?;
    Ok((column(py, starts), column(py, found)))
}

/// Calls a measure of the core on simplices.
fn measured<R: Send, const D: usize, const N: usize>(
    py: Python<'_>,
    points: &PyReadonlyArray2<'_, f64>,
    simplices: &PyReadonlyArray2<'_, i32>,
    of: impl FnOnce(&[[f64; D]], &[[i32; N]], &Watch) -> Result<R> + Send,
) -> Outcome<R> {
    let points: &[[f64; D]] = rows(points, "points")?;
    let simplices = simplices_of(simplices, points.len())?;
    watched(py, |watch| of(points, simplices, watch))
}

/// The areas of triangles.
#[pyfunction]
pub fn areas2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::areas(points, simplices, workers, watch)
    })?;
    Ok(column(py, found))
}

/// The volumes of tetrahedra.
#[pyfunction]
pub fn volumes3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::volumes(points, simplices, workers, watch)
    })?;
    Ok(column(py, found))
}

/// The areas of triangles in 3-D.
#[pyfunction]
pub fn face_areas3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::face_areas(points, simplices, workers, watch)
    })?;
    Ok(column(py, found))
}

/// The unit normals of triangles in 3-D.
#[pyfunction]
pub fn face_normals3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::face_normals(points, simplices, workers, watch)
    })?;
    table(py, found)
}

/// The centers of the circles through the corners of triangles.
#[pyfunction]
pub fn circumcenters2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::circumcenters2(points, simplices, workers, watch)
    })?;
    table(py, found)
}

/// The centers of the spheres through the corners of tetrahedra.
#[pyfunction]
pub fn circumcenters3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::circumcenters3(points, simplices, workers, watch)
    })?;
    table(py, found)
}

/// Smallest and largest angle, area, ratio of radii and of edges of triangles.
#[pyfunction]
pub fn qualities2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Vec<Column<f64>>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::qualities2(points, simplices, workers, watch)
    })?;
    Ok(found.into_iter().map(|values| column(py, values)).collect())
}

/// Smallest and largest dihedral angle, volume, ratio of radii and of edges of tetrahedra.
#[pyfunction]
pub fn qualities3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Vec<Column<f64>>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::qualities3(points, simplices, workers, watch)
    })?;
    Ok(found.into_iter().map(|values| column(py, values)).collect())
}

/// The dihedral angles of tetrahedra at the edges 01, 02, 03, 12, 13 and 23.
#[pyfunction]
pub fn dihedral_angles3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::dihedral_angles(points, simplices, workers, watch)
    })?;
    table(py, found)
}

/// 1 for triangles with an angle below a bound, given by its squared cosine; else 0.
#[pyfunction]
pub fn below2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    squared_cosine: f64,
    workers: usize,
) -> Outcome<Column<i32>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::below(points, simplices, squared_cosine, workers, watch)
    })?;
    Ok(column(py, found))
}

/// The affine maps of triangles to barycentric coordinates.
#[pyfunction]
pub fn transforms2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Py<PyArray3<f64>>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::transforms2(points, simplices, workers, watch)
    })?;
    let count = found.len();
    let flat = found.into_flattened().into_flattened();
    shaped(py, flat, [count, 3, 2])
}

/// The affine maps of tetrahedra to barycentric coordinates.
#[pyfunction]
pub fn transforms3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Py<PyArray3<f64>>> {
    let found = measured(py, &points, &simplices, |points, simplices, watch| {
        measure::transforms3(points, simplices, workers, watch)
    })?;
    let count = found.len();
    let flat = found.into_flattened().into_flattened();
    shaped(py, flat, [count, 4, 3])
}
