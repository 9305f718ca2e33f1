//! Point location on arrays.

use delone_core::base::error::Error;
use delone_core::locate::{Batch, Kept, Locator, along, coordinates, find, nearest};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, rows, shaped};
use crate::errors::Outcome;
use crate::given::checked;
use crate::interpolate::{
    Array, Closed, CornerWeights, Gradients, NaturalWeights, Points, Smooth, Values, WeightRows,
    corner_weights_of, leave_one_out_of, linear_of, natural_of, smooth_of,
};
use crate::locator::Plane;
use crate::signals::watched;

/// Locations of queries in triangles.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Location2 {
    /// The triangle that contains each query, -1 outside, (q,).
    pub simplex: Column<i32>,
    /// Weights of its corners, NaN outside, (q, 3).
    pub weights: Table<f64>,
    /// Outside, the triangle at the nearest point of the boundary; else -1, (q,).
    pub beside: Column<i32>,
    /// Outside, the boundary edge with that point; else -1, (q, 2).
    pub edge: Table<i32>,
    /// Outside, the position of the point along that edge, from 0 to 1; else NaN, (q,).
    pub along: Column<f64>,
}

/// A triangulation that is kept for many calls.
#[pyclass(frozen, module = "delone._core")]
pub struct Locator2(Plane);

#[pymethods]
impl Locator2 {
    #[new]
    fn new(
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        neighbors: PyReadonlyArray2<'_, i32>,
    ) -> Outcome<Self> {
        Plane::new(&points, &simplices, &neighbors).map(Self)
    }

    /// For each query, the first triangle that contains it, or -1.
    fn find(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.column(&xi, workers, find)
    }

    /// Triangles with barycentric coordinates, and outside the nearest boundary point.
    fn locate(&self, py: Python<'_>, xi: Points<'_>, workers: usize) -> Outcome<Location2> {
        let (found, n) = self.0.batch(&xi, workers, coordinates)?;
        Ok(Location2 {
            simplex: column(py, found.triangle),
            weights: shaped(py, found.weights, [n, 3])?,
            beside: column(py, found.beside),
            edge: shaped(py, found.edge, [n, 2])?,
            along: column(py, found.along),
        })
    }

    /// The nearest vertex to each query, in a Delaunay triangulation.
    fn nearest(&self, xi: Points<'_>, workers: usize) -> Outcome<Column<i32>> {
        self.0.column(&xi, workers, nearest)
    }

    /// The triangles along the segment from `a` to `b`.
    fn along(
        &self,
        py: Python<'_>,
        a: PyReadonlyArray1<'_, f64>,
        b: PyReadonlyArray1<'_, f64>,
    ) -> Outcome<Column<i32>> {
        let end = |p: &PyReadonlyArray1<'_, f64>| {
            let pair = p.as_slice().ok().and_then(|p| p.try_into().ok());
            pair.ok_or_else(|| Error::Shape("an end must have two coordinates".into()))
        };
        let (a, b) = (end(&a)?, end(&b)?);
        let met = self
            .0
            .run(py, usize::MAX, |locator, _| along(locator, a, b))?;
        Ok(column(py, met))
    }

    /// Linear interpolation: values, or gradients.
    fn linear(
        &self,
        py: Python<'_>,
        values: Values<'_>,
        xi: Points<'_>,
        order: usize,
        workers: usize,
    ) -> Outcome<Array> {
        linear_of(py, &self.0, &values, &xi, order, workers)
    }

    /// Clough-Tocher interpolation: values, gradients or Hessians.
    #[expect(clippy::too_many_arguments, reason = "Python passes arrays one by one")]
    fn clough_tocher(
        &self,
        py: Python<'_>,
        values: Values<'_>,
        gradients: Gradients<'_>,
        xi: Points<'_>,
        barrier: Option<Closed<'_>>,
        order: usize,
        workers: usize,
    ) -> Outcome<Array> {
        let given = Smooth {
            values: &values,
            gradients: Some(&gradients),
            xi: &xi,
            barrier: barrier.as_ref(),
            order,
            workers,
        };
        smooth_of(py, &self.0, None, given)
    }

    /// The weights of Clough-Tocher interpolation.
    fn clough_tocher_weights(
        &self,
        py: Python<'_>,
        xi: Points<'_>,
        barrier: Option<Closed<'_>>,
        workers: usize,
    ) -> Outcome<CornerWeights> {
        corner_weights_of(py, &self.0, &xi, barrier.as_ref(), workers)
    }

    /// The weights of natural neighbors.
    fn natural(
        &self,
        py: Python<'_>,
        kind: &str,
        xi: Points<'_>,
        barrier: Option<Closed<'_>>,
        workers: usize,
    ) -> Outcome<NaturalWeights> {
        natural_of(py, &self.0, kind, &xi, barrier.as_ref(), workers)
    }

    /// Natural neighbor interpolation: values, gradients or Hessians.
    #[expect(clippy::too_many_arguments, reason = "Python passes arrays one by one")]
    fn natural_values(
        &self,
        py: Python<'_>,
        kind: &str,
        values: Values<'_>,
        gradients: Option<Gradients<'_>>,
        xi: Points<'_>,
        barrier: Option<Closed<'_>>,
        order: usize,
        workers: usize,
    ) -> Outcome<Array> {
        let given = Smooth {
            values: &values,
            gradients: gradients.as_ref(),
            xi: &xi,
            barrier: barrier.as_ref(),
            order,
            workers,
        };
        smooth_of(py, &self.0, Some(kind), given)
    }

    /// For each vertex, the weights of the others.
    fn leave_one_out(&self, py: Python<'_>, kind: &str, workers: usize) -> Outcome<WeightRows> {
        leave_one_out_of(py, &self.0, kind, workers)
    }
}

/// For each query, the first triangle that contains it, or -1.
#[pyfunction]
pub fn find_simplex2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    xi: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<Column<i32>> {
    let given = checked(&points, &simplices, &neighbors)?;
    let queries = rows(&xi, "xi")?;
    let found = watched(py, |watch| {
        let kept = Kept::of(&given, watch)?;
        find(&Batch {
            locator: Locator::new(given, &kept, watch),
            queries,
            workers,
            watch,
        })
    })?;
    Ok(column(py, found))
}
