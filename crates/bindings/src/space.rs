//! 3-D triangulations as arrays.

use delone_core::Point3;
use delone_core::delaunay::space::triangulate;
use delone_core::delaunay::space::validate::{Findings3, validate};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, number_rows, numbers, rows};
use crate::errors::Outcome;
use crate::given::checked;
use crate::signals::watched;
use crate::triangulation::{Triangulation, arrays_of};

/// The Delaunay triangulation of 3-D points.
#[pyfunction]
pub fn triangulate3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<Triangulation> {
    let points: &[Point3] = rows(&points, "points")?;
    let made = watched(py, |watch| triangulate(points, workers, watch))?;
    arrays_of(py, made.arrays, &made.duplicates, &made.stages)
}

/// Faults of a 3-D triangulation; arrays are empty if there are none.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Faults3 {
    /// Tetrahedra that are not positively oriented, (k,).
    pub orientation: Column<i32>,
    /// Oriented faces that more than one tetrahedron has, (k, 3).
    pub facets: Table<i32>,
    /// Tetrahedra whose row of neighbors is wrong, (k,).
    pub neighbors: Column<i32>,
    /// Boundary faces that are not on the hull, (k, 3).
    pub hull: Table<i32>,
    /// Rows of distinct points that no tetrahedron uses, (k,).
    pub missing: Column<i32>,
    /// Rows that are used although an earlier row has the same coordinates, (k,).
    pub repeats: Column<i32>,
    /// Pairs of tetrahedra that are not locally Delaunay, (k, 2).
    pub delaunay: Table<i32>,
    /// Pairs of cospherical tetrahedra that are not canonical, (k, 2).
    pub ties: Table<i32>,
}

/// Returns the faults of a 3-D triangulation.
#[pyfunction]
pub fn validate3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
) -> Outcome<Faults3> {
    let given = checked(&points, &simplices, &neighbors)?;
    let found = watched(py, |watch| validate(given, watch))?;
    faults3(py, found)
}

/// What is wrong, as arrays.
pub fn faults3(py: Python<'_>, found: Findings3) -> Outcome<Faults3> {
    Ok(Faults3 {
        orientation: numbers(py, found.orientation),
        facets: number_rows(py, &found.facets)?,
        neighbors: numbers(py, found.neighbors),
        hull: number_rows(py, &found.hull)?,
        missing: numbers(py, found.missing),
        repeats: numbers(py, found.repeats),
        delaunay: number_rows(py, &found.delaunay)?,
        ties: number_rows(py, &found.ties)?,
    })
}
