//! Refined meshes as arrays.

use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use delone::arrays::{Domain, Lines, Refined};
use delone::{Options, Result};
use delone_core::refine::judge;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, numbers, rows, table};
use crate::errors::{attached, raise};
use crate::given::pairs;
use crate::signals::{stoppable, watched};

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
    let (pieces, ends) = attached(py, || {
        let n = rows::<f64, 2>(&points, "points")?.len();
        let ends = lines.as_ref().map(|l| pairs(&l.1, n, "ends"));
        Ok((pairs(&segments, n, "segments")?, ends.transpose()?))
    })?;
    let domain = attached(py, || {
        let lines = match (&lines, &ends) {
            (Some((of, _, on)), Some(ends)) => Some(Lines {
                of: flat(of, "of")?,
                ends,
                on: flat(on, "on")?,
            }),
            _ => None,
        };
        Ok(Domain {
            points: rows(&points, "points")?,
            simplices: rows(&simplices, "simplices")?,
            labels: flat(&labels, "labels")?,
            areas: flat(&areas, "areas")?,
            segments: &pieces,
            lines,
            frozen: flat(&frozen, "frozen")?,
            circles,
            sizes_yield,
        })
    })?;
    let reporter = progress.map(Reporter::new);
    let outcome = stoppable(py, |stop| {
        let tell = |added: usize, smallest: &mut dyn FnMut() -> f64| {
            if let Some(reporter) = &reporter {
                reporter.tell(added, smallest);
            }
        };
        let stop = || reporter.as_ref().is_some_and(Reporter::failed) || stop();
        let options = Options::new().interrupt(&stop).progress(&tell);
        let options = options.min_angle(min_angle).max_points(max_vertices);
        options.refine(domain)
    });
    if let Some(error) = reporter.and_then(Reporter::exception) {
        return Err(error);
    }
    arrays_of(py, outcome?)
}

/// Calls a Python function from time to time, until it raises an exception.
struct Reporter {
    progress: Py<PyAny>,
    called: Mutex<Instant>,
    failure: OnceLock<PyErr>,
}

impl Reporter {
    fn new(progress: Py<PyAny>) -> Self {
        Self {
            progress,
            called: Mutex::new(Instant::now()),
            failure: OnceLock::new(),
        }
    }

    fn tell(&self, added: usize, smallest: &mut dyn FnMut() -> f64) {
        let Ok(mut called) = self.called.try_lock() else {
            return;
        };
        if called.elapsed() < BETWEEN {
            return;
        }
        let angle = smallest();
        let result = Python::attach(|py| self.progress.call1(py, (added, angle)).map(|_| ()));
        if let Err(error) = result {
            let _ = self.failure.set(error);
        }
        *called = Instant::now();
    }

    fn failed(&self) -> bool {
        self.failure.get().is_some()
    }

    fn exception(self) -> Option<PyErr> {
        self.failure.into_inner()
    }
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
