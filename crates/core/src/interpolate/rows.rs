//! Sparse rows of weights, and their products with values.

use super::field::Field;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, zeroed};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::locate::Output;

/// Rows per task.
const SHARE: usize = 1 << 13;
/// Rows copied between two checks for interruption.
const LOT: usize = 1 << 16;

/// Rows in the order in which a thread computed them.
#[derive(Debug, Default)]
pub struct Part {
    /// The row in the query, and where its entries end.
    pub ends: Vec<(usize, usize)>,
    /// The vertices.
    pub indices: Vec<i32>,
    /// The weights of their values.
    pub weights: Vec<f64>,
    /// The weights of their gradients, if any.
    pub slopes: Vec<[f64; 2]>,
    sloped: bool,
}

impl Part {
    /// Without rows yet; with or without weights of gradients.
    pub fn with_slopes(sloped: bool) -> Self {
        Self {
            sloped,
            ..Self::default()
        }
    }

    /// Adds an entry, unless it is zero.
    #[inline]
    pub fn entry(&mut self, vertex: i32, weight: f64, slope: [f64; 2]) {
        if weight != 0.0 || slope != [0.0; 2] {
            self.indices.push(vertex);
            self.weights.push(weight);
            if self.sloped {
                self.slopes.push(slope);
            }
        }
    }

    /// Ends a row.
    #[inline]
    pub fn close(&mut self, row: usize) {
        self.ends.push((row, self.indices.len()));
    }
}

/// A sparse matrix in compressed rows.
#[derive(Debug)]
pub struct Rows {
    /// Where each row begins, plus the end.
    pub indptr: Vec<i64>,
    /// Vertices.
    pub indices: Vec<i32>,
    /// Weights of their values.
    pub weights: Vec<f64>,
    /// Weights of their gradients, two each; empty if there are none.
    pub slopes: Vec<f64>,
}

impl Rows {
    /// Sorts `count` rows; those that are in no part are empty.
    pub fn of_parts(
        count: usize,
        parts: &[Part],
        sloped: bool,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        let mut pace = Pace::new(watch, LOT);
        let mut indptr = filled(count + 1, 0i64)?;
        // The part of each row, and where it begins there.
        let mut places = filled(count, (0u32, 0usize))?;
        for (i, part) in (0u32..).zip(parts) {
            let mut start = 0;
            for &(row, end) in &part.ends {
                pace.spend(1)?;
                indptr[row + 1] = (end - start) as i64;
                places[row] = (i, start);
                start = end;
            }
        }
        for row in 0..count {
            pace.spend(1)?;
            indptr[row + 1] += indptr[row];
        }
        let total = indptr[count] as usize;
        let mut rows = Self {
            indptr,
            indices: zeroed(total)?,
            weights: zeroed(total)?,
            slopes: zeroed(if sloped { 2 * total } else { 0 })?,
        };
        rows.fill(parts, &places, workers, watch)?;
        Ok(rows)
    }

    /// Copies the entries of all rows, each share of rows by one thread.
    fn fill(
        &mut self,
        parts: &[Part],
        places: &[(u32, usize)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let (mut indices, mut weights) = (&mut self.indices[..], &mut self.weights[..]);
        let mut slopes = &mut self.slopes[..];
        let width = if slopes.is_empty() { 0 } else { 2 };
        let mut tasks = Vec::new();
        for (i, places) in places.chunks(SHARE).enumerate() {
            let ends = &self.indptr[i * SHARE..=i * SHARE + places.len()];
            let count = (ends[places.len()] - ends[0]) as usize;
            let (these_indices, rest) = indices.split_at_mut(count);
            indices = rest;
            let (these_weights, rest) = weights.split_at_mut(count);
            weights = rest;
            let (these_slopes, rest) = slopes.split_at_mut(width * count);
            slopes = rest;
            tasks.push((ends, places, these_indices, these_weights, these_slopes));
        }
        parallel::map_watched(
            workers,
            tasks,
            watch,
            |(ends, places, indices, weights, slopes)| {
                for (pair, &(part, start)) in ends.windows(2).zip(places) {
                    let [from, to] = [pair[0], pair[1]].map(|end| (end - ends[0]) as usize);
                    if from == to {
                        // An empty row is in no part, and there may be no parts.
                        continue;
                    }
                    let part = &parts[part as usize];
                    let source = start..start + (to - from);
                    indices[from..to].copy_from_slice(&part.indices[source.clone()]);
                    weights[from..to].copy_from_slice(&part.weights[source.clone()]);
                    if width > 0 {
                        let source = part.slopes[source].as_flattened();
                        slopes[2 * from..2 * to].copy_from_slice(source);
                    }
                }
                Ok(())
            },
        )?;
        Ok(())
    }
}

/// Sparse rows given by a caller.
#[derive(Debug, Clone, Copy)]
pub struct Table<'a> {
    /// Where each row begins, plus the end.
    pub indptr: &'a [i64],
    /// Vertices.
    pub indices: &'a [i32],
    /// Weights of their values.
    pub weights: &'a [f64],
    /// Weights of their gradients.
    pub slopes: Option<&'a [[f64; 2]]>,
}

impl Table<'_> {
    /// Checks that rows are within the entries, and that indices are below `vertices`.
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

    /// Weights times values, row by row; NaN for an empty row. Entries of zero weight are not read.
    pub fn combine(
        &self,
        vertices: usize,
        field: Field,
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<f64>> {
        self.check(vertices)?;
        let rows = self.indptr.len().saturating_sub(1);
        let out = Output::filled(rows * field.columns, f64::NAN, watch)?;
        let tasks = (0..rows).step_by(SHARE).collect();
        parallel::map_watched(workers, tasks, watch, |start: usize| {
            for row in start..rows.min(start + SHARE) {
                self.combine_row(row, &field, |column, sum| {
                    out.set(row * field.columns + column, sum);
                });
            }
            Ok(())
        })?;
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
            // The sum starts with the first entry that counts, so that one value of weight 1 is
            // returned unchanged, including the sign of zero.
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
