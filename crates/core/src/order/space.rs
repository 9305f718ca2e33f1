//! The distinct 3-D points in Hilbert order, as in 2-D (see `curve`).
//!
//! One key per point, a radix sort; equal points end up in the same cell.

use delone_predicates::Point3;

use super::cells::{Cells, fine_bits, order_runs, row};
use super::radix;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::points::Extent;
use crate::base::watch::Watch;

/// The bounding box of a finite 3-D point set.
pub type Extent3 = Extent<3>;

/// Distinct 3-D points, numbered as vertices along the curve.
#[derive(Debug)]
pub struct Arranged3 {
    /// The points, with `-0.0` replaced by `0.0`, and capacity for one more.
    pub points: Vec<Point3>,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// `[row, first row of the same point]` for each further row, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// Buffers for arranging points. To be allocated by the thread that starts the others: the
/// allocator may return what they allocate themselves to the system each time, and new pages cost
/// more than the sort.
#[derive(Debug)]
pub struct Room3 {
    items: Vec<u64>,
    other: Vec<u64>,
    out: Arranged3,
}

impl Room3 {
    /// Buffers for `n` points.
    pub fn of(n: usize) -> Result<Self> {
        let out = Arranged3 {
            points: with_room(n + 1)?,
            rows: with_room(n)?,
            duplicates: Vec::new(),
        };
        Ok(Self {
            items: with_room(n)?,
            other: with_room(n)?,
            out,
        })
    }
}

/// Arranges finite `points`; the order depends on the coordinates only.
pub fn arrange(points: &[Point3], watch: &Watch) -> Result<Arranged3> {
    arrange_rows(points, None, Room3::of(points.len())?, watch)
}

/// The same in `room`, where `points` are only some of the rows; these are given and ascending.
pub fn arrange_rows(
    points: &[Point3],
    rows: Option<&[u32]>,
    room: Room3,
    watch: &Watch,
) -> Result<Arranged3> {
    let cells = Cells::of(&Extent3::of(points.iter().copied()));
    let low_bit = 32 - fine_bits(points.len());
    let mask = u64::MAX << (32 + low_bit);
    let Room3 {
        mut items,
        mut other,
        out,
    } = room;
    items.extend((0u64..).zip(points).map(|(i, &p)| cells.key(p) & mask | i));
    watch.check()?;
    radix::sort(&mut items, &mut other, low_bit, watch)?;
    order_runs(points, &mut items, watch)?;
    watch.check()?;
    collect(points, rows, &items, out)
}

fn collect(
    points: &[Point3],
    rows: Option<&[u32]>,
    items: &[u64],
    mut out: Arranged3,
) -> Result<Arranged3> {
    let (mut last, mut first) = ([f64::NAN; 3], 0);
    for &item in items {
        // Adding zero turns -0.0 into 0.0, so that later comparisons of bits agree.
        let [x, y, z] = points[row(item)];
        let p = [x + 0.0, y + 0.0, z + 0.0];
        let own = rows.map_or(row(item) as u32, |rows| rows[row(item)]);
        if p == last {
            push(&mut out.duplicates, [own, first])?;
        } else {
            (last, first) = (p, own);
            out.points.push(p);
            out.rows.push(first);
        }
    }
    out.duplicates.sort_unstable();
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    fn arranged(points: &[Point3]) -> Arranged3 {
        arrange(points, &Watch::idle()).unwrap()
    }

    #[test]
    fn duplicates_name_their_first_row() {
        let points = [
            [1.0, 0.0, 2.0],
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 2.0],
            [-0.0, 0.0, -0.0],
            [1.0, -0.0, 2.0],
        ];
        let made = arranged(&points);
        assert_eq!(made.duplicates, [[2, 0], [3, 1], [4, 0]]);
        let mut rows = made.rows;
        rows.sort_unstable();
        assert_eq!(rows, [0, 1]);
    }

    #[test]
    fn order_depends_on_coordinates_alone() {
        let mut next = uniform(7);
        // Clusters at ten scales: deep cells are keyed again.
        let points: Vec<Point3> = (0..3000)
            .map(|i| [0; 3].map(|_| 1e-3f64.powi(i % 10) * next()))
            .collect();
        let reversed: Vec<Point3> = points.iter().rev().copied().collect();
        assert_eq!(arranged(&points).points, arranged(&reversed).points);
        assert_eq!(arranged(&points).points.len(), 3000);
    }

    #[test]
    fn extreme_ranges_are_ordered() {
        for s in [5e-324, 1e-320, 1e-300, 1.0, 1e300, f64::MAX] {
            let mut points: Vec<Point3> = Vec::new();
            for i in 0..64 {
                points.push([i >> 4, i >> 2, i].map(|k| [-s, s, 0.0, s][k & 3]));
            }
            assert_eq!(arranged(&points).points.len(), 27, "{s}");
        }
    }
}
