//! The walk to the triangle that holds a point, from triangle to triangle across edges that have
//! the point on their other side.
//!
//! O. Devillers, S. Pion and M. Teillaud, "Walking in a triangulation" (2002). The visibility walk
//! meets triangles in the order of the power of the point to their circles, with ties as in the
//! mesh, which falls at each step; with exact signs it never comes back and ends.

use delone_predicates::{Point2, Sign, orient2d};

use crate::mesh2::{Patch, next, prev, triangle};

/// The triangle whose closed area holds `q`, or a ghost whose hull edge has `q` strictly beyond
/// it, walking from triangle `from`; and the number of triangles met on the way.
#[inline]
pub fn walk(mesh: &Patch, points: &[Point2], from: u32, q: Point2) -> (u32, usize) {
    walk_within(mesh, points, from, q, usize::MAX).unwrap_or((from, 0))
}

/// The same in a triangulation of any kind, where a walk may turn in circles; nothing where more
/// than `limit` triangles would be met.
#[inline]
pub fn walk_within(
    mesh: &Patch,
    points: &[Point2],
    from: u32,
    q: Point2,
    limit: usize,
) -> Option<(u32, usize)> {
    let at = |v: u32| points[v as usize];
    let inf = mesh.infinite();
    // Whether q lies strictly on the outer side of half-edge e.
    let beyond =
        |e| orient2d(at(mesh.vertex(next(e))), at(mesh.vertex(prev(e))), q) == Sign::Negative;
    let mut start = 8 * from;
    if let Some(k) = mesh.corners(from).iter().position(|&v| v == inf) {
        let outer = 8 * from + k as u32;
        // The ghost's own half-edge has the outside on its left.
        if orient2d(
            at(mesh.vertex(next(outer))),
            at(mesh.vertex(prev(outer))),
            q,
        ) == Sign::Positive
        {
            return Some((from, 0));
        }
        start = mesh.opposite(outer);
    }
    let mut e = start;
    if beyond(start) {
        e = mesh.opposite(start);
        if mesh.vertex(e) == inf {
            return Some((triangle(e), 1));
        }
    }
    let mut steps = 1;
    while steps < limit {
        // The walk came across e; two edges are left to look at.
        let across = if beyond(next(e)) {
            mesh.opposite(next(e))
        } else if beyond(prev(e)) {
            mesh.opposite(prev(e))
        } else {
            return Some((triangle(e), steps));
        };
        if mesh.vertex(across) == inf {
            return Some((triangle(across), steps));
        }
        e = across;
        steps += 1;
    }
    None
}
