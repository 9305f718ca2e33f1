//! The area that two convex cells with few corners share, on the sphere and in the plane: the usual
//! case, without lists.
//!
//! Each sign is computed once and stored as a bit: whether a corner of one cell is to the left of a
//! side of the other. The bits tell which corners are inside the other cell and which sides cross, as
//! in `outline`.
//! A side of a convex cell has at most one piece in another one: from its start, or where it enters, to
//! its end, or where it leaves. These pieces are the sides of the shared area, so that the sum has one
//! term for each; a sum over corners and crossings has two terms for each crossing.

use crate::base::error::{Error, Result};

use super::sides::Outline;
use super::signs::Moved;

/// The maximum number of corners of a cell. With more, sides near the other cell are found first.
const MOST: usize = 16;

/// What two cells share.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Met {
    /// Nothing.
    Nothing,
    /// All of the first cell.
    First,
    /// All of the second cell.
    Second,
    /// The result of the sum.
    Part,
}

/// Takes the sides of the area that two cells share.
pub trait Pieces {
    /// A place.
    type Spot: Copy;
    /// A corner of the first cell, or of the second one.
    fn corner(&self, second: bool, k: u32) -> Self::Spot;
    /// Where a side of the first cell crosses one of the second, and leaves it or enters it.
    fn place(&self, e: u32, f: u32, leaves: bool) -> Self::Spot;
    /// A side of the shared area.
    fn piece(&mut self, from: &Self::Spot, to: &Self::Spot);
}

/// Whether cells are of this kind.
pub fn takes<C: Outline<D>, const D: usize>(p: &C, q: &C) -> bool {
    let usual = |cell: &C| cell.convex() && cell.count() <= MOST;
    usual(p) && usual(q)
}

/// Gives the sides of the area that such cells share; the second cell has moved.
pub fn meet<C: Outline<D>, S: Pieces, const D: usize>(p: &C, q: &C, sum: &mut S) -> Result<Met> {
    let (count, across) = (p.count(), q.count());
    // By side of a cell, the corners of the other one to its left.
    let (mut of, mut at) = ([0; MOST], [0; MOST]);
    let Some(q_inside) = inside(&mut of[..count], (p, q), Moved::Corner) else {
        return Ok(Met::Nothing);
    };
    let Some(p_inside) = inside(&mut at[..across], (q, p), Moved::Side) else {
        return Ok(Met::Nothing);
    };
    if p_inside == all(count) {
        return Ok(Met::First);
    }
    if q_inside == all(across) {
        return Ok(Met::Second);
    }
    // Where sides of the second cell enter the first one and leave it.
    let mut ends_of_second: [[Option<S::Spot>; 2]; MOST] = [[None; 2]; MOST];
    for (e, &beside) in of[..count].iter().enumerate() {
        let next = after(e, count);
        let mut ends = [None; 2];
        // Sides of the second cell with ends on both sides of this one.
        let mut apart = beside ^ rotated(beside, across);
        while apart != 0 {
            let f = apart.trailing_zeros() as usize;
            apart &= apart - 1;
            let (starts, stops) = (bit(at[f], e), bit(at[f], next));
            // As `outline::cross_at`.
            if starts != stops && starts == bit(beside, after(f, across)) {
                let x = sum.place(e as u32, f as u32, starts);
                // Where one leaves, the other one enters.
                ends[usize::from(starts)] = Some(x);
                ends_of_second[f][usize::from(!starts)] = Some(x);
            }
        }
        add(sum, (false, e, next), p_inside, ends)?;
    }
    for (f, ends) in ends_of_second[..across].iter().enumerate() {
        add(sum, (true, f, after(f, across)), q_inside, *ends)?;
    }
    Ok(Met::Part)
}

/// Fills the corners of the other cell to the left of each side of a cell, and returns those inside;
/// nothing if all are to the right of one side.
fn inside<C: Outline<D>, const D: usize>(
    left: &mut [u32],
    (cell, other): (&C, &C),
    moved: Moved,
) -> Option<u32> {
    let mut inside = all(other.count());
    for (k, own) in left.iter_mut().enumerate() {
        *own = cell.left(k as u32, other, moved);
        if *own == 0 {
            return None;
        }
        inside &= *own;
    }
    Some(inside)
}

/// Adds the piece of a side that is in the other cell; `inside` are the corners there, and `ends` where
/// the side enters and leaves.
fn add<S: Pieces>(
    sum: &mut S,
    (second, k, next): (bool, usize, usize),
    inside: u32,
    ends: [Option<S::Spot>; 2],
) -> Result<()> {
    let [from, to] = [(k, ends[0]), (next, ends[1])].map(|(corner, end)| {
        if bit(inside, corner) {
            (Some(sum.corner(second, corner as u32)), end.is_none())
        } else {
            (end, true)
        }
    });
    match (from, to) {
        ((Some(from), true), (Some(to), true)) => sum.piece(&from, &to),
        ((None, _), (None, _)) => {}
        _ => {
            return Err(Error::Internal(
                "a side enters a cell without leaving it".into(),
            ));
        }
    }
    Ok(())
}

/// This many bits.
fn all(count: usize) -> u32 {
    (1 << count) - 1
}

fn bit(bits: u32, k: usize) -> bool {
    bits >> k & 1 == 1
}

/// The corner after one.
fn after(k: usize, count: usize) -> usize {
    if k + 1 == count { 0 } else { k + 1 }
}

/// At each corner, the bit of the one after it.
fn rotated(bits: u32, count: usize) -> u32 {
    bits >> 1 | (bits & 1) << (count - 1)
}
