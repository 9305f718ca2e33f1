//! Bulk triangulation by cavity insertion along the curve.
//!
//! The kernel is Bowyer's and Watson's (see `cavity`). The order is a biased randomised one in the
//! sense of N. Amenta, S. Choi and G. Rote, "Incremental constructions con BRIO" (2003), without
//! the dice: every 64th point along the curve, then every 8th, then the rest. Early points
//! spread over the plane keep cavities small; the curve keeps each round in the cache.
//!
//! An order that is fixed in advance has inputs that make it quadratic: two lines that nearly
//! coincide do, whose triangles are so thin that each point meets most of them. A budget of
//! triangles met, O(n log n), ends such a block early, and `divide_conquer` takes it.

use std::ops::Range;

use delone_predicates::Point2;

use super::cavity::Kernel;
use super::first::first_triangle;
use crate::error::Result;
use crate::mesh2::{Code, Patch, triangle};
use crate::points::Extent;
use crate::watch::Watch;

/// Strides of the rounds. On a million uniform points one round makes 12.6 in-circle tests a
/// point, these three 9.
const STRIDES: [u32; 3] = [64, 8, 1];

/// Insertions between two looks at the watch.
const WATCH_EVERY: usize = 4096;

/// Triangles that an insertion may meet on average, and how many more for each doubling of the
/// number of points: of the generators and the corpus, none but near lines needs more than 10.
const BUDGET: usize = 16;
const BUDGET_DOUBLING: usize = 2;

/// Fills `mesh` with the triangulation of vertices `block` and returns a ghost; nothing where the
/// block is collinear or the budget did not suffice. `points` end with NaN for infinity.
pub fn build(
    points: &[Point2],
    block: Range<u32>,
    mesh: Patch,
    watch: &Watch,
) -> Result<Option<Code>> {
    let own = &points[block.start as usize..block.end as usize];
    let Some(first) = first_triangle(own, Rounds::over(block.len() as u32)) else {
        return Ok(None);
    };
    let first = first.map(|v| block.start + v);
    let extent = Extent::of(own.iter().copied());
    let mut kernel = Kernel::start(points, &extent, mesh, first);
    let n = block.len();
    let mut order = Rounds::over(n as u32)
        .map(|i| block.start + i)
        .filter(|v| !first.contains(v));
    let share = BUDGET + BUDGET_DOUBLING * n.ilog2() as usize;
    // The budget grows as points go in, from that of an eighth of them: a hopeless block ends early.
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

/// The numbers below n in rounds of falling stride, each once.
struct Rounds {
    n: u32,
    round: usize,
    at: u32,
}

impl Rounds {
    fn over(n: u32) -> Self {
        Self { n, round: 0, at: 0 }
    }
}

impl Iterator for Rounds {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        loop {
            let stride = *STRIDES.get(self.round)?;
            let i = self.at;
            if i >= self.n {
                self.round += 1;
                self.at = 0;
                continue;
            }
            self.at += stride;
            if self.round == 0 || !i.is_multiple_of(STRIDES[self.round - 1]) {
                return Some(i);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh2::Mesh2;
    use crate::order::arrange;

    /// What `build` makes of `points`; `None` where it gives up.
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

    #[test]
    fn rounds_name_each_number_once() {
        for n in [0, 1, 2, 63, 64, 65, 1000] {
            let mut all: Vec<u32> = Rounds::over(n).collect();
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }
}
