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

/// The method of a name.
pub fn method_of(name: &str) -> PyResult<Method> {
    let message = || format!("unknown method {name:?}: one of {:?}", methods2());
    Method::named(name).ok_or_else(|| PyValueError::new_err(message()))
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
    let method = method_of(method)?;
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
    let report = Report::new(py);
    report.list("orientation", orientation)?;
    report.list("neighbors", neighbors)?;
    report.list("missing", missing)?;
    report.list("repeats", repeats)?;
    report.table("edges", edges)?;
    report.table("hull", hull)?;
    report.table("delaunay", delaunay)?;
    report.table("ties", ties)?;
    report.table("count", count)?;
    Ok(report.found)
}

/// What was found, by name, where something was.
pub struct Report<'py> {
    /// The names, and numbers or rows of numbers.
    pub found: Bound<'py, PyDict>,
}

impl<'py> Report<'py> {
    /// Nothing yet.
    pub fn new(py: Python<'py>) -> Self {
        Self {
            found: PyDict::new(py),
        }
    }

    /// Numbers.
    pub fn list(&self, name: &str, found: Vec<u32>) -> PyResult<()> {
        if found.is_empty() {
            return Ok(());
        }
        self.found.set_item(name, numbers(self.found.py(), found))
    }

    /// Rows of numbers.
    pub fn table<const D: usize>(&self, name: &str, found: Vec<[u32; D]>) -> PyResult<()> {
        if found.is_empty() {
            return Ok(());
        }
        self.found
            .set_item(name, number_rows(self.found.py(), found)?)
    }
}
