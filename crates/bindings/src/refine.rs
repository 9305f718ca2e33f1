//! Refined meshes as arrays.

use delone_core::error::{Error, Result};
use delone_core::refine::{Task, refine};
use numpy::{Element, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{column, in_range, rows, table};
use crate::errors::raise;
use crate::triangulation::watched;

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

/// A refined triangulation, by name.
#[pyfunction]
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
) -> PyResult<Bound<'py, PyDict>> {
    let ends = || -> Result<Vec<[u32; 2]>> {
        let n = rows::<f64, 2>(&points, "points")?.len();
        let all: &[[i32; 2]] = rows(&segments, "segments")?;
        in_range(all, 0, n, "segments")?;
        Ok(all.iter().map(|s| s.map(|v| v as u32)).collect())
    };
    let ends = ends().map_err(|e| raise(py, &e))?;
    let task = || -> Result<Task<'_>> {
        let all = rows(&points, "points")?;
        let simplices = rows(&simplices, "simplices")?;
        in_range(simplices, 0, all.len(), "simplices")?;
        Ok(Task {
            points: all,
            simplices,
            labels: each(&labels, simplices.len(), "labels")?,
            areas: each(&areas, simplices.len(), "areas")?,
            segments: &ends,
            frozen: each(&frozen, ends.len(), "frozen")?,
            min_angle,
            max_vertices,
        })
    };
    let task = task().map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| refine(task, watch))?;
    let out = PyDict::new(py);
    out.set_item("added", table(py, made.added)?)?;
    out.set_item("on", column(py, made.on))?;
    out.set_item("simplices", table(py, made.simplices)?)?;
    out.set_item("neighbors", table(py, made.neighbors)?)?;
    out.set_item("sides", table(py, made.sides)?)?;
    out.set_item("labels", column(py, made.labels))?;
    let counts = made.counts;
    out.set_item("counts", (counts.segment, counts.angle, counts.size))?;
    out.set_item("exhausted", made.exhausted)?;
    Ok(out)
}
