//! Conversion of errors to the exceptions of `delone.errors`; a panic becomes `InternalError`.

use std::panic::{AssertUnwindSafe, catch_unwind};

use delone::{Error, Point2, Result};
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::table;

/// Runs `work` without the GIL.
pub fn detached<T: Send, E: Into<Error>>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    py.detach(|| caught(work)).map_err(|e| raise(py, &e))
}

/// Runs short `work` with the GIL.
pub fn attached<T>(py: Python<'_>, work: impl FnOnce() -> Result<T>) -> PyResult<T> {
    caught(work).map_err(|e| raise(py, &e))
}

/// The result of `work`, with a panic converted to an error: all calls of Rust go through here.
fn caught<T, E: Into<Error>>(work: impl FnOnce() -> Result<T, E>) -> Result<T> {
    let work = || work().map_err(Into::into);
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Err(Error::Internal(
            text.unwrap_or_else(|| "a panic without a message".into()),
        ))
    })
}

/// The Python exception of an error.
pub fn raise(py: Python<'_>, error: &Error) -> PyErr {
    exception(py, error).unwrap_or_else(|failure| failure)
}

fn exception(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let details = PyDict::new(py);
    let (class, message) = match error {
        Error::Interrupted => {
            // Usually the signal handler has already raised an exception, which is kept.
            return Ok(PyErr::take(py).unwrap_or_else(|| PyKeyboardInterrupt::new_err(())));
        }
        Error::Memory { .. } => return Ok(PyMemoryError::new_err(error.to_string())),
        Error::NonFinite { rows, count, .. } => {
            details.set_item("rows", rows)?;
            details.set_item("count", count)?;
            let message = match count {
                1 => format!("{error}; drop or repair it"),
                _ => format!("{error}: drop or repair them"),
            };
            ("NonFiniteError", message)
        }
        Error::ZeroVectors { rows, count, .. } => {
            details.set_item("rows", rows)?;
            details.set_item("count", count)?;
            let (what, row) = match count {
                1 => ("1 vector is zero and has", rows.first()),
                _ => ("vectors are zero and have", rows.first()),
            };
            let number = if *count == 1 {
                String::new()
            } else {
                format!("{count} ")
            };
            let row = row.copied().unwrap_or_default();
            let message = format!("{number}{what} no direction, first row {row}: drop such rows");
            ("DirectionError", message)
        }
        Error::OneGreatCircle { rows, .. } => {
            let few = rows.len() < 3;
            let reason = if few {
                "too few points"
            } else {
                "one great circle"
            };
            details.set_item("reason", reason)?;
            details.set_item("chain", rows)?;
            let message = if few {
                format!(
                    "{} too few for a triangle: at least three that are not on one great circle \
                     are needed; `error.chain` has the first row of each",
                    distinct(rows.len())
                )
            } else {
                format!(
                    "all {} distinct directions are on one great circle, so there is no triangle; \
                     `error.chain` has their rows in order around it",
                    rows.len()
                )
            };
            ("DegenerateInputError", message)
        }
        Error::TooFew {
            rows, dimension, ..
        } => {
            details.set_item("reason", "too few points")?;
            details.set_item("chain", rows)?;
            let message = match dimension {
                2 => format!("{error}: at least three that are not collinear are needed"),
                _ => format!("{error}: at least four that are not coplanar are needed"),
            };
            ("DegenerateInputError", message)
        }
        Error::Collinear { rows, .. } => {
            details.set_item("reason", "collinear")?;
            details.set_item("chain", rows)?;
            let message = format!(
                "all {} distinct points lie on one line, so there is no triangle; `error.chain` \
                 has their rows in order along it",
                rows.len()
            );
            ("DegenerateInputError", message)
        }
        Error::Coplanar { rows, .. } => {
            details.set_item("reason", "coplanar")?;
            details.set_item("chain", rows)?;
            let message = format!(
                "{error}, so there is no tetrahedron; triangulate them in 2-D, in that plane"
            );
            ("DegenerateInputError", message)
        }
        // The tiles of delone.distributed are 2-D.
        Error::TooLarge { found: None, .. } => {
            ("LimitError", format!("{error}: triangulate fewer points"))
        }
        Error::TooLarge { .. } => {
            let message = format!("{error}: use delone.distributed in 2-D, or fewer points");
            ("LimitError", message)
        }
        Error::Crossing { pairs, points, .. } => {
            // As arrays, because there may be millions.
            let narrow = pairs.iter().map(|pair| pair.map(|row| row as u32));
            details.set_item("pairs", table(py, narrow.collect())?)?;
            details.set_item("points", table(py, points.clone())?)?;
            ("CrossingSegmentsError", crossing(pairs, points))
        }
        Error::CrossingArcs { pairs, .. } => {
            let narrow = pairs.iter().map(|pair| pair.map(|row| row as u32));
            details.set_item("pairs", table(py, narrow.collect())?)?;
            ("CrossingSegmentsError", error.to_string())
        }
        Error::OppositeEnds { rows, count, .. } => {
            details.set_item("rows", rows)?;
            details.set_item("count", count)?;
            let row = rows.first().copied().unwrap_or_default();
            let what = match count {
                1 => format!("segment {row} joins"),
                _ => format!("{count} segments join, first row {row},"),
            };
            let message = format!(
                "{what} opposite directions, which no single shorter arc joins: add a point between \
                 them"
            );
            ("DirectionError", message)
        }
        Error::Budget {
            what,
            limit,
            found,
            segments,
            place,
            corner,
            ..
        } => {
            details.set_item("limit", limit)?;
            details.set_item("found", found)?;
            details.set_item("segments", segments)?;
            details.set_item("place", place.map(|[x, y]| (x, y)))?;
            let place = crowded(segments, *place, *corner);
            let message = format!(
                "found {found} {what}, more than the limit of {limit} vertices allows{place}: \
                 allow more, or make the input simpler there"
            );
            ("BudgetExceededError", message)
        }
        Error::Shape(message) => ("ShapeError", message.clone()),
        Error::NoSuchPoint { .. } | Error::Option(_) => ("ShapeError", error.to_string()),
        Error::Internal(message) => ("InternalError", message.clone()),
        _ => ("InternalError", error.to_string()),
    };
    let class = py.import("delone.errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call((message,), Some(&details))?))
}

/// How many directions there are, as the start of a sentence.
fn distinct(count: usize) -> String {
    match count {
        1 => "1 distinct direction is".into(),
        _ => format!("{count} distinct directions are"),
    }
}

/// Names the first pair of segments that cross.
fn crossing(pairs: &[[usize; 2]], points: &[Point2]) -> String {
    let (count, [s, t]) = (pairs.len(), pairs.first().copied().unwrap_or_default());
    let [x, y] = points.first().copied().unwrap_or_default();
    let what = match count {
        1 => format!("segments {s} and {t} cross at ({x}, {y})"),
        _ => format!("{count} pairs of segments cross, first {s} and {t} at ({x}, {y})"),
    };
    format!("{what}; crossing=\"split\" makes crossings vertices")
}

/// Names the segments with most of the vertices that exceed the budget.
fn crowded(rows: &[usize], place: Option<Point2>, corner: bool) -> String {
    let names: Vec<String> = rows.iter().map(usize::to_string).collect();
    let (names, count) = (names.join(", "), names.len());
    let segments = if count == 1 { "segment" } else { "segments" };
    match (count, place, corner) {
        (0, ..) => String::new(),
        (_, Some([x, y]), true) => {
            format!("; most are on {segments} {names}, the first two of which meet at ({x}, {y})")
        }
        (_, Some([x, y]), false) => {
            format!("; most are on {segments} {names}, the last one at ({x}, {y})")
        }
        (_, None, _) => format!("; most are on {segments} {names}"),
    }
}
