//! The parts of a triangulation that its segments separate: a flood over triangles.

use crate::error::Result;
use crate::memory::{filled, with_room};
use crate::watch::{Pace, Watch};

/// Triangles between two looks at the watch.
const LOT: usize = 1 << 16;

/// For each triangle the number of its component: triangles that share an edge which is not
/// constrained are in one. Numbers count from 0 in the order of their first triangles. Neighbours
/// below 0 are outside.
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
