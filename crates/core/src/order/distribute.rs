//! Distributes points to blocks in parallel: a counting sort by block, one share of the points per
//! task.

use crate::base::error::Result;
use crate::base::memory::{Zero, filled, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// The fewest points per task.
const SHARE: usize = 1 << 12;

/// The most tasks: each has counts for all blocks.
const TASKS: usize = 1 << 8;

/// Points between two checks for interruption: each may be the first to touch a huge page, which
/// takes a millisecond.
const LOT: usize = 1 << 6;

/// Points sorted by block, and by row within each block.
#[derive(Debug)]
pub struct Blocks<const D: usize> {
    /// The points, block by block.
    pub points: Vec<[f64; D]>,
    /// Their rows.
    pub rows: Vec<u32>,
    /// Where each block begins, plus the end.
    pub starts: Vec<usize>,
}

impl<const D: usize> Blocks<D> {
    /// The points of each block with their rows, which are ascending.
    pub fn each(&self) -> impl Iterator<Item = (&[[f64; D]], &[u32])> {
        let range = |w: &[usize]| (&self.points[w[0]..w[1]], &self.rows[w[0]..w[1]]);
        self.starts.windows(2).map(range)
    }
}

/// Distributes `points` to `blocks` blocks, where `block` returns the block of a point; leaves
/// capacity for one more.
pub fn distribute<const D: usize>(
    points: &[[f64; D]],
    blocks: usize,
    block: impl Fn([f64; D]) -> usize + Sync,
    workers: usize,
    watch: &Watch,
) -> Result<Blocks<D>>
where
    [f64; D]: Zero,
{
    let share = points.len().div_ceil(TASKS).max(SHARE);
    let mut block_of = zeroed::<u16>(points.len())?;
    let tasks = points.chunks(share).zip(block_of.chunks_mut(share));
    let classified =
        parallel::map_watched(workers, tasks.collect(), watch, |(share, block_of)| {
            let mut counts = filled(blocks, 0usize)?;
            for (&p, b) in share.iter().zip(block_of) {
                let i = block(p);
                counts[i] += 1;
                *b = i as u16;
            }
            Ok(counts)
        })?;
    let mut out = Blocks {
        points: zeroed(points.len() + 1)?,
        rows: zeroed(points.len())?,
        starts: vec![0],
    };
    out.points.pop(); // Capacity for one more.
    // Each task writes its part of each block: split the outputs into these, block by block.
    let mut parts: Vec<Vec<_>> = classified
        .iter()
        .map(|_| Vec::with_capacity(blocks))
        .collect();
    let (mut rest_points, mut rest_rows) = (&mut out.points[..], &mut out.rows[..]);
    for b in 0..blocks {
        let mut size = 0;
        for (counts, part) in classified.iter().zip(&mut parts) {
            let (p, q) = rest_points.split_at_mut(counts[b]);
            let (r, s) = rest_rows.split_at_mut(counts[b]);
            part.push((p, r));
            (rest_points, rest_rows) = (q, s);
            size += counts[b];
        }
        out.starts.push(out.starts[b] + size);
    }
    let shares = points.chunks(share).zip(block_of.chunks(share));
    let tasks = (0u32..).step_by(share).zip(shares).zip(parts);
    parallel::map_watched(
        workers,
        tasks.collect(),
        watch,
        |((first_row, (share, block_of)), mut part)| {
            let mut filled = filled(blocks, 0usize)?;
            let lots = share.chunks(LOT).zip(block_of.chunks(LOT));
            for ((share, block_of), first_row) in lots.zip((first_row..).step_by(LOT)) {
                watch.check()?;
                for ((&p, &b), row) in share.iter().zip(block_of).zip(first_row..) {
                    let b = usize::from(b);
                    let (points, rows) = &mut part[b];
                    points[filled[b]] = p;
                    rows[filled[b]] = row;
                    filled[b] += 1;
                }
            }
            Ok(())
        },
    )?;
    Ok(out)
}
