//! What is wrong with regular and with periodic triangulations, as arrays.

use delone_core::base::error::Error;
use delone_core::ndim;
use delone_core::regular::space;
use delone_core::regular::{self, Wrapped};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, columns, in_many, in_range, number_rows, numbers, rows,
};
use crate::errors::Outcome;
use crate::given::{checked, finite_weights, unequal};
use crate::ndim::{FaultsN, faults};
use crate::signals::watched;
use crate::space::{Faults3, faults3};
use crate::triangulation::{Faults2, faults2};

/// What is wrong with a 2-D regular triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RegularFaults2 {
    /// Faults as without weights; `missing` has points outside all triangles.
    pub faults: Py<Faults2>,
    /// Rows that should be vertices though triangles cover them, (k,).
    pub hidden: Column<i32>,
    /// The row that represents each point, (n,).
    pub stands_for: Column<i32>,
}

/// What is wrong with a 3-D regular triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RegularFaults3 {
    /// Faults as without weights; `missing` has points outside all tetrahedra.
    pub faults: Py<Faults3>,
    /// Rows that should be vertices though tetrahedra cover them, (k,).
    pub hidden: Column<i32>,
    /// The row that represents each point, (n,).
    pub stands_for: Column<i32>,
}

/// What is wrong with a regular triangulation in four to eight dimensions.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RegularFaultsN {
    /// Faults as without weights; `missing` has points outside all simplices.
    pub faults: Py<FaultsN>,
    /// Rows that should be vertices though simplices cover them, (k,).
    pub hidden: Column<i32>,
    /// The row that represents each point, (n,).
    pub stands_for: Column<i32>,
}

/// What is wrong with a periodic triangulation; arrays are empty where nothing is.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct PeriodicFaults {
    /// Triangles with impossible offsets; if there are any, nothing else is checked, (k,).
    pub offsets: Column<i32>,
    /// Triangles that are not counter-clockwise, (k,).
    pub orientation: Column<i32>,
    /// Triangles whose neighbors or partners are wrong, (k,).
    pub neighbors: Column<i32>,
    /// Edges without a partner that are not on the boundary of the strip, (k, 2).
    pub hull: Table<i32>,
    /// Rows of distinct points that no triangle uses, (k,).
    pub missing: Column<i32>,
    /// Rows that are used although another row represents them, (k,).
    pub repeats: Column<i32>,
    /// Rows that should be vertices though triangles cover them, (k,).
    pub hidden: Column<i32>,
    /// Pairs of triangles that are not locally Delaunay or regular, (k, 2).
    pub delaunay: Table<i32>,
    /// Pairs of triangles on a tie that are not canonical, (k, 2).
    pub ties: Table<i32>,
    /// Numbers of triangles expected and found, (2,), where they differ; otherwise (0,).
    pub count: Column<i32>,
    /// How often the triangles cover the plane, (1,), if not once; otherwise (0,).
    pub layers: Column<i32>,
}

/// What is wrong with a 2-D regular triangulation.
#[pyfunction]
pub fn validate_regular2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<RegularFaults2> {
    let given = checked::<2, 3>(&points, &simplices, &neighbors)?;
    let point_weights = finite_weights(Some(&weights), given.points.len())?;
    let found = watched(py, |watch| regular::validate(given, point_weights, watch))?;
    Ok(RegularFaults2 {
        faults: Py::new(py, faults2(py, found.faults)?)?,
        hidden: numbers(py, found.hidden),
        stands_for: column(py, found.stands_for),
    })
}

/// What is wrong with a 3-D regular triangulation.
#[pyfunction]
pub fn validate_regular3(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<RegularFaults3> {
    let given = checked::<3, 4>(&points, &simplices, &neighbors)?;
    let point_weights = finite_weights(Some(&weights), given.points.len())?;
    let found = watched(py, |watch| space::validate(given, point_weights, watch))?;
    Ok(RegularFaults3 {
        faults: Py::new(py, faults3(py, found.faults)?)?,
        hidden: numbers(py, found.hidden),
        stands_for: column(py, found.stands_for),
    })
}

/// What is wrong with a regular triangulation in four to eight dimensions.
#[pyfunction]
pub fn validate_regular_n(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<RegularFaultsN> {
    in_many!(columns(&points), D, N, P => {
        let given = checked(&points, &simplices, &neighbors)?;
        let weights = finite_weights(Some(&weights), given.points.len())?;
        let (mut found, stands_for) = watched(py, |watch| {
            ndim::validate_regular::<D, N, P>(given, weights, watch)
        })?;
        let hidden = numbers(py, std::mem::take(&mut found.hidden));
        Ok(RegularFaultsN {
            faults: Py::new(py, faults(py, found)?)?,
            hidden,
            stands_for: column(py, stands_for),
        })
    })
}

/// What is wrong with a periodic triangulation: periods of 0 mean none; `offsets` has those of the
/// three corners of each triangle in one row.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one array each")]
pub fn validate_periodic2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    periods: [f64; 2],
    simplices: PyReadonlyArray2<'_, i32>,
    offsets: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    partners: PyReadonlyArray2<'_, i32>,
) -> Outcome<PeriodicFaults> {
    let given = checked::<2, 3>(&points, &simplices, &neighbors)?;
    let count = given.simplices.len();
    let wrapped = Wrapped {
        points: given.points,
        weights: finite_weights(weights.as_ref(), given.points.len())?,
        periods,
        simplices: given.simplices,
        offsets: rows(&offsets, "offsets")?,
        neighbors: given.neighbors,
        partners: rows(&partners, "partners")?,
    };
    in_range(wrapped.partners, -1, 3 * count, "partners")?;
    if wrapped.offsets.len() != count || wrapped.partners.len() != count {
        return Err(unequal().into());
    }
    if !periods.iter().all(|x| *x >= 0.0 && x.is_finite()) {
        return Err(Error::Shape("periods are not finite lengths".into()).into());
    }
    let given = wrapped;
    let found = watched(py, |watch| regular::validate_periodic(given, watch))?;
    Ok(PeriodicFaults {
        offsets: numbers(py, found.offsets),
        orientation: numbers(py, found.orientation),
        neighbors: numbers(py, found.neighbors),
        hull: number_rows(py, &found.hull)?,
        missing: numbers(py, found.missing),
        repeats: numbers(py, found.repeats),
        hidden: numbers(py, found.hidden),
        delaunay: number_rows(py, &found.delaunay)?,
        ties: number_rows(py, &found.ties)?,
        count: numbers(py, found.count.into_flattened()),
        layers: numbers(py, found.layers),
    })
}
