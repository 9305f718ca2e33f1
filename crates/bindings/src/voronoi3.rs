//! 3-D Voronoi and power diagrams, their measures, and cells clipped to a polyhedron, as arrays.

use delone_core::Point3;
use delone_core::base::error::Result;
use delone_core::voronoi::space::{self as dual, Cells, Clip, Measures};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, are_starts, column, each_in_range, flat, in_range, rows, table,
};
use crate::errors::Outcome;
use crate::given::{unequal, weights_of};
use crate::results::{len_of, made_of_arrays, require_equal, rows_of};
use crate::signals::watched;
use crate::voronoi::given;

/// A 3-D Voronoi or power diagram.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Diagram3 {
    /// Vertices of cells, (k, 3).
    pub vertices: Table<f64>,
    /// The vertex of each tetrahedron, -1 beyond the range of doubles, (m,).
    pub simplex_vertex: Column<i32>,
    /// The two sites of each ridge, (r, 2).
    pub sites: Table<i32>,
    /// Start of the entries of each ridge, and the end, (r + 1,).
    pub ridge_starts: Column<i32>,
    /// Entries: a vertex, or ~i for ray i, at both ends of an open ridge.
    pub ridge_entries: Column<i32>,
    /// Directions of the rays, (q, 3).
    pub rays: Table<f64>,
    /// The cell of each point, -1 for none, (n,).
    pub region: Column<i32>,
    /// The point of each cell, (c,).
    pub site: Column<i32>,
    /// Start of the vertices of each cell, and the end, (c + 1,).
    pub region_starts: Column<i32>,
    /// Vertices of cells, ascending, -1 first if a cell is unbounded.
    pub region_vertices: Column<i32>,
    /// Start of the ridges of each cell, and the end, (c + 1,).
    pub region_ridge_starts: Column<i32>,
    /// Ridges of cells, ascending.
    pub region_ridges: Column<i32>,
}

made_of_arrays!(Diagram3 {
    vertices: Table<f64>,
    simplex_vertex: Column<i32>,
    sites: Table<i32>,
    ridge_starts: Column<i32>,
    ridge_entries: Column<i32>,
    rays: Table<f64>,
    region: Column<i32>,
    site: Column<i32>,
    region_starts: Column<i32>,
    region_vertices: Column<i32>,
    region_ridge_starts: Column<i32>,
    region_ridges: Column<i32>,
} lent as Lent3);

impl Diagram3 {
    fn check(&self, py: Python<'_>) -> Result<()> {
        rows_of(py, &self.vertices, 3, "vertices")?;
        rows_of(py, &self.rays, 3, "rays")?;
        let ridges = rows_of(py, &self.sites, 2, "sites")?;
        let cells = len_of(py, &self.site);
        require_equal(&[
            (ridges + 1, len_of(py, &self.ridge_starts)),
            (cells + 1, len_of(py, &self.region_starts)),
            (cells + 1, len_of(py, &self.region_ridge_starts)),
        ])
    }
}

impl Lent3<'_> {
    /// The cells, after a check of their indices.
    fn cells<'a>(&'a self, points: &'a [Point3], weights: &'a [f64]) -> Result<Cells<'a>> {
        let cells = Cells {
            points,
            weights,
            vertices: rows(&self.vertices, "vertices")?,
            sites: rows(&self.sites, "sites")?,
            starts: flat(&self.ridge_starts, "ridge_starts")?,
            entries: flat(&self.ridge_entries, "ridge_entries")?,
            site: flat(&self.site, "site")?,
            ridge_starts: flat(&self.region_ridge_starts, "region_ridge_starts")?,
            ridges: flat(&self.region_ridges, "region_ridges")?,
        };
        in_range(cells.sites, 0, cells.points.len(), "sites")?;
        are_starts(cells.starts, cells.entries.len())?;
        are_starts(cells.ridge_starts, cells.ridges.len())?;
        each_in_range(
            cells.entries,
            i32::MIN,
            cells.vertices.len(),
            "ridge_entries",
        )?;
        each_in_range(cells.site, 0, cells.points.len(), "site")?;
        each_in_range(cells.ridges, 0, cells.sites.len(), "region_ridges")?;
        Ok(cells)
    }
}

/// The diagram of a triangulation; with weights, of the regular triangulation.
#[pyfunction]
pub fn voronoi3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Diagram3> {
    let given = given(&points, weights.as_ref(), &simplices, &neighbors)?;
    let made = watched(py, |watch| dual::diagram(given, workers, watch))?;
    Ok(Diagram3 {
        vertices: table(py, made.vertices)?,
        simplex_vertex: column(py, made.simplex_vertex),
        sites: table(py, made.ridges.sites)?,
        ridge_starts: column(py, made.ridges.starts),
        ridge_entries: column(py, made.ridges.entries),
        rays: table(py, made.ridges.rays)?,
        region: column(py, made.regions.of_point),
        site: column(py, made.regions.site),
        region_starts: column(py, made.regions.starts),
        region_vertices: column(py, made.regions.vertices),
        region_ridge_starts: column(py, made.regions.ridge_starts),
        region_ridges: column(py, made.regions.ridges),
    })
}

/// Measures of cells, and of ridges.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CellMeasures3 {
    /// The area of each ridge, (r,).
    pub ridge_areas: Column<f64>,
    /// Volumes, (c,).
    pub volumes: Column<f64>,
    /// Areas of surfaces, (c,).
    pub areas: Column<f64>,
    /// Centroids, (c, 3).
    pub centroids: Table<f64>,
}

fn measured(py: Python<'_>, made: Measures) -> Outcome<CellMeasures3> {
    Ok(CellMeasures3 {
        ridge_areas: column(py, made.ridge_areas),
        volumes: column(py, made.volumes),
        areas: column(py, made.areas),
        centroids: table(py, made.centroids)?,
    })
}

/// The measures of the cells of a diagram and of its ridges.
#[pyfunction]
pub fn measures3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    diagram: &Bound<'_, Diagram3>,
    workers: usize,
) -> Outcome<CellMeasures3> {
    let lent = diagram.get().lend(py)?;
    let points = rows(&points, "points")?;
    let cells = lent.cells(points, weights_of(weights.as_ref(), points.len())?)?;
    let made = watched(py, |watch| dual::measures(cells, workers, watch))?;
    measured(py, made)
}

/// Cells clipped to a convex polyhedron.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ClippedCells3 {
    /// Measures of each clipped cell and ridge.
    pub measures: Py<CellMeasures3>,
    /// The cells that were clipped, (b,).
    pub cut: Column<i32>,
    /// Start of the corners of each of these, and the end, (b + 1,).
    pub point_starts: Column<i32>,
    /// The corners, (p, 3).
    pub points: Table<f64>,
    /// Start of the faces of each of these, and the end, (b + 1,).
    pub face_starts: Column<i32>,
    /// Start of the corners of each face, and the end, (f + 1,).
    pub corner_starts: Column<i32>,
    /// The corners of faces, as rows of `points`, counter-clockwise from outside.
    pub corners: Column<i32>,
    /// The ridge of each face, negative for a face of the polyhedron, (f,).
    pub labels: Column<i32>,
}

/// The cells of a diagram, clipped to a convex polyhedron given by corners, faces
/// (counter-clockwise from outside, as compressed rows) and the planes n . x <= c of the faces.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "arrays of two things")]
pub fn voronoi_clip3<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    weights: Option<PyReadonlyArray1<'py, f64>>,
    diagram: &Bound<'py, Diagram3>,
    clip_points: PyReadonlyArray2<'py, f64>,
    clip_starts: PyReadonlyArray1<'py, i32>,
    clip_corners: PyReadonlyArray1<'py, i32>,
    clip_planes: PyReadonlyArray2<'py, f64>,
    workers: usize,
) -> Outcome<ClippedCells3> {
    let lent = diagram.get().lend(py)?;
    let clip = Clip {
        points: rows(&clip_points, "clip_points")?,
        starts: flat(&clip_starts, "clip_starts")?,
        corners: flat(&clip_corners, "clip_corners")?,
        planes: rows(&clip_planes, "clip_planes")?,
    };
    are_starts(clip.starts, clip.corners.len())?;
    each_in_range(clip.corners, 0, clip.points.len(), "clip_corners")?;
    let full = clip.starts.windows(2).all(|w| w[1] - w[0] > 2);
    if !full || clip.starts.len() != clip.planes.len() + 1 {
        return Err(unequal().into());
    }
    let points = rows(&points, "points")?;
    let cells = lent.cells(points, weights_of(weights.as_ref(), points.len())?)?;
    let made = watched(py, |watch| dual::clip(cells, clip, workers, watch))?;
    Ok(ClippedCells3 {
        measures: Py::new(py, measured(py, made.measures)?)?,
        cut: column(py, made.cut),
        point_starts: column(py, made.point_starts),
        points: table(py, made.points)?,
        face_starts: column(py, made.face_starts),
        corner_starts: column(py, made.corner_starts),
        corners: column(py, made.corners),
        labels: column(py, made.labels),
    })
}
