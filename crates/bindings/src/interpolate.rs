//! Interpolation: the bodies of the methods of `Locator2`, and other functions.

use delone_core::base::error::{Error, Result};
use delone_core::interpolate::space;
use delone_core::interpolate::{
    Adjacency, Barrier, Field, Kind, Method, Order, Rows, Table as Sums, clough_tocher,
    clough_tocher_weights, global_gradients, leave_one_out, linear, local_gradients, natural,
    natural_values,
};
use delone_core::{Point2, Point3};
use numpy::{
    PyArray3, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, each_in_range, flat, rows, shaped};
use crate::errors::Outcome;
use crate::locator::Plane;
use crate::signals::watched;

/// Columns of values.
pub type Values<'py> = PyReadonlyArray2<'py, f64>;
/// Rows of points.
pub type Points<'py> = PyReadonlyArray2<'py, f64>;
/// A gradient for each value.
pub type Gradients<'py> = PyReadonlyArray3<'py, f64>;
/// Closed edges.
pub type Closed<'py> = PyReadonlyArray2<'py, bool>;

/// `NDArray[np.float64]`: two axes, or three for derivatives.
pub type Array = Py<PyAny>;

fn order_of(order: usize) -> PyResult<Order> {
    Order::of(order).ok_or_else(|| PyValueError::new_err("order must be 0, 1 or 2"))
}

fn kind_of(kind: &str) -> PyResult<Kind> {
    let names = Kind::NAMES.map(|(name, _)| name);
    let message = || PyValueError::new_err(format!("kind must be one of {names:?}, got {kind:?}"));
    Kind::named(kind).ok_or_else(message)
}

/// The barrier, one row per triangle; empty if there is none.
fn barrier_of<'a>(barrier: Option<&'a Closed<'_>>, triangles: usize) -> Result<Barrier<'a>> {
    let Some(array) = barrier else {
        return Ok(&[]);
    };
    let closed = rows(array, "barrier")?;
    if closed.len() == triangles {
        Ok(closed)
    } else {
        Err(Error::Shape(
            "barrier must have one row for each triangle".into(),
        ))
    }
}

/// A result with `columns` columns, and an axis for derivatives if there are any.
fn table_of(
    py: Python<'_>,
    found: Vec<f64>,
    queries: usize,
    columns: usize,
    order: Order,
) -> Outcome<Array> {
    match order {
        Order::Value => Ok(shaped(py, found, [queries, columns])?.into_any()),
        _ => Ok(shaped(py, found, [queries, columns, order.components()])?.into_any()),
    }
}

/// Linear interpolation.
pub fn linear_of(
    py: Python<'_>,
    locator: &Plane,
    values: &Values<'_>,
    xi: &Points<'_>,
    order: usize,
    workers: usize,
) -> Outcome<Array> {
    let order = order_of(order)?;
    let columns = values.shape()[1];
    let items = flat(values, "values")?;
    let (found, n) = locator.batch(xi, workers, |batch| {
        let field = Field::new(&batch.locator.given, items, None, columns)?;
        linear(batch, field, order)
    })?;
    table_of(py, found, n, columns, order)
}

/// The input of Clough-Tocher and natural neighbor interpolation.
pub struct Smooth<'a, 'py> {
    /// Columns of values.
    pub values: &'a Values<'py>,
    /// A gradient for each.
    pub gradients: Option<&'a Gradients<'py>>,
    /// The queries.
    pub xi: &'a Points<'py>,
    /// Closed edges.
    pub barrier: Option<&'a Closed<'py>>,
    /// The order of derivatives.
    pub order: usize,
    /// Number of threads.
    pub workers: usize,
}

/// Clough-Tocher interpolation, or natural neighbor interpolation if there is a kind.
pub fn smooth_of(
    py: Python<'_>,
    locator: &Plane,
    kind: Option<&str>,
    given: Smooth<'_, '_>,
) -> Outcome<Array> {
    let order = order_of(given.order)?;
    let kind = kind.map(kind_of).transpose()?;
    let columns = given.values.shape()[1];
    let items = flat(given.values, "values")?;
    let slopes = given.gradients.map(|g| flat(g, "gradients"));
    let slopes = slopes.transpose()?;
    if slopes.is_none() & kind.is_none_or(Kind::is_smooth) {
        return Err(
            PyValueError::new_err("smooth kinds need gradients: pass those of the values").into(),
        );
    }
    let barrier = barrier_of(given.barrier, locator.held.count(py))?;
    let (found, n) = locator.batch(given.xi, given.workers, |batch| {
        let field = Field::new(&batch.locator.given, items, slopes, columns)?;
        match kind {
            None => clough_tocher(batch, field, barrier, order),
            Some(kind) => natural_values(batch, kind, field, barrier, order),
        }
    })?;
    table_of(py, found, n, columns, order)
}

/// Weights of Clough-Tocher interpolation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CornerWeights {
    /// The triangle that contains each query, -1 outside, (q,).
    pub simplex: Column<i32>,
    /// Weights of values at its corners, (q, 3).
    pub weights: Table<f64>,
    /// Weights of gradients at its corners, (q, 3, 2).
    pub slopes: Py<PyArray3<f64>>,
}

/// The weights of Clough-Tocher interpolation.
pub fn corner_weights_of(
    py: Python<'_>,
    locator: &Plane,
    xi: &Points<'_>,
    barrier: Option<&Closed<'_>>,
    workers: usize,
) -> Outcome<CornerWeights> {
    let barrier = barrier_of(barrier, locator.held.count(py))?;
    let (found, n) = locator.batch(xi, workers, |batch| clough_tocher_weights(batch, barrier))?;
    Ok(CornerWeights {
        simplex: column(py, found.triangle),
        weights: shaped(py, found.weights, [n, 3])?,
        slopes: shaped(py, found.slopes, [n, 3, 2])?,
    })
}

/// Weights of natural neighbors as compressed rows.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct NaturalWeights {
    /// Start of the neighbors of each query, and the end, (q + 1,).
    pub indptr: Column<i64>,
    /// The neighbors, (k,).
    pub indices: Column<i32>,
    /// Their weights, (k,).
    pub weights: Column<f64>,
    /// Weights of their gradients, (k, 2); None if the kind has none.
    pub slopes: Option<Table<f64>>,
    /// The simplex that contains each query, -1 outside, (q,).
    pub simplex: Column<i32>,
}

/// The weights of natural neighbors.
pub fn natural_of(
    py: Python<'_>,
    locator: &Plane,
    kind: &str,
    xi: &Points<'_>,
    barrier: Option<&Closed<'_>>,
    workers: usize,
) -> Outcome<NaturalWeights> {
    let kind = kind_of(kind)?;
    let barrier = barrier_of(barrier, locator.held.count(py))?;
    let ((found, triangle), _) =
        locator.batch(xi, workers, |batch| natural(batch, kind, barrier))?;
    let entries = found.indices.len();
    let slopes = if kind.is_smooth() {
        Some(shaped(py, found.slopes, [entries, 2])?)
    } else {
        None
    };
    Ok(NaturalWeights {
        indptr: column(py, found.indptr),
        indices: column(py, found.indices),
        weights: column(py, found.weights),
        slopes,
        simplex: column(py, triangle),
    })
}

/// Weights as compressed rows.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct WeightRows {
    /// Start of the entries of each row, and the end, (n + 1,).
    pub indptr: Column<i64>,
    /// Vertices, (k,).
    pub indices: Column<i32>,
    /// Their weights, (k,).
    pub weights: Column<f64>,
}

/// For each vertex, the weights of the others.
pub fn leave_one_out_of(
    py: Python<'_>,
    locator: &Plane,
    kind: &str,
    workers: usize,
) -> Outcome<WeightRows> {
    let method = Method::named(kind).ok_or_else(|| {
        PyValueError::new_err(format!("kind {kind:?} has no leave-one-out weights"))
    })?;
    let Rows {
        indptr,
        indices,
        weights,
        ..
    } = locator.run(py, usize::MAX, |at, watch| {
        leave_one_out(at.given, method, workers, watch)
    })?;
    Ok(WeightRows {
        indptr: column(py, indptr),
        indices: column(py, indices),
        weights: column(py, weights),
    })
}

/// Sums of weights times values, row by row.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python passes arrays one by one")]
pub fn combine2(
    py: Python<'_>,
    indptr: PyReadonlyArray1<'_, i64>,
    indices: PyReadonlyArray1<'_, i32>,
    weights: PyReadonlyArray1<'_, f64>,
    values: Values<'_>,
    slopes: Option<PyReadonlyArray2<'_, f64>>,
    gradients: Option<Gradients<'_>>,
    workers: usize,
) -> Outcome<Table<f64>> {
    let [n, columns] = [0, 1].map(|k| values.shape()[k]);
    let slopes = slopes.as_ref().map(|s| rows(s, "slopes"));
    let gradients = gradients.as_ref().map(|g| flat(g, "gradients"));
    let table = Sums {
        indptr: flat(&indptr, "indptr")?,
        indices: flat(&indices, "indices")?,
        weights: flat(&weights, "weights")?,
        slopes: slopes.transpose()?,
    };
    let gradients = gradients.transpose()?;
    if table.slopes.is_some() != gradients.is_some() {
        let text = "slopes and gradients must be given together";
        return Err(PyValueError::new_err(text).into());
    }
    let items = flat(&values, "values")?;
    let field = Field::of_rows(n, items, gradients, columns)?;
    let found = watched(py, |watch| table.combine(n, field, workers, watch))?;
    shaped(py, found, [indptr.shape()[0].saturating_sub(1), columns])
}

/// Gradients of minimal bending energy, and the number of sweeps for each column.
#[pyfunction]
#[pyo3(signature = (points, indptr, indices, values, tol, maxiter, workers, floor=None))]
#[expect(clippy::too_many_arguments, reason = "Python passes arrays one by one")]
pub fn gradients_global2(
    py: Python<'_>,
    points: Points<'_>,
    indptr: PyReadonlyArray1<'_, i32>,
    indices: PyReadonlyArray1<'_, i32>,
    values: Values<'_>,
    tol: f64,
    maxiter: usize,
    workers: usize,
    floor: Option<f64>,
) -> Outcome<(Py<PyArray3<f64>>, Column<i64>)> {
    let rows: &[Point2] = rows(&points, "points")?;
    let (n, columns) = (rows.len(), values.shape()[1]);
    let starts = flat(&indptr, "indptr")?;
    let ends = flat(&indices, "indices")?;
    let items = flat(&values, "values")?;
    let field = Field::of_rows(n, items, None, columns)?;
    let (found, sweeps) = watched(py, |watch| {
        let edges = Adjacency::new(n, starts, ends)?;
        global_gradients(rows, edges, field, tol, floor, maxiter, workers, watch)
    })?;
    Ok((shaped(py, found, [n, columns, 2])?, column(py, sweeps)))
}

/// Gradients of polynomials fitted around each vertex.
#[pyfunction]
pub fn gradients_local2(
    py: Python<'_>,
    points: Points<'_>,
    indptr: PyReadonlyArray1<'_, i32>,
    indices: PyReadonlyArray1<'_, i32>,
    values: Values<'_>,
    degree: usize,
    workers: usize,
) -> Outcome<Py<PyArray3<f64>>> {
    if !(1..=2).contains(&degree) {
        return Err(PyValueError::new_err("degree must be 1 or 2").into());
    }
    let rows: &[Point2] = rows(&points, "points")?;
    let (n, columns) = (rows.len(), values.shape()[1]);
    let starts = flat(&indptr, "indptr")?;
    let ends = flat(&indices, "indices")?;
    let items = flat(&values, "values")?;
    let field = Field::of_rows(n, items, None, columns)?;
    let found = watched(py, |watch| {
        let edges = Adjacency::new(n, starts, ends)?;
        local_gradients(rows, edges, field, degree, workers, watch)
    })?;
    shaped(py, found, [n, columns, 2])
}

/// Gradients of linear functions fitted around some vertices of a 3-D triangulation.
#[pyfunction]
pub fn gradients_local3(
    py: Python<'_>,
    points: Points<'_>,
    indptr: PyReadonlyArray1<'_, i32>,
    indices: PyReadonlyArray1<'_, i32>,
    values: Values<'_>,
    vertices: PyReadonlyArray1<'_, i32>,
    workers: usize,
) -> Outcome<Py<PyArray3<f64>>> {
    let rows: &[Point3] = rows(&points, "points")?;
    let (n, columns) = (rows.len(), values.shape()[1]);
    let starts = flat(&indptr, "indptr")?;
    let ends = flat(&indices, "indices")?;
    let vertices = flat(&vertices, "vertices")?;
    each_in_range(vertices, 0, n, "vertices")?;
    let items = flat(&values, "values")?;
    let field = Field::of_rows(n, items, None, columns)?;
    let found = watched(py, |watch| {
        let edges = Adjacency::new(n, starts, ends)?;
        space::local_gradients(rows, edges, field, vertices, workers, watch)
    })?;
    shaped(py, found, [vertices.len(), columns, 3])
}
