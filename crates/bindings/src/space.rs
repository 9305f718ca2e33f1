//! Triangulations of points in space as arrays.

use delone_core::delaunay3::triangulate;
use delone_core::delaunay3::validate::{Findings3, validate};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{number_rows, rows, table};
use crate::errors::raise;
use crate::given::checked;
use crate::signals::watched;
use crate::triangulation::{Made, Report};

/// The triangulation of the points as arrays.
#[pyfunction]
pub fn triangulate3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> PyResult<Made> {
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| triangulate(points, workers, watch))?;
    let stages = made.stages.iter();
    Ok((
        table(py, made.arrays.simplices)?,
        table(py, made.arrays.neighbors)?,
        number_rows(py, made.duplicates)?,
        stages.map(|(name, t)| (*name, t.as_secs_f64())).collect(),
    ))
}

/// What is wrong with a triangulation of space, by kind; empty where nothing is.
#[pyfunction]
pub fn validate3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = checked(&points, &simplices, &neighbors).map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| validate(given, watch))?;
    let Findings3 {
        orientation,
        facets,
        neighbors,
        hull,
        missing,
        repeats,
        delaunay,
        ties,
    } = found;
    let report = Report::new(py);
    report.list("orientation", orientation)?;
    report.list("neighbors", neighbors)?;
    report.list("missing", missing)?;
    report.list("repeats", repeats)?;
    report.table("facets", facets)?;
    report.table("hull", hull)?;
    report.table("delaunay", delaunay)?;
    report.table("ties", ties)?;
    Ok(report.found)
}
