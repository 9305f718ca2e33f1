//! 2-D triangulations as arrays.

use std::time::Duration;

use delone_core::Point2;
use delone_core::base::arrays::Arrays;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_core::delaunay::plane::{Method, triangulate};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Column, Table, number_rows, numbers, rows, table};
use crate::errors::Outcome;
use crate::given::checked;
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

/// Faults of a 2-D triangulation; arrays are empty if there are none.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Faults2 {
    /// Triangles that are not counter-clockwise, (k,).
    pub orientation: Column<i32>,
    /// Directed edges that more than one triangle uses, (k, 2).
    pub edges: Table<i32>,
    /// Triangles whose row of neighbors is wrong, (k,).
    pub neighbors: Column<i32>,
    /// Boundary edges that are not on the hull, (k, 2).
    pub hull: Table<i32>,
    /// Rows of distinct points that no triangle uses, (k,).
    pub missing: Column<i32>,
    /// Rows that are used although an earlier row has the same coordinates, (k,).
    pub repeats: Column<i32>,
    /// Pairs of triangles that are not locally Delaunay, (k, 2).
    pub delaunay: Table<i32>,
    /// Pairs of cocircular triangles that are not canonical, (k, 2).
    pub ties: Table<i32>,
    /// Numbers of triangles expected and found, (2,), if they differ; otherwise (0,).
    pub count: Column<i32>,
}

/// Returns the faults of a 2-D triangulation.
#[pyfunction]
pub fn validate2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
) -> Outcome<Faults2> {
    let given = checked(&points, &simplices, &neighbors)?;
    let found = watched(py, |watch| validate(given, watch))?;
    faults2(py, found)
}

/// What is wrong, as arrays.
pub fn faults2(py: Python<'_>, found: Findings) -> Outcome<Faults2> {
    Ok(Faults2 {
        orientation: numbers(py, found.orientation),
        edges: number_rows(py, &found.edges)?,
        neighbors: numbers(py, found.neighbors),
        hull: number_rows(py, &found.hull)?,
        missing: numbers(py, found.missing),
        repeats: numbers(py, found.repeats),
        delaunay: number_rows(py, &found.delaunay)?,
        ties: number_rows(py, &found.ties)?,
        count: numbers(py, found.count.into_flattened()),
    })
}
