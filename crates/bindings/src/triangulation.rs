//! Triangulations as arrays.

use delone_core::delaunay2::validate::{Findings, validate};
use delone_core::delaunay2::{Method, triangulate};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{number_rows, numbers, rows, table};
use crate::errors::raise;
use crate::given::checked;
use crate::signals::watched;

/// Names of the methods of `triangulate2`.
#[pyfunction]
pub fn methods2() -> Vec<&'static str> {
    Method::NAMES.iter().map(|&(name, _)| name).collect()
}

/// `(simplices, neighbors, duplicates, stages)`.
pub type Made = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Vec<(&'static str, f64)>);

/// The triangulation of the points as arrays.
#[pyfunction]
pub fn triangulate2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    method: &str,
    workers: usize,
) -> PyResult<Made> {
    let method = Method::named(method).ok_or_else(|| {
        PyValueError::new_err(format!(
            "unknown method {method:?}: one of {:?}",
            methods2()
        ))
    })?;
    let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| triangulate(points, method, workers, watch))?;
    Ok((
        table(py, made.arrays.simplices)?,
        table(py, made.arrays.neighbors)?,
        number_rows(py, made.duplicates)?,
        made.stages
            .iter()
            .map(|(name, time)| (*name, time.as_secs_f64()))
            .collect(),
    ))
}

/// What is wrong with a triangulation, by kind; empty where nothing is.
#[pyfunction]
pub fn validate2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = checked(&points, &simplices, &neighbors).map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| validate(given, watch))?;
    let Findings {
        orientation,
        edges,
        neighbors,
        hull,
        missing,
        repeats,
        delaunay,
        ties,
        count,
    } = found;
    let report = PyDict::new(py);
    let lists = [
        ("orientation", orientation),
        ("neighbors", neighbors),
        ("missing", missing),
        ("repeats", repeats),
    ];
    for (name, rows) in lists.into_iter().filter(|(_, rows)| !rows.is_empty()) {
        report.set_item(name, numbers(py, rows))?;
    }
    let tables = [
        ("edges", edges),
        ("hull", hull),
        ("delaunay", delaunay),
        ("ties", ties),
        ("count", count),
    ];
    for (name, pairs) in tables.into_iter().filter(|(_, pairs)| !pairs.is_empty()) {
        report.set_item(name, number_rows(py, pairs)?)?;
    }
    Ok(report)
}
