//! Splits a large 3-D point set into blocks by a k-d tree over a sample.
//!
//! As in 2-D (see `blocks`), the splits depend on the points only, never on the number of threads,
//! and equal points are in the same block.

use delone_predicates::{Point3, lexicographic};

use super::distribute::{Blocks, distribute};
use super::space::{Arranged3, Extent3, Room3, arrange, arrange_rows};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::watch::Watch;

/// Sampled points per block. A median of this many is off by 0.3 % of the points, and so is the
/// work of two threads with a block each; finding it costs 2 ns per point for a million points.
const SAMPLE: usize = 1 << 14;

/// A split of space: points before `at`, by the coordinate `axis` and then the next ones, go left.
/// That is a half-space with part of its boundary, so the hulls of the two sides do not meet.
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

/// A complete binary tree of splits, root first; the blocks are its leaves from left to right.
#[derive(Debug)]
pub struct Cuts3 {
    cuts: Vec<Cut>,
}

impl Cuts3 {
    /// Splits of `points` into this many blocks, a power of two.
    pub fn of(points: &[Point3], blocks: usize) -> Result<Self> {
        // Odd, since rows of a grid are periodic.
        let step = (points.len() / (SAMPLE * blocks)) | 1;
        let mut sample: Vec<Point3> = with_room(points.len() / step + 1)?;
        sample.extend(points.iter().step_by(step));
        let nowhere = Cut {
            axis: 0,
            at: [0.0; 3],
        };
        let mut cuts = vec![nowhere; blocks - 1];
        cut(&mut cuts, 0, &mut sample);
        Ok(Self { cuts })
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

    /// The closed box around the cell of a block, infinite where no split bounds it.
    pub fn cell(&self, block: usize) -> Extent3 {
        let mut cell = Extent3 {
            min: [f64::NEG_INFINITY; 3],
            max: [f64::INFINITY; 3],
        };
        let mut node = block + self.cuts.len();
        while node > 0 {
            let Cut { axis, at } = self.cuts[(node - 1) / 2];
            // A split further up in the tree is further out.
            if node % 2 == 1 {
                cell.max[axis] = cell.max[axis].min(at[axis]);
            } else {
                cell.min[axis] = cell.min[axis].max(at[axis]);
            }
            node = (node - 1) / 2;
        }
        cell
    }
}

/// Distributes `points` to the blocks of `cuts`.
pub fn split(points: &[Point3], cuts: &Cuts3, workers: usize, watch: &Watch) -> Result<Blocks<3>> {
    distribute(points, cuts.blocks(), |p| cuts.block(p), workers, watch)
}

/// Distinct points in blocks, each sorted along the curve; where each block begins, and the end.
pub fn arrange_blocks(
    points: &[Point3],
    blocks: usize,
    workers: usize,
    watch: &Watch,
) -> Result<(Arranged3, Vec<usize>)> {
    if blocks < 2 {
        let arranged = arrange(points, watch)?;
        let end = arranged.points.len();
        return Ok((arranged, vec![0, end]));
    }
    let cuts = Cuts3::of(points, blocks)?;
    let split = split(points, &cuts, workers, watch)?;
    let tasks = split.each().collect();
    let parts = parallel::map_watched(workers, tasks, watch, |(points, rows)| {
        arrange_rows(points, Some(rows), Room3::of(points.len())?, watch)
    })?;
    let count = parts.iter().map(|part| part.points.len()).sum::<usize>();
    let mut out = Arranged3 {
        points: with_room(count + 1)?,
        rows: with_room(count)?,
        duplicates: Vec::new(),
    };
    let mut starts = vec![0];
    for part in parts {
        out.points.extend(part.points);
        out.rows.extend(part.rows);
        out.duplicates.extend(part.duplicates);
        starts.push(out.points.len());
    }
    out.duplicates.sort_unstable();
    Ok((out, starts))
}

fn cut(cuts: &mut [Cut], node: usize, sample: &mut [Point3]) {
    if node >= cuts.len() || sample.is_empty() {
        return;
    }
    let extent = Extent3::of(sample.iter().copied());
    // Halved, since the sides themselves may overflow.
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
