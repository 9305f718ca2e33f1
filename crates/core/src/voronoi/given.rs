//! The triangulation whose dual is computed, in 2-D or 3-D.

use crate::base::error::{Error, Result};

/// A triangulation as arrays: vertices are rows of points, neighbors simplices or -1. With weights,
/// one for each point, it is the regular triangulation.
#[derive(Clone, Copy)]
pub struct Given<'a, const D: usize, const N: usize> {
    /// Coordinates, finite.
    pub points: &'a [[f64; D]],
    /// Weights, finite; empty for none.
    pub weights: &'a [f64],
    /// The vertices of each simplex, positively oriented.
    pub simplices: &'a [[i32; N]],
    /// The simplex opposite each corner, -1 outside.
    pub neighbors: &'a [[i32; N]],
}

impl<const D: usize, const N: usize> Given<'_, D, N> {
    pub(crate) fn weight(&self, v: i32) -> f64 {
        self.weights.get(v as usize).copied().unwrap_or(0.0)
    }

    pub(crate) fn point(&self, v: i32) -> [f64; D] {
        self.points[v as usize]
    }

    /// The corner of `other` opposite the side that it shares with `t`.
    #[inline]
    pub(crate) fn back(&self, t: usize, other: usize) -> Result<usize> {
        let row = self.neighbors[other];
        // Arithmetic instead of a search, because branches would be unpredictable.
        let back = (1..N).map(|k| k * usize::from(row[k] == t as i32)).sum();
        if back < N && row[back] == t as i32 {
            return Ok(back);
        }
        Err(Error::Shape(format!("{other} is not a neighbor of {t}")))
    }
}
