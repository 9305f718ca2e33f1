//! Visibility walk to the triangle that contains a point.
//!
//! From triangle to triangle, across edges that have the point on their other side.
//!
//! O. Devillers, S. Pion and M. Teillaud, "Walking in a triangulation" (2002). In a Delaunay
//! triangulation the power of the point with respect to the circumcircle, with ties as in the mesh,
//! decreases at each step; with exact signs the walk never returns to a triangle and terminates.

use delone_predicates::{Point2, Sign, orient2d};

use crate::mesh::plane::{Patch, half_edge, next, prev, triangle};

/// The triangle whose closed area contains `q`, or a ghost with `q` strictly outside its hull edge,
/// by a walk from triangle `from`; and the number of triangles visited on the way.
#[inline]
pub fn walk(mesh: &Patch, points: &[Point2], from: u32, q: Point2) -> (u32, usize) {
    walk_within(mesh, points, from, q, usize::MAX).unwrap_or((from, 0))
}

/// The same in an arbitrary triangulation, where a walk may cycle; `None` after `limit` triangles.
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
    let mut start = half_edge(from, 0);
    if let Some(k) = mesh.corners(from).iter().position(|&v| v == inf) {
        let outer = half_edge(from, k as u32);
        // The finite half-edge of a ghost has the outside on its left.
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
        // The walk came across e; two edges are left to test.
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
