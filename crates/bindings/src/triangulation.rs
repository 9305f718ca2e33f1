//! Triangulations as arrays.

use delone_core::delaunay2::validate::{Findings, Given, validate};
use delone_core::delaunay2::{Method, triangulate};
use delone_core::error::{Error, Result};
use delone_core::watch::Watch;
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{column, in_range, rows, table};
use crate::errors::{detached, raise};
use crate::signals::Signals;

/// Runs `work` without the GIL under a watch on Python's signals.
pub fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Watch) -> Result<T> + Send,
) -> PyResult<T> {
    let signals = Signals::new();
    let outcome = detached(py, || work(&Watch::new(&|| signals.stop())));
    match signals.exception() {
        Some(signal) => Err(signal),
        None => outcome,
    }
}

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
    let duplicates = made
        .duplicates
        .iter()
        .map(|pair| pair.map(|v| v as i32))
        .collect();
    Ok((
        table(py, made.arrays.simplices)?,
        table(py, made.arrays.neighbors)?,
        table::<i32, 2>(py, duplicates)?,
        made.stages
            .iter()
            .map(|(name, time)| (*name, time.as_secs_f64()))
            .collect(),
    ))
}

/// Borrowed arrays. An index in them that is out of range is an `InternalError` when it is used.
fn given<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given<'a>> {
    let given = Given {
        points: rows(points, "points")?,
        simplices: rows(simplices, "simplices")?,
        neighbors: rows(neighbors, "neighbors")?,
    };
    if given.neighbors.len() != given.simplices.len() {
        return Err(Error::Shape(
            "neighbors and simplices differ in length".into(),
        ));
    }
    Ok(given)
}

/// Borrowed arrays whose indices have been checked, which takes a look at each.
pub fn checked<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given<'a>> {
    let given = given(points, simplices, neighbors)?;
    in_range(given.simplices, 0, given.points.len(), "simplices")?;
    in_range(given.neighbors, -1, given.simplices.len(), "neighbors")?;
    Ok(given)
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
        report.set_item(
            name,
            column(py, rows.into_iter().map(|v| v as i32).collect()),
        )?;
    }
    let tables = [
        ("edges", edges),
        ("hull", hull),
        ("delaunay", delaunay),
        ("ties", ties),
        ("count", count),
    ];
    for (name, pairs) in tables.into_iter().filter(|(_, pairs)| !pairs.is_empty()) {
        let pairs = pairs
            .into_iter()
            .map(|pair| pair.map(|v| v as i32))
            .collect();
        report.set_item(name, table::<i32, 2>(py, pairs)?)?;
    }
    Ok(report)
}
