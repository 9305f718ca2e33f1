//! Triangulations of points in space as arrays.

use delone_core::delaunay3::triangulate;
use delone_core::delaunay3::validate::{Findings3, Given3, validate};
use delone_core::error::Error;
use delone_core::skeleton3;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{column, in_range, rows, table};
use crate::errors::raise;
use crate::triangulation::{Made, watched};

/// The triangulation of the points as arrays.
#[pyfunction]
pub fn triangulate3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> PyResult<Made> {
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| triangulate(points, workers, watch))?;
    let duplicates = made.duplicates.iter();
    let duplicates = duplicates.map(|pair| pair.map(|v| v as i32)).collect();
    let stages = made.stages.iter();
    Ok((
        table(py, made.arrays.simplices)?,
        table(py, made.arrays.neighbors)?,
        table::<i32, 2>(py, duplicates)?,
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
    let report = PyDict::new(py);
    let lists = [
        ("orientation", orientation),
        ("neighbors", neighbors),
        ("missing", missing),
        ("repeats", repeats),
    ];
    for (name, rows) in lists.into_iter().filter(|(_, rows)| !rows.is_empty()) {
        let rows = rows.into_iter().map(|v| v as i32).collect();
        report.set_item(name, column(py, rows))?;
    }
    for (name, rows) in [("facets", facets), ("hull", hull)] {
        if !rows.is_empty() {
            report.set_item(name, table(py, signed(rows))?)?;
        }
    }
    for (name, rows) in [("delaunay", delaunay), ("ties", ties)] {
        if !rows.is_empty() {
            report.set_item(name, table(py, signed(rows))?)?;
        }
    }
    Ok(report)
}

fn signed<const D: usize>(rows: Vec<[u32; D]>) -> Vec<[i32; D]> {
    rows.into_iter().map(|row| row.map(|v| v as i32)).collect()
}

/// Borrowed arrays whose indices have been checked.
fn checked<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given3<'a>, Error> {
    let given = Given3 {
        points: rows(points, "points")?,
        simplices: rows(simplices, "simplices")?,
        neighbors: rows(neighbors, "neighbors")?,
    };
    if given.neighbors.len() != given.simplices.len() {
        let message = "neighbors and simplices differ in length";
        return Err(Error::Shape(message.into()));
    }
    in_range(given.simplices, 0, given.points.len(), "simplices")?;
    in_range(given.neighbors, -1, given.simplices.len(), "neighbors")?;
    Ok(given)
}

/// Every edge once: the smaller vertex first, rows ascending.
#[pyfunction]
pub fn edges3(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> PyResult<Py<PyAny>> {
    let simplices = (|| {
        let simplices = rows(&simplices, "simplices")?;
        in_range(simplices, 0, npoints, "simplices")?;
        Ok::<_, Error>(simplices)
    })()
    .map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| {
        skeleton3::edges(simplices, npoints, workers, watch)
    })?;
    table(py, found)
}

/// Every face once: vertices and rows ascending.
#[pyfunction]
pub fn faces3(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    workers: usize,
) -> PyResult<Py<PyAny>> {
    let (simplices, neighbors) = (|| {
        let (simplices, neighbors) = (
            rows(&simplices, "simplices")?,
            rows(&neighbors, "neighbors")?,
        );
        in_range(simplices, 0, npoints, "simplices")?;
        Ok::<_, Error>((simplices, neighbors))
    })()
    .map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| {
        skeleton3::faces(simplices, neighbors, npoints, workers, watch)
    })?;
    table(py, found)
}
