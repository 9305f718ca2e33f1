//! Checks whether arrays of unknown origin are a mesh.

use delone_core::base::consistency::{self, Fault};
use delone_core::ndim;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{columns, in_many};
use crate::errors::Outcome;
use crate::given::checked;
use crate::signals::watched;

/// The first fault of simplices: `("neighbors", row)` or `("orientation", row)`; None if
/// there is none.
#[pyfunction]
pub fn fault(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Option<(&'static str, usize)>> {
    let found = match columns(&points) {
        2 => {
            let given = checked(&points, &simplices, &neighbors)?;
            watched(py, |watch| consistency::triangles(given, workers, watch))?
        }
        3 => {
            let given = checked(&points, &simplices, &neighbors)?;
            watched(py, |watch| consistency::tetrahedra(given, workers, watch))?
        }
        many => in_many!(many, D, N, P => {
            let given = checked(&points, &simplices, &neighbors)?;
            watched(py, |watch| ndim::fault::<D, N, P>(given, workers, watch))
        })?,
    };
    Ok(found.map(named))
}

fn named(fault: Fault) -> (&'static str, usize) {
    match fault {
        Fault::Neighbors(t) => ("neighbors", t),
        Fault::Orientation(t) => ("orientation", t),
    }
}
