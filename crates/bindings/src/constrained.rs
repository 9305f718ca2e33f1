//! Constrained triangulations as arrays.

use delone_core::Point2;
use delone_core::constrained::{
    Constrained, Options, Rule, components, constrain, polygon, simple_ring,
};
use delone_core::error::{Error, Result};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Column, Table, column, frozen, in_range, number_rows, numbers, rows, table};
use crate::errors::raise;
use crate::given::pairs;
use crate::signals::watched;
use crate::triangulation::method_of;

/// The constrained triangulation of points and segments, by name.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options, one by one")]
pub fn constrained2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    segments: PyReadonlyArray2<'py, i32>,
    split: bool,
    conforming: bool,
    max_vertices: usize,
    method: &str,
    workers: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let method = method_of(method)?;
    let options = Options {
        split,
        conforming,
        max_vertices,
        method,
        workers,
    };
    let points: &[Point2] = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let segments = pairs(&segments, points.len(), "segments").map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| constrain(points, &segments, options, watch))?;
    by_name(py, made)
}

fn by_name(py: Python<'_>, made: Constrained) -> PyResult<Bound<'_, PyDict>> {
    let out = PyDict::new(py);
    let sub = made.subsegments;
    out.set_item("added", table(py, made.added)?)?;
    out.set_item("simplices", table(py, made.arrays.simplices)?)?;
    out.set_item("neighbors", table(py, made.arrays.neighbors)?)?;
    out.set_item("constrained", table(py, made.constrained)?)?;
    out.set_item("duplicates", number_rows(py, made.duplicates)?)?;
    out.set_item("segments", table(py, sub.ends)?)?;
    out.set_item("source_start", column(py, sub.start))?;
    out.set_item("source", column(py, sub.source))?;
    out.set_item("forward", column(py, sub.forward))?;
    out.set_item("zero", numbers(py, made.zero))?;
    out.set_item("through", number_rows(py, made.through)?)?;
    out.set_item("crossings", number_rows(py, made.crossings)?)?;
    let stages = made.stages.iter();
    let stages: Vec<_> = stages.map(|(name, t)| (*name, t.as_secs_f64())).collect();
    out.set_item("stages", stages)?;
    Ok(out)
}

/// Components of triangles that share edges which are not constrained.
#[pyfunction]
pub fn components2(
    py: Python<'_>,
    neighbors: PyReadonlyArray2<'_, i32>,
    constrained: PyReadonlyArray2<'_, bool>,
) -> PyResult<Column<i32>> {
    let given = || -> Result<_> {
        let sides: &[[i32; 3]] = rows(&neighbors, "neighbors")?;
        let walls: &[[bool; 3]] = rows(&constrained, "constrained")?;
        if sides.len() != walls.len() {
            return Err(Error::Shape(
                "constrained and neighbors differ in length".into(),
            ));
        }
        in_range(sides, -1, sides.len(), "neighbors")?;
        Ok((sides, walls))
    };
    let (sides, walls) = given().map_err(|e| raise(py, &e))?;
    let labels = watched(py, |watch| components(sides, walls, watch))?;
    Ok(column(py, labels))
}

/// The triangles inside rings, and the vertices added where they cross.
#[pyfunction]
pub fn polygon2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray1<'_, i32>,
    nonzero: bool,
) -> PyResult<(Table<f64>, Table<i32>)> {
    let points: &[Point2] = rows(&points, "points").map_err(|e| raise(py, &e))?;
    let starts = bounds(&starts, points.len()).map_err(|e| raise(py, &e))?;
    let rule = if nonzero {
        Rule::NonZero
    } else {
        Rule::EvenOdd
    };
    let filled = watched(py, |watch| polygon(points, &starts, rule, watch))?;
    Ok((table(py, filled.added)?, table(py, filled.simplices)?))
}

/// A copy of the points and the triangles of one ring, read-only; nothing unless it is known to be
/// simple, and `points` an array that can be read as it lies.
///
/// It holds the GIL: such rings are short, and giving it back would cost as much as the triangles.
#[pyfunction]
pub fn ring2(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
) -> PyResult<Option<(Table<f64>, Table<i32>)>> {
    let Ok(points) = points.extract::<PyReadonlyArray2<'_, f64>>() else {
        return Ok(None);
    };
    let Ok(points) = rows::<f64, 2>(&points, "points") else {
        return Ok(None);
    };
    let Some(simplices) = simple_ring(points).map_err(|e| raise(py, &e))? else {
        return Ok(None);
    };
    Ok(Some((frozen(py, points)?, frozen(py, &simplices)?)))
}

/// Where each ring begins, and the end: ascending, within `n` points.
fn bounds(starts: &PyReadonlyArray1<'_, i32>, n: usize) -> Result<Vec<usize>> {
    let starts = starts
        .as_slice()
        .map_err(|_| Error::Shape("starts is not contiguous".into()))?;
    let ascend = starts.windows(2).all(|w| w[0] <= w[1]);
    let inside = starts.iter().all(|&s| s >= 0 && s as usize <= n);
    if !(ascend && inside) {
        let message = format!("starts must ascend from 0 to {n} at most");
        return Err(Error::Shape(message));
    }
    Ok(starts.iter().map(|&s| s as usize).collect())
}
