//! Breaks ties: re-triangulates each polygon of cocircular points as a fan from its smallest
//! vertex.
//!
//! For methods whose ties are arbitrary.
//!
//! The triangles of such a polygon have no vertex inside it, so their dual is a tree, and a search
//! from one of them visits each once. Every flip gives the smallest vertex one more triangle, so a
//! polygon of k vertices takes at most k - 3 flips. A polygon that is a fan has no wrong edge left
//! and is not visited again: the total time is linear.

use delone_predicates::{Point2, incircle, lexicographic, tie_flips};

use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, half_edges, next, prev, triangle};

/// Triangles between two checks for interruption.
const WATCH_EVERY: u32 = 1 << 14;

/// Flips edges of the first `triangles` triangles of `mesh`, ghosts included, until ties are
/// canonical. The triangulation must be Delaunay.
pub fn fan(mesh: &mut Patch, points: &[Point2], triangles: usize, watch: &Watch) -> Result<()> {
    let start = mesh.first();
    let mut polygon = Vec::new();
    for t in start..start + triangles as u32 {
        if (t - start).is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        for e in half_edges(t) {
            if e < mesh.opposite(e) && tied(mesh, points, e) && wrong(mesh, points, e) {
                gather(mesh, points, e, &mut polygon);
                fan_one(mesh, points, &polygon);
            }
        }
    }
    Ok(())
}

/// Whether the two triangles of `e` are finite and cocircular.
fn tied(mesh: &Patch, points: &[Point2], e: Code) -> bool {
    let inf = mesh.infinite();
    let apex = mesh.vertex(mesh.opposite(e));
    let corners = mesh.corners(triangle(e));
    if apex == inf || corners.contains(&inf) {
        return false;
    }
    let [a, b, c] = corners.map(|v| points[v as usize]);
    incircle(a, b, c, points[apex as usize]).is_zero()
}

/// Whether a tie across `e` violates the rule.
fn wrong(mesh: &Patch, points: &[Point2], e: Code) -> bool {
    let at = |e: Code| points[mesh.vertex(e) as usize];
    tie_flips(at(next(e)), at(prev(e)), at(e), at(mesh.opposite(e)))
}

/// Lists the triangles of the cocircular polygon around the edge `e`, by a half-edge of each.
fn gather(mesh: &Patch, points: &[Point2], e: Code, polygon: &mut Vec<Code>) {
    polygon.clear();
    polygon.extend([e, mesh.opposite(e)]);
    let mut done = 0;
    while done < polygon.len() {
        // The search came across this edge; two are left.
        let e = polygon[done];
        for side in [next(e), prev(e)] {
            if tied(mesh, points, side) {
                polygon.push(mesh.opposite(side));
            }
        }
        done += 1;
    }
}

/// Flips until all triangles of `polygon` contain its smallest vertex.
fn fan_one(mesh: &mut Patch, points: &[Point2], polygon: &[Code]) {
    let corners = polygon
        .iter()
        .flat_map(|&e| [e, next(e), prev(e)])
        .map(|e| (mesh.vertex(e), e));
    let order = |u: u32, v: u32| lexicographic(points[u as usize], points[v as usize]);
    let Some((smallest, _)) = corners.clone().min_by(|p, q| order(p.0, q.0)) else {
        return;
    };
    let mut opposite: Vec<Code> = corners
        .filter(|&(v, _)| v == smallest)
        .map(|(_, e)| e)
        .collect();
    while let Some(e) = opposite.pop() {
        //        m                m          The triangle across the edge opposite the smallest
        //      /   \            / | \        vertex m joins the fan; two edges opposite m
        //     u --- v    ->    u  |  v       replace it.
        //      \   /            \ | /
        //        q                q
        if tied(mesh, points, e) {
            let other = mesh.flip(e);
            opposite.extend([e, other]);
        }
    }
}
