//! Divide and conquer all the way down: cut at the median, triangulate both sides, merge.
//!
//! L. Guibas and J. Stolfi (1985; see `merge`), cuts alternating between the axes as in
//! R. A. Dwyer, "A faster divide-and-conquer algorithm for constructing Delaunay triangulations",
//! Algorithmica 2 (1987). O(n log n) in the worst case: medians are found in linear time, merges
//! are linear, and the depth is log n.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::merge::merge;
use crate::error::Result;
use crate::mesh2::{Code, Patch};
use crate::order::blocks::Axis;
use crate::watch::Watch;

/// Vertices of a part whose merge looks at the watch.
const WATCHED: usize = 1 << 12;

/// Fills `mesh` with the triangulation of `vertices`, two at least, and returns a ghost.
pub fn build(
    points: &[Point2],
    vertices: &mut [u32],
    mesh: &mut Patch,
    watch: &Watch,
) -> Result<Code> {
    conquer(points, vertices, mesh.reborrow(), Axis::X, watch)
}

/// Records are handed down with the vertices: a part of k vertices has 2 k and leaves two free.
fn conquer(
    points: &[Point2],
    vertices: &mut [u32],
    mut mesh: Patch,
    axis: Axis,
    watch: &Watch,
) -> Result<Code> {
    let at = |v: u32| points[v as usize];
    if vertices.len() <= 3 {
        vertices.sort_unstable_by(|&u, &v| lexicographic(at(u), at(v)));
        return Ok(match *vertices {
            [a, b, c] => match orient2d(at(a), at(b), at(c)) {
                Sign::Positive => mesh.triangle([a, b, c]),
                Sign::Negative => mesh.triangle([b, a, c]),
                Sign::Zero => mesh.chain(vertices),
            },
            _ => mesh.chain(vertices),
        });
    }
    if vertices.len() >= WATCHED {
        watch.check()?;
    }
    let middle = vertices.len() / 2;
    vertices.select_nth_unstable_by(middle, |&u, &v| {
        lexicographic(axis.turned(at(u)), axis.turned(at(v)))
    });
    let (first, second) = vertices.split_at_mut(middle);
    let (left, right) = mesh.reborrow().split_at(middle);
    let other = if axis == Axis::X { Axis::Y } else { Axis::X };
    let sides = [
        conquer(points, first, left, other, watch)?,
        conquer(points, second, right, other, watch)?,
    ];
    let spare = mesh.spare(middle);
    Ok(merge(&mut mesh, points, sides, axis, spare))
}
