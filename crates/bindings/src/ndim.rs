//! Triangulations in four to eight dimensions as arrays, and point location in them.

use delone_core::base::arrays::Arrays;
use delone_core::base::error::{Error, Result};
use delone_core::locate::find;
use delone_core::ndim::halfspaces::{Trouble, intersect};
use delone_core::ndim::{self, Hull, Hyper, Lazy, Rest, Simplices, Weighed};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, columns, flat, flattened, in_flats, in_many, number_rows, numbers, rows,
    shaped, table,
};
use crate::errors::Outcome;
use crate::given::simplices_of;
use crate::interpolate::Points;
use crate::locator::Tiling;
use crate::signals::watched;
use crate::triangulation::{Triangulation, arrays_of};

/// The Delaunay triangulation of points with four to eight coordinates.
#[pyfunction]
pub fn triangulate_n(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> Outcome<Triangulation> {
    in_many!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let made = watched(py, |watch| ndim::triangulate::<D, N, P>(points, watch))?;
        triangulation(py, made)
    })
}

/// The Delaunay triangulation of points in a flat: `points` are their coordinates along its axes, and
/// `rest` the others, padded with zeros to eight, (n, 8).
#[pyfunction]
pub fn triangulate_in_flat(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    rest: PyReadonlyArray2<'_, f64>,
) -> Outcome<Triangulation> {
    in_flats!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let rest = rest_of(&rest, points.len())?;
        let made = watched(py, |watch| {
            ndim::triangulate_in_flat::<D, N, P>(points, rest, watch)
        })?;
        triangulation(py, made)
    })
}

fn triangulation<const V: usize>(py: Python<'_>, made: Simplices<V>) -> Outcome<Triangulation> {
    let signed = |v: [u32; V]| v.map(|i| i as i32);
    let arrays = Arrays {
        simplices: made.simplices.into_iter().map(signed).collect(),
        neighbors: made.neighbors,
    };
    arrays_of(py, arrays, &made.duplicates, &[])
}

/// The coordinates of points that are not axes of a flat.
pub fn rest_of<'a>(rest: &'a PyReadonlyArray2<'_, f64>, points: usize) -> Result<&'a [Rest]> {
    let found: &[Rest] = rows(rest, "rest")?;
    if found.len() == points {
        return Ok(found);
    }
    let message = format!("rest has {} rows, not {points}", found.len());
    Err(Error::Shape(message))
}

/// The convex hull of points with four to eight coordinates.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct HullN {
    /// Vertices of the facets, positively oriented behind a point inside, (m, d).
    pub simplices: Table<i32>,
    /// The facet opposite each vertex, (m, d).
    pub neighbors: Table<i32>,
    /// The plane of each facet, numbered, (m,).
    pub facet_of: Column<i32>,
    /// For each facet, the row of a point that is not on its plane, (m,).
    pub inside: Column<i32>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
}

/// The convex hull of points with four to eight coordinates.
#[pyfunction]
pub fn hull_n(py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> Outcome<HullN> {
    in_many!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let found = watched(py, |watch| ndim::hull::<D, N, P>(points, watch))?;
        facets(py, found)
    })
}

/// The convex hull in a flat of points, given as to `triangulate_in_flat`.
#[pyfunction]
pub fn hull_in_flat(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    rest: PyReadonlyArray2<'_, f64>,
) -> Outcome<HullN> {
    in_flats!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let rest = rest_of(&rest, points.len())?;
        let found = watched(py, |watch| ndim::hull_in_flat::<D, N, P>(points, rest, watch))?;
        facets(py, found)
    })
}

fn facets<const D: usize>(py: Python<'_>, found: Hull<D>) -> Outcome<HullN> {
    Ok(HullN {
        simplices: number_rows(py, &found.simplices)?,
        neighbors: number_rows(py, &found.neighbors)?,
        facet_of: numbers(py, found.plane),
        inside: numbers(py, found.inside),
        duplicates: number_rows(py, &found.duplicates)?,
    })
}

/// The intersection of half-spaces around a point.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Halfspaces {
    /// The dual point of each half-space, (n, d).
    pub dual_points: Table<f64>,
    /// Half-spaces of the simplices of the dual hull, sorted, (m, d).
    pub simplices: Table<i32>,
    /// The corner of each simplex, (m,).
    pub corner_of: Column<i32>,
    /// Half-spaces that meet at each corner, one corner after another, (k,).
    pub facets: Column<i32>,
    /// Start of the half-spaces of each corner, and the end, (c + 1,).
    pub starts: Column<i32>,
    /// The corners, infinite where the intersection is unbounded, (c, d).
    pub points: Table<f64>,
    /// Outer unit normals and offsets of the dual points of each corner, (c, d + 1).
    pub equations: Table<f64>,
}

/// An intersection, or None, the reason, and the rows that cause it.
type Intersected = (Option<Halfspaces>, &'static str, Column<i32>);

/// The intersection of half-spaces `a x + b <= 0` around a point, in two to eight dimensions. If it has
/// no corners: "not inside" or "too close", with the row of a half-space, or "flat", with the rows that
/// span all.
#[pyfunction]
pub fn halfspaces(
    py: Python<'_>,
    rows: PyReadonlyArray2<'_, f64>,
    point: PyReadonlyArray1<'_, f64>,
) -> Outcome<Intersected> {
    match columns(&rows) {
        3 => intersected::<2, 3, 4>(py, &rows, &point),
        4 => intersected::<3, 4, 4>(py, &rows, &point),
        5 => intersected::<4, 5, 4>(py, &rows, &point),
        6 => intersected::<5, 6, 8>(py, &rows, &point),
        7 => intersected::<6, 7, 8>(py, &rows, &point),
        8 => intersected::<7, 8, 8>(py, &rows, &point),
        9 => intersected::<8, 9, 8>(py, &rows, &point),
        other => Err(Error::Shape(format!("half-spaces have {other} columns, not 3 to 9")).into()),
    }
}

/// The intersection of half-spaces with `D` coordinates.
fn intersected<const D: usize, const V: usize, const P: usize>(
    py: Python<'_>,
    halfspaces: &PyReadonlyArray2<'_, f64>,
    point: &PyReadonlyArray1<'_, f64>,
) -> Outcome<Intersected> {
    let halfspaces: &[[f64; V]] = rows(halfspaces, "halfspaces")?;
    let wrong = |_| Error::Shape(format!("the interior point does not have {D} coordinates"));
    let point: [f64; D] = flat(point, "interior_point")?.try_into().map_err(wrong)?;
    let found = watched(py, |watch| intersect::<D, V, P>(halfspaces, point, watch))?;
    let (reason, trouble) = match found {
        Ok(corners) => {
            let found = Halfspaces {
                dual_points: table(py, corners.dual)?,
                simplices: number_rows(py, &corners.simplices)?,
                corner_of: numbers(py, corners.corner),
                facets: numbers(py, corners.facets),
                starts: numbers(py, corners.starts),
                points: table(py, corners.points)?,
                equations: table(py, corners.equations)?,
            };
            return Ok((Some(found), "", numbers(py, Vec::new())));
        }
        Err(Trouble::NotInside(row)) => ("not inside", vec![row]),
        Err(Trouble::TooClose(row)) => ("too close", vec![row]),
        Err(Trouble::Flat(rows)) => ("flat", rows),
    };
    Ok((None, reason, numbers(py, trouble)))
}

/// The orientations of simplices in four to eight dimensions: 1, 0 or -1, exactly.
#[pyfunction]
pub fn orientations_n(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<i32>> {
    in_many!(columns(&points), D, N, P => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let simplices = simplices_of(&simplices, points.len())?;
        let found = watched(py, |watch| {
            ndim::orientations::<D, N, P>(points, simplices, workers, watch)
        })?;
        Ok(column(py, found))
    })
}

/// Queries in simplices of one dimension.
trait Kept: Send + Sync {
    fn find(&self, xi: &Points<'_>, workers: usize) -> Outcome<Column<i32>>;
    fn within(&self, xi: &Points<'_>, workers: usize) -> Outcome<(Column<i32>, Table<f64>)>;
    fn nearest(&self, xi: &Points<'_>, workers: usize) -> Outcome<Column<i32>>;
}

impl<const D: usize, const N: usize> Kept for Tiling<Hyper<D>, D, N>
where
    Hyper<D>: Weighed<D, N>,
{
    fn find(&self, xi: &Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.column(xi, workers, find)
    }

    fn within(&self, xi: &Points<'_>, workers: usize) -> Outcome<(Column<i32>, Table<f64>)> {
        let py = xi.py();
        let (found, n) = self.batch(xi, workers, ndim::within)?;
        let weights = shaped(py, found.weights, [n, N])?;
        Ok((column(py, found.simplex), weights))
    }

    fn nearest(&self, xi: &Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.column(xi, workers, ndim::nearest)
    }
}

/// A Delaunay triangulation in four to eight dimensions that is kept for many calls.
#[pyclass(frozen, module = "delone._core")]
pub struct LocatorN(Box<dyn Kept>);

#[pymethods]
impl LocatorN {
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
    ) -> Outcome<Self> {
        in_many!(columns(&points), D, N, P => {
            let kept = Tiling::<Hyper<D>, D, N>::new(&points, &simplices, &neighbors)?;
            Ok(Self(Box::new(kept)))
        })
    }

    /// For each query, the first simplex that contains it, or -1.
    fn find(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.find(&xi, workers)
    }

    /// Simplices with barycentric coordinates.
    fn within(&self, xi: Points<'_>, workers: usize) -> Outcome<(Column<i32>, Table<f64>)> {
        self.0.within(&xi, workers)
    }

    /// The nearest vertex to each query.
    fn nearest(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.nearest(&xi, workers)
    }
}

/// Points with any number of coordinates, whose triangulation is not computed.
#[pyclass(frozen, module = "delone._core")]
pub struct LazyN(Lazy);

#[pymethods]
impl LazyN {
    #[new]
    fn new(points: PyReadonlyArray2<'_, f64>) -> Outcome<Self> {
        let d = columns(&points).max(1);
        let given = flattened(&points, columns(&points), "points")?;
        let made = watched(points.py(), |watch| Lazy::new(given, d, watch))?;
        Ok(Self(made))
    }

    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    #[getter]
    fn duplicates(&self, py: Python<'_>) -> Outcome<Table<i32>> {
        number_rows(py, self.0.duplicates())
    }

    /// For each query the rows of the corners of the simplex that contains it, -1 outside, and
    /// their weights.
    fn within(&self, xi: Points<'_>, workers: usize) -> Outcome<(Table<i32>, Table<f64>)> {
        let (py, d) = (xi.py(), self.0.dimension());
        let given = flattened(&xi, d, "xi")?;
        let found = watched(py, |watch| self.0.locate(given, workers, watch))?;
        let shape = [given.len() / d, d + 1];
        Ok((
            shaped(py, found.rows, shape)?,
            shaped(py, found.weights, shape)?,
        ))
    }
}
