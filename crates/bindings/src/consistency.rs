//! Checks whether arrays of unknown origin are a mesh.

use delone_core::consistency::{self, Fault};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::errors::Outcome;
use crate::given::checked;
use crate::signals::watched;

/// The first fault of triangles: `("neighbors", row)` or `("orientation", row)`; None if there is
/// none.
#[pyfunction]
pub fn fault2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Option<(&'static str, usize)>> {
    let given = checked(&points, &simplices, &neighbors)?;
    let found = watched(py, |watch| consistency::triangles(given, workers, watch))?;
    Ok(found.map(named))
}

/// The same for tetrahedra.
#[pyfunction]
pub fn fault3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Option<(&'static str, usize)>> {
    let given = checked(&points, &simplices, &neighbors)?;
    let found = watched(py, |watch| consistency::tetrahedra(given, workers, watch))?;
    Ok(found.map(named))
}

fn named(fault: Fault) -> (&'static str, usize) {
    match fault {
        Fault::Neighbors(t) => ("neighbors", t),
        Fault::Orientation(t) => ("orientation", t),
    }
}
