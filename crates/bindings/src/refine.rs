//! Refined meshes as arrays.

use std::time::{Duration, Instant};

use delone_core::error::{Error, Result};
use delone_core::refine::{Lines, Refined, Task, judge, refine_telling};
use numpy::{Element, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Column, column, in_range, numbers, rows, table};
use crate::errors::raise;
use crate::given::pairs;
use crate::signals::watched;

/// A vector of one entry for each of `n` things.
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

/// Least time between two calls of `progress`.
const BETWEEN: Duration = Duration::from_millis(100);

/// A refined triangulation, by name. `progress` is called with the number of vertices added and the
/// smallest angle now.
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
) -> PyResult<Bound<'py, PyDict>> {
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
    let mut told = Instant::now();
    let mut refused = None;
    let mut tell = |added: usize, smallest: &mut dyn FnMut() -> f64| -> Result<()> {
        let Some(progress) = &progress else {
            return Ok(());
        };
        if told.elapsed() < BETWEEN {
            return Ok(());
        }
        let angle = smallest();
        let answer = Python::attach(|py| progress.call1(py, (added, angle)).map(|_| ()));
        told = Instant::now();
        answer.map_err(|error| {
            refused = Some(error);
            Error::Interrupted
        })
    };
    let outcome = watched(py, |watch| refine_telling(task, watch, &mut tell));
    if let Some(error) = refused {
        return Err(error);
    }
    dictionary(py, outcome?)
}

/// The arrays, by name.
fn dictionary(py: Python<'_>, made: Refined) -> PyResult<Bound<'_, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("added", table(py, made.added)?)?;
    out.set_item("on", column(py, made.on))?;
    out.set_item("simplices", table(py, made.simplices)?)?;
    out.set_item("neighbors", table(py, made.neighbors)?)?;
    out.set_item("sides", table(py, made.sides)?)?;
    out.set_item("labels", column(py, made.labels))?;
    out.set_item("needles", column(py, made.needles))?;
    let counts = made.counts;
    out.set_item("counts", (counts.segment, counts.angle, counts.size))?;
    out.set_item("exhausted", made.exhausted)?;
    Ok(out)
}

/// The triangles with an angle below a bound, given by its squared cosine; those among which the
/// smallest and the largest angles are; and those that are beyond the range of doubles.
#[pyfunction]
pub fn judge2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    cos2: f64,
) -> PyResult<(Column<i32>, Column<i32>, Column<i32>)> {
    let given = || -> Result<_> {
        let all = rows(&points, "points")?;
        let simplices: &[[i32; 3]] = rows(&simplices, "simplices")?;
        in_range(simplices, 0, all.len(), "simplices")?;
        Ok((all, simplices))
    };
    let (points, simplices) = given().map_err(|e| raise(py, &e))?;
    let found = watched(py, |watch| judge(points, simplices, cos2, watch))?;
    let all = [found.below, found.extremes, found.beyond];
    let [below, extremes, beyond] = all.map(|triangles| numbers(py, triangles));
    Ok((below, extremes, beyond))
}
