//! What is wrong with triangulations, as arrays.

use delone_core::base::error::Error;
use delone_core::base::proof::Findings;
use delone_core::base::watch::Watch;
use delone_core::delaunay::{plane, space};
use delone_core::ndim;
use delone_core::regular::{self, Wrapped};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, columns, in_flats, in_many, in_range, number_rows, numbers, rows,
    signed, wide,
};
use crate::errors::Outcome;
use crate::given::{checked, finite_weights, unequal};
use crate::ndim::rest_of;
use crate::signals::watched;

/// Faults of a triangulation with d coordinates; arrays are empty if there are none.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct Faults {
    /// Simplices that are not positively oriented, (k,).
    pub orientation: Column<i32>,
    /// In 2-D, directed edges that more than one triangle uses, (k, 2).
    pub edges: Table<i32>,
    /// In 3-D, oriented faces that more than one tetrahedron has, (k, d).
    pub facets: Table<i32>,
    /// Simplices whose row of neighbors is wrong, (k,).
    pub neighbors: Column<i32>,
    /// Boundary facets that are not on the hull, (k, d).
    pub hull: Table<i32>,
    /// Rows of distinct points that no simplex uses; with weights, those outside all simplices, (k,).
    pub missing: Column<i32>,
    /// With weights, rows that should be vertices though simplices cover them, (k,).
    pub hidden: Column<i32>,
    /// Rows that are used although another row represents their coordinates, (k,).
    pub repeats: Column<i32>,
    /// Pairs of simplices that are not locally Delaunay or regular, (k, 2).
    pub delaunay: Table<i32>,
    /// Pairs of simplices on a tie that are not canonical, (k, 2).
    pub ties: Table<i32>,
    /// In 2-D, numbers of triangles expected and found, (2,), if they differ; otherwise (0,).
    pub count: Column<i32>,
    /// In more than three dimensions, simplices that cover a point of simplex 0, (k,).
    pub overlaps: Column<i32>,
}

/// Faults of a periodic triangulation; arrays are empty if there are none.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct PeriodicFaults {
    /// Triangles with impossible offsets; if there are any, nothing else is checked, (k,).
    pub offsets: Column<i32>,
    /// Faults as without periods: `neighbors` has triangles whose neighbors or partners are wrong,
    /// and `hull` edges without a partner that are not on the boundary of the strip.
    pub faults: Py<Faults>,
    /// How often the triangles cover the plane, (1,), if not once; otherwise (0,).
    pub layers: Column<i32>,
}

/// Faults as arrays.
fn faults<const D: usize>(py: Python<'_>, found: Findings<D>) -> Outcome<Faults> {
    let (edges, facets) = match D {
        2 => (found.facets, Vec::new()),
        _ => (Vec::new(), found.facets),
    };
    Ok(Faults {
        orientation: numbers(py, found.orientation),
        edges: wide(py, signed(&edges).into_flattened(), 2)?,
        facets: number_rows(py, &facets)?,
        neighbors: numbers(py, found.neighbors),
        hull: number_rows(py, &found.hull)?,
        missing: numbers(py, found.missing),
        hidden: numbers(py, found.hidden),
        repeats: numbers(py, found.repeats),
        delaunay: number_rows(py, &found.delaunay)?,
        ties: number_rows(py, &found.ties)?,
        count: numbers(py, found.count.into_flattened()),
        overlaps: numbers(py, found.overlaps),
    })
}

/// Returns the faults of a triangulation with two to eight coordinates.
#[pyfunction]
pub fn validate<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
) -> Outcome<Faults> {
    match columns(&points) {
        2 => {
            let given = checked(&points, &simplices, &neighbors)?;
            faults(
                py,
                watched(py, |watch| plane::validate::validate(given, watch))?,
            )
        }
        3 => {
            let given = checked(&points, &simplices, &neighbors)?;
            faults(
                py,
                watched(py, |watch| space::validate::validate(given, watch))?,
            )
        }
        many => in_many!(many, D, N, P => {
            let given = checked(&points, &simplices, &neighbors)?;
            faults(py, watched(py, |watch| ndim::validate::<D, N, P>(given, watch))?)
        }),
    }
}

/// The faults of a triangulation of points in a flat, given as to `triangulate_in_flat`.
#[pyfunction]
pub fn validate_in_flat(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    rest: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<Faults> {
    in_flats!(columns(&points), D, N, P => {
        let given = checked(&points, &simplices, &neighbors)?;
        let rest = rest_of(&rest, given.points.len())?;
        let check = |watch: &Watch| ndim::validate_in_flat::<D, N, P>(given, rest, watch);
        faults(py, watched(py, check)?)
    })
}

/// The same of a regular triangulation; also, for each row, the one that represents it.
#[pyfunction]
pub fn validate_regular(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    weights: PyReadonlyArray1<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
) -> Outcome<(Faults, Column<i32>)> {
    macro_rules! by {
        ($validate:expr) => {{
            let given = checked(&points, &simplices, &neighbors)?;
            let weights = finite_weights(Some(&weights), given.points.len())?;
            let (found, stands_for) = watched(py, |watch| $validate(given, weights, watch))?;
            Ok((faults(py, found)?, column(py, stands_for)))
        }};
    }
    match columns(&points) {
        2 => by!(regular::validate),
        3 => by!(regular::space::validate),
        many => in_many!(many, D, N, P => by!(ndim::validate_regular::<D, N, P>)),
    }
}

/// Returns the faults of a periodic triangulation: periods of 0 mean none; `offsets` has those of the
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
    let found = watched(py, |watch| regular::validate_periodic(wrapped, watch))?;
    Ok(PeriodicFaults {
        offsets: numbers(py, found.offsets),
        faults: Py::new(py, faults(py, found.faults)?)?,
        layers: numbers(py, found.layers),
    })
}
