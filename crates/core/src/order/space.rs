//! The distinct points of space in Hilbert order. As in the plane (see `curve`): a key a point, a
//! radix sort, crowded cells keyed again in the box of their own points, equal points found where
//! they meet.

use delone_predicates::{Point3, lexicographic};

use super::{hilbert3, radix};
use crate::error::Result;
use crate::memory::{push, with_room};
use crate::watch::Watch;

/// Longest run of equal keys that is sorted lexicographically and not keyed again.
const CROWD: usize = 16;

/// Bits of a key.
const KEY_BITS: u32 = 3 * hilbert3::BITS;

/// The box of a finite point set in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent3 {
    /// Smallest coordinate of each axis.
    pub min: Point3,
    /// Largest coordinate of each axis.
    pub max: Point3,
}

impl Extent3 {
    /// The box of all points.
    pub const EVERYWHERE: Self = Self {
        min: [f64::NEG_INFINITY; 3],
        max: [f64::INFINITY; 3],
    };

    /// The box of some points, which must be finite; inside out where there are none.
    pub fn of(points: impl IntoIterator<Item = Point3>) -> Self {
        let mut e = Self {
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        };
        for p in points {
            for (k, x) in p.into_iter().enumerate() {
                // Selections, which are one instruction where `f64::min` has to mind NaN.
                e.min[k] = if x < e.min[k] { x } else { e.min[k] };
                e.max[k] = if x > e.max[k] { x } else { e.max[k] };
            }
        }
        e
    }
}

/// Cells of a box: 1024 to the longest side.
struct Cells {
    min: Point3,
    before: f64,
    scale: f64,
}

impl Cells {
    fn of(extent: &Extent3) -> Self {
        let side = (0..3).fold(0.0, |side: f64, k| side.max(extent.max[k] - extent.min[k]));
        // As in the plane: a power of two keeps what follows inside the range of doubles.
        let before = if side > 1e300 {
            2f64.powi(-30)
        } else if side < 1e-280 {
            2f64.powi(200)
        } else {
            1.0
        };
        let min = extent.min.map(|x| x * before);
        let far = (0..3).map(|k| extent.max[k] * before - min[k]);
        let cells = f64::from(1u32 << hilbert3::BITS);
        Self {
            min,
            before,
            scale: cells / far.fold(0.0, f64::max),
        }
    }

    /// The key of the cell of `p`, in the upper bits.
    #[inline]
    fn key(&self, p: Point3) -> u64 {
        const LAST: u32 = (1 << hilbert3::BITS) - 1;
        let cell = |k: usize| {
            // Conversions saturate and make NaN zero: the far corner is in the last cell.
            (((p[k] * self.before - self.min[k]) * self.scale) as u32).min(LAST)
        };
        u64::from(hilbert3::key([cell(0), cell(1), cell(2)])) << (64 - KEY_BITS)
    }
}

/// Distinct points of space, numbered as vertices along the curve.
#[derive(Debug)]
pub struct Arranged3 {
    /// The points, `-0.0` made `0.0`, with room for one more.
    pub points: Vec<Point3>,
    /// For each, its first row in the input.
    pub rows: Vec<u32>,
    /// `[row, first row of the same point]` for each further row, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// Room for the arrangement of some points. To be made by the thread that starts others: what they ask for
/// themselves the allocator may give back to the system each time, and fresh pages cost more than the sort.
#[derive(Debug)]
pub struct Room3 {
    items: Vec<u64>,
    other: Vec<u64>,
    out: Arranged3,
}

impl Room3 {
    /// Room for `n` points.
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

/// Arranges finite `points`; the order hangs on the coordinates alone.
pub fn arrange(points: &[Point3], watch: &Watch) -> Result<Arranged3> {
    arrange_rows(points, None, Room3::of(points.len())?, watch)
}

/// The same in `room` where `points` are but some of the rows, which are given and ascend.
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
    radix::sort(&mut items, &mut other, low_bit)?;
    watch.check()?;
    order_runs(points, &mut items);
    watch.check()?;
    collect(points, rows, &items, out)
}

/// Bits of a key that are worth sorting by, in whole digits of the sort.
fn fine_bits(points: usize) -> u32 {
    (usize::BITS - points.leading_zeros() + 4)
        .next_multiple_of(8)
        .min(32)
}

fn row(item: u64) -> usize {
    (item & u64::from(u32::MAX)) as usize
}

/// Puts the items of each run of equal keys in order. A run that is keyed again splits, since two
/// ends of its box get different keys; so the stack of runs empties.
fn order_runs(points: &[Point3], items: &mut [u64]) {
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
        let extent = Extent3::of(run.iter().map(|&i| points[row(i)]));
        if extent.min == extent.max {
            continue; // One point many times; the stable sort has left its rows ascending.
        }
        let cells = Cells::of(&extent);
        for item in run.iter_mut() {
            *item = cells.key(points[row(*item)]) & (u64::MAX << 32) | row(*item) as u64;
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
    points: &[Point3],
    rows: Option<&[u32]>,
    items: &[u64],
    mut out: Arranged3,
) -> Result<Arranged3> {
    let (mut last, mut first) = ([f64::NAN; 3], 0);
    for &item in items {
        // Adding zero makes -0.0 the same number as 0.0 in every later comparison of bits.
        let p = points[row(item)].map(|x| x + 0.0);
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
        let mut x = 7u64;
        let mut next = || {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (x >> 11) as f64 / (1u64 << 53) as f64
        };
        // Clusters of ten scales: deep cells are keyed again.
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
