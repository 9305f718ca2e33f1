//! Lawson flips of arbitrary triangulations, and neighbors, as arrays.

use delone_core::delaunay::plane::lawson::lawson;
use delone_core::mesh::plane::import::adjacency;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Table, rows, table};
use crate::errors::Outcome;
use crate::given::simplices_of;
use crate::signals::watched;

/// A triangulation made canonical by flips.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct FlippedTriangulation {
    /// Vertices of the triangles, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// Number of flips.
    pub flips: usize,
    /// The vertices of each flip, (flips, 4); None if they were not recorded.
    pub sequence: Option<Table<i32>>,
}

/// The canonical triangulation by flips, the number of flips, and their sequence if recorded.
#[pyfunction]
pub fn lawson2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    record: bool,
) -> Outcome<FlippedTriangulation> {
    let points = rows(&points, "points")?;
    let simplices = simplices_of(&simplices, points.len())?;
    let made = watched(py, |watch| lawson(points, simplices, record, watch))?;
    let sequence = if record {
        Some(table(py, made.sequence)?)
    } else {
        None
    };
    Ok(FlippedTriangulation {
        simplices: table(py, made.arrays.simplices)?,
        neighbors: table(py, made.arrays.neighbors)?,
        flips: made.flips,
        sequence,
    })
}

/// The triangle across the edge opposite each corner, -1 outside.
#[pyfunction]
pub fn neighbors2(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    npoints: usize,
) -> Outcome<Table<i32>> {
    let simplices = simplices_of(&simplices, npoints)?;
    let neighbors = watched(py, |watch| adjacency(simplices, npoints, watch))?;
    table(py, neighbors)
}
