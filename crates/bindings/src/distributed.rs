//! Disks of triangles and the points deepest in circles, for triangulations in tiles.

use delone_core::base::error::{Error, Result};
use delone_core::base::memory::with_room;
use delone_core::distributed::{deepest, disk, within};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, rows, table};
use crate::errors::Outcome;
use crate::signals::watched;

/// Triangles between two checks for interruption.
const LOT: usize = 1 << 18;

/// Center and radius of disks that contain the closed circumdisks; an infinite radius means the
/// whole plane.
#[pyfunction]
pub fn disks2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
) -> Outcome<Table<f64>> {
    let points = rows(&points, "points")?;
    let simplices: &[[i32; 3]] = rows(&simplices, "simplices")?;
    in_range(simplices, 0, points.len(), "simplices")?;
    let disks = watched(py, |watch| -> Result<_> {
        let mut disks = with_room(simplices.len())?;
        for lot in simplices.chunks(LOT) {
            watch.check()?;
            let corners = |s: &[i32; 3]| s.map(|v| points[v as usize]);
            disks.extend(lot.iter().map(|s| disk(corners(s))));
        }
        Ok(disks)
    })?;
    table(py, disks)
}

/// Which triangles have their corners among the first `own` points and their disks in a box.
#[pyfunction]
pub fn within2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    own: usize,
    bounds: [f64; 4],
    workers: usize,
) -> Outcome<Column<bool>> {
    let points = rows(&points, "points")?;
    let simplices: &[[i32; 3]] = rows(&simplices, "simplices")?;
    in_range(simplices, 0, points.len(), "simplices")?;
    let found = watched(py, |watch| {
        within(points, simplices, own, bounds, workers, watch)
    })?;
    Ok(column(py, found))
}

/// Points in conflict with triangles, those deepest in circles first.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct DeepestPoints {
    /// Start of the points of each triangle, and the end, (m + 1,).
    pub starts: Column<i64>,
    /// Rows of points, (k,).
    pub rows: Column<i32>,
    /// Whether these are all points in conflict with the triangle, (m,).
    pub complete: Column<bool>,
}

/// For each triangle (rows of six coordinates), up to `most` points in conflict, and whether these
/// are all.
#[pyfunction]
pub fn deepest2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    corners: PyReadonlyArray2<'_, f64>,
    most: usize,
    workers: usize,
) -> Outcome<DeepestPoints> {
    let points = rows(&points, "points")?;
    let corners: &[[f64; 6]] = rows(&corners, "corners")?;
    let finite = points.as_flattened().iter().all(|x| x.is_finite())
        && corners.as_flattened().iter().all(|x| x.is_finite());
    if !finite {
        let error = Error::Shape("points and corners must be finite".into());
        return Err(error.into());
    }
    let found = watched(py, |watch| {
        let mut triangles = with_room(corners.len())?;
        triangles.extend(
            corners
                .iter()
                .map(|&[a, b, c, d, e, f]| [[a, b], [c, d], [e, f]]),
        );
        deepest(points, &triangles, most, workers, watch)
    })?;
    Ok(DeepestPoints {
        starts: column(py, found.starts),
        rows: column(py, found.rows),
        complete: column(py, found.all),
    })
}
