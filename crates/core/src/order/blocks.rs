//! Splits a large point set into blocks by a k-d tree over a sample.
//!
//! Threads can work on separate blocks, and each block fits the cache. The splits depend on the
//! points only, never on the number of threads, and equal points are in the same block.

use delone_predicates::{Point2, lexicographic};

use super::distribute::{Blocks, distribute};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::Extent;
use crate::base::watch::Watch;

/// The most points that a block should hold: its mesh, 80 bytes per point, fits the cache of a core.
/// Of the powers of two from 2^12 to 2^17, this is the fastest for one thread.
const BLOCK: usize = 1 << 15;

/// From this many points on there are two blocks at least, for two threads: below, starting one takes
/// longer than it saves.
const SHARED: usize = 1 << 13;

/// Sampled points per block: splits are off the median by a few percent.
const SAMPLE: usize = 256;

/// Which coordinate is compared first across a split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// By x, then y: left before right.
    X,
    /// By y, then by descending x: below before above, as if rotated by a right angle.
    Y,
}

impl Axis {
    /// The point in the frame in which the axis is first: for Y the plane is rotated clockwise.
    #[inline]
    pub fn turned(self, p: Point2) -> Point2 {
        match self {
            Self::X => p,
            Self::Y => [p[1], -p[0]],
        }
    }

    /// Whether `p` comes before `q` along the axis, without a branch.
    #[inline]
    pub fn before(self, p: Point2, q: Point2) -> bool {
        let (p, q) = (self.turned(p), self.turned(q));
        (p[0] < q[0]) | (p[0] == q[0]) & (p[1] < q[1])
    }
}

/// A split of the plane: points before `at` along `axis` go left.
#[derive(Debug, Clone, Copy)]
pub struct Cut {
    /// The axis that is compared first.
    pub axis: Axis,
    at: Point2,
}

/// A complete binary tree of splits, root first; the blocks are its leaves from left to right.
#[derive(Debug)]
pub struct Cuts {
    cuts: Vec<Cut>,
}

impl Cuts {
    /// Splits for `points`: enough for blocks of at most about `BLOCK`.
    pub fn of(points: &[Point2]) -> Self {
        let fewest = 1 + usize::from(points.len() >= SHARED);
        let blocks = points.len().div_ceil(BLOCK).max(fewest).next_power_of_two();
        let step = (points.len() / (SAMPLE * blocks)).max(1);
        let mut sample: Vec<Point2> = points.iter().copied().step_by(step).collect();
        let mut cuts = vec![
            Cut {
                axis: Axis::X,
                at: [0.0; 2]
            };
            blocks - 1
        ];
        cut(&mut cuts, 0, &mut sample);
        Self { cuts }
    }

    /// The number of blocks.
    pub fn blocks(&self) -> usize {
        self.cuts.len() + 1
    }

    /// The axis of the split between blocks `[i w, i w + w/2)` and the `w/2` that follow, w =
    /// `width`.
    pub fn axis(&self, i: usize, width: usize) -> Axis {
        self.cuts[self.blocks() / width - 1 + i].axis
    }

    /// The block of a point.
    #[inline]
    fn block(&self, p: Point2) -> usize {
        let mut node = 0;
        while let Some(cut) = self.cuts.get(node) {
            // The first coordinates decide without a branch; ties are rare.
            let k = usize::from(cut.axis == Axis::Y);
            let mut left = p[k] < cut.at[k];
            if p[k] == cut.at[k] {
                left = cut.axis.before(p, cut.at);
            }
            node = 2 * node + 2 - usize::from(left);
        }
        node - self.cuts.len()
    }
}

fn cut(cuts: &mut [Cut], node: usize, sample: &mut [Point2]) {
    if node >= cuts.len() || sample.is_empty() {
        return;
    }
    let extent = Extent::of(sample.iter().copied());
    // Halved, since the sides themselves may overflow.
    let half = |k: usize| extent.max[k] / 2.0 - extent.min[k] / 2.0;
    let axis = if half(0) >= half(1) { Axis::X } else { Axis::Y };
    let order = |p: &Point2, q: &Point2| lexicographic(axis.turned(*p), axis.turned(*q));
    let middle = sample.len() / 2;
    let (left, &mut at, right) = sample.select_nth_unstable_by(middle, order);
    cuts[node] = Cut { axis, at };
    cut(cuts, 2 * node + 1, left);
    cut(cuts, 2 * node + 2, right);
}

/// Distributes `points` to the blocks of `cuts`.
pub fn split(points: &[Point2], cuts: &Cuts, workers: usize, watch: &Watch) -> Result<Blocks<2>> {
    let blocks = cuts.blocks();
    if blocks == 1 {
        let mut rows = with_room(points.len())?;
        rows.extend(0..points.len() as u32);
        let mut all = with_room(points.len() + 1)?;
        all.extend_from_slice(points);
        return Ok(Blocks {
            points: all,
            rows,
            starts: vec![0, points.len()],
        });
    }
    distribute(points, blocks, |p| cuts.block(p), workers, watch)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_hold_each_row_once_and_lie_on_their_side_of_each_cut() {
        let n = 3 * BLOCK;
        let points: Vec<Point2> = (0..n as u64)
            .map(|i| {
                let hash = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
                [(hash >> 40) as f64, (hash >> 20 & 0xfffff) as f64]
            })
            .collect();
        let cuts = Cuts::of(&points);
        assert_eq!(cuts.blocks(), 4);
        let one = split(&points, &cuts, 1, &Watch::idle()).unwrap();
        let two = split(&points, &cuts, 2, &Watch::idle()).unwrap();
        assert_eq!((&one.rows, &one.starts), (&two.rows, &two.starts));
        let mut rows = one.rows.clone();
        rows.sort_unstable();
        assert!(rows.iter().copied().eq(0..n as u32));
        let root = cuts.cuts[0];
        for (i, &p) in one.points.iter().enumerate() {
            assert_eq!(points[one.rows[i] as usize], p);
            assert_eq!(root.axis.before(p, root.at), i < one.starts[2]);
        }
    }
}
