//! The distinct points of an input in insertion order: in blocks, each sorted along the curve.

use std::sync::Mutex;

use delone_predicates::Point2;

use super::blocks::{Cuts, split};
use super::curve::{Scratch, along_curve};
use super::distribute::Blocks;
use crate::base::error::Result;
use crate::base::parallel;
use crate::base::watch::Watch;

/// Distinct points, numbered as vertices.
#[derive(Debug)]
pub struct Arranged {
    /// The points, with `-0.0` replaced by `0.0`, and capacity for one more.
    pub points: Vec<Point2>,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// `[row, first row of the same point]` for each further row, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// Where each block begins, plus the end.
    pub starts: Vec<usize>,
    /// The cuts between the blocks.
    pub cuts: Cuts,
}

/// Arranges finite `points`; the same for any number of workers.
pub fn arrange(points: &[Point2], workers: usize, watch: &Watch) -> Result<Arranged> {
    let cuts = Cuts::of(points);
    let Blocks {
        mut points,
        mut rows,
        starts,
    } = split(points, &cuts, workers, watch)?;
    let (mut rest_points, mut rest_rows) = (&mut points[..], &mut rows[..]);
    let mut tasks = Vec::with_capacity(cuts.blocks());
    for w in starts.windows(2) {
        let (p, q) = rest_points.split_at_mut(w[1] - w[0]);
        let (r, s) = rest_rows.split_at_mut(w[1] - w[0]);
        tasks.push((p, r));
        (rest_points, rest_rows) = (q, s);
    }
    // At most one block per worker is in progress, and its buffers are reused.
    let largest = tasks.iter().map(|(points, _)| points.len()).max();
    let rooms = Mutex::new(Vec::new());
    let ordered = parallel::map_watched(workers, tasks, watch, |(points, rows)| {
        let room = rooms.lock().ok().and_then(|mut rooms| rooms.pop());
        let mut room = match room {
            Some(room) => room,
            None => Scratch::with_room(largest.unwrap_or(0))?,
        };
        let ordered = along_curve(points, rows, &mut room, watch);
        if let Ok(mut rooms) = rooms.lock() {
            rooms.push(room);
        }
        ordered
    })?;
    let mut out = Arranged {
        points,
        rows,
        duplicates: Vec::new(),
        starts: vec![0],
        cuts,
    };
    let mut distinct = Vec::with_capacity(ordered.len());
    for (count, duplicates) in ordered {
        distinct.push(count);
        out.duplicates.extend(duplicates);
    }
    close_up(&mut out, &starts, &distinct);
    out.duplicates.sort_unstable();
    Ok(out)
}

/// Moves the blocks together over the gaps left by duplicates.
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
