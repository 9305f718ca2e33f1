//! The components into which segments separate a triangulation: a flood fill over triangles, and
//! their numbers, which depend on coordinates only.

use std::cmp::Ordering;

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

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

/// Numbers components in the order of their smallest triangles, whatever their numbers so far, which
/// must be at least 0. Triangles are compared by their smallest corners, then their middle ones, then
/// their largest; corners lexicographically. Linear in the number of triangles, plus a sort of the
/// components.
pub fn numbered_by_smallest<const D: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; 3]],
    component: &[i32],
    watch: &Watch,
) -> Result<Vec<i32>> {
    let count = component.iter().max().map_or(0, |&most| most as usize + 1);
    if count <= 1 {
        return filled(component.len(), 0);
    }
    let compared = |a: i32, b: i32| {
        let (a, b) = (&points[a as usize], &points[b as usize]);
        a.partial_cmp(b).unwrap_or(Ordering::Equal)
    };
    let ordered = |corners: [i32; 3]| {
        let mut corners = corners;
        corners.sort_unstable_by(|&a, &b| compared(a, b));
        corners
    };
    let smaller = |one: &[i32; 3], other: &[i32; 3]| {
        let pairs = one.iter().zip(other);
        pairs.fold(Ordering::Equal, |found, (&a, &b)| {
            found.then_with(|| compared(a, b))
        })
    };
    // The smallest triangle of each component, its corners in order; -1 where there is none yet.
    let mut least = filled(count, [-1; 3])?;
    // Its smallest coordinate: few triangles reach it, so that few corners are sorted.
    let mut reached = filled(count, f64::INFINITY)?;
    let mut pace = Pace::new(watch, LOT);
    for (corners, &at) in simplices.iter().zip(component) {
        pace.spend(1)?;
        let [a, b, c] = corners.map(|v| points[v as usize][0]);
        let x = a.min(b).min(c);
        if x > reached[at as usize] {
            continue;
        }
        reached[at as usize] = x;
        let best = &mut least[at as usize];
        let corners = ordered(*corners);
        if best[0] < 0 || smaller(&corners, best) == Ordering::Less {
            *best = corners;
        }
    }
    let mut present = with_room(count)?;
    present.extend((0..count).filter(|&c| least[c][0] >= 0));
    present.sort_unstable_by(|&a, &b| smaller(&least[a], &least[b]));
    let mut number = filled(count, -1)?;
    for (i, &c) in (0..).zip(&present) {
        number[c] = i;
    }
    let mut found = with_room(component.len())?;
    found.extend(component.iter().map(|&c| number[c as usize]));
    Ok(found)
}
