//! Vertices whose triangles do not form one fan, closed or open.

use super::edges::{BOUNDARY, Edges, MANY};
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::{Pace, Watch};

/// Steps between two checks for interruption.
const LOT: usize = 1 << 14;

/// The vertices, below `n`, whose triangles do not form one fan, ascending.
///
/// Each walk around a vertex stays on edges of two triangles, where one triangle leads to one
/// other: it ends at the boundary or where it started.
pub fn not_fans(faces: &[[u32; 3]], edges: &Edges, n: usize, watch: &Watch) -> Result<Vec<u32>> {
    let mut degree = filled(n, 0_u32)?;
    let mut any = filled(n, BOUNDARY)?;
    let mut bad = filled(n, false)?;
    let mut pace = Pace::new(watch, LOT);
    for (half, &partner) in (0u32..).zip(&edges.partner) {
        pace.spend(1)?;
        let face = faces[half as usize / 3];
        let [v, w] = [0, 1].map(|k| face[(half as usize + k) % 3]);
        degree[v as usize] += 1;
        any[v as usize] = half;
        if partner == MANY {
            bad[v as usize] = true;
            bad[w as usize] = true;
        }
    }
    let mut found = Vec::new();
    for v in 0..n as u32 {
        let (count, start) = (degree[v as usize], any[v as usize]);
        if count == 0 {
            continue;
        }
        pace.spend(count as usize)?;
        if bad[v as usize] || seen_from(faces, edges, v, start) != count {
            push(&mut found, v)?;
        }
    }
    Ok(found)
}

/// The number of triangles of the fan around `v` with the half-edge `start` from `v`.
fn seen_from(faces: &[[u32; 3]], edges: &Edges, v: u32, start: u32) -> u32 {
    let first = start / 3;
    let before = 3 * first + (start + 2) % 3;
    let mut seen = 1;
    for side in [start, before] {
        let mut half = side;
        loop {
            let across = edges.partner[half as usize];
            if across == BOUNDARY || across == MANY {
                break;
            }
            if across / 3 == first {
                // The whole fan was seen from one side.
                return seen;
            }
            seen += 1;
            half = other_edge(faces, across, v);
        }
    }
    seen
}

/// The other edge with the vertex `v` of the triangle of a half-edge with this vertex.
fn other_edge(faces: &[[u32; 3]], half: u32, v: u32) -> u32 {
    let (face, k) = (half / 3, half % 3);
    // The half-edge starts at v, or ends there.
    let starts = faces[face as usize][k as usize] == v;
    3 * face + (k + if starts { 2 } else { 1 }) % 3
}
