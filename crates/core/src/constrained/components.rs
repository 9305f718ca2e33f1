//! The components into which segments separate a triangulation: a flood fill over triangles.

use crate::error::Result;
use crate::memory::{filled, with_room};
use crate::watch::{Pace, Watch};

/// Triangles between two checks for interruption.
const LOT: usize = 1 << 16;

/// The component of each triangle: triangles that share an unconstrained edge are in the same one.
/// Components are numbered from 0 in the order of their first triangles. Neighbors below 0 are
/// outside.
pub fn components(
    neighbors: &[[i32; 3]],
    constrained: &[[bool; 3]],
    watch: &Watch,
) -> Result<Vec<i32>> {
    let mut pace = Pace::new(watch, LOT);
    let mut label = filled(neighbors.len(), -1)?;
    let mut stack = with_room(64)?;
    let mut count = 0;
    for start in 0..neighbors.len() {
        if label[start] >= 0 {
            continue;
        }
        label[start] = count;
        stack.push(start);
        while let Some(t) = stack.pop() {
            pace.spend(1)?;
            for (&n, wall) in neighbors[t].iter().zip(constrained[t]) {
                if !wall && n >= 0 && label[n as usize] < 0 {
                    label[n as usize] = count;
                    stack.push(n as usize);
                }
            }
        }
        count += 1;
    }
    Ok(label)
}
