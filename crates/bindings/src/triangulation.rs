//! 2-D and 3-D triangulations as arrays.

use std::time::Duration;

use delone_core::base::arrays::Arrays;
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::delaunay::space;
use delone_core::{Point2, Point3};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Table, number_rows, rows, table};
use crate::errors::Outcome;
use crate::results::Stages;
use crate::signals::watched;

/// Names of the methods of `triangulate2`.
#[pyfunction]
pub fn methods2() -> Vec<&'static str> {
    Method::NAMES.iter().map(|&(name, _)| name).collect()
}

/// The method with a given name.
pub fn method_of(name: &str) -> PyResult<Method> {
    let message = || format!("unknown method {name:?}: one of {:?}", methods2());
    Method::named(name).ok_or_else(|| PyValueError::new_err(message()))
}

/// A Delaunay triangulation of either dimension d.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Triangulation {
    /// Vertices of the simplices, (m, d + 1).
    pub simplices: Table<i32>,
    /// The simplex opposite each vertex, -1 outside, (m, d + 1).
    pub neighbors: Table<i32>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
    /// Pairs of stage name and seconds.
    pub stages: Stages,
}

/// Pairs of stage names and seconds.
pub fn seconds(py: Python<'_>, stages: &[(&'static str, Duration)]) -> Outcome<Stages> {
    let pairs = stages
        .iter()
        .map(|(name, time)| (*name, time.as_secs_f64()));
    Ok(PyTuple::new(py, pairs)?.unbind())
}

/// The Delaunay triangulation of 2-D points.
#[pyfunction]
pub fn triangulate2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    method: &str,
    workers: usize,
) -> Outcome<Triangulation> {
    let method = method_of(method)?;
    let points: &[Point2] = rows(&points, "points")?;
    let made = watched(py, |watch| triangulate(points, method, workers, watch))?;
    arrays_of(py, made.arrays, &made.duplicates, &made.stages)
}

/// The Delaunay triangulation of 3-D points.
#[pyfunction]
pub fn triangulate3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<Triangulation> {
    let points: &[Point3] = rows(&points, "points")?;
    let made = watched(py, |watch| space::triangulate(points, workers, watch))?;
    arrays_of(py, made.arrays, &made.duplicates, &made.stages)
}

/// A triangulation as arrays.
pub fn arrays_of<const N: usize>(
    py: Python<'_>,
    arrays: Arrays<N>,
    duplicates: &[[u32; 2]],
    stages: &[(&'static str, Duration)],
) -> Outcome<Triangulation> {
    Ok(Triangulation {
        simplices: table(py, arrays.simplices)?,
        neighbors: table(py, arrays.neighbors)?,
        duplicates: number_rows(py, duplicates)?,
        stages: seconds(py, stages)?,
    })
}
