//! Checks of surfaces of triangles in 3-D as arrays.

use delone_core::Point3;
use delone_core::base::error::Result;
use delone_core::base::memory::signed;
use delone_core::solids::imprint;
use delone_core::solids::surface::{self, Checked, Options, Pairs, Resolved};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, number_rows, numbers, rows, table};
use crate::errors::Outcome;
use crate::signals::watched;

/// Pairs of faces that cross or touch.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct FacePairs {
    /// Rows of both faces, the smaller first, (p, 2).
    pub faces: Table<i32>,
    /// The kind of each pair, (p,).
    pub kinds: Column<u8>,
    /// Whether they cross, (p,).
    pub crossing: Column<bool>,
    /// The number of all pairs of each kind, (6,).
    pub counts: Column<u64>,
    /// The number of all pairs that cross.
    pub ncrossing: u64,
}

/// What a surface is.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CheckedSurface {
    /// Rows of points with the first rows of the same coordinates, (k, 2).
    pub duplicate_points: Table<i32>,
    /// Faces that use a vertex twice, (k,).
    pub repeats: Column<i32>,
    /// Other faces without area, (k,).
    pub collinear: Column<i32>,
    /// Rows of faces with the first rows of the same vertices, (k, 2).
    pub duplicate_faces: Table<i32>,
    /// Pairs that cross or touch.
    pub pairs: Py<FacePairs>,
    /// The number of edges.
    pub nedges: usize,
    /// Edges of one face, (k, 2).
    pub boundary: Table<i32>,
    /// Edges of three faces or more, (k, 2).
    pub many: Table<i32>,
    /// Edges that are not passed equally often in both directions, (k, 2).
    pub unbalanced: Table<i32>,
    /// Vertices whose faces do not form one fan, (k,).
    pub not_fans: Column<i32>,
    /// The component of each face, -1 of degenerate ones, (m,).
    pub component: Column<i32>,
    /// The number of components.
    pub ncomponents: u32,
    /// The number of regions that are separated from the outside; None if faces cross.
    pub nregions: Option<u32>,
    /// Faces with the same region on both sides, (k,).
    pub dangling: Column<i32>,
    /// The signed volume.
    pub volume: f64,
    /// The exact sign of the volume.
    pub sign: i8,
}

fn pairs_of(py: Python<'_>, pairs: Pairs) -> Outcome<Py<FacePairs>> {
    let faces: Vec<[u32; 2]> = pairs.first.iter().map(|pair| pair.faces).collect();
    let kinds = pairs.first.iter().map(|pair| pair.kind as u8).collect();
    let crossing = pairs.first.iter().map(|pair| !pair.touching).collect();
    let made = FacePairs {
        faces: number_rows(py, &faces)?,
        kinds: column(py, kinds),
        crossing: column(py, crossing),
        counts: column(py, pairs.counts.to_vec()),
        ncrossing: pairs.crossing,
    };
    Ok(Py::new(py, made)?)
}

/// Points and faces, borrowed and checked.
fn borrowed<'a>(
    points: &'a PyReadonlyArray2<'_, f64>,
    faces: &'a PyReadonlyArray2<'_, i32>,
) -> Result<(&'a [Point3], &'a [[i32; 3]])> {
    let points: &[Point3] = rows(points, "points")?;
    let faces = rows(faces, "faces")?;
    in_range(faces, 0, points.len(), "faces")?;
    Ok((points, faces))
}

/// Checks a surface; at most `limit` pairs are returned.
#[pyfunction]
pub fn check_surface3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    faces: PyReadonlyArray2<'_, i32>,
    limit: usize,
    workers: usize,
) -> Outcome<CheckedSurface> {
    let (points, faces) = borrowed(&points, &faces)?;
    let options = Options { limit, workers };
    let found: Checked = watched(py, |watch| surface::check(points, faces, options, watch))?;
    Ok(CheckedSurface {
        duplicate_points: number_rows(py, &found.clean.same_points)?,
        repeats: numbers(py, found.clean.repeats),
        collinear: numbers(py, found.clean.collinear),
        duplicate_faces: number_rows(py, &found.clean.same_faces)?,
        pairs: pairs_of(py, found.pairs)?,
        nedges: found.nedges,
        boundary: number_rows(py, &found.edges.boundary)?,
        many: number_rows(py, &found.edges.many)?,
        unbalanced: number_rows(py, &found.edges.unbalanced)?,
        not_fans: numbers(py, found.not_fans),
        component: column(py, found.component),
        ncomponents: found.components,
        nregions: found.regions,
        dangling: numbers(py, found.dangling),
        volume: found.volume,
        sign: found.sign.into(),
    })
}

/// `(faces, source)`.
type Parts = (Table<i32>, Column<i32>);

/// `(parts, pairs)`: the faces subdivided where they touch, None if some cross, and at most `limit`
/// pairs.
#[pyfunction]
pub fn resolve_touches3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    faces: PyReadonlyArray2<'_, i32>,
    limit: usize,
    workers: usize,
) -> Outcome<(Option<Parts>, Py<FacePairs>)> {
    let (points, faces) = borrowed(&points, &faces)?;
    let options = Options { limit, workers };
    let (made, pairs) = watched(py, |watch| {
        surface::resolve_touches(points, faces, options, watch)
    })?;
    let parts = made.map(|made| parts_of(py, &made)).transpose()?;
    Ok((parts, pairs_of(py, pairs)?))
}

fn parts_of(py: Python<'_>, made: &Resolved) -> Outcome<Parts> {
    let faces = made.faces.iter().map(|face| face.map(|v| v as i32));
    let source = made.source.iter().map(|&row| row as i32).collect();
    Ok((table(py, faces.collect())?, column(py, source)))
}

/// A surface cut at itself.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CutSurface {
    /// Vertices after those of the input, (k, 3).
    pub added: Table<f64>,
    /// Triangles, (f, 3).
    pub faces: Table<i32>,
    /// The face of the input that each is a part of, (f,).
    pub source: Column<i32>,
    /// Rows of points with the rows that replace them, (k, 2).
    pub merged: Table<i32>,
    /// The largest distance of a vertex from its source.
    pub distance: f64,
    /// The tolerance used.
    pub tolerance: f64,
    /// The number of rounds.
    pub rounds: usize,
    /// Rows of faces of which parts still cross, (k, 2).
    pub crossing: Table<i32>,
}

/// Cuts a surface where its faces cross, overlap or touch.
#[pyfunction]
pub fn imprint_surface3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    faces: PyReadonlyArray2<'_, i32>,
    tolerance: f64,
    workers: usize,
) -> Outcome<CutSurface> {
    let (points, faces) = borrowed(&points, &faces)?;
    let options = imprint::Options { tolerance, workers };
    let made = watched(py, |watch| imprint::imprint(points, faces, options, watch))?;
    Ok(CutSurface {
        added: table(py, made.added)?,
        faces: table(py, signed(made.faces))?,
        source: numbers(py, made.source),
        merged: number_rows(py, &made.merged)?,
        distance: made.distance,
        tolerance: made.tolerance,
        rounds: made.rounds,
        crossing: number_rows(py, &made.crossing)?,
    })
}
