//! Refined meshes as arrays.

use std::time::{Duration, Instant};

use delone_core::error::{Error, Result};
use delone_core::refine::{Lines, Refined, Task, judge, refine_telling};
use numpy::{Element, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, numbers, rows, table};
use crate::errors::raise;
use crate::given::pairs;
use crate::signals::watched;

/// A vector that must have `n` entries.
fn each<'a, T: Element>(
    array: &'a PyReadonlyArray1<'_, T>,
    n: usize,
    name: &str,
) -> Result<&'a [T]> {
    let values = array
        .as_slice()
        .map_err(|_| Error::Shape(format!("{name} is not contiguous")))?;
    if values.len() == n {
        Ok(values)
    } else {
        let found = values.len();
        Err(Error::Shape(format!("{name} has {found} entries, not {n}")))
    }
}

/// `(of, ends, on)`: the line of each segment, the ends of lines, the line of each point or -1.
type Given<'py> = (
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
);

/// Minimum time between two calls of `progress`.
const BETWEEN: Duration = Duration::from_millis(100);

/// A refined triangulation of the hull.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RefinedMesh {
    /// Added vertices; they follow the input vertices, (a, 2).
    pub added: Table<f64>,
    /// The line that each of these lies on, or -1, (a,).
    pub on: Column<i32>,
    /// Vertices of the triangles, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// The line under the edge opposite each vertex, or -1, (m, 3).
    pub sides: Table<i32>,
    /// The label of each triangle, -1 outside of the domain, (m,).
    pub labels: Column<i32>,
    /// The number of the unrefined needle that contains each triangle, or -1, (m,).
    pub needles: Column<i32>,
    /// Number of vertices added on segments.
    pub for_segments: usize,
    /// Number of vertices added inside for angles.
    pub for_angles: usize,
    /// Number of vertices added inside for sizes.
    pub for_sizes: usize,
    /// Whether the limit on vertices was reached.
    pub exhausted: bool,
}

/// Refines a triangulation. `progress` is called with the number of added vertices and the current
/// smallest angle.
#[pyfunction]
#[pyo3(signature = (points, simplices, labels, areas, segments, frozen, min_angle, max_vertices,
                    lines=None, circles=false, sizes_yield=false, progress=None))]
#[expect(clippy::too_many_arguments, reason = "one array each")]
pub fn refine2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    areas: PyReadonlyArray1<'py, f64>,
    segments: PyReadonlyArray2<'py, i32>,
    frozen: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
    max_vertices: usize,
    lines: Option<Given<'py>>,
    circles: bool,
    sizes_yield: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<RefinedMesh> {
    let found = || -> Result<_> {
        let n = rows::<f64, 2>(&points, "points")?.len();
        let ends = lines.as_ref().map(|l| pairs(&l.1, n, "ends"));
        Ok((pairs(&segments, n, "segments")?, ends.transpose()?))
    };
    let (pieces, ends) = found().map_err(|e| raise(py, &e))?;
    let task = || -> Result<Task<'_>> {
        let all = rows(&points, "points")?;
        let simplices = rows(&simplices, "simplices")?;
        in_range(simplices, 0, all.len(), "simplices")?;
        let lines = match (&lines, &ends) {
            (Some((of, _, on)), Some(ends)) => {
                let of: &[[i32; 1]] = each(of, pieces.len(), "of")?.as_chunks().0;
                in_range(of, 0, ends.len(), "of")?;
                let on: &[[i32; 1]] = each(on, all.len(), "on")?.as_chunks().0;
                in_range(on, -1, ends.len(), "on")?;
                Some(Lines {
                    of: of.as_flattened(),
                    ends,
                    on: on.as_flattened(),
                })
            }
            _ => None,
        };
        let count = ends.as_ref().map_or(pieces.len(), Vec::len);
        Ok(Task {
            points: all,
            simplices,
            labels: each(&labels, simplices.len(), "labels")?,
            areas: each(&areas, simplices.len(), "areas")?,
            segments: &pieces,
            lines,
            frozen: each(&frozen, count, "frozen")?,
            min_angle,
            circles,
            sizes_yield,
            max_vertices,
        })
    };
    let task = task().map_err(|e| raise(py, &e))?;
    let mut called = Instant::now();
    let mut failure = None;
    let mut notify = |added: usize, smallest: &mut dyn FnMut() -> f64| -> Result<()> {
        let Some(progress) = &progress else {
            return Ok(());
        };
        if called.elapsed() < BETWEEN {
            return Ok(());
        }
        let angle = smallest();
        let result = Python::attach(|py| progress.call1(py, (added, angle)).map(|_| ()));
        called = Instant::now();
        result.map_err(|error| {
            failure = Some(error);
            Error::Interrupted
        })
    };
    let outcome = watched(py, |watch| refine_telling(task, watch, &mut notify));
    if let Some(error) = failure {
        return Err(error);
    }
    arrays_of(py, outcome?)
}

/// The result as Python arrays.
fn arrays_of(py: Python<'_>, made: Refined) -> PyResult<RefinedMesh> {
    Ok(RefinedMesh {
        added: table(py, made.added)?,
        on: column(py, made.on),
        simplices: table(py, made.simplices)?,
        neighbors: table(py, made.neighbors)?,
        sides: table(py, made.sides)?,
        labels: column(py, made.labels),
        needles: column(py, made.needles),
        for_segments: made.counts.segment,
        for_angles: made.counts.angle,
        for_sizes: made.counts.size,
        exhausted: made.exhausted,
    })
}

/// Triangles with small, extreme or unknown angles.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct JudgedTriangles {
    /// Those with an angle below the bound, (k,).
    pub below: Column<i32>,
    /// Those that include the smallest and the largest angle, (e,).
    pub extremes: Column<i32>,
    /// Those that are beyond the range of doubles, (b,).
    pub beyond: Column<i32>,
}

/// The triangles with an angle below a bound, given by its squared cosine; those that include the
/// smallest and the largest angle; and those beyond the range of doubles.
#[pyfunction]
pub fn judge2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    cos2: f64,
) -> PyResult<JudgedTriangles> {
    let given = || -> Result<_> {
        let all = rows(&points, "points")?;
        let simplices: &[[i32; 3]] = rows(&simplices, "simplices")?;
        in_range(simplices, 0, all.len(), "simplices")?;
        Ok((all, simplices))
    };
    let (points, simplices) = given().map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| judge(points, simplices, cos2, watch))?;
    Ok(JudgedTriangles {
        below: numbers(py, found.below),
        extremes: numbers(py, found.extremes),
        beyond: numbers(py, found.beyond),
    })
}
