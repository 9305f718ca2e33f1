//! Improved tetrahedra as arrays.

use delone_core::error::{Error, Result};
use delone_core::improve::{Improved, Task, improve};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{column, flat, in_range, rows, table};
use crate::errors::raise;
use crate::signals::watched;

/// Better tetrahedra, by name. `progress` is called after each pass with its number and how many
/// tetrahedra are below the bound.
#[pyfunction]
#[pyo3(signature = (points, simplices, labels, fixed, min_angle, flips, smooth, exude, turn, passes,
                    progress=None))]
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
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
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
        })
    };
    let task = task().map_err(|e| raise(py, &e))?;
    let mut refused = None;
    let mut tell = |pass: usize, below: usize| -> Result<()> {
        let Some(progress) = &progress else {
            return Ok(());
        };
        let answer = Python::attach(|py| progress.call1(py, (pass, below)).map(|_| ()));
        answer.map_err(|error| {
            refused = Some(error);
            Error::Interrupted
        })
    };
    let outcome = watched(py, |watch| improve(task, watch, &mut tell));
    if let Some(error) = refused {
        return Err(error);
    }
    dictionary(py, outcome?)
}

/// The arrays, by name.
fn dictionary(py: Python<'_>, made: Improved) -> PyResult<Bound<'_, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("points", table(py, made.points)?)?;
    out.set_item("simplices", table(py, made.simplices)?)?;
    out.set_item("neighbors", table(py, made.neighbors)?)?;
    out.set_item("weights", column(py, made.weights))?;
    out.set_item("labels", column(py, made.labels))?;
    let counts = PyDict::new(py);
    for (name, count) in [
        ("edges", made.counts.edges),
        ("boundary", made.counts.boundary),
        ("faces", made.counts.faces),
        ("moves", made.counts.moves),
        ("weights", made.counts.weights),
        ("passes", made.counts.passes),
        ("refused", made.counts.refused),
    ] {
        counts.set_item(name, count)?;
    }
    out.set_item("counts", counts)?;
    out.set_item("exhausted", made.exhausted)?;
    Ok(out)
}
