//! Visibility walk to the triangle that contains a direction, by exact signs.
//!
//! The walk goes from triangle to triangle across great circles with the direction on their other
//! side. Let n be the normal of a triangle and h > 0 its distance from the center; the ray of p
//! meets the plane of the triangle at h / (n p) times p. In a Delaunay triangulation, the ray
//! leaves the half-spaces of the planes sooner and sooner: n p / h rises at each step (the planes
//! of the two triangles meet in their edge, and p is beyond it), with ties as in the mesh. So the
//! walk terminates.

use delone_predicates::Sign;

use super::directions::Directions;
use crate::mesh::plane::{Patch, half_edge, half_edges, next, prev, triangle};

/// The triangle whose closed area contains `p`, or a ghost with `p` strictly outside its edge, by a walk
/// from triangle `from`; and the number of triangles visited on the way.
pub fn walk(mesh: &Patch, directions: &Directions, from: u32, p: u32) -> (u32, usize) {
    let inf = mesh.infinite();
    let side = |e| directions.orient([mesh.vertex(next(e)), mesh.vertex(prev(e)), p]);
    let mut t = from;
    if let Some(k) = mesh.corners(from).iter().position(|&v| v == inf) {
        let outer = half_edge(from, k as u32);
        // The finite half-edge of a ghost has the outside on its left.
        if side(outer) == Sign::Positive {
            return (from, 1);
        }
        t = triangle(mesh.opposite(outer));
    }
    let mut steps = 1;
    loop {
        let Some(e) = half_edges(t).find(|&e| side(e) == Sign::Negative) else {
            return (t, steps);
        };
        let across = mesh.opposite(e);
        t = triangle(across);
        if mesh.vertex(across) == inf {
            return (t, steps);
        }
        steps += 1;
    }
}
