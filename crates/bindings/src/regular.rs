//! Regular triangulations of weighted points, and triangulations of periodic sets, as arrays.

use delone_core::error::Error;
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
    /// The rows that are not hidden in their order, where all points lie on one line, (k,).
    pub chain: Column<i32>,
    /// The row that stands for each point, -1 for one that is hidden, (n,).
    pub stands_for: Column<i32>,
}

/// The regular triangulation of weighted points; a chain of rows where all are in line.
#[pyfunction]
pub fn regular2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
) -> PyResult<RegularTriangulation> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| regular::regular(points, weights, watch))?;
    Ok(RegularTriangulation {
        simplices: table(py, made.triangles.simplices)?,
        neighbors: table(py, made.triangles.neighbors)?,
        chain: numbers(py, made.chain),
        stands_for: column(py, made.stands_for),
    })
}

/// The regular triangulation of weighted points of space.
#[pyfunction]
pub fn regular3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
) -> PyResult<RegularTriangulation> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| space::regular(points, weights, watch))?;
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
    /// The copies in their order, where all lie on one line, (k,).
    pub chain: Column<i32>,
    /// The row of each copy, (c,).
    pub rows: Column<i32>,
    /// By how many periods each copy is moved, (c, 2).
    pub moved: Table<i32>,
}

/// The Delaunay triangulation (with weights the regular one) of points and their copies one period
/// away: `taken` has rows and by how
/// many periods they are moved; vertices number the copies.
#[pyfunction]
pub fn periodic2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    taken: PyReadonlyArray2<'_, i32>,
) -> PyResult<PeriodicTriangulation> {
    let (points, heavy, taken) = attached(py, || {
        let (points, taken) = (rows(&points, "points")?, rows::<i32, 3>(&taken, "taken")?);
        let heavy = finite_weights(weights.as_ref(), points.len())?;
        let right = |t: &[i32; 3]| {
            t[0] >= 0
                && (t[0] as usize) < points.len()
                && t[1..].iter().all(|k| (-1..=1).contains(k))
        };
        if taken.iter().all(right) {
            return Ok((points, heavy, taken));
        }
        Err(Error::Shape(
            "copies are rows and periods of -1, 0 or 1".into(),
        ))
    })?;
    let made = watched(py, |watch| {
        regular::periodic(points, heavy, periods, taken, watch)
    })?;
    Ok(PeriodicTriangulation {
        simplices: table(py, made.triangles.simplices)?,
        neighbors: table(py, made.triangles.neighbors)?,
        chain: numbers(py, made.chain),
        rows: column(py, made.rows),
        moved: table(py, made.moved)?,
    })
}

/// `(centers, shared)`: the centre of each triangle of copies, and whether it is that of the neighbour
/// across each edge, whose apex is given; corners and apexes are rows and periods, three a triangle.
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
    let (points, heavy, corners, apexes) = attached(py, || {
        let points = rows(&points, "points")?;
        let heavy = finite_weights(weights.as_ref(), points.len())?;
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
            return Ok((points, heavy, corners, apexes));
        }
        Err(Error::Shape(
            "copies are rows and small numbers of periods".into(),
        ))
    })?;
    let (centers, shared) = watched(py, |watch| {
        voronoi::centers(points, heavy, periods, corners, apexes, workers, watch)
    })?;
    Ok((table(py, centers)?, table(py, shared)?))
}
