//! Which corners and crossings of two cells their shared area is a sum over, on the sphere and in
//! the plane.
//!
//! With G_e(x) the integral of the area form along a side e from its start to x, the area is the
//! sum of G_e(end) over sides e of either cell that end in the other one, and of +-(G_e(x) -
//! G_f(x)) over all crossings x of a side e of the first and f of the second cell, + where e leaves
//! the second one (W. R. Franklin, "Polygon properties calculated from the vertex neighborhoods",
//! 1987, in the plane). Nothing is sorted along a side, and concave cells, parts and holes are not
//! special cases.
//!
//! The second cell has moved, so that no sign is zero. Signs decide which terms there are; each term
//! is computed from the corners as given.

use std::cmp::Ordering;

use super::signs::Moved;

/// What is wrong with a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// Fewer than three distinct corners, or no area.
    Empty = 1,
    /// A side joins opposite directions.
    Opposite = 2,
    /// No hemisphere contains it.
    Large = 3,
    /// Two of its sides cross.
    Crossing = 4,
}

/// A cell with sides between corners.
pub trait Outline: Sized {
    /// The number of corners, and of sides.
    fn count(&self) -> usize;
    /// The corner at which the side that starts at a corner ends.
    fn next(&self, k: u32) -> u32;
    /// Whether the cell is known to be convex.
    fn convex(&self) -> bool;
    /// Where a corner of another cell is: 1 to the left of a side, -1 to its right.
    fn sign(&self, k: u32, other: &Self, corner: u32, moved: Moved) -> i8;
    /// Whether a corner of another cell is in this one; of the two, `moved` has moved.
    fn holds(&self, other: &Self, corner: u32, moved: Moved) -> bool;
    /// Appends the sides whose boxes meet that of another cell.
    fn near(&self, other: &Self, found: &mut Vec<u32>);
}

/// Takes the terms of a sum.
pub trait Sum {
    /// A side of the first cell, which the terms that follow are about.
    fn side(&mut self, e: u32);
    /// That side ends in the second cell.
    fn first(&mut self);
    /// That side crosses one of the second cell, and leaves it there or enters it.
    fn crossing(&mut self, f: u32, leaves: bool);
    /// A side of the second cell ends in the first one.
    fn second(&mut self, f: u32);
}

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

/// Buffers.
#[derive(Default)]
pub struct Work {
    /// Corners of the first cell at sides of the second one, and vice versa.
    at: Vec<i8>,
    of: Vec<i8>,
    first: Near,
    second: Near,
}

/// Sides of a cell near the other one, and which of them end in that.
#[derive(Default)]
struct Near {
    sides: Vec<u32>,
    inside: Vec<bool>,
}

/// Whether two arcs cross, from the signs of the second one's ends at the first one, and of the
/// first one's ends at the second one.
///
/// Both circles separate the other arc's ends, so each arc meets one of the two points where the
/// circles meet. At n x m the second arc, with normal m, comes from the right of the first and ends
/// to its left, and the first comes from the left of the second and ends to its right; at -n x m it
/// is the reverse. So the points are the same if and only if the second sign of one is the first of
/// the other. Lines meet in one point, where this always holds.
#[inline]
pub fn cross_at(at: [i8; 2], of: [i8; 2]) -> bool {
    at[0] != at[1] && of[0] != of[1] && of[0] == at[1]
}

/// Gives the terms of the area that cells share; the second one has moved.
pub fn meet<C: Outline>(p: &C, q: &C, work: &mut Work, sum: &mut impl Sum) -> Met {
    let Work {
        at,
        of,
        first,
        second,
    } = work;
    near(p, q, first);
    near(q, p, second);
    if first.sides.is_empty() && second.sides.is_empty() {
        // A cell inside the other one has its sides in the box of that.
        return Met::Nothing;
    }
    // Signs: rows are sides, columns both ends of the sides of the other cell.
    if !signs(at, (q, &second.sides), (p, &first.sides), Moved::Side)
        || !signs(of, (p, &first.sides), (q, &second.sides), Moved::Corner)
    {
        return Met::Nothing;
    }
    corners_inside(first, (p, q), at, second.sides.len(), Moved::Side);
    corners_inside(second, (q, p), of, first.sides.len(), Moved::Corner);
    let mut crossed = false;
    let (count, across) = (first.sides.len(), second.sides.len());
    for (k, &e) in first.sides.iter().enumerate() {
        sum.side(e);
        if first.inside[k] {
            sum.first();
        }
        for (l, &f) in second.sides.iter().enumerate() {
            // The ends of e at f, and those of f at e.
            let (i, j) = (2 * (l * count + k), 2 * (k * across + l));
            let (ends_e, ends_f) = ([at[i], at[i + 1]], [of[j], of[j + 1]]);
            if cross_at(ends_f, ends_e) {
                crossed = true;
                // To the left of a side is inside.
                sum.crossing(f, ends_e[0] > 0);
            }
        }
    }
    if !crossed {
        // One cell inside the other: its area as it is.
        let all = |near: &Near, cell: &C| {
            near.sides.len() == cell.count() && near.inside.iter().all(|&x| x)
        };
        let none = |near: &Near| !near.inside.contains(&true);
        if all(first, p) && none(second) {
            return Met::First;
        }
        if all(second, q) && none(first) {
            return Met::Second;
        }
    }
    for (l, &f) in second.sides.iter().enumerate() {
        if second.inside[l] {
            sum.second(f);
        }
    }
    Met::Part
}

/// Cells with fewer corners take all their sides.
const FEW: usize = 12;

/// Sides of a cell whose boxes meet that of the other one.
fn near<C: Outline>(cell: &C, other: &C, found: &mut Near) {
    found.sides.clear();
    if cell.count() < FEW {
        found.sides.extend(0..cell.count() as u32);
    } else {
        cell.near(other, &mut found.sides);
    }
}

/// The signs of the ends of the other cell's sides at the sides of a cell. False if all are to the
/// right of one side of a convex cell, which then shares nothing.
fn signs<C: Outline>(
    into: &mut Vec<i8>,
    (cell, sides): (&C, &[u32]),
    (other, others): (&C, &[u32]),
    moved: Moved,
) -> bool {
    into.clear();
    let all = others.len() == other.count();
    for &k in sides {
        let from = into.len();
        let mut any = false;
        for (at, &l) in others.iter().enumerate() {
            // Sides in sequence share corners.
            let a = match at.checked_sub(1) {
                Some(before) if other.next(others[before]) == l => into[from + 2 * before + 1],
                _ => cell.sign(k, other, l, moved),
            };
            let next = other.next(l);
            let b = if next == others[0] {
                // The end of the last side is the start of the first.
                if at == 0 { a } else { into[from] }
            } else {
                cell.sign(k, other, next, moved)
            };
            into.extend([a, b]);
            any |= a > 0 || b > 0;
        }
        if !any && all && cell.convex() {
            return false;
        }
    }
    true
}

/// Which sides of a cell end in the other one.
fn corners_inside<C: Outline>(
    near: &mut Near,
    (cell, other): (&C, &C),
    at: &[i8],
    rows: usize,
    moved: Moved,
) {
    let count = near.sides.len();
    near.inside.clear();
    for (k, &e) in near.sides.iter().enumerate() {
        let found = if other.convex() && rows == other.count() {
            (0..rows).all(|l| at[2 * (l * count + k) + 1] > 0)
        } else {
            other.holds(cell, cell.next(e), moved)
        };
        near.inside.push(found);
    }
}

/// A cell made of rings.
pub trait Prepared<const D: usize>: Outline {
    /// Prepares a cell from its rings, each of which may be a hole.
    fn of(rings: &mut dyn Iterator<Item = (bool, &[[f64; D]])>) -> (Option<Self>, Option<Fault>);
    /// The area.
    fn area(&self) -> f64;
    /// Whether outer rings were clockwise.
    fn turned(&self) -> bool;
    /// Corners that repeat the one before.
    fn repeated(&self) -> usize;
    /// Two sides that cross in their interiors, or run the same way in a common part, if any do.
    fn crossing(&self) -> Option<[usize; 2]>;
}

/// The corners of a ring without those that repeat the one before; of several ways to write a corner,
/// the smallest.
pub fn distinct<T>(
    ring: impl Iterator<Item = T>,
    same: impl Fn(&T, &T) -> bool,
    compare: impl Fn(&T, &T) -> Ordering,
) -> Vec<T> {
    let mut found: Vec<T> = Vec::with_capacity(ring.size_hint().0);
    for v in ring {
        match found.last_mut() {
            Some(last) if same(last, &v) => {
                if compare(&v, last).is_lt() {
                    *last = v;
                }
            }
            _ => found.push(v),
        }
    }
    while found.len() > 1 && same(&found[0], &found[found.len() - 1]) {
        if let Some(last) = found.pop()
            && compare(&last, &found[0]).is_lt()
        {
            found[0] = last;
        }
    }
    found
}

/// Rotates a ring so that the sequence of its corners is the smallest one.
pub fn start_at_smallest<T>(ring: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let count = ring.len();
    let mut best = 0;
    for start in 1..count {
        let later = (0..count)
            .map(|k| compare(&ring[(start + k) % count], &ring[(best + k) % count]))
            .find(|order| order.is_ne());
        if later == Some(Ordering::Less) {
            best = start;
        }
    }
    ring.rotate_left(best);
}
