//! Convex hulls as arrays.

use delone_core::hull::{self, Hull3};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{number_rows, numbers, rows};
use crate::errors::raise;
use crate::signals::watched;

/// `(vertices, duplicates)`.
type Chain = (Py<PyAny>, Py<PyAny>);

/// The extreme points in the plane, counter-clockwise, and the rows that repeat them.
#[pyfunction]
pub fn hull2(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> PyResult<Chain> {
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let (vertices, duplicates) = watched(py, |watch| hull::hull2(points, watch))?;
    Ok((numbers(py, vertices), number_rows(py, duplicates)?))
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
    Ok(Some((
        number_rows(py, simplices)?,
        number_rows(py, neighbors)?,
        numbers(py, facet),
        numbers(py, polygons),
        numbers(py, starts),
        number_rows(py, duplicates)?,
    )))
}
