//! The distinct points of a block in a canonical order along the Hilbert curve.
//!
//! Equal points are in the same cell, and all but the first row are removed as duplicates. The
//! order depends on the coordinates only, not on the order of the rows.

use delone_predicates::Point2;

use super::cells::{Cells, fine_bits, order_runs, row};
use super::radix;
use crate::base::error::Result;
use crate::base::memory::{clear_with_room, with_room};
use crate::base::points::Extent;
use crate::base::watch::Watch;

/// Buffers reused from block to block.
#[derive(Default)]
pub struct Scratch {
    items: Vec<u64>,
    other: Vec<u64>,
    points: Vec<Point2>,
    rows: Vec<u32>,
}

impl Scratch {
    /// Buffers for blocks of up to `points` points.
    pub fn with_room(points: usize) -> Result<Self> {
        Ok(Self {
            items: with_room(points)?,
            other: with_room(points)?,
            points: with_room(points)?,
            rows: with_room(points)?,
        })
    }
}

/// Sorts the `points` of a block and their `rows`, which are ascending: the distinct points come
/// first. Returns their number and `[row, first row of the same point]` for each further row.
pub fn along_curve(
    points: &mut [Point2],
    rows: &mut [u32],
    scratch: &mut Scratch,
    watch: &Watch,
) -> Result<(usize, Vec<[u32; 2]>)> {
    let cells = Cells::of(&Extent::of(points.iter().copied()));
    let low_bit = 32 - fine_bits(points.len());
    let mask = u64::MAX << (32 + low_bit);
    let Scratch {
        items,
        other,
        points: to,
        rows: to_rows,
    } = scratch;
    clear_with_room(items, points.len())?;
    clear_with_room(to, points.len())?;
    clear_with_room(to_rows, points.len())?;
    items.extend(
        (0u64..)
            .zip(&*points)
            .map(|(i, &p)| cells.key(p) & mask | i),
    );
    watch.check()?;
    radix::sort(items, other, low_bit, watch)?;
    order_runs(points, items, watch)?;
    watch.check()?;
    let duplicates = collect(points, rows, items, to, to_rows);
    points[..to.len()].copy_from_slice(to);
    rows[..to.len()].copy_from_slice(to_rows);
    Ok((to.len(), duplicates))
}

/// The keys of points sorted by `along_curve`, as a whole block or as a crowded cell of one: they
/// are ascending.
pub fn keys(points: &[Point2], block: bool) -> impl Iterator<Item = u32> {
    let cells = Cells::of(&Extent::of(points.iter().copied()));
    let low_bit = if block {
        32 - fine_bits(points.len())
    } else {
        0
    };
    points
        .iter()
        .map(move |&p| (cells.key(p) >> 32) as u32 >> low_bit << low_bit)
}

fn collect(
    points: &[Point2],
    rows: &[u32],
    items: &[u64],
    to: &mut Vec<Point2>,
    to_rows: &mut Vec<u32>,
) -> Vec<[u32; 2]> {
    let mut duplicates = Vec::new();
    let (mut last, mut first) = ([f64::NAN; 2], 0);
    for &item in items {
        // Adding zero turns -0.0 into 0.0, so that later comparisons of bits agree.
        let p = points[row(item)].map(|x| x + 0.0);
        if p == last {
            duplicates.push([rows[row(item)], first]);
        } else {
            (last, first) = (p, rows[row(item)]);
            to.push(p);
            to_rows.push(first);
        }
    }
    duplicates
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    fn ordered(points: &[Point2]) -> (Vec<Point2>, Vec<u32>, Vec<[u32; 2]>) {
        let mut to = points.to_vec();
        let mut rows: Vec<u32> = (0..points.len() as u32).collect();
        let (distinct, duplicates) =
            along_curve(&mut to, &mut rows, &mut Scratch::default(), &Watch::idle()).unwrap();
        to.truncate(distinct);
        rows.truncate(distinct);
        (to, rows, duplicates)
    }

    #[test]
    fn duplicates_name_their_first_row() {
        let points = [[1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [-0.0, 0.0], [1.0, -0.0]];
        let (_, mut rows, mut duplicates) = ordered(&points);
        duplicates.sort_unstable();
        assert_eq!(duplicates, [[2, 0], [3, 1], [4, 0]]);
        rows.sort_unstable();
        assert_eq!(rows, [0, 1]);
    }

    #[test]
    fn order_depends_on_coordinates_alone() {
        let mut next = uniform(7);
        // Clusters at ten scales: deep cells are keyed again.
        let points: Vec<Point2> = (0..3000)
            .map(|i| {
                let s = 1e-3f64.powi(i % 10);
                [s * next(), s * next()]
            })
            .collect();
        let reversed: Vec<Point2> = points.iter().rev().copied().collect();
        assert_eq!(ordered(&points).0, ordered(&reversed).0);
    }

    #[test]
    fn extreme_ranges_are_ordered() {
        for s in [1e-320, 1e-300, 1.0, 1e300, f64::MAX] {
            let points = [
                [-s, -s],
                [s, s],
                [0.0, 0.0],
                [s, -s],
                [-s, s],
                [s / 2.0, s / 2.0],
            ];
            assert_eq!(ordered(&points).0.len(), 6, "{s}");
        }
    }
}
