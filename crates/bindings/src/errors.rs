//! Conversion of errors to the exceptions of `delone.errors`; a panic becomes `InternalError`.

use std::panic::{AssertUnwindSafe, catch_unwind};

use delone_core::base::error::{Error, Result};
use numpy::{BorrowError, Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Why a call has no result: an error of the core, or an exception that Python has raised.
pub enum Failure {
    Core(Error),
    Python(PyErr),
}

/// The result of a call of the bindings.
pub type Outcome<T> = std::result::Result<T, Failure>;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Core(error)
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<BorrowError> for Failure {
    fn from(error: BorrowError) -> Self {
        Self::Python(error.into())
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Python(error) => error,
            Failure::Core(error) => {
                Python::attach(|py| exception(py, &error)).unwrap_or_else(|e| e)
            }
        }
    }
}

/// Runs `work` without the GIL.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T> + Send) -> Outcome<T> {
    Ok(py.detach(|| caught(work))?)
}

/// Runs short `work` with the GIL.
pub fn attached<T>(work: impl FnOnce() -> Result<T>) -> Outcome<T> {
    Ok(caught(work)?)
}

/// The result of `work`, with a panic converted to an error: all calls of Rust go through here.
fn caught<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Err(Error::Internal(
            text.unwrap_or_else(|| "a panic without a message".into()),
        ))
    })
}

/// Bytes below which a refused allocation is reported without a text, which needs memory itself.
const WORDS: usize = 1 << 16;

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    // Where even little memory is refused, there is none for words.
    if matches!(error, Error::Memory { bytes } if *bytes < WORDS) {
        return Ok(PyMemoryError::new_err(()));
    }
    let details = PyDict::new(py);
    match error {
        Error::Interrupted => {
            // Usually the signal handler has already raised an exception, which is kept.
            return Ok(PyErr::take(py).unwrap_or_else(|| PyKeyboardInterrupt::new_err(())));
        }
        Error::Memory { .. } => return Ok(PyMemoryError::new_err(error.to_string())),
        Error::NonFinite { rows, count }
        | Error::ZeroVectors { rows, count }
        | Error::OppositeEnds { rows, count } => {
            details.set_item("rows", rows)?;
            details.set_item("count", count)?;
        }
        Error::Flat { rows, .. } => {
            details.set_item("reason", reason(error))?;
            details.set_item("chain", rows)?;
        }
        Error::OneGreatCircle { chain }
        | Error::TooFew { chain }
        | Error::TooFewInSpace { chain }
        | Error::Collinear { chain }
        | Error::Coplanar { chain } => {
            details.set_item("reason", reason(error))?;
            details.set_item("chain", chain)?;
        }
        Error::Crossing { pairs, points } => {
            // As arrays, because there may be millions.
            details.set_item("pairs", pairs_of(py, pairs)?)?;
            details.set_item("points", pairs_of(py, points)?)?;
        }
        Error::CrossingArcs { pairs } => details.set_item("pairs", pairs_of(py, pairs)?)?,
        Error::Budget {
            limit,
            found,
            densest,
            ..
        } => {
            details.set_item("limit", limit)?;
            details.set_item("found", found)?;
            details.set_item("segments", &densest.segments)?;
            details.set_item("place", densest.place.map(|[x, y]| (x, y)))?;
        }
        _ => {}
    }
    let class = py.import("delone.errors")?.getattr(error.class())?;
    Ok(PyErr::from_value(
        class.call((error.to_string(),), Some(&details))?,
    ))
}

/// Pairs as an array, (k, 2).
fn pairs_of<'py, T: Element + Clone>(
    py: Python<'py>,
    pairs: &[[T; 2]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    PyArray1::from_slice(py, pairs.as_flattened()).reshape([pairs.len(), 2])
}

/// Why points span no simplex.
fn reason(error: &Error) -> &'static str {
    match error {
        Error::Collinear { .. } => "collinear",
        Error::Coplanar { .. } => "coplanar",
        Error::Flat {
            dimension,
            distinct,
            ..
        } if distinct > dimension => "flat",
        Error::OneGreatCircle { chain } if chain.len() >= 3 => "one great circle",
        _ => "too few points",
    }
}
