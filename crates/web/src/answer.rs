//! What a call returns: arrays by number, or an error with the class and text of Python's.

use delone::{Error, Point2, Result};
use wasm_bindgen::prelude::*;

/// Arrays, each of which JavaScript takes once, or an error.
#[wasm_bindgen]
#[derive(Default)]
pub struct Answer {
    integers: Vec<Vec<i32>>,
    numbers: Vec<Vec<f64>>,
    class: &'static str,
    message: String,
    rows: Vec<i32>,
}

#[wasm_bindgen]
impl Answer {
    /// The array of integers with this number.
    pub fn integers(&mut self, number: usize) -> Vec<i32> {
        self.integers
            .get_mut(number)
            .map_or_else(Vec::new, std::mem::take)
    }

    /// The array of doubles with this number.
    pub fn numbers(&mut self, number: usize) -> Vec<f64> {
        self.numbers
            .get_mut(number)
            .map_or_else(Vec::new, std::mem::take)
    }

    /// The name of the Python exception; empty without an error.
    #[wasm_bindgen(getter)]
    pub fn class(&self) -> String {
        self.class.into()
    }

    /// Its text.
    #[wasm_bindgen(getter)]
    pub fn message(&self) -> String {
        self.message.clone()
    }

    /// The rows that it names.
    pub fn rows(&self) -> Vec<i32> {
        self.rows.clone()
    }
}

/// Arrays of integers, and of doubles.
pub type Arrays = (Vec<Vec<i32>>, Vec<Vec<f64>>);

/// Runs `work`.
pub fn answer(work: impl FnOnce() -> Result<Arrays>) -> Answer {
    match work() {
        Ok((integers, numbers)) => Answer {
            integers,
            numbers,
            ..Answer::default()
        },
        Err(error) => {
            let (class, message, rows) = described(&error);
            Answer {
                class,
                message,
                rows: rows.into_iter().map(|row| row as i32).collect(),
                ..Answer::default()
            }
        }
    }
}

/// Class, text and rows, as in the bindings for Python.
fn described(error: &Error) -> (&'static str, String, Vec<usize>) {
    let text = error.to_string();
    match error {
        Error::NonFinite { rows, count, .. } => {
            let it = if *count == 1 {
                "; drop or repair it"
            } else {
                ": drop or repair them"
            };
            ("NonFiniteError", text + it, rows.clone())
        }
        Error::TooFew {
            rows, dimension: 2, ..
        } => {
            let hint = ": at least three that are not collinear are needed";
            ("DegenerateInputError", text + hint, rows.clone())
        }
        Error::TooFew { rows, .. } => {
            let hint = ": at least four that are not coplanar are needed";
            ("DegenerateInputError", text + hint, rows.clone())
        }
        Error::Collinear { rows, .. } => {
            let message = format!(
                "all {} distinct points lie on one line, so there is no triangle; `error.chain` \
                 has their rows in order along it",
                rows.len()
            );
            ("DegenerateInputError", message, rows.clone())
        }
        Error::Coplanar { rows, .. } => {
            let hint = ", so there is no tetrahedron; triangulate them in 2-D, in that plane";
            ("DegenerateInputError", text + hint, rows.clone())
        }
        Error::TooLarge { .. } => ("LimitError", text + ": triangulate fewer points", vec![]),
        Error::Crossing { pairs, points, .. } => (
            "CrossingSegmentsError",
            crossing(pairs, points),
            pairs.as_flattened().to_vec(),
        ),
        Error::Budget { segments, .. } => {
            let hint = ": allow more, or make the input simpler there";
            ("BudgetExceededError", text + hint, segments.clone())
        }
        Error::NoSuchPoint { segment, .. } => ("ShapeError", text, vec![*segment]),
        Error::Shape(_) => ("ShapeError", text, vec![]),
        Error::Seed { hole, .. } => ("InputError", text, vec![*hole]),
        Error::EmptyDomain | Error::Option(_) => ("InputError", text, vec![]),
        Error::Memory { .. } => ("MemoryError", text, vec![]),
        _ => ("InternalError", text, vec![]),
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

/// Pairs of a flat array.
pub fn pairs(flat: &[f64]) -> &[Point2] {
    flat.as_chunks().0
}

/// Rows of a flat array.
pub fn rows<const N: usize>(flat: &[i32]) -> &[[i32; N]] {
    flat.as_chunks().0
}

/// Row numbers as JavaScript takes them.
pub fn signed(rows: Vec<u32>) -> Vec<i32> {
    rows.into_iter().map(|row| row as i32).collect()
}

/// Rows that repeat earlier rows, flat.
pub fn repeats(duplicates: &[[u32; 2]]) -> Vec<i32> {
    signed(duplicates.as_flattened().to_vec())
}
