//! Hilbert keys of points by cells of a box, and the order of points that share a cell.
//!
//! Cells are those of the bounding box of the points. Cells that hold many points get keys again,
//! in the box of their own points, so that clusters of any depth are in curve order, too; a few
//! points in one cell are sorted lexicographically.

use delone_predicates::lexicographic;

use super::{hilbert, hilbert_n, hilbert3};
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};

/// The longest run of equal keys that is sorted lexicographically instead of keyed again.
pub const CROWD: usize = 16;

/// Items of runs between two checks for interruption.
const LOT: usize = 1 << 16;

/// Cells of a box: in 2-D 65536 along the longer side, in 3-D 1024 along the longest, in more
/// dimensions as many as keys of 32 bits have.
pub struct Cells<const D: usize> {
    min: [f64; D],
    before: f64,
    scale: f64,
}

impl<const D: usize> Cells<D> {
    const BITS: u32 = match D {
        2 => hilbert::BITS,
        3 => hilbert3::BITS,
        _ => 32 / D as u32,
    };

    /// The cells of a bounding box.
    pub fn of(extent: &Extent<D>) -> Self {
        let side = extent.side();
        // A power of two keeps the differences and the scale in the range of doubles. Only the
        // order of the points depends on the rounding here, never a simplex.
        let before = if side > 1e300 {
            2f64.powi(-30)
        } else if side < 1e-280 {
            2f64.powi(200)
        } else {
            1.0
        };
        let min = extent.min.map(|x| x * before);
        let far = (0..D).map(|k| extent.max[k] * before - min[k]);
        Self {
            min,
            before,
            scale: f64::from(1u32 << Self::BITS) / far.fold(0.0, f64::max),
        }
    }

    /// The key of the cell of `p`, in the upper half.
    #[inline]
    pub fn key(&self, p: [f64; D]) -> u64 {
        // Conversions saturate and turn NaN into zero: the far corner is in the last cell.
        let cell = |k: usize| {
            (((p[k] * self.before - self.min[k]) * self.scale) as u32).min((1 << Self::BITS) - 1)
        };
        match D {
            2 => u64::from(hilbert::key(cell(0) as u16, cell(1) as u16)) << 32,
            3 => {
                let key = hilbert3::key([cell(0), cell(1), cell(2)]);
                u64::from(key) << (64 - 3 * hilbert3::BITS)
            }
            _ => {
                let key = hilbert_n::key::<D>(std::array::from_fn(cell), Self::BITS);
                key << (64 - D as u32 * Self::BITS)
            }
        }
    }
}

/// Bits of a key that are worth sorting by: keys finer than about 16 cells per point cost passes
/// and gain nothing, as runs are few.
pub fn fine_bits(points: usize) -> u32 {
    (usize::BITS - points.leading_zeros() + 4)
        .next_multiple_of(8)
        .min(32)
}

/// The row of an item, which is its lower half.
pub fn row(item: u64) -> usize {
    (item & u64::from(u32::MAX)) as usize
}

/// Sorts the items of each run of equal keys. A run that is keyed again splits, since the two ends
/// of its box get different keys; so the stack of runs becomes empty.
pub fn order_runs<const D: usize>(
    points: &[[f64; D]],
    items: &mut [u64],
    watch: &Watch,
) -> Result<()> {
    let mut pace = Pace::new(watch, LOT);
    let mut runs = Vec::new();
    push_runs(items, 0, &mut runs);
    while let Some((start, end)) = runs.pop() {
        pace.spend(end - start)?;
        let run = &mut items[start..end];
        if run.len() <= CROWD {
            run.sort_unstable_by(|&i, &j| {
                lexicographic(points[row(i)], points[row(j)]).then(row(i).cmp(&row(j)))
            });
            continue;
        }
        let extent = Extent::of(run.iter().map(|&i| points[row(i)]));
        if extent.min == extent.max {
            continue; // All points are equal; the stable sort left their rows ascending.
        }
        let cells = Cells::of(&extent);
        for item in run.iter_mut() {
            *item = cells.key(points[row(*item)]) | row(*item) as u64;
        }
        run.sort_unstable();
        push_runs(run, start, &mut runs);
    }
    Ok(())
}

/// Lists the runs of at least two equal keys in `items`, whose first is item `offset` overall.
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
