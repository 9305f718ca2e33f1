//! The Urquhart graph: a Delaunay triangulation without the longest edge of each triangle.
//!
//! R. B. Urquhart, in Electronics Letters 16 (1980). Only an edge that is strictly longer than the two others is removed: the opposite corner is then inside
//! its lune, so the relative neighborhood graph keeps none of these.

use delone_predicates::proximity::shorter;
use delone_predicates::{Point2, Sign};

use super::edges::{SHARE, joined, sorted};
use crate::error::Result;
use crate::memory::push;
use crate::parallel;
use crate::watch::Watch;

/// The edges of triangles that are strictly longest in none.
pub fn urquhart(
    points: &[Point2],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let at = |v: i32| points[v as usize];
    let found = filtered(simplices, neighbors, workers, watch, |[a, b], apex| {
        let longer = |end| shorter(at(apex), at(end), at(a), at(b)) == Sign::Positive;
        !longer(a) || !longer(b)
    })?;
    sorted(&found, points.len(), watch)
}

/// The edges that remain for all opposite corners, the smaller row first, in no order.
pub(super) fn filtered(
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
    remains: impl Fn([i32; 2], i32) -> bool + Sync,
) -> Result<Vec<[i32; 2]>> {
    let shares = (0..simplices.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let mut found = Vec::new();
        for t in first..simplices.len().min(first + SHARE) {
            // An edge between two triangles belongs to the later one.
            for k in (0..3).filter(|&k| neighbors[t][k] < t as i32) {
                let edge @ [a, b] = [1, 2].map(|i| simplices[t][(k + i) % 3]);
                let beyond = usize::try_from(neighbors[t][k])
                    .ok()
                    .and_then(|other| simplices[other].into_iter().find(|&v| v != a && v != b));
                let mut apexes = std::iter::once(simplices[t][k]).chain(beyond);
                if apexes.all(|apex| remains(edge, apex)) {
                    push(&mut found, [a.min(b), a.max(b)])?;
                }
            }
        }
        Ok(found)
    })?;
    joined(&parts)
}
