//! Improved tetrahedra as arrays.

use delone_core::base::error::Result;
use delone_core::base::error::{Error, Result as CoreResult};
use delone_core::solids::improve::{self, Improved, Task};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, rows, table};
use crate::errors::Outcome;
use crate::given::target_of;
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
    /// Vertices of the boundary or of regions among these.
    pub slides: usize,
    /// Tetrahedra removed at the boundary.
    pub peeled: usize,
    /// Weights assigned.
    pub weights: usize,
    /// Vertices added.
    pub added: usize,
    /// Vertices removed; no tetrahedron uses their rows.
    pub removed: usize,
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
    /// An upper bound on the distance between the boundary and the original one.
    pub distance: f64,
    /// Numbers of changes.
    pub counts: Py<ImprovementCounts>,
    /// Whether the limit on passes was reached while passes still made progress.
    pub exhausted: bool,
}

/// The arrays of a mesh to change.
struct Given<'py> {
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    fixed: PyReadonlyArray1<'py, bool>,
    removable: PyReadonlyArray1<'py, bool>,
}

impl Given<'_> {
    /// A task without any changes, after checking the arrays.
    fn task(&self, min_angle: f64) -> Result<Task<'_>> {
        let points = rows(&self.points, "points")?;
        let simplices = rows(&self.simplices, "simplices")?;
        in_range(simplices, 0, points.len(), "simplices")?;
        Ok(Task {
            points,
            simplices,
            labels: flat(&self.labels, "labels")?,
            fixed: flat(&self.fixed, "fixed")?,
            removable: flat(&self.removable, "removable")?,
            min_angle,
            flips: false,
            smooth: false,
            exude: false,
            turn: false,
            tolerance: 0.0,
            passes: 0,
            most: 0,
        })
    }
}

/// Removes vertices, no two of which are neighbors, if no angle falls below the bound, and none that is
/// already below it becomes smaller.
#[pyfunction]
pub fn coarsen3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    removable: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
) -> Outcome<ImprovedMesh> {
    let given = Given {
        fixed: PyArray1::zeros(py, 0, false).readonly(),
        points,
        simplices,
        labels,
        removable,
    };
    let task = given.task(min_angle)?;
    arrays_of(py, watched(py, |watch| improve::coarsen(task, watch))?)
}

/// Moves vertices that are not fixed to the mean of the circumcenters of their tetrahedra ("odt") or of
/// their neighbors ("laplace"), as far as the bound allows.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one array or option each")]
pub fn smooth3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    fixed: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
    target: &str,
    rounds: usize,
) -> Outcome<ImprovedMesh> {
    let target = target_of(target)?;
    let given = Given {
        removable: PyArray1::zeros(py, 0, false).readonly(),
        points,
        simplices,
        labels,
        fixed,
    };
    let task = Task {
        passes: rounds,
        ..given.task(min_angle)?
    };
    arrays_of(
        py,
        watched(py, |watch| improve::relax(task, target, watch))?,
    )
}

/// Improves tetrahedra. `progress` is called after each pass with its number and the number of
/// tetrahedra below the bound.
#[pyfunction]
#[pyo3(signature = (points, simplices, labels, fixed, removable, min_angle, flips, smooth, exude,
                    turn, tolerance, passes, most, progress=None))]
#[expect(clippy::too_many_arguments, reason = "one option each")]
pub fn improve3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    fixed: PyReadonlyArray1<'py, bool>,
    removable: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
    flips: bool,
    smooth: bool,
    exude: bool,
    turn: bool,
    tolerance: f64,
    passes: usize,
    most: usize,
    progress: Option<Passes>,
) -> Outcome<ImprovedMesh> {
    let given = Given {
        points,
        simplices,
        labels,
        fixed,
        removable,
    };
    let task = Task {
        flips,
        smooth,
        exude,
        turn,
        tolerance,
        passes,
        most,
        ..given.task(min_angle)?
    };
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
    let outcome = watched(py, |watch| improve::improve(task, watch, &mut notify));
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
        slides: made.counts.slides,
        peeled: made.counts.peeled,
        weights: made.counts.weights,
        added: made.counts.added,
        removed: made.counts.removed,
        passes: made.counts.passes,
        refused: made.counts.refused,
    };
    Ok(ImprovedMesh {
        points: table(py, made.points)?,
        simplices: table(py, made.simplices)?,
        neighbors: table(py, made.neighbors)?,
        weights: column(py, made.weights),
        labels: column(py, made.labels),
        distance: made.distance,
        counts: Py::new(py, counts)?,
        exhausted: made.exhausted,
    })
}
