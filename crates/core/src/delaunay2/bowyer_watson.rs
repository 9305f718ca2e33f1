//! Bulk triangulation by cavity insertion along the curve.
//!
//! The kernel is Bowyer's and Watson's (see `cavity`). The order is a biased randomised one in the
//! sense of N. Amenta, S. Choi and G. Rote, "Incremental constructions con BRIO" (2003), without
//! the dice: every 64th point along the curve, then every 8th, then the rest. Early points
//! spread over the plane keep cavities small; the curve keeps each round in the cache.

use delone_predicates::{Point2, Sign, orient2d};

use super::cavity::Kernel;
use super::walk::walk;
use crate::error::Result;
use crate::mesh2::Mesh2;
use crate::points::Extent;
use crate::watch::Watch;

/// Strides of the rounds. On a million uniform points one round makes 12.6 in-circle tests a
/// point, these three 9.
const STRIDES: [u32; 3] = [64, 8, 1];

/// Insertions between two looks at the watch.
const WATCH_EVERY: usize = 4096;

/// The triangulation of distinct `points` in curve order, or nothing where all are collinear.
/// A NaN point for the vertex at infinity is appended to `points`.
pub fn build(points: &mut Vec<Point2>, extent: &Extent, watch: &Watch) -> Result<Option<Mesh2>> {
    let Some(first) = first_triangle(points) else {
        return Ok(None);
    };
    let n = points.len() as u32;
    points.push([f64::NAN; 2]);
    let points = &points[..];
    let mut kernel = Kernel::start(points, extent, first)?;
    let mut order = Rounds::over(n).filter(|i| !first.contains(i)).peekable();
    let mut near = 0;
    let mut until_watch = WATCH_EVERY;
    while let Some(p) = order.next() {
        let aim = order.peek().map_or(p, |&q| q);
        let seed = walk(kernel.mesh(), points, near, points[p as usize]);
        near = kernel.insert(p, seed, points[aim as usize]);
        until_watch -= 1;
        if until_watch == 0 {
            watch.check()?;
            until_watch = WATCH_EVERY;
        }
    }
    Ok(Some(kernel.into_mesh()))
}

/// The first two points of the order and the first that is not in line with them, turned left.
fn first_triangle(points: &[Point2]) -> Option<[u32; 3]> {
    let mut order = Rounds::over(points.len() as u32);
    let (a, b) = (order.next()?, order.next()?);
    order.find_map(
        |c| match orient2d(points[a as usize], points[b as usize], points[c as usize]) {
            Sign::Positive => Some([a, b, c]),
            Sign::Negative => Some([b, a, c]),
            Sign::Zero => None,
        },
    )
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

    #[test]
    fn rounds_name_each_number_once() {
        for n in [0, 1, 2, 63, 64, 65, 1000] {
            let mut all: Vec<u32> = Rounds::over(n).collect();
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }
}
