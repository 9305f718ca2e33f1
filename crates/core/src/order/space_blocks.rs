//! Cuts a large point set of space into blocks, by a k-d tree over a sample, so that threads can work on
//! them. As in the plane (see `blocks`) the cuts hang on the points alone, never on the number of threads,
//! and equal points fall in one block.

use delone_predicates::{Point3, lexicographic};

use super::space::Extent3;
use crate::error::Result;
use crate::memory::with_room;

/// Sampled points a block: cuts are off the median by some per cent.
const SAMPLE: usize = 1024;

/// A cut of space: what comes before `at`, by the coordinate `axis` and then the next ones, goes left.
/// That is a half-space with a part of its border, so the hulls of the two sides do not meet.
#[derive(Debug, Clone, Copy)]
struct Cut {
    axis: usize,
    at: Point3,
}

impl Cut {
    #[inline]
    fn turned(&self, p: Point3) -> Point3 {
        [0, 1, 2].map(|k| p[(self.axis + k) % 3])
    }

    #[inline]
    fn before(&self, p: Point3) -> bool {
        let (x, at) = (p[self.axis], self.at[self.axis]);
        x < at || x == at && lexicographic(self.turned(p), self.turned(self.at)).is_lt()
    }
}

/// A complete binary tree of cuts, root first; the blocks are its leaves from left to right.
#[derive(Debug)]
pub struct Cuts3 {
    cuts: Vec<Cut>,
}

impl Cuts3 {
    /// Cuts for `points`: enough for blocks of at most about `block`.
    pub fn of(points: &[Point3], block: usize) -> Self {
        let blocks = points.len().div_ceil(block).next_power_of_two();
        let step = (points.len() / (SAMPLE * blocks)).max(1);
        let mut sample: Vec<Point3> = points.iter().copied().step_by(step).collect();
        let nowhere = Cut {
            axis: 0,
            at: [0.0; 3],
        };
        let mut cuts = vec![nowhere; blocks - 1];
        cut(&mut cuts, 0, &mut sample);
        Self { cuts }
    }

    /// The number of blocks.
    pub fn blocks(&self) -> usize {
        self.cuts.len() + 1
    }

    #[inline]
    fn block(&self, p: Point3) -> usize {
        let mut node = 0;
        while let Some(cut) = self.cuts.get(node) {
            node = 2 * node + 2 - usize::from(cut.before(p));
        }
        node - self.cuts.len()
    }

    /// The closed box around the cell of a block, infinite where no cut bounds it.
    pub fn cell(&self, block: usize) -> Extent3 {
        let mut cell = Extent3 {
            min: [f64::NEG_INFINITY; 3],
            max: [f64::INFINITY; 3],
        };
        let mut node = block + self.cuts.len();
        while node > 0 {
            let Cut { axis, at } = self.cuts[(node - 1) / 2];
            // A cut further up is further out.
            if node % 2 == 1 {
                cell.max[axis] = cell.max[axis].min(at[axis]);
            } else {
                cell.min[axis] = cell.min[axis].max(at[axis]);
            }
            node = (node - 1) / 2;
        }
        cell
    }

    /// The points of each block with their rows, which ascend.
    pub fn split(&self, points: &[Point3]) -> Result<Vec<(Vec<Point3>, Vec<u32>)>> {
        let mut counts = vec![0usize; self.blocks()];
        let mut block_of = with_room(points.len())?;
        for &p in points {
            let b = self.block(p);
            counts[b] += 1;
            block_of.push(b as u16);
        }
        let mut out = Vec::with_capacity(self.blocks());
        for count in counts {
            out.push((with_room(count)?, with_room(count)?));
        }
        for ((&p, &b), row) in points.iter().zip(&block_of).zip(0..) {
            let (points, rows) = &mut out[usize::from(b)];
            points.push(p);
            rows.push(row);
        }
        Ok(out)
    }
}

fn cut(cuts: &mut [Cut], node: usize, sample: &mut [Point3]) {
    if node >= cuts.len() || sample.is_empty() {
        return;
    }
    let extent = Extent3::of(sample.iter().copied());
    // Halves, since the sides themselves may overflow.
    let half = |k: usize| extent.max[k] / 2.0 - extent.min[k] / 2.0;
    let axis = (1..3).fold(0, |axis, k| if half(k) > half(axis) { k } else { axis });
    let mut here = Cut { axis, at: [0.0; 3] };
    let middle = sample.len() / 2;
    let order = |p: &Point3, q: &Point3| lexicographic(here.turned(*p), here.turned(*q));
    let (left, &mut at, right) = sample.select_nth_unstable_by(middle, order);
    here.at = at;
    cuts[node] = here;
    cut(cuts, 2 * node + 1, left);
    cut(cuts, 2 * node + 2, right);
}
