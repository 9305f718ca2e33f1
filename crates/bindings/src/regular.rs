//! Regular triangulations of weighted points, and triangulations of periodic points, as arrays.

use delone::Error;
use delone_core::{regular, regular3 as space, voronoi};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, numbers, rows, table};
use crate::errors::attached;
use crate::given::finite_weights;
use crate::signals::watched;

/// The regular triangulation of weighted points, of either dimension d.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RegularTriangulation {
    /// Vertices of the simplices, (m, d + 1).
    pub simplices: Table<i32>,
    /// The simplex opposite each vertex, -1 outside, (m, d + 1).
    pub neighbors: Table<i32>,
    /// Rows that are not hidden, in order along the line, if all points are collinear, (k,).
    pub chain: Column<i32>,
    /// The row that represents each point, -1 for hidden points, (n,).
    pub stands_for: Column<i32>,
}

/// The regular triangulation of weighted 2-D points; a chain of rows if all are collinear.
#[pyfunction]
pub fn regular2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    workers: usize,
) -> PyResult<RegularTriangulation> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| {
        regular::regular(points, weights, workers, watch)
    })?;
    Ok(RegularTriangulation {
        simplices: table(py, made.triangles.simplices)?,
        neighbors: table(py, made.triangles.neighbors)?,
        chain: numbers(py, made.chain),
        stands_for: column(py, made.stands_for),
    })
}

/// The regular triangulation of weighted 3-D points.
#[pyfunction]
pub fn regular3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    workers: usize,
) -> PyResult<RegularTriangulation> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| space::regular(points, weights, workers, watch))?;
    Ok(RegularTriangulation {
        simplices: table(py, made.tetrahedra.simplices)?,
        neighbors: table(py, made.tetrahedra.neighbors)?,
        chain: column(py, Vec::new()),
        stands_for: column(py, made.stands_for),
    })
}

/// The triangulation of points and their copies.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct PeriodicTriangulation {
    /// Vertices of the triangles, as numbers of copies, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// The copies, in order along the line, if all are collinear, (k,).
    pub chain: Column<i32>,
    /// The row of each copy, (c,).
    pub rows: Column<i32>,
    /// The number of periods by which each copy is shifted, (c, 2).
    pub moved: Table<i32>,
}

/// The Delaunay triangulation (with weights the regular one) of points and their copies one period
/// away: `taken` has the rows and shifts of the copies; vertices are numbers of copies.
#[pyfunction]
pub fn periodic2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    taken: PyReadonlyArray2<'_, i32>,
) -> PyResult<PeriodicTriangulation> {
    let (points, point_weights, taken) = attached(py, || {
        let (points, taken) = (rows(&points, "points")?, rows::<i32, 3>(&taken, "taken")?);
        let point_weights = finite_weights(weights.as_ref(), points.len())?;
        let right = |t: &[i32; 3]| {
            t[0] >= 0
                && (t[0] as usize) < points.len()
                && t[1..].iter().all(|k| (-1..=1).contains(k))
        };
        if taken.iter().all(right) {
            return Ok((points, point_weights, taken));
        }
        Err(Error::Shape(
            "copies must be rows and shifts of -1, 0 or 1 periods".into(),
        ))
    })?;
    let made = watched(py, |watch| {
        regular::periodic(points, point_weights, periods, taken, watch)
    })?;
    Ok(PeriodicTriangulation {
        simplices: table(py, made.triangles.simplices)?,
        neighbors: table(py, made.triangles.neighbors)?,
        chain: numbers(py, made.chain),
        rows: column(py, made.rows),
        moved: table(py, made.moved)?,
    })
}

/// `(centers, shared)`: the center of each triangle of copies, and whether the neighbor across each
/// edge, with a given apex, has the same center; corners and apexes are rows and shifts, three per
/// triangle.
#[pyfunction]
pub fn periodic_centers2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    corners: PyReadonlyArray2<'_, i32>,
    apexes: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> PyResult<(Table<f64>, Table<bool>)> {
    let (points, point_weights, corners, apexes) = attached(py, || {
        let points = rows(&points, "points")?;
        let point_weights = finite_weights(weights.as_ref(), points.len())?;
        let (corners, apexes) = (
            rows::<i32, 3>(&corners, "corners")?,
            rows(&apexes, "apexes")?,
        );
        let right = |t: &[i32; 3]| {
            t[0] >= 0
                && (t[0] as usize) < points.len()
                && t[1..].iter().all(|k| (-9..=9).contains(k))
        };
        if corners.len() == apexes.len()
            && corners.len() % 3 == 0
            && corners.iter().chain(apexes).all(right)
        {
            return Ok((points, point_weights, corners, apexes));
        }
        Err(Error::Shape(
            "copies must be rows and shifts of -9 to 9 periods".into(),
        ))
    })?;
    let (centers, shared) = watched(py, |watch| {
        voronoi::centers(
            points,
            point_weights,
            periods,
            corners,
            apexes,
            workers,
            watch,
        )
    })?;
    Ok((table(py, centers)?, table(py, shared)?))
}
