//! The distinct points of a block in one canonical order along the Hilbert curve.
//!
//! Cells come from the box of the points. Cells that hold many points are keyed again in the box of
//! their own points, so that clusters of any depth are in curve order, too; few points in one cell
//! go lexicographically. Equal points meet in one cell, and all but the first row drop out as
//! duplicates. The order depends on the coordinates alone, not on the order of the rows.

use delone_predicates::{Point2, lexicographic};

use super::{hilbert, radix};
use crate::error::Result;
use crate::memory::{clear_with_room, with_room};
use crate::parallel;
use crate::points::Extent;
use crate::watch::Watch;

/// Longest run of equal keys that is sorted lexicographically and not keyed again.
const CROWD: usize = 16;

/// Fewest points that a thread is worth in [`order_of`].
const SHARE: usize = 1 << 14;

/// Cells of a box: 65536 to the longer side.
struct Cells {
    min: Point2,
    before: f64,
    scale: f64,
}

impl Cells {
    fn of(extent: &Extent) -> Self {
        let side = extent.side();
        // A power of two keeps the differences and the scale inside the range of doubles. Only
        // the order of the points hangs on the rounding here, never a triangle.
        let before = if side > 1e300 {
            2f64.powi(-30)
        } else if side < 1e-280 {
            2f64.powi(200)
        } else {
            1.0
        };
        let [x, y] = extent.min;
        let cells = f64::from(1u32 << hilbert::BITS);
        let far = [
            extent.max[0] * before - x * before,
            extent.max[1] * before - y * before,
        ];
        Self {
            min: [x * before, y * before],
            before,
            scale: cells / far[0].max(far[1]),
        }
    }

    /// The key of the cell of `p`; conversions saturate, so the far corner is in the last cell.
    #[inline]
    fn key(&self, p: Point2) -> u64 {
        let cell = |k: usize| ((p[k] * self.before - self.min[k]) * self.scale) as u16;
        u64::from(hilbert::key(cell(0), cell(1)))
    }
}

/// Room that one block after the other uses.
#[derive(Default)]
pub struct Scratch {
    items: Vec<u64>,
    other: Vec<u64>,
    points: Vec<Point2>,
    rows: Vec<u32>,
}

/// Orders the `points` of a block and their `rows`, which ascend: distinct points first, whose
/// number is returned with `[row, first row of the same point]` for each further row.
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
            .map(|(i, &p)| cells.key(p) << 32 & mask | i),
    );
    watch.check()?;
    radix::sort(items, other, low_bit)?;
    watch.check()?;
    order_runs(points, items);
    watch.check()?;
    let duplicates = collect(points, rows, items, to, to_rows);
    points[..to.len()].copy_from_slice(to);
    rows[..to.len()].copy_from_slice(to_rows);
    Ok((to.len(), duplicates))
}

/// The rows of the finite points along the curve, in parts of which each follows the one before;
/// for points of which nothing is built. Whoever comes first among points of one cell is open.
pub fn order_of(points: &[Point2], workers: usize) -> Result<Vec<Vec<u32>>> {
    let share = points.len().div_ceil(workers.max(1)).max(SHARE);
    let shares = || points.chunks(share).collect::<Vec<_>>();
    let extents = parallel::map(workers, shares(), |share| {
        Extent::of(share.iter().copied().filter(is_finite))
    });
    let extent = Extent::of(
        extents
            .iter()
            .flat_map(|e| [e.min, e.max])
            .filter(is_finite),
    );
    let cells = Cells::of(&extent);
    let low_bit = 32 - fine_bits(points.len());
    let mask = u64::MAX << (32 + low_bit);
    let tasks = (0u64..).step_by(share).zip(shares()).collect();
    let sorted = parallel::map(workers, tasks, |(first, share)| {
        let mut items = with_room(share.len())?;
        let rows = (first..).zip(share).filter(|(_, p)| is_finite(p));
        items.extend(rows.map(|(i, &p)| cells.key(p) << 32 & mask | i));
        radix::sort(&mut items, &mut Vec::new(), low_bit)?;
        Ok(items)
    });
    let sorted = sorted.into_iter().collect::<Result<Vec<Vec<u64>>>>()?;
    let tasks = if sorted.len() > 1 {
        4 * workers as u64
    } else {
        1
    };
    let cut = |part: u64| ((u128::from(part) << 64) / u128::from(tasks)) as u64;
    let parts = parallel::map(workers, (0..tasks).collect(), |part| {
        let within = |items: &[u64]| {
            let place = |cut| items.partition_point(|&item| item < cut);
            let end = if part + 1 < tasks {
                place(cut(part + 1))
            } else {
                items.len()
            };
            place(cut(part))..end
        };
        let mut items = with_room(sorted.iter().map(|s| within(s).len()).sum())?;
        for share in &sorted {
            items.extend_from_slice(&share[within(share)]);
        }
        if sorted.len() > 1 {
            // Its few runs ascend, and it merges them.
            items.sort();
        }
        order_crowds(points, &mut items);
        let mut rows = with_room(items.len())?;
        rows.extend(items.into_iter().map(|item| row(item) as u32));
        Ok(rows)
    });
    parts.into_iter().collect()
}

fn is_finite(p: &Point2) -> bool {
    p[0].is_finite() && p[1].is_finite()
}

/// Bits of a key that are worth sorting by: keys finer than about 16 cells a point cost passes and
/// gain nothing, as runs are few.
fn fine_bits(points: usize) -> u32 {
    (usize::BITS - points.leading_zeros() + 4)
        .next_multiple_of(8)
        .min(32)
}

/// Orders the items of each cell that holds many points.
fn order_crowds(points: &[Point2], items: &mut [u64]) {
    for run in items.chunk_by_mut(|i, j| i >> 32 == j >> 32) {
        if run.len() > CROWD {
            order_runs(points, run);
        }
    }
}

fn row(item: u64) -> usize {
    (item & u64::from(u32::MAX)) as usize
}

/// Puts the items of each run of equal keys in order. A run that is keyed again splits, since the
/// two ends of its box get different keys; so the stack of runs empties.
fn order_runs(points: &[Point2], items: &mut [u64]) {
    let mut runs = Vec::new();
    push_runs(items, 0, &mut runs);
    while let Some((start, end)) = runs.pop() {
        let run = &mut items[start..end];
        if run.len() <= CROWD {
            run.sort_unstable_by(|&i, &j| {
                lexicographic(points[row(i)], points[row(j)]).then(row(i).cmp(&row(j)))
            });
            continue;
        }
        let extent = Extent::of(run.iter().map(|&i| points[row(i)]));
        if extent.min == extent.max {
            continue; // One point many times; the stable sort has left its rows ascending.
        }
        let cells = Cells::of(&extent);
        for item in run.iter_mut() {
            *item = cells.key(points[row(*item)]) << 32 | row(*item) as u64;
        }
        run.sort_unstable();
        push_runs(run, start, &mut runs);
    }
}

/// Lists the runs of two and more equal keys of `items`, whose first is item `offset` of all.
fn push_runs(items: &[u64], offset: usize, runs: &mut Vec<(usize, usize)>) {
    let mut start = 0;
    for i in 1..=items.len() {
        if i == items.len() || items[i] >> 32 != items[start] >> 32 {
            if i - start > 1 {
                runs.push((offset + start, offset + i));
            }
            start = i;
        }
    }
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
        // Adding zero makes -0.0 the same number as 0.0 in every later comparison of bits.
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
        let mut x = 7u64;
        let mut next = || {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (x >> 11) as f64 / (1u64 << 53) as f64
        };
        // Clusters of ten scales: deep cells are keyed again.
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
