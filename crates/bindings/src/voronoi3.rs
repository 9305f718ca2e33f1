//! Voronoi and power diagrams of space, their measures, and cells cut to a polyhedron, as arrays.

use delone_core::error::Result;
use delone_core::voronoi3::{self as dual, Cells, Clip, Measures};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{are_starts, column, each_in_range, flat, in_range, rows, table};
use crate::errors::{attached, raise};
use crate::given::{unequal, weights_of};
use crate::signals::watched;
use crate::voronoi::{given, item};

/// The diagram of a triangulation; of the regular one, where there are weights.
#[pyfunction]
pub fn voronoi3<'py>(
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
    let made = watched(py, |watch| dual::diagram(given, workers, watch))?;
    let out = PyDict::new(py);
    out.set_item("vertices", table(py, made.vertices)?)?;
    out.set_item("simplex_vertex", column(py, made.simplex_vertex))?;
    out.set_item("sites", table(py, made.ridges.sites)?)?;
    out.set_item("starts", column(py, made.ridges.starts))?;
    out.set_item("entries", column(py, made.ridges.entries))?;
    out.set_item("rays", table(py, made.ridges.rays)?)?;
    out.set_item("region", column(py, made.regions.of_point))?;
    out.set_item("site", column(py, made.regions.site))?;
    out.set_item("region_starts", column(py, made.regions.starts))?;
    out.set_item("region_vertices", column(py, made.regions.vertices))?;
    out.set_item("region_ridge_starts", column(py, made.regions.ridge_starts))?;
    out.set_item("region_ridges", column(py, made.regions.ridges))?;
    Ok(out)
}

/// The arrays of a diagram, borrowed.
struct Borrowed<'py> {
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    vertices: PyReadonlyArray2<'py, f64>,
    sites: PyReadonlyArray2<'py, i32>,
    starts: PyReadonlyArray1<'py, i32>,
    entries: PyReadonlyArray1<'py, i32>,
    site: PyReadonlyArray1<'py, i32>,
    ridge_starts: PyReadonlyArray1<'py, i32>,
    ridges: PyReadonlyArray1<'py, i32>,
}

impl<'py> Borrowed<'py> {
    fn new(
        points: PyReadonlyArray2<'py, f64>,
        weights: Option<PyReadonlyArray1<'py, f64>>,
        diagram: &Bound<'py, PyDict>,
    ) -> PyResult<Self> {
        Ok(Self {
            points,
            weights,
            vertices: item(diagram, "vertices")?.extract()?,
            sites: item(diagram, "sites")?.extract()?,
            starts: item(diagram, "starts")?.extract()?,
            entries: item(diagram, "entries")?.extract()?,
            site: item(diagram, "site")?.extract()?,
            ridge_starts: item(diagram, "region_ridge_starts")?.extract()?,
            ridges: item(diagram, "region_ridges")?.extract()?,
        })
    }

    fn cells(&self) -> Result<Cells<'_>> {
        let points = rows(&self.points, "points")?;
        let cells = Cells {
            points,
            weights: weights_of(self.weights.as_ref(), points.len())?,
            vertices: rows(&self.vertices, "vertices")?,
            sites: rows(&self.sites, "sites")?,
            starts: flat(&self.starts, "starts")?,
            entries: flat(&self.entries, "entries")?,
            site: flat(&self.site, "site")?,
            ridge_starts: flat(&self.ridge_starts, "region_ridge_starts")?,
            ridges: flat(&self.ridges, "region_ridges")?,
        };
        in_range(cells.sites, 0, cells.points.len(), "sites")?;
        are_starts(cells.starts, cells.entries.len())?;
        are_starts(cells.ridge_starts, cells.ridges.len())?;
        each_in_range(cells.entries, i32::MIN, cells.vertices.len(), "entries")?;
        each_in_range(cells.site, 0, cells.points.len(), "site")?;
        each_in_range(cells.ridges, 0, cells.sites.len(), "region_ridges")?;
        if cells.starts.len() == cells.sites.len() + 1
            && cells.ridge_starts.len() == cells.site.len() + 1
        {
            return Ok(cells);
        }
        Err(unequal())
    }
}

fn measured<'py>(py: Python<'py>, made: Measures) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("ridge_areas", column(py, made.ridge_areas))?;
    out.set_item("volumes", column(py, made.volumes))?;
    out.set_item("areas", column(py, made.areas))?;
    out.set_item("centroids", table(py, made.centroids)?)?;
    Ok(out)
}

/// Measures of the cells of a diagram, as `voronoi3` gives it, and of its ridges.
#[pyfunction]
pub fn measures3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    diagram: &Bound<'py, PyDict>,
    workers: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let borrowed = Borrowed::new(points, weights, diagram)?;
    let cells = borrowed.cells().map_err(|e| raise(py, &e))?;
    let made = watched(py, |watch| dual::measures(cells, workers, watch))?;
    measured(py, made)
}

/// The cells of a diagram cut to a convex polyhedron, given by corners, faces (counter-clockwise
/// from outside, as compressed rows) and the planes n . x <= c of these.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "arrays of two things")]
pub fn voronoi_clip3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    diagram: &Bound<'py, PyDict>,
    clip_points: PyReadonlyArray2<'py, f64>,
    clip_starts: PyReadonlyArray1<'py, i32>,
    clip_corners: PyReadonlyArray1<'py, i32>,
    clip_planes: PyReadonlyArray2<'py, f64>,
    workers: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let borrowed = Borrowed::new(points, weights, diagram)?;
    let (cells, clip) = attached(py, || {
        let clip = Clip {
            points: rows(&clip_points, "clip_points")?,
            starts: flat(&clip_starts, "clip_starts")?,
            corners: flat(&clip_corners, "clip_corners")?,
            planes: rows(&clip_planes, "clip_planes")?,
        };
        are_starts(clip.starts, clip.corners.len())?;
        each_in_range(clip.corners, 0, clip.points.len(), "clip_corners")?;
        let full = clip.starts.windows(2).all(|w| w[1] - w[0] > 2);
        if full && clip.starts.len() == clip.planes.len() + 1 {
            return Ok((borrowed.cells()?, clip));
        }
        Err(unequal())
    })?;
    let made = watched(py, |watch| dual::clip(cells, clip, workers, watch))?;
    let out = measured(py, made.measures)?;
    out.set_item("cut", column(py, made.cut))?;
    out.set_item("point_starts", column(py, made.point_starts))?;
    out.set_item("points", table(py, made.points)?)?;
    out.set_item("face_starts", column(py, made.face_starts))?;
    out.set_item("corner_starts", column(py, made.corner_starts))?;
    out.set_item("corners", column(py, made.corners))?;
    out.set_item("labels", column(py, made.labels))?;
    Ok(out)
}
