//! Components of a surface, and the regions that it separates.
//!
//! Each triangle has a front and a back. Around an edge, sorted by angle, the side of a triangle
//! and the facing side of the next one are in one region. If in the end front and back of a
//! triangle are in different sets, they are in different regions of space: the triangles with one
//! side in the set form a closed surface modulo 2, which any path from one side to the other
//! crosses. So a component with k sets separates k - 1 regions from what is outside it.

use std::cmp::Ordering;

use delone_predicates::{Point3, Sign, orient2d, orient3d};

use super::contact::Projection;
use super::edges::{Edges, ends};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 14;

/// The number of the component of each triangle, numbered by their first triangles, and how many
/// there are; triangles are connected by edges.
pub fn components(faces: usize, edges: &Edges, watch: &Watch) -> Result<(Vec<i32>, u32)> {
    let mut sets = Sets::of(faces)?;
    let mut pace = Pace::new(watch, LOT);
    for edge in edges.each() {
        pace.spend(1)?;
        for pair in edge.windows(2) {
            sets.join(pair[0] / 3, pair[1] / 3);
        }
    }
    let (labels, count) = sets.numbered(|_| true)?;
    Ok((labels, count as u32))
}

/// The number of sets of sides, and the triangles with both sides in one set, ascending. The
/// triangles may have only vertices and edges in common.
pub fn regions(
    points: &[Point3],
    faces: &[[u32; 3]],
    edges: &Edges,
    watch: &Watch,
) -> Result<(u32, Vec<u32>)> {
    let mut sets = Sets::of(2 * faces.len())?;
    let mut pace = Pace::new(watch, LOT);
    let mut around = Vec::new();
    for edge in edges.each() {
        pace.spend(1)?;
        around.clear();
        for &half in edge {
            push(&mut around, half)?;
        }
        if edge.len() > 2 {
            pace.spend(edge.len())?;
            sort_around(points, faces, &mut around);
        }
        let low = ends(faces, edge[0]);
        let low = low[0].min(low[1]);
        // The front of a triangle faces the positive rotation around its own direction.
        let side = |half: u32, front: bool| 2 * (half / 3) + u32::from(!front);
        let forward = |half: u32| ends(faces, half)[0] == low;
        for (i, &half) in around.iter().enumerate() {
            let next = around[(i + 1) % around.len()];
            sets.join(side(half, forward(half)), side(next, !forward(next)));
        }
    }
    let mut count = 0;
    let mut dangling = with_room(0)?;
    for face in 0..faces.len() as u32 {
        pace.spend(1)?;
        let [front, back] = [2 * face, 2 * face + 1].map(|side| (sets.root(side), side));
        count += u32::from(front.0 == front.1) + u32::from(back.0 == back.1);
        if front.0 == back.0 {
            push(&mut dangling, face)?;
        }
    }
    Ok((count, dangling))
}

/// Sorts the half-edges of one edge by the angle of their triangles around it.
fn sort_around(points: &[Point3], faces: &[[u32; 3]], halves: &mut [u32]) {
    let at = |v: u32| points[v as usize];
    let opposite = |half: u32| {
        let half = half as usize;
        at(faces[half / 3][(half + 2) % 3])
    };
    let [a, b] = ends(faces, halves[0]);
    let (a, b) = (at(a.min(b)), at(a.max(b)));
    let first = opposite(halves[0]);
    // 0 at the angle of the first, 1 up to the half turn, 2 there, 3 beyond.
    let quarter = |c: Point3| match orient3d(a, b, first, c) {
        Sign::Positive => 1,
        Sign::Negative => 3,
        Sign::Zero => match Projection::of([a, b, first]) {
            Some(plane) if plane.turn == in_plane(&plane, a, b, c) => 0,
            _ => 2,
        },
    };
    halves.sort_by(|&g, &h| {
        let (p, q) = (opposite(g), opposite(h));
        quarter(p)
            .cmp(&quarter(q))
            .then_with(|| match orient3d(a, b, p, q) {
                Sign::Positive => Ordering::Less,
                Sign::Negative => Ordering::Greater,
                Sign::Zero => g.cmp(&h),
            })
    });
}

/// The orientation of three points in the projection of a plane.
fn in_plane(plane: &Projection, a: Point3, b: Point3, c: Point3) -> Sign {
    let [a, b, c] = [a, b, c].map(|p| plane.of_point(p));
    orient2d(a, b, c)
}
