//! Measures of simplices: edges and faces, centers, sizes, shapes.

use delone_core::base::error::Result;
use delone_core::base::watch::Watch;
use delone_core::{measure, ndim};
use numpy::{PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, columns, in_many, rows, shaped, table};
use crate::errors::Outcome;
use crate::given::simplices_of;
use crate::signals::watched;

/// Every edge of simplices once: the smaller vertex first, rows ascending.
#[pyfunction]
pub fn edges(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> Outcome<Table<i32>> {
    let found = match columns(&simplices) {
        3 => {
            let simplices = simplices_of(&simplices, npoints)?;
            let neighbors = rows(&neighbors, "neighbors")?;
            watched(py, |watch| {
                measure::edges2(simplices, neighbors, npoints, workers, watch)
            })?
        }
        4 => {
            let simplices: &[[i32; 4]] = simplices_of(&simplices, npoints)?;
            watched(py, |watch| {
                measure::edges(simplices, npoints, workers, watch)
            })?
        }
        many => in_many!(many - 1, D, N, P => {
            let simplices: &[[i32; N]] = simplices_of(&simplices, npoints)?;
            watched(py, |watch| measure::edges(simplices, npoints, workers, watch))
        })?,
    };
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

/// The neighbors of each vertex along `edges`: `(indptr, indices)`.
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

/// A measure of the core: of points and simplices, with a number of threads.
type Measure<R, const D: usize, const N: usize> =
    fn(&[[f64; D]], &[[i32; N]], usize, &Watch) -> Result<R>;

/// Calls a measure of the core.
fn measured<R: Send, const D: usize, const N: usize>(
    py: Python<'_>,
    points: &PyReadonlyArray2<'_, f64>,
    simplices: &PyReadonlyArray2<'_, i32>,
    workers: usize,
    of: Measure<R, D, N>,
) -> Outcome<R> {
    let points: &[[f64; D]] = rows(points, "points")?;
    let simplices = simplices_of(simplices, points.len())?;
    watched(py, |watch| of(points, simplices, workers, watch))
}

/// The same, as a table.
fn tabled<const C: usize, const D: usize, const N: usize>(
    py: Python<'_>,
    points: &PyReadonlyArray2<'_, f64>,
    simplices: &PyReadonlyArray2<'_, i32>,
    workers: usize,
    of: Measure<Vec<[f64; C]>, D, N>,
) -> Outcome<Table<f64>> {
    table(py, measured(py, points, simplices, workers, of)?)
}

/// The areas of triangles, or the volumes of simplices of more dimensions.
#[pyfunction]
pub fn sizes(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    let found = match columns(&points) {
        2 => measured(py, &points, &simplices, workers, measure::areas)?,
        3 => measured(py, &points, &simplices, workers, measure::volumes)?,
        many => in_many!(many, D, N, P => {
            measured(py, &points, &simplices, workers, ndim::volumes::<D, N, P>)
        })?,
    };
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
    let found = measured(py, &points, &simplices, workers, measure::face_areas)?;
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
    tabled(py, &points, &simplices, workers, measure::face_normals)
}

/// The centers of the circles or spheres through the corners of simplices.
#[pyfunction]
pub fn circumcenters(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    match columns(&points) {
        2 => tabled(py, &points, &simplices, workers, measure::circumcenters2),
        3 => tabled(py, &points, &simplices, workers, measure::circumcenters3),
        many => in_many!(many, D, N, P => {
            tabled(py, &points, &simplices, workers, ndim::circumcenters::<D, N, P>)
        }),
    }
}

/// Smallest and largest angle (of tetrahedra, dihedral angle), size, ratio of radii and of edges.
#[pyfunction]
pub fn qualities(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Vec<Column<f64>>> {
    let found = match columns(&points) {
        2 => measured(py, &points, &simplices, workers, measure::qualities2)?,
        _ => measured(py, &points, &simplices, workers, measure::qualities3)?,
    };
    Ok(found.into_iter().map(|values| column(py, values)).collect())
}

/// The smallest angle of all triangles in degrees, 180 if there are none.
#[pyfunction]
pub fn smallest_angle2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<f64> {
    measured(py, &points, &simplices, workers, measure::smallest_angle)
}

/// The dihedral angles of tetrahedra at the edges 01, 02, 03, 12, 13 and 23.
#[pyfunction]
pub fn dihedral_angles3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    tabled(py, &points, &simplices, workers, measure::dihedral_angles)
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
    let points = rows(&points, "points")?;
    let simplices = simplices_of(&simplices, points.len())?;
    let found = watched(py, |watch| {
        measure::below(points, simplices, squared_cosine, workers, watch)
    })?;
    Ok(column(py, found))
}

/// The affine maps of simplices to barycentric coordinates.
#[pyfunction]
pub fn transforms(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Py<PyArray3<f64>>> {
    let d = columns(&points);
    let flat = match d {
        2 => measured(py, &points, &simplices, workers, measure::transforms2)?
            .into_flattened()
            .into_flattened(),
        3 => measured(py, &points, &simplices, workers, measure::transforms3)?
            .into_flattened()
            .into_flattened(),
        many => in_many!(many, D, N, P => {
            let maps = measured(py, &points, &simplices, workers, ndim::transforms::<D, N, P>);
            maps.map(|maps| maps.into_flattened().into_flattened())
        })?,
    };
    let count = columns(&simplices) * d;
    let shape = [flat.len() / count, d + 1, d];
    shaped(py, flat, shape)
}
