//! Regular triangulations of weighted points, and triangulations of periodic points, as arrays.

use delone_core::base::error::Error;
use delone_core::regular::{self as plane, space};
use delone_core::{ndim, voronoi};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, columns, in_many, number_rows, numbers, rows, table};
use crate::errors::Outcome;
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

/// The regular triangulation of weighted points; in 2-D a chain of rows if all are collinear.
#[pyfunction]
pub fn regular(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    workers: usize,
) -> Outcome<RegularTriangulation> {
    if columns(&points) == 2 {
        let points = rows(&points, "points")?;
        let weights = finite_weights(Some(&weights), points.len())?;
        let made = watched(py, |watch| plane::regular(points, weights, workers, watch))?;
        return Ok(RegularTriangulation {
            simplices: table(py, made.triangles.simplices)?,
            neighbors: table(py, made.triangles.neighbors)?,
            chain: numbers(py, made.chain),
            stands_for: column(py, made.stands_for),
        });
    }
    if columns(&points) == 3 {
        let points = rows(&points, "points")?;
        let weights = finite_weights(Some(&weights), points.len())?;
        let made = watched(py, |watch| space::regular(points, weights, workers, watch))?;
        return Ok(RegularTriangulation {
            simplices: table(py, made.tetrahedra.simplices)?,
            neighbors: table(py, made.tetrahedra.neighbors)?,
            chain: column(py, Vec::new()),
            stands_for: column(py, made.stands_for),
        });
    }
    in_many!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let weights = finite_weights(Some(&weights), points.len())?;
        let (made, stands_for) =
            watched(py, |watch| ndim::regular::<D, N, P>(points, weights, watch))?;
        Ok(RegularTriangulation {
            simplices: number_rows(py, &made.simplices)?,
            neighbors: table(py, made.neighbors)?,
            chain: column(py, Vec::new()),
            stands_for: column(py, stands_for),
        })
    })
}

/// A triangulation of periodic points: one triangle of each class of translates.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct PeriodicTriangulation {
    /// Vertices of the triangles, (m, 3).
    pub simplices: Table<i32>,
    /// The number of periods by which each corner is shifted, x and y by turns, (m, 6).
    pub offsets: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// The same with its corner, 3 t + k, (m, 3).
    pub partners: Table<i32>,
    /// Rows that are not hidden, in order along the line, if there is no triangle, (k,).
    pub chain: Column<i32>,
}

/// The Delaunay triangulation (with weights the regular one) of points that repeat after `periods`,
/// 0 for none; points must lie within one period.
#[pyfunction]
pub fn periodic2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    workers: usize,
) -> Outcome<PeriodicTriangulation> {
    let points = rows(&points, "points")?;
    let point_weights = finite_weights(weights.as_ref(), points.len())?;
    let made = watched(py, |watch| {
        plane::periodic(points, point_weights, periods, workers, watch)
    })?;
    let neighbors: Vec<[i32; 3]> = made
        .partners
        .iter()
        .map(|codes| codes.map(|code| code.div_euclid(3)))
        .collect();
    Ok(PeriodicTriangulation {
        simplices: table(py, made.simplices)?,
        offsets: table(py, made.offsets)?,
        neighbors: table(py, neighbors)?,
        partners: table(py, made.partners)?,
        chain: column(py, made.chain),
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
) -> Outcome<(Table<f64>, Table<bool>)> {
    let points = rows(&points, "points")?;
    let point_weights = finite_weights(weights.as_ref(), points.len())?;
    let corners = rows::<i32, 3>(&corners, "corners")?;
    let apexes = rows(&apexes, "apexes")?;
    let right = |t: &[i32; 3]| {
        t[0] >= 0 && (t[0] as usize) < points.len() && t[1..].iter().all(|k| (-9..=9).contains(k))
    };
    let paired = corners.len() == apexes.len() && corners.len() % 3 == 0;
    if !paired || !corners.iter().chain(apexes).all(right) {
        let text = "copies must be rows and shifts of -9 to 9 periods";
        return Err(Error::Shape(text.into()).into());
    }
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
