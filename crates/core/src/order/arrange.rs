//! The distinct points of an input as the methods want them: in blocks, each along the curve.

use delone_predicates::Point2;

use super::blocks::{Blocks, Cuts, split};
use super::curve::along_curve;
use crate::error::Result;
use crate::memory::zeroed;
use crate::parallel;
use crate::watch::Watch;

/// Distinct points, numbered as vertices.
#[derive(Debug)]
pub struct Arranged {
    /// The points, `-0.0` made `0.0`, with room for one more.
    pub points: Vec<Point2>,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// `[row, first row of the same point]` for each further row, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// Where each block begins, and the end.
    pub starts: Vec<usize>,
    /// The cuts between the blocks.
    pub cuts: Cuts,
}

/// Arranges finite `points`; the same for any number of workers.
pub fn arrange(points: &[Point2], workers: usize, watch: &Watch) -> Result<Arranged> {
    let cuts = Cuts::of(points);
    // One block keeps its rows and needs no copy.
    let split = if cuts.blocks() > 1 {
        Some(split(points, &cuts, workers)?)
    } else {
        None
    };
    watch.check()?;
    let whole = [0, points.len()];
    let (from, rows, starts) = match &split {
        Some(Blocks {
            points,
            rows,
            starts,
        }) => (&points[..], Some(&rows[..]), &starts[..]),
        None => (points, None, &whole[..]),
    };
    let mut out = Arranged {
        points: zeroed(points.len() + 1)?,
        rows: zeroed(points.len())?,
        duplicates: Vec::new(),
        starts: vec![0],
        cuts,
    };
    let (mut rest_points, mut rest_rows) = (&mut out.points[..], &mut out.rows[..]);
    let mut tasks = Vec::with_capacity(starts.len());
    for range in starts.windows(2).map(|w| w[0]..w[1]) {
        let (p, q) = rest_points.split_at_mut(range.len());
        let (r, s) = rest_rows.split_at_mut(range.len());
        tasks.push((range, (p, r)));
        (rest_points, rest_rows) = (q, s);
    }
    let ordered = parallel::map(workers, tasks, |(range, out)| {
        along_curve(
            &from[range.clone()],
            rows.map(|rows| &rows[range]),
            out,
            watch,
        )
    });
    let mut distinct = Vec::with_capacity(ordered.len());
    for block in ordered {
        let (count, duplicates) = block?;
        distinct.push(count);
        out.duplicates.extend(duplicates);
    }
    close_up(&mut out, starts, &distinct);
    out.duplicates.sort_unstable();
    Ok(out)
}

/// Moves the blocks together over the gaps that duplicates have left.
fn close_up(out: &mut Arranged, starts: &[usize], distinct: &[usize]) {
    let mut end = 0;
    for (&start, &count) in starts.iter().zip(distinct) {
        if start != end {
            out.points.copy_within(start..start + count, end);
            out.rows.copy_within(start..start + count, end);
        }
        end += count;
        out.starts.push(end);
    }
    out.points.truncate(end);
    out.rows.truncate(end);
}
