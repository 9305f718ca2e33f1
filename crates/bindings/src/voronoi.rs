//! 2-D Voronoi and power diagrams, and polygons clipped from them, as arrays.

use delone_core::Point2;
use delone_core::base::error::{Error, Result};
use delone_core::voronoi::{self, Cells, Convex, Given, Outline};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, are_starts, column, each_in_range, flat, in_range, rows, table,
};
use crate::errors::{Outcome, detached};
use crate::given::{checked, unequal, weights_of};
use crate::results::{len_of, made_of_arrays, require_equal, rows_of};
use crate::signals::watched;

/// The triangulation whose dual is computed.
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

/// A 2-D Voronoi or power diagram.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Diagram2 {
    /// Vertices of cells, (k, 2).
    pub vertices: Table<f64>,
    /// The vertex of each triangle, -1 beyond the range of doubles, (m,).
    pub simplex_vertex: Column<i32>,
    /// The two sites of each ridge, (r, 2).
    pub sites: Table<i32>,
    /// The two ends of each ridge: a vertex, or ~i for ray i, (r, 2).
    pub ends: Table<i32>,
    /// Directions of the rays, (q, 2).
    pub rays: Table<f64>,
    /// The vertex beyond the range of doubles at the end of each ray, NaN if none, (q, 2).
    pub beyond: Table<f64>,
    /// The cell of each point, -1 for none, (n,).
    pub region: Column<i32>,
    /// The point of each cell, (c,).
    pub site: Column<i32>,
    /// Start of the entries of each cell, and the end, (c + 1,).
    pub region_starts: Column<i32>,
    /// Entries: vertices, counter-clockwise, -1 for an end at infinity, (e,).
    pub region_vertices: Column<i32>,
    /// Entries: the ridge that starts at each vertex, (e,).
    pub region_ridges: Column<i32>,
}

made_of_arrays!(Diagram2 {
    vertices: Table<f64>,
    simplex_vertex: Column<i32>,
    sites: Table<i32>,
    ends: Table<i32>,
    rays: Table<f64>,
    beyond: Table<f64>,
    region: Column<i32>,
    site: Column<i32>,
    region_starts: Column<i32>,
    region_vertices: Column<i32>,
    region_ridges: Column<i32>,
} lent as Lent2);

impl Diagram2 {
    fn check(&self, py: Python<'_>) -> Result<()> {
        rows_of(py, &self.vertices, 2, "vertices")?;
        require_equal(&[
            (
                rows_of(py, &self.sites, 2, "sites")?,
                rows_of(py, &self.ends, 2, "ends")?,
            ),
            (
                rows_of(py, &self.rays, 2, "rays")?,
                rows_of(py, &self.beyond, 2, "beyond")?,
            ),
            (len_of(py, &self.site) + 1, len_of(py, &self.region_starts)),
            (
                len_of(py, &self.region_vertices),
                len_of(py, &self.region_ridges),
            ),
        ])
    }
}

impl Lent2<'_> {
    /// The cells, after a check of their indices.
    fn cells<'a>(&'a self, points: &'a [Point2], weights: &'a [f64]) -> Result<Cells<'a>> {
        let cells = Cells {
            points,
            weights,
            vertices: rows(&self.vertices, "vertices")?,
            sites: rows(&self.sites, "sites")?,
            ends: rows(&self.ends, "ends")?,
            rays: rows(&self.rays, "rays")?,
            beyond: rows(&self.beyond, "beyond")?,
            site: flat(&self.site, "site")?,
            starts: flat(&self.region_starts, "region_starts")?,
            entry_vertices: flat(&self.region_vertices, "region_vertices")?,
            entry_ridges: flat(&self.region_ridges, "region_ridges")?,
        };
        let (vertices, ridges) = (cells.vertices.len(), cells.sites.len());
        in_range(cells.sites, 0, cells.points.len(), "sites")?;
        are_starts(cells.starts, cells.entry_vertices.len())?;
        each_in_range(cells.entry_vertices, -1, vertices, "region_vertices")?;
        each_in_range(cells.entry_ridges, 0, ridges, "region_ridges")?;
        Ok(cells)
    }
}

/// The diagram of a triangulation; with weights, of the regular triangulation.
#[pyfunction]
pub fn voronoi2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Diagram2> {
    let given = given(&points, weights.as_ref(), &simplices, &neighbors)?;
    let made = watched(py, |watch| voronoi::diagram(given, workers, watch))?;
    Ok(Diagram2 {
        vertices: table(py, made.vertices)?,
        simplex_vertex: column(py, made.triangle_vertex),
        sites: table(py, made.ridges.sites)?,
        ends: table(py, made.ridges.ends)?,
        rays: table(py, made.ridges.rays)?,
        beyond: table(py, made.ridges.beyond)?,
        region: column(py, made.regions.of_point),
        site: column(py, made.regions.site),
        region_starts: column(py, made.regions.starts),
        region_vertices: column(py, made.regions.vertices),
        region_ridges: column(py, made.regions.ridges),
    })
}

/// Cells clipped to a box: convex polygons.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ClippedCells2 {
    /// Start of the corners of each cell, and the end, (c + 1,).
    pub starts: Column<i32>,
    /// The corners, counter-clockwise, (p, 2).
    pub corners: Table<f64>,
    /// The ridge along the edge that starts at each corner, -1 for the box, (p,).
    pub ridges: Column<i32>,
}

/// The cells of a diagram, clipped to a box.
#[pyfunction]
pub fn voronoi_clip2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    diagram: &Bound<'_, Diagram2>,
    bounds: [f64; 4],
    workers: usize,
) -> Outcome<ClippedCells2> {
    let lent = diagram.get().lend(py)?;
    let points = rows(&points, "points")?;
    let cells = lent.cells(points, weights_of(weights.as_ref(), points.len())?)?;
    let [left, bottom, right, top] = bounds;
    let made = watched(py, |watch| {
        voronoi::clip(cells, [left, bottom], [right, top], workers, watch)
    })?;
    Ok(ClippedCells2 {
        starts: column(py, made.starts),
        corners: table(py, made.points)?,
        ridges: column(py, made.ridges),
    })
}

/// Measures of polygons.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CellMeasures2 {
    /// Areas, (c,).
    pub areas: Column<f64>,
    /// Centroids, (c, 2).
    pub centroids: Table<f64>,
    /// Perimeters, (c,).
    pub perimeters: Column<f64>,
}

fn measured(py: Python<'_>, made: voronoi::Measures) -> Outcome<CellMeasures2> {
    Ok(CellMeasures2 {
        areas: column(py, made.areas),
        centroids: table(py, made.centroids)?,
        perimeters: column(py, made.perimeters),
    })
}

/// The measures of polygons.
#[pyfunction]
pub fn measures2(
    py: Python<'_>,
    starts: PyReadonlyArray1<'_, i32>,
    corners: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<CellMeasures2> {
    let (starts, corners) = (flat(&starts, "starts")?, rows(&corners, "corners")?);
    are_starts(starts, corners.len())?;
    let made = watched(py, |watch| {
        voronoi::measures(starts, corners, workers, watch)
    })?;
    measured(py, made)
}

/// For each polygon its connected group of polygons that no segment comes near, or -1; and the
/// number of groups.
#[pyfunction]
pub fn touched2(
    py: Python<'_>,
    starts: PyReadonlyArray1<'_, i32>,
    corners: PyReadonlyArray2<'_, f64>,
    ridges: PyReadonlyArray1<'_, i32>,
    segments: PyReadonlyArray2<'_, f64>,
) -> Outcome<(Column<i32>, usize)> {
    let (starts, corners) = (flat(&starts, "starts")?, rows(&corners, "corners")?);
    are_starts(starts, corners.len())?;
    let ridges = flat(&ridges, "ridges")?;
    if ridges.len() != corners.len() {
        return Err(Error::Shape("ridges and corners differ in length".into()).into());
    }
    let segments = rows(&segments, "segments")?;
    let (groups, count) = detached(py, || voronoi::touched(starts, corners, ridges, segments))?;
    Ok((column(py, groups), count))
}

/// Polygons clipped to an outline.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CellPieces2 {
    /// For each polygon what is left: -1 (unknown), 0 (nothing), 1 (all) or 2 (parts), (k,).
    pub left: Column<i8>,
    /// Start of the parts of each polygon, and the end, (k + 1,).
    pub cells: Column<i64>,
    /// Start of the rings of each part, and the end.
    pub parts: Column<i64>,
    /// Start of the corners of each ring, and the end.
    pub rings: Column<i64>,
    /// The corners, (p, 2).
    pub points: Table<f64>,
    /// The ridge along the edge that starts at each corner, negative for none, (p,).
    pub ridges: Column<i32>,
    /// Measures of each clipped polygon.
    pub measures: Py<CellMeasures2>,
}

/// Clips the polygons `rows` to an outline: rings with their inside to the left. `inside` is
/// whether the outline contains the first corner of each of these polygons.
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
) -> Outcome<CellPieces2> {
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
        return Err(unequal().into());
    }
    let made = watched(py, |watch| {
        voronoi::pieces(cells, rows, inside, outline, workers, watch)
    })?;
    Ok(CellPieces2 {
        left: column(py, made.left),
        cells: column(py, made.cells),
        parts: column(py, made.parts),
        rings: column(py, made.rings),
        points: table(py, made.points)?,
        ridges: column(py, made.ridges),
        measures: Py::new(py, measured(py, made.measures)?)?,
    })
}
