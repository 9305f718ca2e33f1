//! Values and gradients at the vertices, as columns of fields.

use crate::base::arrays::Triangles;
use crate::base::error::{Error, Result};

/// Columns of values at the vertices, with gradients if given.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    values: &'a [f64],
    gradients: Option<&'a [f64]>,
    /// The number of columns.
    pub columns: usize,
}

impl<'a> Field<'a> {
    /// Rows of `columns` values, and of as many gradients.
    pub fn new(
        given: &Triangles,
        values: &'a [f64],
        gradients: Option<&'a [f64]>,
        columns: usize,
    ) -> Result<Self> {
        Self::of_rows(given.points.len(), values, gradients, columns)
    }

    /// The same for a given number of vertices.
    pub fn of_rows(
        rows: usize,
        values: &'a [f64],
        gradients: Option<&'a [f64]>,
        columns: usize,
    ) -> Result<Self> {
        let items = rows * columns;
        let fits = values.len() == items && gradients.is_none_or(|g| g.len() == 2 * items);
        if !fits {
            return Err(Error::Shape(format!(
                "values and gradients must have one row for each of the {rows} points"
            )));
        }
        Ok(Self {
            values,
            gradients,
            columns,
        })
    }

    /// The value at a vertex.
    #[inline]
    pub fn value(&self, vertex: i32, column: usize) -> f64 {
        self.values[vertex as usize * self.columns + column]
    }

    /// The gradient at a vertex; zero if gradients are not given.
    #[inline]
    pub fn gradient(&self, vertex: i32, column: usize) -> [f64; 2] {
        let i = 2 * (vertex as usize * self.columns + column);
        self.gradients.map_or([0.0; 2], |g| [g[i], g[i + 1]])
    }

    /// The row of values at a vertex.
    #[inline]
    pub fn row(&self, vertex: i32) -> &'a [f64] {
        let start = vertex as usize * self.columns;
        &self.values[start..start + self.columns]
    }
}
