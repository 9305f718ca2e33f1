//! Constrained triangulations as arrays.

use delone_core::Point2;
use delone_core::base::error::{Error, Result};
use delone_core::base::memory::copied;
use delone_core::constrained::nesting::{Covers, Parts, closed, first_of, odd_pairs};
use delone_core::constrained::{
    Constrained, Options, Rule, components, constrain, numbered_by_smallest, polygon, simple_ring,
};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, each_in_range, flat, frozen, in_range, rows, sealed, sealed_rows,
    signed, table,
};
use crate::errors::Outcome;
use crate::given::{pairs, unequal};
use crate::results::{Borrowed, Stages, len_of, made_of_arrays, require_equal, rows_of};
use crate::signals::watched;
use crate::triangulation::{method_of, seconds};

/// A constrained Delaunay triangulation of the whole hull.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct ConstrainedTriangulation {
    /// Added vertices, (a, 2).
    pub added: Table<f64>,
    /// Vertices of the triangles; added vertices follow the input, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// Whether the edge opposite each vertex is a subsegment, (m, 3).
    pub constrained: Table<bool>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
    /// The subsegments, (q, 2).
    pub segments: Table<i32>,
    /// Start of the rows that cover each subsegment in `source`, and the end, (q + 1,).
    pub source_start: Column<i64>,
    /// The rows of segments that cover subsegments, (c,).
    pub source: Column<i32>,
    /// Whether each of these has the direction of the subsegment, (c,).
    pub forward: Column<bool>,
    /// Rows of segments of zero length, (k,).
    pub zero: Column<i32>,
    /// Rows of segments, and input vertices inside them, (k, 2).
    pub through: Table<i32>,
    /// Pairs of rows of segments that cross, and the vertex at the crossing, (k, 3).
    pub crossings: Table<i32>,
}

made_of_arrays!(ConstrainedTriangulation {
    added: Table<f64>,
    simplices: Table<i32>,
    neighbors: Table<i32>,
    constrained: Table<bool>,
    duplicates: Table<i32>,
    segments: Table<i32>,
    source_start: Column<i64>,
    source: Column<i32>,
    forward: Column<bool>,
    zero: Column<i32>,
    through: Table<i32>,
    crossings: Table<i32>,
});

impl ConstrainedTriangulation {
    fn check(&self, py: Python<'_>) -> Result<()> {
        rows_of(py, &self.added, 2, "added")?;
        rows_of(py, &self.duplicates, 2, "duplicates")?;
        rows_of(py, &self.through, 2, "through")?;
        rows_of(py, &self.crossings, 3, "crossings")?;
        let triangles = rows_of(py, &self.simplices, 3, "simplices")?;
        require_equal(&[
            (triangles, rows_of(py, &self.neighbors, 3, "neighbors")?),
            (triangles, rows_of(py, &self.constrained, 3, "constrained")?),
            (
                rows_of(py, &self.segments, 2, "segments")? + 1,
                len_of(py, &self.source_start),
            ),
            (len_of(py, &self.source), len_of(py, &self.forward)),
        ])
    }
}

/// The constrained triangulation of points and segments, as arrays that cannot be made writeable,
/// the seconds of its stages, and, if the polygon of each segment is given, what `areas2` returns.
#[pyfunction]
#[pyo3(signature = (points, segments, split, conforming, max_vertices, method, workers, polygons=None))]
#[expect(clippy::too_many_arguments, reason = "the options, one by one")]
pub fn constrained2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    segments: PyReadonlyArray2<'py, i32>,
    split: bool,
    conforming: bool,
    max_vertices: usize,
    method: &str,
    workers: usize,
    polygons: Option<PyReadonlyArray1<'py, i32>>,
) -> Outcome<(ConstrainedTriangulation, Stages, Option<Areas>)> {
    let method = method_of(method)?;
    let points: &[Point2] = rows(&points, "points")?;
    let given = pairs(&segments, points.len(), "segments")?;
    let options = Options {
        split,
        conforming,
        max_vertices,
        method,
        workers,
    };
    let made = watched(py, |watch| constrain(points, &given, options, watch))?;
    let stages = seconds(py, &made.stages)?;
    let made = arrays_of(py, made)?;
    let areas = polygons.map(|polygons| areas_of(py, &made, segments, polygons));
    Ok((made, stages, areas.transpose()?))
}

fn arrays_of(py: Python<'_>, made: Constrained) -> Outcome<ConstrainedTriangulation> {
    let zero = made.zero.into_iter().map(|row| row as i32).collect();
    Ok(ConstrainedTriangulation {
        added: sealed_rows(py, made.added)?,
        simplices: sealed_rows(py, made.arrays.simplices)?,
        neighbors: sealed_rows(py, made.arrays.neighbors)?,
        constrained: sealed_rows(py, made.constrained)?,
        duplicates: sealed_rows(py, signed(&made.duplicates))?,
        segments: sealed_rows(py, made.subsegments.ends)?,
        source_start: sealed(py, made.subsegments.start)?,
        source: sealed(py, made.subsegments.source)?,
        forward: sealed(py, made.subsegments.forward)?,
        zero: sealed(py, zero)?,
        through: sealed_rows(py, signed(&made.through))?,
        crossings: sealed_rows(py, signed(&made.crossings))?,
    })
}

/// Components of triangles that share unconstrained edges.
#[pyfunction]
pub fn components2(
    py: Python<'_>,
    neighbors: PyReadonlyArray2<'_, i32>,
    constrained: PyReadonlyArray2<'_, bool>,
) -> Outcome<Column<i32>> {
    let sides: &[[i32; 3]] = rows(&neighbors, "neighbors")?;
    let walls: &[[bool; 3]] = rows(&constrained, "constrained")?;
    if sides.len() != walls.len() {
        return Err(unequal().into());
    }
    in_range(sides, -1, sides.len(), "neighbors")?;
    let labels = watched(py, |watch| components(sides, walls, watch))?;
    Ok(column(py, labels))
}

/// Components of triangles in 2-D or 3-D, numbered in the order of their smallest triangles, which
/// depends on coordinates only.
#[pyfunction]
pub fn numbered_components(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    component: PyReadonlyArray1<'_, i32>,
) -> Outcome<Column<i32>> {
    let corners: &[[i32; 3]] = rows(&simplices, "simplices")?;
    let of = flat(&component, "component")?;
    in_range(corners, 0, points.shape()[0], "simplices")?;
    in_range(of.as_chunks::<1>().0, 0, i32::MAX as usize, "component")?;
    if of.len() != corners.len() {
        return Err(Error::Shape("component and simplices differ in length".into()).into());
    }
    let found = if points.shape()[1] == 2 {
        let points = rows::<f64, 2>(&points, "points")?;
        watched(py, |watch| numbered_by_smallest(points, corners, of, watch))?
    } else {
        let points = rows::<f64, 3>(&points, "points")?;
        watched(py, |watch| numbered_by_smallest(points, corners, of, watch))?
    };
    Ok(column(py, found))
}

/// `(simplices, neighbors, constrained, component, segments)`, all of the whole hull.
#[derive(FromPyObject)]
pub struct PartArrays<'py>(
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray2<'py, bool>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray2<'py, i32>,
);

impl PartArrays<'_> {
    /// Borrowed and checked.
    fn checked(&self) -> Result<(Parts<'_>, &[[i32; 2]])> {
        let parts = Parts {
            simplices: rows(&self.0, "simplices")?,
            neighbors: rows(&self.1, "neighbors")?,
            walls: rows(&self.2, "constrained")?,
            component: flat(&self.3, "component")?,
        };
        let segments = rows(&self.4, "segments")?;
        let count = parts.simplices.len();
        if [
            parts.neighbors.len(),
            parts.walls.len(),
            parts.component.len(),
        ] != [count; 3]
        {
            return Err(unequal());
        }
        each_in_range(parts.component, 0, count, "component")?;
        in_range(parts.simplices, 0, i32::MAX as usize, "simplices")?;
        let points = parts.simplices.as_flattened().iter().max();
        let points = points.map_or(0, |&last| last as usize + 1);
        in_range(segments, 0, points, "segments")?;
        Ok((parts, segments))
    }
}

/// `(source_start, source, polygons)`.
#[derive(FromPyObject)]
pub struct CoverArrays<'py>(
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, i32>,
);

impl CoverArrays<'_> {
    /// Borrowed and checked.
    fn checked(&self) -> Result<Covers<'_>> {
        let covers = Covers {
            starts: flat(&self.0, "source_start")?,
            source: flat(&self.1, "source")?,
            polygons: flat(&self.2, "polygons")?,
        };
        let ends = (covers.starts.first(), covers.starts.last());
        let all = (Some(&0), Some(&(covers.source.len() as i64)));
        if ends != all || !covers.starts.is_sorted() {
            return Err(Error::Shape("source_start must partition source".into()));
        }
        each_in_range(covers.source, 0, covers.polygons.len(), "source")?;
        Ok(covers)
    }
}

/// The components to the left and right of each subsegment, (q, 2).
#[pyfunction]
pub fn components_beside2(py: Python<'_>, parts: PartArrays<'_>) -> Outcome<Table<i32>> {
    let (parts, segments) = parts.checked()?;
    table(py, watched(py, |watch| parts.beside(segments, watch))?)
}

/// Pairs of a component and a polygon whose rings contain it, ascending, (k, 2); `first` is in none.
#[pyfunction]
pub fn components_inside2(
    py: Python<'_>,
    parts: PartArrays<'_>,
    covers: CoverArrays<'_>,
    first: usize,
) -> Outcome<Table<i32>> {
    let (parts, segments) = parts.checked()?;
    let covers = covers.checked()?;
    if covers.starts.len() != segments.len() + 1 {
        return Err(unequal().into());
    }
    let found = watched(py, |watch| parts.containing(segments, covers, first, watch))?;
    table(py, found)
}

/// `tuple[NDArray[np.int32], NDArray[np.int32]]`: the component of each triangle, and the polygon of
/// each component.
type Areas = (Column<i32>, Column<i32>);

/// The component of each triangle, and the first polygon whose rings contain each component, or -1.
/// Triangles that share unconstrained edges are in one component. `polygons` has the polygon of each
/// of the segments that were given, -1 for sides of none. A polygon with a missing side
/// contains nothing; what is outside the triangles is in no polygon.
#[pyfunction]
pub fn areas2(
    py: Python<'_>,
    made: PyRef<'_, ConstrainedTriangulation>,
    segments: PyReadonlyArray2<'_, i32>,
    polygons: PyReadonlyArray1<'_, i32>,
) -> Outcome<Areas> {
    areas_of(py, &made, segments, polygons)
}

fn areas_of(
    py: Python<'_>,
    made: &ConstrainedTriangulation,
    segments: PyReadonlyArray2<'_, i32>,
    polygons: PyReadonlyArray1<'_, i32>,
) -> Outcome<Areas> {
    let duplicates = made.duplicates.lend(py)?;
    let mut ends = copied(rows::<i32, 2>(&segments, "segments")?)?;
    // Equal points are one vertex; duplicates ascend by row.
    let duplicates: &[[i32; 2]] = rows(&duplicates, "duplicates")?;
    for end in ends.as_flattened_mut() {
        if let Ok(at) = duplicates.binary_search_by_key(end, |pair| pair[0]) {
            *end = duplicates[at][1];
        }
    }
    let polygons = column(py, sides_of_closed(py, &ends, &polygons)?);
    let [simplices, neighbors] = [made.simplices.lend(py)?, made.neighbors.lend(py)?];
    let (walls, pieces) = (made.constrained.lend(py)?, made.segments.lend(py)?);
    let component = components2(py, neighbors.clone(), walls.clone())?;
    let of = component.lend(py)?;
    let last = flat(&of, "component")?.iter().max();
    let count = last.map_or(0, |&last| last as usize + 1);
    let parts = PartArrays(simplices, neighbors, walls, of.clone(), pieces);
    let covers = CoverArrays(
        made.source_start.lend(py)?,
        made.source.lend(py)?,
        polygons.lend(py)?,
    );
    let inside = components_inside2(py, parts, covers, count)?.lend(py)?;
    let first = first_of(rows(&inside, "inside")?, count)?;
    Ok((component, column(py, first)))
}

/// The polygon of each segment, or -1, without polygons of which an odd number of sides meet at some
/// vertex.
#[pyfunction]
pub fn closed_polygons(
    py: Python<'_>,
    ends: PyReadonlyArray2<'_, i32>,
    polygons: PyReadonlyArray1<'_, i32>,
) -> Outcome<Column<i32>> {
    let found = sides_of_closed(py, rows(&ends, "ends")?, &polygons)?;
    Ok(column(py, found))
}

fn sides_of_closed(
    py: Python<'_>,
    ends: &[[i32; 2]],
    polygons: &PyReadonlyArray1<'_, i32>,
) -> Outcome<Vec<i32>> {
    let polygons = flat(polygons, "polygons")?;
    if polygons.len() != ends.len() {
        return Err(unequal().into());
    }
    watched(py, |watch| closed(ends, polygons, watch))
}

/// Pairs of a subsegment and a polygon of which an odd number of sides cover it, ascending, (k, 2).
#[pyfunction]
pub fn odd_pairs2(py: Python<'_>, covers: CoverArrays<'_>) -> Outcome<Table<i32>> {
    let covers = covers.checked()?;
    table(py, watched(py, |watch| odd_pairs(covers, watch))?)
}

/// The triangles inside rings, and the vertices added where they cross.
#[pyfunction]
pub fn polygon2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray1<'_, i32>,
    nonzero: bool,
) -> Outcome<(Table<f64>, Table<i32>)> {
    let points: &[Point2] = rows(&points, "points")?;
    let starts = bounds(&starts, points.len())?;
    let rule = if nonzero {
        Rule::NonZero
    } else {
        Rule::EvenOdd
    };
    let filled = watched(py, |watch| polygon(points, &starts, rule, watch))?;
    Ok((table(py, filled.added)?, table(py, filled.simplices)?))
}

/// A read-only copy of the points and the triangles of one ring; None unless the ring is known to
/// be simple and `points` is a contiguous array of doubles.
///
/// It holds the GIL: such rings are short, and releasing it would cost as much as triangulating.
#[pyfunction]
pub fn ring2(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
) -> Outcome<Option<(Table<f64>, Table<i32>)>> {
    let Ok(points) = points.extract::<PyReadonlyArray2<'_, f64>>() else {
        return Ok(None);
    };
    let Ok(points) = rows::<f64, 2>(&points, "points") else {
        return Ok(None);
    };
    let Some(simplices) = simple_ring(points)? else {
        return Ok(None);
    };
    Ok(Some((frozen(py, points)?, frozen(py, &simplices)?)))
}

/// The start of each ring, and the end.
fn bounds(starts: &PyReadonlyArray1<'_, i32>, count: usize) -> Result<Vec<usize>> {
    let starts = flat(starts, "starts")?;
    each_in_range(starts, 0, count + 1, "starts")?;
    if !starts.is_sorted() {
        return Err(Error::Shape("starts must ascend".into()));
    }
    Ok(starts.iter().map(|&s| s as usize).collect())
}
