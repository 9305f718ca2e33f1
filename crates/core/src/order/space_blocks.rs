//! Cuts a large point set of space into blocks, by a k-d tree over a sample, so that threads can work on
//! them. As in the plane (see `blocks`) the cuts hang on the points alone, never on the number of threads,
//! and equal points fall in one block.

use delone_predicates::{Point3, lexicographic};

use super::space::Extent3;
use crate::error::Result;
use crate::memory::{with_room, zeroed};
use crate::parallel;

/// Sampled points a block. A median of so many is off by 0.3 % of the points, and by so much two threads with
/// a block each differ; to find it costs 2 ns a point of a million.
const SAMPLE: usize = 1 << 14;

/// Points that one task classifies.
const SHARE: usize = 1 << 16;

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
    /// Cuts of `points` into so many blocks, a power of two.
    pub fn of(points: &[Point3], blocks: usize) -> Result<Self> {
        // Odd, as rows of a grid come in periods.
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
}

/// Points sorted into blocks, in the order of their rows within each.
#[derive(Debug)]
pub struct Blocks3 {
    points: Vec<Point3>,
    rows: Vec<u32>,
    starts: Vec<usize>,
}

impl Blocks3 {
    /// The points of each block with their rows, which ascend.
    pub fn each(&self) -> impl Iterator<Item = (&[Point3], &[u32])> {
        let range = |w: &[usize]| (&self.points[w[0]..w[1]], &self.rows[w[0]..w[1]]);
        self.starts.windows(2).map(range)
    }
}

/// Sorts `points` into the blocks of `cuts`.
pub fn split(points: &[Point3], cuts: &Cuts3, workers: usize) -> Result<Blocks3> {
    let blocks = cuts.blocks();
    let shares: Vec<&[Point3]> = points.chunks(SHARE).collect();
    let classified: Vec<_> = parallel::map(workers, shares, |share| {
        let mut counts = vec![0usize; blocks];
        let block_of = share.iter().map(|&p| {
            let b = cuts.block(p);
            counts[b] += 1;
            b as u16
        });
        (block_of.collect::<Vec<u16>>(), counts)
    });
    let mut out = Blocks3 {
        points: zeroed(points.len())?,
        rows: zeroed(points.len())?,
        starts: vec![0],
    };
    // Each share writes its part of each block: cut the outputs into those parts, block by block.
    let mut parts: Vec<Vec<_>> = classified
        .iter()
        .map(|_| Vec::with_capacity(blocks))
        .collect();
    let (mut rest_points, mut rest_rows) = (&mut out.points[..], &mut out.rows[..]);
    for b in 0..blocks {
        let mut size = 0;
        for ((_, counts), part) in classified.iter().zip(&mut parts) {
            let (p, q) = rest_points.split_at_mut(counts[b]);
            let (r, s) = rest_rows.split_at_mut(counts[b]);
            part.push((p, r));
            (rest_points, rest_rows) = (q, s);
            size += counts[b];
        }
        out.starts.push(out.starts[b] + size);
    }
    let tasks = points.chunks(SHARE).zip(&classified).zip(parts).enumerate();
    parallel::map(
        workers,
        tasks.collect(),
        |(i, ((share, (block_of, _)), mut part))| {
            let mut filled = vec![0usize; blocks];
            let first_row = (i * SHARE) as u32;
            for ((&p, &b), row) in share.iter().zip(block_of).zip(first_row..) {
                let b = usize::from(b);
                let (points, rows) = &mut part[b];
                points[filled[b]] = p;
                rows[filled[b]] = row;
                filled[b] += 1;
            }
        },
    );
    Ok(out)
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
