//! The values of weighted points.

use super::ball::hides;
use super::simplices::Sites;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 14;

/// The values of all rows, of which only those of vertices have a meaning: the negative weight, or
/// the least value of an edge if a neighbor is in conflict.
pub fn vertices<const D: usize>(
    sites: Sites<'_, D>,
    edges: &[[i32; 2]],
    values: &[f64],
    watch: &Watch,
) -> Result<Vec<f64>> {
    let count = sites.points.len();
    let mut found = with_room(count)?;
    if sites.weights.is_empty() {
        found.resize(count, 0.0);
        return Ok(found);
    }
    let mut least = filled(count, f64::INFINITY)?;
    let mut is_met = filled(count, false)?;
    let mut pace = Pace::new(watch, LOT);
    for (&[a, b], &value) in edges.iter().zip(values) {
        pace.spend(1)?;
        for [a, b] in [[a, b], [b, a]] {
            least[a as usize] = value.min(least[a as usize]);
            is_met[a as usize] |= hides(sites.kind(), sites.at(a), sites.at(b));
        }
    }
    let own = sites.weights.iter().zip(&is_met).zip(&least);
    // Adding 0 makes -0 the 0 that it is.
    found.extend(own.map(|((w, &met), &least)| if met { least } else { 0.0 - w }));
    Ok(found)
}
