//! Triangulations passed as arrays: borrowed and checked for one call, or held for many; and other
//! arrays passed with points: weights, edges.

use delone_core::base::arrays::Given;
use delone_core::base::error::{Error, Result};
use delone_core::base::target::Target;
use delone_core::base::watch::Watch;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{flat, in_range, rows};
use crate::errors::Outcome;
use crate::signals::{watched, watched_attached};

/// Up to this number of queries a call keeps the GIL: it is over before another thread could run.
const FEW: usize = 16;

/// Borrowed arrays. An index that is out of range causes an `InternalError` when it is used.
fn borrowed<'a, const D: usize, const N: usize>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given<'a, D, N>> {
    Ok(Given {
        points: rows(points, "points")?,
        simplices: rows(simplices, "simplices")?,
        neighbors: rows(neighbors, "neighbors")?,
    })
}

/// Borrowed arrays, after a check of every index.
pub fn checked<'a, const D: usize, const N: usize>(
    points: &'a PyReadonlyArray2<'_, f64>,
    simplices: &'a PyReadonlyArray2<'_, i32>,
    neighbors: &'a PyReadonlyArray2<'_, i32>,
) -> Result<Given<'a, D, N>> {
    let given = borrowed(points, simplices, neighbors)?;
    if given.neighbors.len() != given.simplices.len() {
        return Err(not_beside());
    }
    in_range(given.simplices, 0, given.points.len(), "simplices")?;
    in_range(given.neighbors, -1, given.simplices.len(), "neighbors")?;
    Ok(given)
}

/// Checked arrays that never change.
pub struct Held {
    points: Py<PyArray2<f64>>,
    simplices: Py<PyArray2<i32>>,
    neighbors: Py<PyArray2<i32>>,
}

/// The arrays of `Held`, borrowed from Python for one call.
pub struct Lent<'py> {
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
}

impl Held {
    /// Holds arrays that the caller has checked.
    pub fn new(
        points: &PyReadonlyArray2<'_, f64>,
        simplices: &PyReadonlyArray2<'_, i32>,
        neighbors: &PyReadonlyArray2<'_, i32>,
    ) -> Self {
        Self {
            points: (**points).clone().unbind(),
            simplices: (**simplices).clone().unbind(),
            neighbors: (**neighbors).clone().unbind(),
        }
    }

    /// Borrows the arrays.
    pub fn lend<'py>(&self, py: Python<'py>) -> Outcome<Lent<'py>> {
        Ok(Lent {
            points: self.points.bind(py).try_readonly()?,
            simplices: self.simplices.bind(py).try_readonly()?,
            neighbors: self.neighbors.bind(py).try_readonly()?,
        })
    }

    /// The number of simplices.
    pub fn count(&self, py: Python<'_>) -> usize {
        self.simplices.bind(py).shape()[0]
    }
}

impl Lent<'_> {
    /// The arrays.
    pub fn given<const D: usize, const N: usize>(&self) -> Result<Given<'_, D, N>> {
        borrowed(&self.points, &self.simplices, &self.neighbors)
    }
}

/// Runs `work` for `count` queries, without the GIL unless there are few.
pub fn answered<T: Send>(
    py: Python<'_>,
    count: usize,
    work: impl FnOnce(&Watch) -> Result<T> + Send,
) -> Outcome<T> {
    if count <= FEW {
        return watched_attached(work);
    }
    watched(py, work)
}

/// The target of smoothing, by its name.
pub fn target_of(name: &str) -> Result<Target> {
    let names = Target::NAMES.map(|(name, _)| name);
    let wrong = || Error::Shape(format!("target must be one of {names:?}, got {name:?}"));
    Target::named(name).ok_or_else(wrong)
}

/// The error for neighbors that do not match the simplices.
pub fn not_beside() -> Error {
    Error::Shape(
        "neighbors and simplices differ in length: each simplex needs a row of neighbors".into(),
    )
}

/// The error for arrays whose lengths do not match.
pub fn unequal() -> Error {
    Error::Shape("arrays that belong together differ in length".into())
}

/// Weights of `n` points; empty if none are given.
pub fn weights_of<'a>(
    weights: Option<&'a PyReadonlyArray1<'_, f64>>,
    n: usize,
) -> Result<&'a [f64]> {
    let Some(given) = weights else { return Ok(&[]) };
    let found = flat(given, "weights")?;
    if found.len() == n {
        return Ok(found);
    }
    Err(unequal())
}

/// The same, after a check that all are finite.
pub fn finite_weights<'a>(
    weights: Option<&'a PyReadonlyArray1<'_, f64>>,
    n: usize,
) -> Result<&'a [f64]> {
    let wrong = || Error::Shape("weights must have one finite number for each point".into());
    let found = weights_of(weights, n).map_err(|_| wrong())?;
    if found.iter().all(|w| w.is_finite()) {
        return Ok(found);
    }
    Err(wrong())
}

/// Segments, or other edges, as vertices among `n` points.
pub fn pairs(array: &PyReadonlyArray2<'_, i32>, n: usize, name: &str) -> Result<Vec<[u32; 2]>> {
    let all: &[[i32; 2]] = rows(array, name)?;
    in_range(all, 0, n, name)?;
    Ok(all.iter().map(|s| s.map(|v| v as u32)).collect())
}

/// Borrowed simplices whose vertices among `n` points have been checked.
pub fn simplices_of<'a, const N: usize>(
    simplices: &'a PyReadonlyArray2<'_, i32>,
    n: usize,
) -> Result<&'a [[i32; N]]> {
    let simplices = rows(simplices, "simplices")?;
    in_range(simplices, 0, n, "simplices")?;
    Ok(simplices)
}
