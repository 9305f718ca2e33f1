//! Improved tetrahedra as arrays.

use delone_core::base::error::Result;
use delone_core::base::error::{Error, Result as CoreResult};
use delone_core::solids::improve::{Improved, Task, improve};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, rows, table};
use crate::errors::Outcome;
use crate::results::Passes;
use crate::signals::watched;

/// Numbers of changes to tetrahedra, by kind.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ImprovementCounts {
    /// Edges removed.
    pub edges: usize,
    /// Edges of the boundary among these.
    pub boundary: usize,
    /// Faces removed.
    pub faces: usize,
    /// Vertices moved.
    pub moves: usize,
    /// Weights assigned.
    pub weights: usize,
    /// Vertices added.
    pub added: usize,
    /// Passes.
    pub passes: usize,
    /// Changes rejected.
    pub refused: usize,
}

/// Improved tetrahedra.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ImprovedMesh {
    /// Coordinates, (n, 3).
    pub points: Table<f64>,
    /// Vertices of the tetrahedra, (m, 4).
    pub simplices: Table<i32>,
    /// The tetrahedron opposite each vertex, -1 outside, (m, 4).
    pub neighbors: Table<i32>,
    /// The weight of each point, 0 for most, (n,).
    pub weights: Column<f64>,
    /// The label of each tetrahedron, (m,).
    pub labels: Column<i32>,
    /// Numbers of changes.
    pub counts: Py<ImprovementCounts>,
    /// Whether the limit on passes was reached while passes still made progress.
    pub exhausted: bool,
}

/// Improves tetrahedra. `progress` is called after each pass with its number and the number of
/// tetrahedra below the bound.
#[pyfunction]
#[pyo3(signature = (points, simplices, labels, fixed, min_angle, flips, smooth, exude, turn, passes,
                    most, progress=None))]
#[expect(clippy::too_many_arguments, reason = "one option each")]
pub fn improve3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    fixed: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
    flips: bool,
    smooth: bool,
    exude: bool,
    turn: bool,
    passes: usize,
    most: usize,
    progress: Option<Passes>,
) -> Outcome<ImprovedMesh> {
    let task = || -> Result<Task<'_>> {
        let points = rows(&points, "points")?;
        let simplices = rows(&simplices, "simplices")?;
        in_range(simplices, 0, points.len(), "simplices")?;
        Ok(Task {
            points,
            simplices,
            labels: flat(&labels, "labels")?,
            fixed: flat(&fixed, "fixed")?,
            min_angle,
            flips,
            smooth,
            exude,
            turn,
            passes,
            most,
        })
    };
    let task = task()?;
    let mut failure = None;
    let mut notify = |pass: usize, below: usize| -> CoreResult<()> {
        let Some(progress) = &progress else {
            return Ok(());
        };
        let result = Python::attach(|py| progress.call1(py, (pass, below)).map(|_| ()));
        result.map_err(|error| {
            failure = Some(error);
            Error::Interrupted
        })
    };
    let outcome = watched(py, |watch| improve(task, watch, &mut notify));
    if let Some(error) = failure {
        return Err(error.into());
    }
    arrays_of(py, outcome?)
}

/// The result as Python arrays.
fn arrays_of(py: Python<'_>, made: Improved) -> Outcome<ImprovedMesh> {
    let counts = ImprovementCounts {
        edges: made.counts.edges,
        boundary: made.counts.boundary,
        faces: made.counts.faces,
        moves: made.counts.moves,
        weights: made.counts.weights,
        added: made.counts.added,
        passes: made.counts.passes,
        refused: made.counts.refused,
    };
    Ok(ImprovedMesh {
        points: table(py, made.points)?,
        simplices: table(py, made.simplices)?,
        neighbors: table(py, made.neighbors)?,
        weights: column(py, made.weights),
        labels: column(py, made.labels),
        counts: Py::new(py, counts)?,
        exhausted: made.exhausted,
    })
}
