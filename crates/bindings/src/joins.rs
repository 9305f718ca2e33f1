//! Equal facets in lists, as arrays.

use delone_core::base::error::Result;
use delone_core::base::joins;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, in_range, rows, table};
use crate::errors::Outcome;
use crate::signals::watched;

/// The first row of `facets`, (k, 2) or (k, 3), that is each of `wanted`, -1 where there is none;
/// with the same order of vertices if they are `directed`.
#[pyfunction]
pub fn facet_rows(
    py: Python<'_>,
    facets: PyReadonlyArray2<'_, i32>,
    wanted: PyReadonlyArray2<'_, i32>,
    npoints: usize,
    directed: bool,
) -> Outcome<Column<i32>> {
    match facets.shape()[1] {
        2 => rows_in::<2>(py, &facets, &wanted, npoints, directed),
        _ => rows_in::<3>(py, &facets, &wanted, npoints, directed),
    }
}

fn rows_in<const D: usize>(
    py: Python<'_>,
    facets: &PyReadonlyArray2<'_, i32>,
    wanted: &PyReadonlyArray2<'_, i32>,
    npoints: usize,
    directed: bool,
) -> Outcome<Column<i32>> {
    let (known, wanted): (&[[i32; D]], _) = {
        let known = rows(facets, "facets")?;
        in_range(known, 0, npoints, "facets")?;
        (known, rows(wanted, "wanted")?)
    };
    let found = watched(py, |watch| joins::rows(known, wanted, directed, watch))?;
    Ok(column(py, found))
}

/// The simplex opposite each vertex, -1 if there is none: of triangles, of the same orientation, or of
/// tetrahedra.
#[pyfunction]
pub fn facet_neighbors(
    py: Python<'_>,
    simplices: PyReadonlyArray2<'_, i32>,
    npoints: usize,
) -> Outcome<Table<i32>> {
    if simplices.shape()[1] == 3 {
        let of: &[[i32; 3]] = corners(&simplices, npoints)?;
        let found = watched(py, |watch| joins::neighbors_of_triangles(of, watch))?;
        return table(py, found);
    }
    let of: &[[i32; 4]] = corners(&simplices, npoints)?;
    let found = watched(py, |watch| joins::neighbors_of_tetrahedra(of, watch))?;
    table(py, found)
}

fn corners<'a, const N: usize>(
    simplices: &'a PyReadonlyArray2<'_, i32>,
    npoints: usize,
) -> Result<&'a [[i32; N]]> {
    let corners = rows(simplices, "simplices")?;
    in_range(corners, 0, npoints, "simplices")?;
    Ok(corners)
}
