//! Distributes points to blocks in parallel: a counting sort by block, one share of the points per
//! task.

use crate::error::Result;
use crate::memory::{Zero, zeroed};
use crate::parallel;
use crate::watch::Watch;

/// Points per task.
const SHARE: usize = 1 << 16;

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
pub fn deal<const D: usize>(
    points: &[[f64; D]],
    blocks: usize,
    block: impl Fn([f64; D]) -> usize + Sync,
    workers: usize,
    watch: &Watch,
) -> Result<Blocks<D>>
where
    [f64; D]: Zero,
{
    let shares: Vec<&[[f64; D]]> = points.chunks(SHARE).collect();
    let classified = parallel::map_watched(workers, shares, watch, |share| {
        let mut counts = vec![0usize; blocks];
        let mut block_of = Vec::with_capacity(share.len());
        for &p in share {
            let b = block(p);
            counts[b] += 1;
            block_of.push(b as u16);
        }
        Ok((block_of, counts))
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
    parallel::map_watched(
        workers,
        tasks.collect(),
        watch,
        |(i, ((share, (block_of, _)), mut part))| {
            let mut filled = vec![0usize; blocks];
            let first_row = (i * SHARE) as u32;
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
