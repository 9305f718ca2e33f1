//! Cells with sides between corners, and the sides by their boxes: in a tree if there are many, so
//! that a query about one position of a polygon with thousands of corners looks only at the sides
//! there.

use std::sync::OnceLock;

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::boxes::Boxes;

use super::signs::Moved;

/// Cells with more corners have a tree.
pub const MANY: usize = 64;
/// Pairs of sides between two checks for interruption.
const PACE: usize = 1 << 16;
/// Pairs for each side that a sweep may find: a search in a tree takes as long as some of them.
const SWEPT: usize = 64;

/// A cell with sides between corners.
pub trait Outline<const D: usize>: Sized {
    /// The number of corners, and of sides.
    fn count(&self) -> usize;
    /// The corner at which the side that starts at a corner ends.
    fn next(&self, k: u32) -> u32;
    /// Where rings after the first one start.
    fn later_rings(&self) -> &[u32];
    /// Whether the cell is known to be convex.
    fn convex(&self) -> bool;
    /// A box that holds the cell.
    fn extent(&self) -> Extent<D>;
    /// A box that holds a side.
    fn reach(&self, k: u32) -> Extent<D>;
    /// Where a tree of these boxes is kept, once it has been asked for.
    fn kept(&self) -> &OnceLock<Boxes<D>>;
    /// Where a corner of another cell is: 1 to the left of a side, -1 to its right.
    fn sign(&self, k: u32, other: &Self, corner: u32, moved: Moved) -> i8;
    /// The corners of another cell, of up to 32, that are to the left of a side, as bits.
    fn left(&self, k: u32, other: &Self, moved: Moved) -> u32 {
        (0..other.count() as u32).fold(0, |bits, l| {
            bits | u32::from(self.sign(k, other, l, moved) > 0) << l
        })
    }
    /// Whether a corner of another cell is in this one; of the two, `moved` has moved.
    fn holds(
        &self,
        other: &Self,
        corner: u32,
        moved: Moved,
        found: &mut Vec<u32>,
        pace: &mut Pace,
    ) -> Result<bool>;
}

/// Appends the sides whose boxes meet an extent, ascending.
pub fn meeting<C: Outline<D>, const D: usize>(
    cell: &C,
    extent: &Extent<D>,
    found: &mut Vec<u32>,
    watch: &Watch,
) -> Result<()> {
    let meets = |k: u32| {
        let own = cell.reach(k);
        (0..D).all(|i| own.min[i] <= extent.max[i] && extent.min[i] <= own.max[i])
    };
    if cell.count() <= MANY {
        found.extend((0..cell.count() as u32).filter(|&k| meets(k)));
        return Ok(());
    }
    let from = found.len();
    tree(cell, watch)?.meeting(extent, |k| {
        if meets(k as u32) {
            found.push(k as u32);
        }
    });
    found[from..].sort_unstable();
    Ok(())
}

fn tree<'a, C: Outline<D>, const D: usize>(cell: &'a C, watch: &Watch) -> Result<&'a Boxes<D>> {
    let kept = cell.kept();
    if let Some(tree) = kept.get() {
        return Ok(tree);
    }
    let tree = Boxes::over(cell.count(), |k| cell.reach(k as u32), watch)?;
    Ok(kept.get_or_init(|| tree))
}

/// Whether `bad` is true of a pair of sides whose boxes meet; it may be asked for a pair twice.
///
/// A sweep along the longest side of the cell's box finds the pairs, unless many meet in that
/// coordinate alone.
pub fn any_pair<C: Outline<D>, const D: usize>(
    cell: &C,
    mut bad: impl FnMut(u32, u32) -> Result<bool>,
    watch: &Watch,
) -> Result<bool> {
    let count = cell.count();
    let mut pace = Pace::new(watch, PACE);
    let Extent { min, max } = cell.extent();
    let length = |k: usize| max[k] / 2.0 - min[k] / 2.0;
    let axis = (1..D).fold(0, |top, k| if length(k) > length(top) { k } else { top });
    let mut spans: Vec<(f64, f64, u32)> = with_room(count)?;
    for k in 0..count as u32 {
        let own = cell.reach(k);
        spans.push((own.min[axis], own.max[axis], k));
    }
    spans.sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
    let mut left = SWEPT.saturating_mul(count);
    for (at, &(_, end, e)) in spans.iter().enumerate() {
        let later = &spans[at + 1..];
        let met = later.partition_point(|x| x.0 <= end);
        if met > left {
            return any_pair_by_boxes(cell, bad, pace);
        }
        left -= met;
        pace.spend(met + 1)?;
        for &(_, _, f) in &later[..met] {
            if bad(e, f)? {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

/// The same by a tree.
fn any_pair_by_boxes<C: Outline<D>, const D: usize>(
    cell: &C,
    mut bad: impl FnMut(u32, u32) -> Result<bool>,
    mut pace: Pace,
) -> Result<bool> {
    let mut found = Vec::new();
    for e in 0..cell.count() as u32 {
        found.clear();
        meeting(cell, &cell.reach(e), &mut found, pace.watch())?;
        pace.spend(found.len() + 1)?;
        for &f in found.iter().filter(|&&f| f > e) {
            if bad(e, f)? {
                return Ok(true);
            }
        }
    }
    Ok(false)
}
