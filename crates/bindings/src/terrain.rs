//! Contours of triangulated surfaces, volumes between them, and their simplification.

use delone_core::base::arrays::Given;
use delone_core::base::error::{Error, Result};
use delone_core::terrain::contour;
use delone_core::terrain::simplify::{Task, simplify};
use delone_core::terrain::volume::{self, Other, Surface};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, rows, table};
use crate::errors::Outcome;
use crate::given::{checked, unequal};
use crate::signals::watched;

/// Contour lines as runs of coordinates.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ContourLines {
    /// Coordinates of all lines, (p, 2). A ring ends with its first point.
    pub points: Table<f64>,
    /// The start of each line, and the end of the last, (k + 1,).
    pub starts: Column<i64>,
    /// The number of the level of each line, ascending, (k,).
    pub levels: Column<i32>,
    /// Triangles in which lines would cross; if there are any, there are no lines, (t,).
    pub tangled: Column<i32>,
}

/// Bands between levels as polygons: runs of rings, which are runs of coordinates.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ContourBands {
    /// Coordinates of all rings, (p, 2). Each ring ends with its first point.
    pub points: Table<f64>,
    /// The start of each ring in the points, and the end of the last, (r + 1,).
    pub rings: Column<i64>,
    /// The start of each polygon in the rings, and the end of the last, (k + 1,).
    pub polygons: Column<i64>,
    /// The band of each polygon, ascending, (k,).
    pub bands: Column<i32>,
    /// Triangles in which bands would overlap; if there are any, there are no bands, (t,).
    pub tangled: Column<i32>,
}

/// Finite numbers, one for each point.
fn heights_of<'a>(heights: &'a PyReadonlyArray1<'_, f64>, n: usize) -> Result<&'a [f64]> {
    let found = flat(heights, "heights")?;
    if found.len() != n {
        return Err(unequal());
    }
    if found.iter().all(|z| z.is_finite()) {
        return Ok(found);
    }
    Err(Error::Shape("heights must be finite".into()))
}

/// Ascending finite levels.
fn levels_of<'a>(levels: &'a PyReadonlyArray1<'_, f64>) -> Result<&'a [f64]> {
    let found = flat(levels, "levels")?;
    if found.iter().all(|z| z.is_finite()) && found.is_sorted_by(|a, b| a < b) {
        return Ok(found);
    }
    Err(Error::Shape("levels must be finite and ascending".into()))
}

/// The contour lines of a surface, with higher ground to their left. Those in triangles of
/// `collapsed`, which may be empty, pass through vertices; `far` allows points of lines that are
/// far apart to be united.
#[pyfunction]
pub fn contour_lines2(
    py: Python<'_>,
    surface: Sheet<'_>,
    levels: PyReadonlyArray1<'_, f64>,
    limit: usize,
    collapsed: PyReadonlyArray1<'_, bool>,
    far: bool,
    workers: usize,
) -> Outcome<ContourLines> {
    let (surface, levels) = (
        surface.surface()?,
        (levels_of(&levels)?, flat(&collapsed, "collapsed")?),
    );
    let found = watched(py, |watch| {
        let threads = (workers, watch);
        contour::lines(surface.given, surface.heights, levels, far, limit, threads)
    })?;
    Ok(ContourLines {
        points: table(py, found.points)?,
        starts: column(py, found.starts),
        levels: column(py, found.levels),
        tangled: column(py, found.tangled),
    })
}

/// The bands of a surface between levels, below the first and above the last; see `contour_lines2`.
#[pyfunction]
pub fn contour_bands2(
    py: Python<'_>,
    surface: Sheet<'_>,
    levels: PyReadonlyArray1<'_, f64>,
    limit: usize,
    collapsed: PyReadonlyArray1<'_, bool>,
    far: bool,
    workers: usize,
) -> Outcome<ContourBands> {
    let (surface, levels) = (
        surface.surface()?,
        (levels_of(&levels)?, flat(&collapsed, "collapsed")?),
    );
    let found = watched(py, |watch| {
        let threads = (workers, watch);
        contour::bands(surface.given, surface.heights, levels, far, limit, threads)
    })?;
    Ok(ContourBands {
        points: table(py, found.points)?,
        rings: column(py, found.rings),
        polygons: column(py, found.polygons),
        bands: column(py, found.bands),
        tangled: column(py, found.tangled),
    })
}

/// A triangulation and, if there are any, the heights of its points.
#[derive(FromPyObject)]
pub struct Sheet<'py> {
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
    heights: PyReadonlyArray1<'py, f64>,
}

impl Sheet<'_> {
    fn given(&self) -> Result<Given<'_, 2, 3>> {
        checked(&self.points, &self.simplices, &self.neighbors)
    }

    fn surface(&self) -> Result<Surface<'_>> {
        let given = self.given()?;
        Ok(Surface {
            given,
            heights: heights_of(&self.heights, given.points.len())?,
        })
    }
}

/// For each triangle of a surface: the volumes below it and above it up to another surface or to
/// the plane z = c + a x + b y, the areas of both, and the area of the overlap.
#[pyfunction]
pub fn volumes2(
    py: Python<'_>,
    surface: Sheet<'_>,
    other: Option<Sheet<'_>>,
    plane: [f64; 3],
    region: Option<Sheet<'_>>,
    workers: usize,
) -> Outcome<[Column<f64>; 5]> {
    let other = match &other {
        Some(sheet) => Other::Surface(sheet.surface()?),
        None => Other::Plane(plane),
    };
    let region = region.as_ref().map(Sheet::given).transpose()?;
    let surface = surface.surface()?;
    let found = watched(py, |watch| {
        volume::volumes(surface, other, region, workers, watch)
    })?;
    Ok(found.map(|values| column(py, values)))
}

/// Points in the order in which they make a coarse surface finer.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Simplified2 {
    /// The points that are inserted, as rows, (k,).
    pub order: Column<i32>,
    /// A bound on the vertical distance of all points before the first insertion and after each,
    /// (k + 1,).
    pub errors: Column<f64>,
    /// The number of triangles before the first insertion and after each, (k + 1,).
    pub triangles: Column<i32>,
}

/// Inserts points into a `coarse` surface, always the one that is farthest from it, until none is farther
/// than `max_error` or there would be more than `max_triangles`. `segments` are edges that stay,
/// `present` is the number of triangles, `points` and `z` are the other points.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn simplify2(
    py: Python<'_>,
    coarse: Sheet<'_>,
    segments: PyReadonlyArray2<'_, i32>,
    present: usize,
    points: PyReadonlyArray2<'_, f64>,
    z: PyReadonlyArray1<'_, f64>,
    max_error: f64,
    max_triangles: usize,
    workers: usize,
) -> Outcome<Simplified2> {
    let surface = coarse.surface()?;
    let points = rows(&points, "points")?;
    let z = heights_of(&z, points.len())?;
    let segments = rows::<i32, 2>(&segments, "segments")?;
    in_range(segments, 0, surface.given.points.len(), "segments")?;
    let segments: Vec<_> = segments.iter().map(|s| s.map(|v| v as u32)).collect();
    let task = Task {
        coarse: surface.given,
        heights: surface.heights,
        segments: &segments,
        triangles: present,
        points,
        z,
        max_error,
        max_triangles,
        workers,
    };
    let found = watched(py, |watch| simplify(task, watch))?;
    Ok(Simplified2 {
        order: column(py, found.order),
        errors: column(py, found.errors),
        triangles: column(py, found.triangles),
    })
}
