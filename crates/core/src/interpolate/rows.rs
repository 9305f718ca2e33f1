//! Sparse rows of weights, and what they make of values.

use super::field::Field;
use super::natural::Part;
use crate::error::{Error, Result};
use crate::locate::Output;
use crate::memory::filled;
use crate::parallel;
use crate::watch::Watch;

/// Rows that a thread takes at once.
const SHARE: usize = 1 << 13;

/// A sparse matrix in compressed rows.
#[derive(Debug)]
pub struct Rows {
    /// Where each row begins, and the end.
    pub indptr: Vec<i64>,
    /// Vertices.
    pub indices: Vec<i32>,
    /// Weights of their values.
    pub weights: Vec<f64>,
    /// Weights of their gradients, two each; empty where there are none.
    pub slopes: Vec<f64>,
}

impl Rows {
    /// Puts `count` rows in order; those that are in no part are empty.
    pub fn of_parts(count: usize, parts: Vec<Part>, sloped: bool) -> Result<Self> {
        let mut indptr = filled(count + 1, 0i64)?;
        for part in &parts {
            let mut start = 0;
            for &(row, end) in &part.ends {
                indptr[row + 1] = (end - start) as i64;
                start = end;
            }
        }
        for row in 0..count {
            indptr[row + 1] += indptr[row];
        }
        let total = indptr[count] as usize;
        let mut indices = filled(total, 0i32)?;
        let mut weights = filled(total, 0.0)?;
        let mut slopes = filled(if sloped { 2 * total } else { 0 }, 0.0)?;
        for part in parts {
            let mut start = 0;
            for &(row, end) in &part.ends {
                let to = indptr[row] as usize..indptr[row + 1] as usize;
                indices[to.clone()].copy_from_slice(&part.indices[start..end]);
                weights[to.clone()].copy_from_slice(&part.weights[start..end]);
                if sloped {
                    let from = part.slopes[start..end].as_flattened();
                    slopes[2 * to.start..2 * to.end].copy_from_slice(from);
                }
                start = end;
            }
        }
        Ok(Self {
            indptr,
            indices,
            weights,
            slopes,
        })
    }
}

/// Sparse rows as a caller holds them.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    /// Where each row begins, and the end.
    pub indptr: &'a [i64],
    /// Vertices.
    pub indices: &'a [i32],
    /// Weights of their values.
    pub weights: &'a [f64],
    /// Weights of their gradients.
    pub slopes: Option<&'a [[f64; 2]]>,
}

impl Table<'_> {
    /// Checks that rows are within the entries, and entries among `vertices`.
    fn check(&self, vertices: usize) -> Result<()> {
        let n = self.indices.len();
        let ascending = self.indptr.is_sorted() && self.indptr.first() == Some(&0);
        if !ascending || self.indptr.last() != Some(&(n as i64)) {
            return Err(Error::Shape(format!("indptr does not go from 0 to {n}")));
        }
        if self.weights.len() != n || self.slopes.is_some_and(|s| s.len() != n) {
            return Err(Error::Shape("indices and weights differ in length".into()));
        }
        let outside = |&v: &i32| v < 0 || v as usize >= vertices;
        match self.indices.iter().find(|v| outside(v)) {
            Some(v) => Err(Error::Shape(format!("index {v} is outside 0..{vertices}"))),
            None => Ok(()),
        }
    }

    /// Weights times values, row by row; NaN for an empty row. Entries of no weight are not read.
    pub fn combine(
        &self,
        vertices: usize,
        field: Field,
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<f64>> {
        self.check(vertices)?;
        let rows = self.indptr.len().saturating_sub(1);
        let out = Output::filled(rows * field.columns, f64::NAN)?;
        let tasks = (0..rows).step_by(SHARE).collect();
        let ends = parallel::map(workers, tasks, |start: usize| {
            watch.check()?;
            for row in start..rows.min(start + SHARE) {
                self.combine_row(row, &field, |column, sum| {
                    out.set(row * field.columns + column, sum);
                });
            }
            Ok(())
        });
        ends.into_iter().collect::<Result<()>>()?;
        Ok(out.into_vec())
    }

    #[inline]
    fn combine_row(&self, row: usize, field: &Field, mut set: impl FnMut(usize, f64)) {
        let entries = self.indptr[row] as usize..self.indptr[row + 1] as usize;
        let (indices, weights) = (
            &self.indices[entries.clone()],
            &self.weights[entries.clone()],
        );
        for column in 0..field.columns {
            // The first that counts is where the sum begins, so that one value of weight 1 comes
            // out as it is, its sign of zero included.
            let mut sum = None;
            let mut add = |x: f64| sum = Some(sum.map_or(x, |sum: f64| sum + x));
            for (&vertex, &w) in indices.iter().zip(weights) {
                if w != 0.0 {
                    add(w * field.value(vertex, column));
                }
            }
            for (&vertex, s) in indices
                .iter()
                .zip(self.slopes.map_or(&[][..], |s| &s[entries.clone()]))
            {
                if *s != [0.0; 2] {
                    let g = field.gradient(vertex, column);
                    add(s[0] * g[0] + s[1] * g[1]);
                }
            }
            if !indices.is_empty() {
                set(column, sum.unwrap_or(0.0));
            }
        }
    }
}
