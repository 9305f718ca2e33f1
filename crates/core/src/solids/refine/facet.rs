//! Facets: walls in one plane, and the segments that bound them.

use std::collections::HashSet;

use delone_predicates::{Sign, orient3d};

use super::judge::{cross, dot, minus};
use super::mesh::{Mesh, Side, edge};
use super::near::{self, AtEdge, Pair};
use crate::base::error::{Error, Result};
use crate::base::memory::{push, with_room};
use crate::base::sets::Sets;

/// Joins walls to facets and collects the segments.
///
/// Walls are in one facet if they came from one face, or have equal markers and are in one plane,
/// exactly or by [`near`] a common plane, on two sides of an edge that has no other wall.
pub fn collect(mesh: &mut Mesh, source: &[i32], markers: &[i32], tolerance: f64) -> Result<()> {
    let mut at: Vec<AtEdge> = with_room(3 * mesh.facet.len())?;
    for t in (0..mesh.places()).filter(|&t| mesh.is_there(t)) {
        for k in 0..4 {
            let side = (t, k);
            if !super::is_wall(mesh, t, k) || mesh.behind(side).is_some_and(|o| o < side) {
                continue;
            }
            let [a, b, c] = mesh.face(side);
            for (x, y, z) in [(a, b, c), (b, c, a), (c, a, b)] {
                push(&mut at, (edge(x, y), mesh.wall[t as usize][k], z, side))?;
            }
        }
    }
    at.sort_unstable();
    // Join walls across edges between two of them.
    let mut sets = Sets::of(mesh.facet.len())?;
    let mut pairs: Vec<Pair> = Vec::new();
    let mut rest = at.as_slice();
    while let Some((&(ends, first, z, side), others)) = rest.split_first() {
        let same = others.iter().take_while(|o| o.0 == ends).count();
        if same == 1 {
            let (_, second, w, other) = others[0];
            let [a, b, c, d] = mesh.places_of([ends[0], ends[1], z, w]);
            let (i, j) = (first as usize, second as usize);
            // On two sides: the normals from the edge are opposite.
            let normals = [c, d].map(|x| cross(minus(b, a), minus(x, a)));
            let opposite = dot(normals[0], normals[1]) < 0.0;
            let alike = markers[i] == markers[j];
            let flat = || orient3d(a, b, c, d) == Sign::Zero;
            let exact = source[i] == source[j] || (alike && opposite && flat());
            if exact {
                sets.join(first, second);
            }
            if tolerance > 0.0 && (exact || alike) {
                let turned = is_along(mesh, side, ends) == is_along(mesh, other, ends);
                push(
                    &mut pairs,
                    Pair {
                        walls: [first, second],
                        exact,
                        opposite,
                        turned,
                    },
                )?;
            }
        }
        rest = &others[same..];
    }
    if !pairs.is_empty() {
        near::join(mesh, &at, &pairs, &mut sets, tolerance)?;
    }
    for (row, facet) in (0..).zip(&mut mesh.facet) {
        *facet = sets.root(row);
    }
    // All other edges of walls are segments.
    let (mut segments, mut pinched) = (HashSet::new(), HashSet::new());
    let mut rest = at.as_slice();
    while let Some((&(ends, first, _, first_side), others)) = rest.split_first() {
        let same = others.iter().take_while(|o| o.0 == ends).count();
        let facet = |row: u32| mesh.facet[row as usize];
        if same != 1 || facet(first) != facet(others[0].1) {
            insert(&mut segments, ends)?;
            let all = std::iter::once(first_side).chain(others[..same].iter().map(|o| o.3));
            if all.filter(|&side| mesh.behind(side).is_none()).count() > 2 {
                insert(&mut pinched, ends)?;
            }
        }
        rest = &others[same..];
    }
    (mesh.segments, mesh.pinched) = (segments, pinched);
    Ok(())
}

/// Whether a wall, as seen from a side, passes an edge from its first to its second vertex.
fn is_along(mesh: &Mesh, side: Side, [a, b]: [u32; 2]) -> bool {
    let [x, y, z] = mesh.face(side);
    [[x, y], [y, z], [z, x]].contains(&[a, b])
}

/// Adds an edge to a set.
pub fn insert(set: &mut HashSet<[u32; 2]>, ends: [u32; 2]) -> Result<()> {
    let bytes = 8 * set.capacity();
    set.try_reserve(1).map_err(|_| Error::Memory { bytes })?;
    set.insert(ends);
    Ok(())
}
