//! Convex hulls as arrays.

use delone_core::hull::{self, Hull3};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{column, rows, table};
use crate::errors::{detached, raise};
use crate::triangulation::watched;

/// `(vertices, duplicates)`.
type Chain = (Py<PyAny>, Py<PyAny>);

/// The extreme points in the plane, counter-clockwise, and the rows that repeat them.
#[pyfunction]
pub fn hull2(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> PyResult<Chain> {
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let (vertices, duplicates) = detached(py, || Ok(hull::hull2(points)))?;
    Ok((
        column(py, vertices.into_iter().map(|v| v as i32).collect()),
        table::<i32, 2>(py, signed(duplicates))?,
    ))
}

/// `(simplices, neighbors, facet, polygons, starts, duplicates)`.
type Faces = (
    Py<PyAny>,
    Py<PyAny>,
    Py<PyAny>,
    Py<PyAny>,
    Py<PyAny>,
    Py<PyAny>,
);

/// The hull of points in space; nothing where they span no volume.
#[pyfunction]
pub fn hull3(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> PyResult<Option<Faces>> {
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let Some(found) = watched(py, |watch| hull::hull3(points, watch))? else {
        return Ok(None);
    };
    let Hull3 {
        simplices,
        neighbors,
        facet,
        polygons,
        starts,
        duplicates,
    } = found;
    let numbers = |rows: Vec<u32>| column(py, rows.into_iter().map(|v| v as i32).collect());
    Ok(Some((
        table::<i32, 3>(py, signed(simplices))?,
        table::<i32, 3>(py, signed(neighbors))?,
        numbers(facet),
        numbers(polygons),
        numbers(starts),
        table::<i32, 2>(py, signed(duplicates))?,
    )))
}

fn signed<const D: usize>(rows: Vec<[u32; D]>) -> Vec<[i32; D]> {
    rows.into_iter().map(|row| row.map(|v| v as i32)).collect()
}
