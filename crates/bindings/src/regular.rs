//! Regular triangulations of weighted points, and triangulations of periodic sets, as arrays.

use delone_core::error::Error;
use delone_core::{regular, regular3 as space, voronoi};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{column, numbers, rows, table};
use crate::errors::attached;
use crate::given::finite_weights;
use crate::signals::watched;

/// `(simplices, neighbors, chain, stands_for)`.
type Weighed = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

/// The regular triangulation of weighted points; a chain of rows where all are in line.
#[pyfunction]
pub fn regular2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
) -> PyResult<Weighed> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| regular::regular(points, weights, watch))?;
    Ok((
        table(py, made.triangles.simplices)?,
        table(py, made.triangles.neighbors)?,
        numbers(py, made.chain),
        column(py, made.stands_for),
    ))
}

/// `(simplices, neighbors, stands_for)`.
type Weighed3 = (Py<PyAny>, Py<PyAny>, Py<PyAny>);

/// The regular triangulation of weighted points of space.
#[pyfunction]
pub fn regular3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
) -> PyResult<Weighed3> {
    let (points, weights) = attached(py, || {
        let points = rows(&points, "points")?;
        Ok((points, finite_weights(Some(&weights), points.len())?))
    })?;
    let made = watched(py, |watch| space::regular(points, weights, watch))?;
    Ok((
        table(py, made.tetrahedra.simplices)?,
        table(py, made.tetrahedra.neighbors)?,
        column(py, made.stands_for),
    ))
}

/// `(simplices, neighbors, chain, rows, moved)`.
type Repeated = (Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>, Py<PyAny>);

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
) -> PyResult<Repeated> {
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
    Ok((
        table(py, made.triangles.simplices)?,
        table(py, made.triangles.neighbors)?,
        numbers(py, made.chain),
        column(py, made.rows),
        table(py, made.moved)?,
    ))
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
) -> PyResult<(Py<PyAny>, Py<PyAny>)> {
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
