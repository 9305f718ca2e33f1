//! What a call returns: arrays by number, or an error with the class and text of Python's.

use delone_core::base::error::Error;
use delone_predicates::Point2;
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

/// Why a call has no result: an error of the core, or an argument that is out of range, with its row.
pub enum Failure {
    Core(Error),
    Input(String, Option<usize>),
}

/// The result of a call.
pub type Outcome<T> = Result<T, Failure>;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Core(error)
    }
}

/// Runs `work`.
pub fn answer(work: impl FnOnce() -> Outcome<Arrays>) -> Answer {
    match work() {
        Ok((integers, numbers)) => Answer {
            integers,
            numbers,
            ..Answer::default()
        },
        Err(Failure::Core(error)) => Answer {
            class: error.class(),
            message: error.to_string(),
            rows: signed(error.rows().to_vec()),
            ..Answer::default()
        },
        Err(Failure::Input(message, row)) => Answer {
            class: "InputError",
            message,
            rows: row.into_iter().map(|row| row as i32).collect(),
            ..Answer::default()
        },
    }
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
