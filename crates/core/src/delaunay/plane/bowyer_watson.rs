//! Bowyer-Watson insertion of a block along the Hilbert curve, in rounds.
//!
//! The kernel is Bowyer's and Watson's (see `cavity`). The order is a biased randomized one as in
//! N. Amenta, S. Choi and G. Rote, "Incremental constructions con BRIO" (2003), but without random
//! choices: every 64th point along the curve, then every 8th, then the rest. Early points that are
//! spread out keep cavities small; the curve keeps each round in the cache.
//!
//! Any order that is fixed in advance is quadratic for some inputs, for example for two lines that
//! nearly coincide: their triangles are so thin that each point visits most of them. A budget of
//! O(n log n) visited triangles ends such a block early, and `divide_conquer` takes over.

use std::ops::Range;

use delone_predicates::Point2;

use super::cavity::Kernel;
use super::first::first_triangle;
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, triangle};
use crate::order::Rounds;

/// Strides of the rounds. On a million uniform points one round makes 12.6 in-circle tests per
/// point, these three make 9.
const STRIDES: [u32; 3] = [64, 8, 1];

/// Insertions between two checks for interruption.
const WATCH_EVERY: usize = 4096;

/// Triangles that an insertion may visit on average, and how many more for each doubling of the
/// number of points. Of the generators and the corpus, only near lines need more than 10.
const BUDGET: usize = 16;
const BUDGET_DOUBLING: usize = 2;

/// Fills `mesh` with the triangulation of vertices `block` and returns a ghost; `None` if the block
/// is collinear or the budget is exhausted. `points` end with NaN for infinity.
pub fn build(
    points: &[Point2],
    block: Range<u32>,
    mesh: Patch,
    watch: &Watch,
) -> Result<Option<Code>> {
    let own = &points[block.start as usize..block.end as usize];
    let Some(first) = first_triangle(own, Rounds::over(block.len() as u32, STRIDES)) else {
        return Ok(None);
    };
    let first = first.map(|v| block.start + v);
    let extent = Extent::of(own.iter().copied());
    let mut kernel = Kernel::start(points, &extent, mesh, first);
    let n = block.len();
    let mut order = Rounds::over(n as u32, STRIDES)
        .map(|i| block.start + i)
        .filter(|v| !first.contains(v));
    let share = BUDGET + BUDGET_DOUBLING * n.ilog2() as usize;
    // The budget grows with each insertion, from that of an eighth of the points: a hopeless block
    // ends early.
    let mut budget = share * (n / 8 + WATCH_EVERY);
    let mut near = triangle(kernel.ghost());
    let mut until_watch = WATCH_EVERY;
    let mut next = order.next();
    while let Some(p) = next {
        next = order.next();
        let aim = points[next.unwrap_or(p) as usize];
        near = kernel.insert(p, near, aim);
        until_watch -= 1;
        if until_watch == 0 {
            watch.check()?;
            until_watch = WATCH_EVERY;
        }
        budget += share;
        if kernel.work() > budget {
            return Ok(None);
        }
    }
    Ok(Some(kernel.ghost()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::plane::Mesh2;
    use crate::order::arrange;

    /// The result of `build` for `points`; `None` if it gives up.
    fn built(points: &[Point2]) -> Option<Code> {
        let mut arranged = arrange(points, 1, &Watch::idle()).unwrap();
        let n = arranged.points.len();
        arranged.points.push([f64::NAN; 2]);
        let mut mesh = Mesh2::with_vertices(n).unwrap();
        build(&arranged.points, 0..n as u32, mesh.patch(), &Watch::idle()).unwrap()
    }

    #[test]
    fn two_lines_that_nearly_coincide_exceed_the_budget() {
        let lines = |apart: f64| -> Vec<Point2> {
            let point = |i| {
                let t = f64::from(i) / 1e5;
                [t, f64::from(i % 2) * (apart + t * apart / 100.0)]
            };
            (0..100_000).map(point).collect()
        };
        assert!(built(&lines(1e-7)).is_none());
        assert!(built(&lines(1e-3)).is_some());
    }
}
