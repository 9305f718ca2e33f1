//! Convex hulls as arrays.

use delone_core::hull;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, number_rows, numbers, rows};
use crate::errors::Outcome;
use crate::signals::watched;

/// `(vertices, duplicates)`.
type Chain = (Column<i32>, Table<i32>);

/// The extreme points in 2-D, counter-clockwise, and the rows that repeat them.
#[pyfunction]
pub fn hull2(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> Outcome<Chain> {
    let points = rows(&points, "points")?;
    let (vertices, duplicates) = watched(py, |watch| hull::hull2(points, watch))?;
    Ok((numbers(py, vertices), number_rows(py, &duplicates)?))
}

/// The convex hull of 3-D points.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Hull3 {
    /// Vertices of the triangles of facets, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, (m, 3).
    pub neighbors: Table<i32>,
    /// The facet of each triangle, (m,).
    pub facet_of: Column<i32>,
    /// Vertices of all facets, one facet after another, (k,).
    pub polygons: Column<i32>,
    /// Start of the vertices of each facet, and the end, (f + 1,).
    pub starts: Column<i32>,
    /// Rows that repeat earlier rows, and the first of these, (d, 2).
    pub duplicates: Table<i32>,
}

/// The hull of 3-D points; None if they span no volume.
#[pyfunction]
pub fn hull3(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> Outcome<Option<Hull3>> {
    let points = rows(&points, "points")?;
    let Some(found) = watched(py, |watch| hull::hull3(points, watch))? else {
        return Ok(None);
    };
    Ok(Some(Hull3 {
        simplices: number_rows(py, &found.simplices)?,
        neighbors: number_rows(py, &found.neighbors)?,
        facet_of: numbers(py, found.facet),
        polygons: numbers(py, found.polygons),
        starts: numbers(py, found.starts),
        duplicates: number_rows(py, &found.duplicates)?,
    }))
}
