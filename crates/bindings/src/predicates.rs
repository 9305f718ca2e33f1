//! The predicates over arrays of points.

use delone_core::base::error::{Error, Result};
use delone_core::base::memory::with_room;
use delone_predicates as exact;
use delone_predicates::Sign;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, column, rows};
use crate::errors::{Outcome, detached};

/// One sign per row of `M` arrays of `D`-dimensional points.
fn signs<const D: usize, const M: usize>(
    py: Python<'_>,
    arguments: [&PyReadonlyArray2<'_, f64>; M],
    sign: impl Fn([[f64; D]; M]) -> Sign + Send + Sync,
) -> Outcome<Column<i8>> {
    let mut columns: [&[[f64; D]]; M] = [&[]; M];
    for (column, argument) in columns.iter_mut().zip(arguments) {
        *column = rows(argument, "argument")?;
    }
    let n = columns[0].len();
    if columns.iter().any(|c| c.len() != n) {
        return Err(Error::Shape("arguments differ in length".into()).into());
    }
    let signs = detached(py, || -> Result<_> {
        let mut signs = with_room(n)?;
        signs.extend((0..n).map(|i| sign(columns.map(|c| c[i])) as i8));
        Ok(signs)
    })?;
    Ok(column(py, signs))
}

/// Orientation signs of the triangles a, b, c.
#[pyfunction]
pub fn orient2d(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    c: PyReadonlyArray2<'_, f64>,
) -> Outcome<Column<i8>> {
    signs(py, [&a, &b, &c], |[a, b, c]| exact::orient2d(a, b, c))
}

/// Signs of d relative to the circle through a, b, c.
#[pyfunction]
pub fn incircle(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    c: PyReadonlyArray2<'_, f64>,
    d: PyReadonlyArray2<'_, f64>,
    canonical: bool,
) -> Outcome<Column<i8>> {
    let sign = if canonical {
        exact::incircle_canonical
    } else {
        exact::incircle
    };
    signs(py, [&a, &b, &c, &d], |[a, b, c, d]| sign(a, b, c, d))
}

/// Orientation signs of the tetrahedra a, b, c, d.
#[pyfunction]
pub fn orient3d(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    c: PyReadonlyArray2<'_, f64>,
    d: PyReadonlyArray2<'_, f64>,
) -> Outcome<Column<i8>> {
    signs(py, [&a, &b, &c, &d], |[a, b, c, d]| {
        exact::orient3d(a, b, c, d)
    })
}

/// Signs of e relative to the sphere through a, b, c, d.
#[pyfunction]
pub fn insphere(
    py: Python<'_>,
    a: PyReadonlyArray2<'_, f64>,
    b: PyReadonlyArray2<'_, f64>,
    c: PyReadonlyArray2<'_, f64>,
    d: PyReadonlyArray2<'_, f64>,
    e: PyReadonlyArray2<'_, f64>,
    canonical: bool,
) -> Outcome<Column<i8>> {
    let sign = if canonical {
        exact::insphere_canonical
    } else {
        exact::insphere
    };
    signs(py, [&a, &b, &c, &d, &e], |[a, b, c, d, e]| {
        sign(a, b, c, d, e)
    })
}
