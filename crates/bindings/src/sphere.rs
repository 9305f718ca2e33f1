//! Triangulations of directions as arrays.

use delone_core::Point3;
use delone_core::base::arrays::Arrays;
use delone_core::base::error::Result;
use delone_core::base::memory::copied;
use delone_core::base::watch::Watch;
use delone_core::interpolate::sphere::{Kind, Queries, weights};
use delone_core::sphere::angles::{Measure, directions};
use delone_core::sphere::locate::Index;
use delone_core::sphere::{constrain, directions as rays, dual, measure, span, triangulate, void};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, flat, in_range, number_rows, numbers, rows, shaped, table,
};
use crate::constrained::ConstrainedTriangulation;
use crate::errors::Outcome;
use crate::given::{not_beside, pairs, unequal};
use crate::signals::watched;

/// A Delaunay triangulation of directions.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct SphereTriangulation {
    /// Vertices of the triangles, counter-clockwise seen from outside, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 beyond a hull, (m, 3).
    pub neighbors: Table<i32>,
    /// Rows that repeat the direction of earlier rows, and the first of these, (d, 2).
    pub duplicates: Table<i32>,
}

/// Returns the triangulation of the directions of vectors.
#[pyfunction]
pub fn sphere_delaunay(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<SphereTriangulation> {
    let vectors = rows(&vectors, "vectors")?;
    let made = watched(py, |watch| triangulate(vectors, workers, watch))?;
    Ok(SphereTriangulation {
        simplices: table(py, made.arrays.simplices)?,
        neighbors: table(py, made.arrays.neighbors)?,
        duplicates: number_rows(py, &made.duplicates)?,
    })
}

/// Returns the constrained triangulation of the directions of vectors and arcs between them.
#[pyfunction]
pub fn sphere_constrained(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    segments: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<ConstrainedTriangulation> {
    let vectors = rows(&vectors, "vectors")?;
    let segments = pairs(&segments, vectors.len(), "segments")?;
    let made = watched(py, |watch| constrain(vectors, &segments, workers, watch))?;
    Ok(ConstrainedTriangulation {
        added: table::<f64, 2>(py, Vec::new())?,
        simplices: table(py, made.arrays.simplices)?,
        neighbors: table(py, made.arrays.neighbors)?,
        constrained: table(py, made.constrained)?,
        duplicates: number_rows(py, &made.duplicates)?,
        segments: table(py, made.subsegments.ends)?,
        source_start: column(py, made.subsegments.start),
        source: column(py, made.subsegments.source),
        forward: column(py, made.subsegments.forward),
        zero: numbers(py, made.zero),
        through: number_rows(py, &made.through)?,
        crossings: number_rows::<3>(py, &[])?,
    })
}

/// Returns vectors in the directions of longitudes and latitudes, (n, 3).
#[pyfunction]
pub fn sphere_directions(
    py: Python<'_>,
    lonlat: PyReadonlyArray2<'_, f64>,
    degrees: bool,
    workers: usize,
) -> Outcome<Table<f64>> {
    let lonlat = rows(&lonlat, "lonlat")?;
    let measure = if degrees {
        Measure::Degrees
    } else {
        Measure::Radians
    };
    let vectors = watched(py, |watch| directions(lonlat, measure, workers, watch))?;
    table(py, vectors)
}

/// Returns the unit vectors of vectors, rounded, (n, 3).
#[pyfunction]
pub fn sphere_units(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let vectors = rows(&vectors, "vectors")?;
    let (heads, _) = watched(py, |watch| {
        rays::check(vectors)?;
        rays::units(vectors, workers, watch)
    })?;
    table(py, heads)
}

/// Returns the solid angles of triangles, (m,).
#[pyfunction]
pub fn sphere_areas(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    let (vectors, simplices) = given(&vectors, &simplices)?;
    let found = watched(py, |watch| {
        measure::areas(vectors, simplices, workers, watch)
    })?;
    Ok(column(py, found))
}

/// Returns the unit vectors at the circumcenters of triangles, (m, 3).
#[pyfunction]
pub fn sphere_circumcenters(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let (vectors, simplices) = given(&vectors, &simplices)?;
    let found = watched(py, |watch| {
        measure::circumcenters(vectors, simplices, workers, watch)
    })?;
    table(py, found)
}

/// The Voronoi diagram of directions.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct SphereDual {
    /// Facets of the convex hull: the triangles, and those across a void, (f, 3).
    pub simplices: Table<i32>,
    /// The facet opposite each corner, (f, 3).
    pub neighbors: Table<i32>,
    /// The vertex of each facet, (f,).
    pub vertex: Column<i32>,
    /// The first facet of each vertex, (k,).
    pub facet: Column<i32>,
    /// The edge of each ridge, and the corners to its left and right, (r, 4).
    pub around: Table<i32>,
    /// The vertices of each ridge, to the left and right of its edge, (r, 2).
    pub ends: Table<i32>,
    /// The cell of each row, -1 if it is not a corner, (n,).
    pub cell: Column<i32>,
    /// Where the entries of each cell begin.
    pub starts: Column<i32>,
    /// The vertices of cells, counter-clockwise.
    pub vertices: Column<i32>,
    /// The ridges that follow them.
    pub ridges: Column<i32>,
}

/// Returns the dual of a triangulation of at least four directions; facets of one circle share a
/// vertex if `merged`.
#[pyfunction]
pub fn sphere_dual(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    merged: bool,
    workers: usize,
) -> Outcome<SphereDual> {
    let (vectors, simplices) = given(&vectors, &simplices)?;
    let neighbors: &[[i32; 3]] = rows(&neighbors, "neighbors")?;
    if neighbors.len() != simplices.len() {
        return Err(not_beside().into());
    }
    in_range(neighbors, -1, simplices.len(), "neighbors")?;
    let (facets, made) = watched(py, |watch| {
        let facets = void::complete(vectors, simplices, neighbors, watch)?;
        let made = dual::dual(
            vectors,
            &facets.simplices,
            &facets.neighbors,
            merged,
            workers,
            watch,
        )?;
        Result::Ok((facets, made))
    })?;
    Ok(SphereDual {
        simplices: table(py, facets.simplices)?,
        neighbors: table(py, facets.neighbors)?,
        vertex: column(py, made.vertex),
        facet: column(py, made.facet),
        around: table(py, made.around)?,
        ends: table(py, made.ends)?,
        cell: column(py, made.cell),
        starts: column(py, made.starts),
        vertices: column(py, made.vertices),
        ridges: column(py, made.ridges),
    })
}

/// Returns the length of each ridge, and the area between it and either of its sites, (r, 2).
#[pyfunction]
pub fn sphere_spans(
    py: Python<'_>,
    vectors: PyReadonlyArray2<'_, f64>,
    around: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let (vectors, around) = (rows(&vectors, "vectors")?, rows(&around, "around")?);
    in_range::<4>(around, 0, vectors.len(), "around")?;
    let found = watched(py, |watch| span::spans(vectors, around, workers, watch))?;
    table(py, found)
}

/// Weights of vertices at directions as compressed rows.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct SphereWeights {
    /// Start of the entries of each query, and the end, (q + 1,).
    pub indptr: Column<i64>,
    /// The vertices, (k,).
    pub indices: Column<i32>,
    /// Their weights, (k,).
    pub weights: Column<f64>,
    /// Derivatives of the weights toward east and north, per radian, (k, 2); None if not wanted.
    pub slopes: Option<Table<f64>>,
}

/// A triangulation of directions that is kept for many calls.
#[pyclass(frozen, module = "delone._core")]
pub struct SphereLocator(Index);

#[pymethods]
impl SphereLocator {
    #[new]
    fn new(
        py: Python<'_>,
        vectors: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
        workers: usize,
    ) -> Outcome<Self> {
        let (vectors, simplices) = given(&vectors, &simplices)?;
        let neighbors: &[[i32; 3]] = rows(&neighbors, "neighbors")?;
        if simplices.is_empty() || neighbors.len() != simplices.len() {
            return Err(unequal().into());
        }
        in_range(neighbors, -1, simplices.len(), "neighbors")?;
        let index = watched(py, |watch| {
            let arrays = Arrays {
                simplices: copied(simplices)?,
                neighbors: copied(neighbors)?,
            };
            Index::new(copied(vectors)?, arrays, workers, watch)
        })?;
        Ok(Self(index))
    }

    /// For each vector, the first triangle that contains its direction, or -1.
    fn find(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> Outcome<Column<i32>> {
        self.column(py, &xi, |index, xi, watch| index.find(xi, workers, watch))
    }

    /// The weights of vertices at vectors, each of which is in or at a triangle, or -1 for none; and if
    /// `sloped` their derivatives.
    fn weights(
        &self,
        py: Python<'_>,
        kind: &str,
        xi: PyReadonlyArray2<'_, f64>,
        simplex: PyReadonlyArray1<'_, i32>,
        sloped: bool,
        workers: usize,
    ) -> Outcome<SphereWeights> {
        let names = Kind::NAMES.map(|(name, _)| name);
        let wrong = || format!("kind must be one of {names:?}, got {kind:?}");
        let kind = Kind::named(kind).ok_or_else(|| PyValueError::new_err(wrong()))?;
        let queries = Queries {
            vectors: rows(&xi, "xi")?,
            simplices: flat(&simplex, "simplex")?,
        };
        let found = watched(py, |watch| {
            weights(&self.0, kind, queries, sloped, workers, watch)
        })?;
        let entries = found.indices.len();
        let slopes = if sloped {
            Some(shaped(py, found.slopes, [entries, 2])?)
        } else {
            None
        };
        Ok(SphereWeights {
            indptr: column(py, found.indptr),
            indices: column(py, found.indices),
            weights: column(py, found.weights),
            slopes,
        })
    }

    /// The vertex nearest to the direction of each vector.
    fn nearest(
        &self,
        py: Python<'_>,
        xi: PyReadonlyArray2<'_, f64>,
        workers: usize,
    ) -> Outcome<Column<i32>> {
        self.column(py, &xi, |index, xi, watch| {
            index.nearest(xi, workers, watch)
        })
    }
}

impl SphereLocator {
    fn column(
        &self,
        py: Python<'_>,
        xi: &PyReadonlyArray2<'_, f64>,
        answer: impl Fn(&Index, Vec<Point3>, &Watch) -> Result<Vec<i32>> + Sync + Send,
    ) -> Outcome<Column<i32>> {
        let xi = rows(xi, "xi")?;
        let found = watched(py, |watch| answer(&self.0, copied(xi)?, watch))?;
        Ok(column(py, found))
    }
}

/// Vectors, and triangles of their rows.
fn given<'a>(
    vectors: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
) -> Result<(&'a [Point3], &'a [[i32; 3]])> {
    let (vectors, simplices) = (rows(vectors, "vectors")?, rows(simplices, "simplices")?);
    in_range(simplices, 0, vectors.len(), "simplices")?;
    Ok((vectors, simplices))
}
