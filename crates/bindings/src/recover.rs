//! Recovered faces as arrays.

use delone_core::alpha::labels;
use delone_core::base::error::Error;
use delone_core::base::memory::{copied, filled};
use delone_core::base::watch::Watch;
use delone_core::solids::recover::{Counts, Recovered, Task, recover};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, numbers, rows, table};
use crate::errors::Outcome;
use crate::signals::watched;

/// What happened during a recovery of faces.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RecoveryCounts {
    /// Edges of faces that the Delaunay triangulation lacks.
    pub missing_edges: usize,
    /// Faces that it lacks.
    pub missing_faces: usize,
    /// Changes by flips.
    pub flips: usize,
    /// Edges recovered by flips.
    pub flipped_edges: usize,
    /// Faces recovered by flips.
    pub flipped_faces: usize,
    /// Points that were temporarily put on edges.
    pub segment_points: usize,
    /// Points that were temporarily put in faces.
    pub face_points: usize,
    /// Sectors whose point on the boundary moved into the inside.
    pub suppressed: usize,
    /// Sectors that were joined to a vertex without a point.
    pub joined: usize,
    /// Interior points that were removed again.
    pub thinned: usize,
}

/// Tetrahedra that have given faces.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RecoveredFaces {
    /// The points given, followed by those that were added, (n + k, 3).
    pub points: Table<f64>,
    /// Vertices of the tetrahedra, (t, 4).
    pub tetrahedra: Table<i32>,
    /// The tetrahedron opposite each vertex, -1 if there is none, (t, 4).
    pub neighbors: Table<i32>,
    /// The row of the face opposite each vertex, -1 if there is none, (t, 4).
    pub walls: Table<i32>,
    /// The cell of each tetrahedron, from 0: faces separate cells, (t,).
    pub cells: Column<i32>,
    /// The number of points that were added.
    pub nadded: usize,
    /// What happened.
    pub counts: Py<RecoveryCounts>,
    /// Rows of faces near which no double is left for a point, (k,): then there are no tetrahedra.
    pub crowded: Column<i32>,
}

/// Tetrahedra that have all faces, which may meet only in common vertices and edges. What can be
/// reached from far outside without crossing a face is left out.
#[pyfunction]
pub fn recover_faces<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    faces: PyReadonlyArray2<'py, i32>,
    max_points: usize,
    flips: bool,
    workers: usize,
) -> Outcome<RecoveredFaces> {
    let task = || -> Result<Task<'_>, Error> {
        let points = rows(&points, "points")?;
        let faces = rows(&faces, "faces")?;
        in_range(faces, 0, points.len(), "faces")?;
        Ok(Task {
            points,
            faces,
            max_points,
            flips,
            workers,
        })
    };
    let task = task()?;
    let (made, cells) = watched(py, |watch| {
        let made = recover(task, watch)?;
        let cells = cells_of(&made, watch)?;
        Ok::<_, Error>((made, cells))
    })?;
    arrays_of(py, made, cells, task.points.len())
}

/// The component of each tetrahedron between faces.
fn cells_of(made: &Recovered, watch: &Watch) -> Result<Vec<i32>, Error> {
    let mut open = copied(&made.neighbors)?;
    for (across, face) in open
        .as_flattened_mut()
        .iter_mut()
        .zip(made.walls.as_flattened())
    {
        if *face >= 0 {
            *across = -1;
        }
    }
    labels(&filled(open.len(), true)?, &open, watch)
}

/// The result as Python arrays.
fn arrays_of(
    py: Python<'_>,
    made: Recovered,
    cells: Vec<i32>,
    given: usize,
) -> Outcome<RecoveredFaces> {
    Ok(RecoveredFaces {
        nadded: made.points.len().saturating_sub(given),
        points: table(py, made.points)?,
        tetrahedra: table(py, made.tetrahedra)?,
        neighbors: table(py, made.neighbors)?,
        walls: table(py, made.walls)?,
        cells: column(py, cells),
        counts: Py::new(py, counts_of(made.counts))?,
        crowded: numbers(py, made.crowded),
    })
}

/// The counts as a Python object.
fn counts_of(counts: Counts) -> RecoveryCounts {
    RecoveryCounts {
        missing_edges: counts.missing_edges,
        missing_faces: counts.missing_faces,
        flips: counts.flips,
        flipped_edges: counts.flipped_edges,
        flipped_faces: counts.flipped_faces,
        segment_points: counts.segment_points,
        face_points: counts.face_points,
        suppressed: counts.suppressed,
        joined: counts.joined,
        thinned: counts.thinned,
    }
}
