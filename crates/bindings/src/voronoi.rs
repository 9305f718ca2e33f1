//! Voronoi and power diagrams, and polygons cut from them, as arrays.

use delone_core::error::{Error, Result};
use delone_core::voronoi::{self, Cells, Convex, Given, Outline};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{
    Column, Table, are_starts, column, each_in_range, flat, in_range, rows, table,
};
use crate::errors::{attached, detached, raise};
use crate::given::{checked, unequal, weights_of};
use crate::signals::watched;

/// A triangulation whose dual is wanted.
pub(crate) fn given<'a, const D: usize, const N: usize>(
    points: &'a PyReadonlyArray2<'_, f64>,
    weights: Option<&'a PyReadonlyArray1<'_, f64>>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given<'a, D, N>> {
    let found = checked(points, simplices, neighbors)?;
    Ok(Given {
        points: found.points,
        weights: weights_of(weights, found.points.len())?,
        simplices: found.simplices,
        neighbors: found.neighbors,
    })
}

/// The diagram of a triangulation; of the regular one, where there are weights.
#[pyfunction]
pub fn voronoi2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
    workers: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let given = attached(py, || {
        given(&points, weights.as_ref(), &simplices, &neighbors)
    })?;
    let made = watched(py, |watch| voronoi::diagram(given, workers, watch))?;
    let out = PyDict::new(py);
    out.set_item("vertices", table(py, made.vertices)?)?;
    out.set_item("triangle_vertex", column(py, made.triangle_vertex))?;
    out.set_item("sites", table(py, made.ridges.sites)?)?;
    out.set_item("ends", table(py, made.ridges.ends)?)?;
    out.set_item("rays", table(py, made.ridges.rays)?)?;
    out.set_item("beyond", table(py, made.ridges.beyond)?)?;
    out.set_item("region", column(py, made.regions.of_point))?;
    out.set_item("site", column(py, made.regions.site))?;
    out.set_item("starts", column(py, made.regions.starts))?;
    out.set_item("region_vertices", column(py, made.regions.vertices))?;
    out.set_item("region_ridges", column(py, made.regions.ridges))?;
    Ok(out)
}

/// Polygons as arrays: `(starts, corners, ridges)`.
type Cut = (Column<i32>, Table<f64>, Column<i32>);

/// The cells of a diagram, as `voronoi2` gives it, cut to a box.
#[pyfunction]
pub fn voronoi_clip2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    diagram: &Bound<'py, PyDict>,
    bounds: [f64; 4],
    workers: usize,
) -> PyResult<Cut> {
    let pairs =
        |name: &str| -> PyResult<PyReadonlyArray2<'py, f64>> { item(diagram, name)?.extract() };
    let codes =
        |name: &str| -> PyResult<PyReadonlyArray2<'py, i32>> { item(diagram, name)?.extract() };
    let list =
        |name: &str| -> PyResult<PyReadonlyArray1<'py, i32>> { item(diagram, name)?.extract() };
    let (vertices, rays, beyond) = (pairs("vertices")?, pairs("rays")?, pairs("beyond")?);
    let (sites, ends) = (codes("sites")?, codes("ends")?);
    let (site, starts) = (list("site")?, list("starts")?);
    let (region_vertices, region_ridges) = (list("region_vertices")?, list("region_ridges")?);
    let cells = attached(py, || {
        let points = rows(&points, "points")?;
        let cells = Cells {
            points,
            weights: weights_of(weights.as_ref(), points.len())?,
            vertices: rows(&vertices, "vertices")?,
            sites: rows(&sites, "sites")?,
            ends: rows(&ends, "ends")?,
            rays: rows(&rays, "rays")?,
            beyond: rows(&beyond, "beyond")?,
            site: flat(&site, "site")?,
            starts: flat(&starts, "starts")?,
            entry_vertices: flat(&region_vertices, "region_vertices")?,
            entry_ridges: flat(&region_ridges, "region_ridges")?,
        };
        in_range(cells.sites, 0, cells.points.len(), "sites")?;
        are_starts(cells.starts, cells.entry_vertices.len())?;
        each_in_range(
            cells.entry_vertices,
            -1,
            cells.vertices.len(),
            "region_vertices",
        )?;
        each_in_range(cells.entry_ridges, 0, cells.sites.len(), "region_ridges")?;
        if cells.ends.len() != cells.sites.len() || cells.starts.len() != cells.site.len() + 1 {
            return Err(unequal());
        }
        Ok(cells)
    })?;
    let [left, bottom, right, top] = bounds;
    let made = watched(py, |watch| {
        voronoi::clip(cells, [left, bottom], [right, top], workers, watch)
    })?;
    Ok((
        column(py, made.starts),
        table(py, made.points)?,
        column(py, made.ridges),
    ))
}

pub(crate) fn item<'py>(diagram: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    diagram.get_item(name)?.ok_or_else(|| {
        raise(
            diagram.py(),
            &Error::Shape(format!("the diagram has no {name}")),
        )
    })
}

/// `(areas, centroids, perimeters)` of polygons.
#[pyfunction]
pub fn measures2(
    py: Python<'_>,
    starts: PyReadonlyArray1<'_, i32>,
    corners: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> PyResult<(Column<f64>, Table<f64>, Column<f64>)> {
    let (starts, corners) = attached(py, || {
        let (starts, corners) = (flat(&starts, "starts")?, rows(&corners, "corners")?);
        are_starts(starts, corners.len())?;
        Ok((starts, corners))
    })?;
    let made = watched(py, |watch| {
        voronoi::measures(starts, corners, workers, watch)
    })?;
    Ok((
        column(py, made.areas),
        table(py, made.centroids)?,
        column(py, made.perimeters),
    ))
}

/// For each polygon its group of those that no segment comes near, or -1; and the number of groups.
#[pyfunction]
pub fn touched2(
    py: Python<'_>,
    starts: PyReadonlyArray1<'_, i32>,
    corners: PyReadonlyArray2<'_, f64>,
    ridges: PyReadonlyArray1<'_, i32>,
    segments: PyReadonlyArray2<'_, f64>,
) -> PyResult<(Column<i32>, usize)> {
    let (starts, corners, ridges, segments) = attached(py, || {
        let (starts, corners) = (flat(&starts, "starts")?, rows(&corners, "corners")?);
        are_starts(starts, corners.len())?;
        let ridges = flat(&ridges, "ridges")?;
        if ridges.len() != corners.len() {
            return Err(Error::Shape("ridges and corners differ in length".into()));
        }
        Ok((starts, corners, ridges, rows(&segments, "segments")?))
    })?;
    let (groups, count) = detached(py, || voronoi::touched(starts, corners, ridges, segments))?;
    Ok((column(py, groups), count))
}

/// What an outline, rings with their inside to the left, leaves of some of the polygons: for each of `rows`,
/// of whose first corner `inside` tells whether the outline has it, -1 (doubtful), 0 (nothing), 1 (all)
/// or 2 (parts), and the parts as arrays.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn pieces2<'py>(
    py: Python<'py>,
    starts: PyReadonlyArray1<'py, i32>,
    corners: PyReadonlyArray2<'py, f64>,
    ridges: PyReadonlyArray1<'py, i32>,
    rows: PyReadonlyArray1<'py, i32>,
    inside: PyReadonlyArray1<'py, bool>,
    rings: PyReadonlyArray1<'py, i32>,
    outline: PyReadonlyArray2<'py, f64>,
    workers: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (cells, rows, inside, outline) = attached(py, || {
        let cells = Convex {
            starts: flat(&starts, "starts")?,
            corners: crate::arrays::rows(&corners, "corners")?,
            ridges: flat(&ridges, "ridges")?,
        };
        are_starts(cells.starts, cells.corners.len())?;
        let outline = Outline {
            starts: flat(&rings, "rings")?,
            points: crate::arrays::rows(&outline, "outline")?,
        };
        are_starts(outline.starts, outline.points.len())?;
        let (rows, inside) = (flat(&rows, "rows")?, flat(&inside, "inside")?);
        each_in_range(rows, 0, cells.starts.len() - 1, "rows")?;
        if cells.ridges.len() != cells.corners.len() || rows.len() != inside.len() {
            return Err(unequal());
        }
        Ok((cells, rows, inside, outline))
    })?;
    let made = watched(py, |watch| {
        voronoi::pieces(cells, rows, inside, outline, workers, watch)
    })?;
    let out = PyDict::new(py);
    out.set_item("left", column(py, made.left))?;
    out.set_item("cells", column(py, made.cells))?;
    out.set_item("parts", column(py, made.parts))?;
    out.set_item("rings", column(py, made.rings))?;
    out.set_item("points", table(py, made.points)?)?;
    out.set_item("ridges", column(py, made.ridges))?;
    out.set_item("areas", column(py, made.measures.areas))?;
    out.set_item("centroids", table(py, made.measures.centroids)?)?;
    out.set_item("perimeters", column(py, made.measures.perimeters))?;
    Ok(out)
}
