//! Alpha complexes and concave hulls as arrays.

use delone_core::alpha::{self, Cloud, Limit, Sites};
use delone_core::base::error::{Error, Result};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, columns, flat, flattened, in_dimension, in_many, in_range, rows, table,
    wide,
};
use crate::errors::Outcome;
use crate::given::{checked, finite_weights, simplices_of, unequal};
use crate::signals::watched;

/// `(simplices, values)`.
type Valued = (Table<i32>, Column<f64>);
/// `(values of triangles, (edges, values))`.
type Flat = (Column<f64>, Valued);
/// `(values of tetrahedra, (faces, values), (edges, values))`.
type Solid = (Column<f64>, Valued, Valued);
/// `(vertices, starts, parts, outer)`.
type Rings = (Column<i32>, Column<i32>, Column<i32>, Column<bool>);

/// The values of triangles and their edges.
#[pyfunction]
pub fn alpha_flat(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Flat> {
    in_dimension!(columns(&points), D, N => {
        let given = checked::<D, 3>(&points, &simplices, &neighbors)?;
        let weights = finite_weights(weights.as_ref(), given.points.len())?;
        let found = watched(py, |watch| {
            let sites = Sites {
                points: given.points,
                weights,
            };
            alpha::flat(sites, given.simplices, given.neighbors, workers, watch)
        })?;
        let edges = (table(py, found.edges)?, column(py, found.of_edges));
        Ok((column(py, found.triangles), edges))
    })
}

/// The values of simplices in four to eight dimensions, and `(faces, values)` of each dimension below.
#[pyfunction]
pub fn alpha_faces(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    simplices: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<(Column<f64>, Vec<Valued>)> {
    in_many!(columns(&points), D, N, P => {
        let cloud = Cloud {
            points: flattened(&points, D, "points")?,
            dimension: D,
            weights: finite_weights(weights.as_ref(), points.shape()[0])?,
        };
        let simplices = simplices_of::<N>(&simplices, points.shape()[0])?.as_flattened();
        let (values, below) =
            watched(py, |watch| alpha::faces(cloud, simplices, workers, watch))?;
        let listed = below.into_iter().enumerate().map(|(k, level)| {
            Ok((wide(py, level.rows, k + 1)?, column(py, level.values)))
        });
        Ok((column(py, values), listed.collect::<Outcome<_>>()?))
    })
}

/// The values of edges without cofaces.
#[pyfunction]
pub fn alpha_edges(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    edges: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Column<f64>> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let weights = finite_weights(weights.as_ref(), points.len())?;
        let sites = Sites { points, weights };
        let edges = simplices_of::<2>(&edges, points.len())?;
        let found = watched(py, |watch| alpha::edges(sites, edges, workers, watch))?;
        Ok(column(py, found))
    })
}

/// The values of points, from those of edges.
#[pyfunction]
pub fn alpha_vertices(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    edges: PyReadonlyArray2<'_, i32>,
    values: PyReadonlyArray1<'_, f64>,
) -> Outcome<Column<f64>> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let weights = finite_weights(weights.as_ref(), points.len())?;
        let edges = simplices_of::<2>(&edges, points.len())?;
        let values = flat(&values, "values")?;
        if edges.len() != values.len() {
            return Err(unequal().into());
        }
        let sites = Sites { points, weights };
        let found = watched(py, |watch| alpha::vertices(sites, edges, values, watch))?;
        Ok(column(py, found))
    })
}

/// The numbers of components of the first simplices of an order.
#[pyfunction]
pub fn alpha_counts(
    py: Python<'_>,
    order: PyReadonlyArray1<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    outside: bool,
) -> Outcome<Column<i32>> {
    let order = flat(&order, "order")?;
    let d = columns(&neighbors).wrapping_sub(1);
    if d > 3 {
        return in_many!(d, D, N, P => counted::<N>(py, order, &neighbors, outside));
    }
    in_dimension!(d, D, N => counted::<N>(py, order, &neighbors, outside))
}

/// The same for simplices with `N` corners.
fn counted<const N: usize>(
    py: Python<'_>,
    order: &[i32],
    neighbors: &PyReadonlyArray2<'_, i32>,
    outside: bool,
) -> Outcome<Column<i32>> {
    let neighbors: &[[i32; N]] = rows(neighbors, "neighbors")?;
    in_range(neighbors, -1, neighbors.len(), "neighbors")?;
    in_range(order.as_chunks::<1>().0, 0, neighbors.len(), "order")?;
    let found = watched(py, |watch| alpha::counts(order, neighbors, outside, watch))?;
    Ok(column(py, found))
}

/// The component of each simplex that is kept, -1 of others.
#[pyfunction]
pub fn alpha_labels(
    py: Python<'_>,
    kept: PyReadonlyArray1<'_, bool>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<Column<i32>> {
    in_dimension!(columns(&neighbors).wrapping_sub(1), D, N => {
        let neighbors: &[[i32; N]] = rows(&neighbors, "neighbors")?;
        in_range(neighbors, -1, neighbors.len(), "neighbors")?;
        let kept = flat(&kept, "kept")?;
        if kept.len() != neighbors.len() {
            return Err(unequal().into());
        }
        let found = watched(py, |watch| alpha::labels(kept, neighbors, watch))?;
        Ok(column(py, found))
    })
}

/// The values of tetrahedra, their faces and their edges.
#[pyfunction]
pub fn alpha_solid3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Solid> {
    let given = checked::<3, 4>(&points, &simplices, &neighbors)?;
    let weights = finite_weights(weights.as_ref(), given.points.len())?;
    let found = watched(py, |watch| {
        let sites = Sites {
            points: given.points,
            weights,
        };
        alpha::solid(sites, given.simplices, given.neighbors, workers, watch)
    })?;
    let faces = (table(py, found.faces)?, column(py, found.of_faces));
    let edges = (table(py, found.edges)?, column(py, found.of_edges));
    Ok((column(py, found.tetrahedra), faces, edges))
}

/// `(triangles, edges, conflicts)`: the values of periodic triangles, (m,), and of the edges opposite
/// their corners, (m, 3), and whether (tail, head) of these are in conflict with the other, (3 m, 2).
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one array each")]
pub fn alpha_torus2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    simplices: PyReadonlyArray2<'_, i32>,
    offsets: PyReadonlyArray3<'_, i32>,
    partners: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<(Column<f64>, Table<f64>, Table<i32>)> {
    let points: &[[f64; 2]] = rows(&points, "points")?;
    let weights = finite_weights(weights.as_ref(), points.len())?;
    let simplices = simplices_of::<3>(&simplices, points.len())?;
    let partners: &[[i32; 3]] = rows(&partners, "partners")?;
    in_range(partners, -1, 3 * simplices.len(), "partners")?;
    let offsets = flat(&offsets, "offsets")?.as_chunks::<2>().0;
    let offsets: &[[[i32; 2]; 3]] = offsets.as_chunks::<3>().0;
    let right = |corner: &[i32; 2]| corner.iter().all(|k| (-2..=2).contains(k));
    if !offsets.iter().flatten().all(right) {
        return Err(Error::Shape("offsets must be -2 to 2 periods".into()).into());
    }
    if offsets.len() != simplices.len() || partners.len() != simplices.len() {
        return Err(unequal().into());
    }
    let sites = Sites { points, weights };
    let found = watched(py, |watch| {
        alpha::torus(sites, periods, simplices, offsets, partners, workers, watch)
    })?;
    Ok((
        column(py, found.triangles),
        table(py, found.of_edges)?,
        table(py, found.conflicts.into_flattened())?,
    ))
}

/// `(vertices, starts, parts, outer)`: the rings of the components of triangles.
#[pyfunction]
pub fn alpha_rings2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    labels: PyReadonlyArray1<'_, i32>,
) -> Outcome<Rings> {
    let given = checked::<2, 3>(&points, &simplices, &neighbors)?;
    let labels = flat(&labels, "labels")?;
    if labels.len() != given.simplices.len() {
        return Err(unequal().into());
    }
    let found = watched(py, |watch| {
        alpha::rings(
            given.points,
            given.simplices,
            given.neighbors,
            labels,
            watch,
        )
    })?;
    Ok((
        column(py, found.vertices),
        column(py, found.starts),
        column(py, found.parts),
        column(py, found.outer),
    ))
}

/// The limit of a name: a length, or a ratio.
fn limit(name: &str, value: f64) -> Result<Limit> {
    match name {
        "length" => Ok(Limit::Length(value)),
        "ratio" => Ok(Limit::Ratio(value)),
        _ => Err(Error::Shape(format!(
            "the limit must be length or ratio, got {name}"
        ))),
    }
}

/// Which simplices of a concave hull remain; `holes` is whether triangles may leave holes.
#[pyfunction]
pub fn erode(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    name: &str,
    value: f64,
    holes: bool,
) -> Outcome<Column<bool>> {
    let limit = limit(name, value)?;
    let found = if columns(&points) == 2 {
        let given = checked::<2, 3>(&points, &simplices, &neighbors)?;
        watched(py, |watch| alpha::erode2(given, limit, holes, watch))?
    } else {
        let given = checked::<3, 4>(&points, &simplices, &neighbors)?;
        watched(py, |watch| alpha::erode3(given, limit, watch))?
    };
    Ok(column(py, found))
}
