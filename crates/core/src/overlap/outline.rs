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

use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::base::watch::{Pace, Watch};

pub use super::convex::Met;
use super::convex::{self, Pieces};
pub use super::sides::Outline;
use super::sides::meeting;
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
    /// Two of its sides cross, or a ring crosses itself where it touches itself.
    Crossing = 4,
}

/// How two sides of a cell lie to each other.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Lie {
    /// They have at most the end of one in common, which is the start of the other.
    Apart,
    /// They may touch.
    Touching,
    /// They cross, or run the same way in a common part.
    Crossing,
}

/// Takes the terms of a sum, or the sides of the shared area.
pub trait Sum: Pieces {
    /// A side of the first cell, which the terms that follow are about.
    fn side(&mut self, e: u32);
    /// That side ends in the second cell.
    fn first(&mut self);
    /// That side crosses one of the second cell, and leaves it there or enters it.
    fn crossing(&mut self, f: u32, leaves: bool);
    /// A side of the second cell ends in the first one.
    fn second(&mut self, f: u32);
}

/// Buffers.
#[derive(Default)]
pub struct Work {
    /// Corners of the first cell at sides of the second one, and vice versa.
    at: Vec<i8>,
    of: Vec<i8>,
    first: Near,
    second: Near,
    crossings: Vec<Crossing>,
    found: Vec<u32>,
}

/// Sides of a cell near the other one, ascending, and which of them end in that.
#[derive(Default)]
struct Near {
    sides: Vec<u32>,
    inside: Vec<bool>,
}

/// Where a side of the first cell crosses one of the second, by their places among those that are
/// near, and whether it leaves the second cell there.
type Crossing = (u32, u32, bool);

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

/// Cells with fewer corners take all their sides.
const FEW: usize = 12;
/// Up to so many pairs of sides, all signs are asked for; of more, those of sides whose boxes meet.
const PAIRS: usize = 1 << 12;

/// Gives the terms of the area that cells share; the second one has moved.
pub fn meet<C: Outline<D>, const D: usize>(
    p: &C,
    q: &C,
    work: &mut Work,
    pace: &mut Pace,
    sum: &mut impl Sum,
) -> Result<Met> {
    if convex::takes(p, q) {
        return convex::meet(p, q, sum);
    }
    let Work {
        at,
        of,
        first,
        second,
        crossings,
        found,
    } = work;
    near(p, q, first, pace.watch())?;
    near(q, p, second, pace.watch())?;
    if first.sides.is_empty() && second.sides.is_empty() {
        // A cell inside the other one has its sides in the box of that.
        return Ok(Met::Nothing);
    }
    let (count, across) = (first.sides.len(), second.sides.len());
    crossings.clear();
    if count * across <= PAIRS {
        pace.spend(count * across)?;
        // Signs: rows are sides, columns both ends of the sides of the other cell.
        if !signs(at, (q, &second.sides), (p, &first.sides), Moved::Side)
            || !signs(of, (p, &first.sides), (q, &second.sides), Moved::Corner)
        {
            return Ok(Met::Nothing);
        }
        for k in 0..count {
            for l in 0..across {
                // The ends of e at f, and those of f at e.
                let (i, j) = (2 * (l * count + k), 2 * (k * across + l));
                let (ends_e, ends_f) = ([at[i], at[i + 1]], [of[j], of[j + 1]]);
                if cross_at(ends_f, ends_e) {
                    // To the left of a side is inside.
                    crossings.push((k as u32, l as u32, ends_e[0] > 0));
                }
            }
        }
    } else {
        at.clear();
        of.clear();
        crossings_by_boxes((p, first), (q, second), crossings, found, pace)?;
    }
    let own = crossings.iter().map(|x| x.0);
    ends_inside(first, (p, q), at, own, Moved::Side, found, pace)?;
    let own = crossings.iter().map(|x| x.1);
    ends_inside(second, (q, p), of, own, Moved::Corner, found, pace)?;
    let mut next = 0;
    for (k, &e) in first.sides.iter().enumerate() {
        sum.side(e);
        if first.inside[k] {
            sum.first();
        }
        while let Some(&(_, l, leaves)) = crossings.get(next).filter(|x| x.0 == k as u32) {
            sum.crossing(second.sides[l as usize], leaves);
            next += 1;
        }
    }
    if crossings.is_empty() {
        // One cell inside the other: its area as it is.
        let all =
            |near: &Near, count: usize| near.sides.len() == count && near.inside.iter().all(|&x| x);
        let none = |near: &Near| !near.inside.contains(&true);
        if all(first, p.count()) && none(second) {
            return Ok(Met::First);
        }
        if all(second, q.count()) && none(first) {
            return Ok(Met::Second);
        }
    }
    for (l, &f) in second.sides.iter().enumerate() {
        if second.inside[l] {
            sum.second(f);
        }
    }
    Ok(Met::Part)
}

/// Sides of a cell whose boxes meet that of the other one.
fn near<C: Outline<D>, const D: usize>(
    cell: &C,
    other: &C,
    near: &mut Near,
    watch: &Watch,
) -> Result<()> {
    near.sides.clear();
    if cell.count() < FEW {
        near.sides.extend(0..cell.count() as u32);
        return Ok(());
    }
    meeting(cell, &other.extent(), &mut near.sides, watch)
}

/// The crossings of sides whose boxes meet, by side of the first cell, then of the second one.
fn crossings_by_boxes<C: Outline<D>, const D: usize>(
    (p, first): (&C, &Near),
    (q, second): (&C, &Near),
    crossings: &mut Vec<Crossing>,
    found: &mut Vec<u32>,
    pace: &mut Pace,
) -> Result<()> {
    for (k, &e) in first.sides.iter().enumerate() {
        found.clear();
        meeting(q, &p.reach(e), found, pace.watch())?;
        pace.spend(found.len() + 1)?;
        for &f in &*found {
            let ends_e = [e, p.next(e)].map(|v| q.sign(f, p, v, Moved::Side));
            if ends_e[0] == ends_e[1] {
                continue;
            }
            let ends_f = [f, q.next(f)].map(|v| p.sign(e, q, v, Moved::Corner));
            if cross_at(ends_f, ends_e) {
                let l = second.sides.binary_search(&f);
                let l = l.map_err(|_| Error::Internal("a side is not in its cell's box".into()))?;
                push(crossings, (k as u32, l as u32, ends_e[0] > 0))?;
            }
        }
    }
    Ok(())
}

/// The signs of the ends of the other cell's sides at the sides of a cell. False if all are to the
/// right of one side of a convex cell, which then shares nothing.
fn signs<C: Outline<D>, const D: usize>(
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

/// Which sides of a cell end in the other one: `crossed` are the places of those that cross, once for
/// each crossing. With all signs and a convex cell, the signs tell; else each crossing of a ring
/// goes into the cell or out of it, and one corner of each ring is located.
fn ends_inside<C: Outline<D>, const D: usize>(
    near: &mut Near,
    (cell, other): (&C, &C),
    at: &[i8],
    crossed: impl Iterator<Item = u32>,
    moved: Moved,
    found: &mut Vec<u32>,
    pace: &mut Pace,
) -> Result<()> {
    let (count, rows) = (near.sides.len(), other.count());
    near.inside.clear();
    if other.convex() && at.len() == 2 * rows * count {
        let ends = (0..count).map(|k| (0..rows).all(|l| at[2 * (l * count + k) + 1] > 0));
        near.inside.extend(ends);
        return Ok(());
    }
    // Whether a side crosses an odd number of times, then whether it ends inside.
    near.inside.resize(count, false);
    for k in crossed {
        near.inside[k as usize] ^= true;
    }
    let ring = |k: u32| cell.later_rings().partition_point(|&start| start <= k);
    let mut from = 0;
    while from < count {
        let own = ring(near.sides[from]);
        let end = from + near.sides[from..].partition_point(|&k| ring(k) == own);
        let start = other.holds(cell, near.sides[from], moved, found, pace)?;
        let mut inside = start;
        for x in &mut near.inside[from..end] {
            inside ^= *x;
            *x = inside;
        }
        if inside != start {
            return Err(Error::Internal("a ring goes in without coming out".into()));
        }
        from = end;
    }
    Ok(())
}

/// A cell made of rings.
pub trait Prepared<const D: usize>: Outline<D> {
    /// Prepares a cell from its rings, each of which may be a hole. One with a fault may be given, for
    /// what its sides do.
    fn of(rings: &mut dyn Iterator<Item = (bool, &[[f64; D]])>) -> (Option<Self>, Option<Fault>);
    /// The area.
    fn area(&self) -> f64;
    /// Whether outer rings were clockwise.
    fn turned(&self) -> bool;
    /// Corners that repeat the one before.
    fn repeated(&self) -> usize;
    /// How two sides lie to each other. In a cell with a fault, those that run the same way in a common
    /// part may touch: parts to both sides of them may cancel.
    fn lie(&self, e: u32, f: u32) -> Lie;
    /// Whether one of two sides follows the other one.
    fn follow(&self, e: u32, f: u32) -> bool {
        self.next(e) == f || self.next(f) == e
    }
    /// Whether two corners are equal.
    fn equal(&self, k: u32, l: u32) -> bool;
    /// Whether a corner is in a side, and not at an end of it.
    fn inside(&self, e: u32, corner: u32) -> bool;
    /// The order of two corners in a side.
    fn along(&self, e: u32, k: u32, l: u32) -> Ordering;
    /// The sign of the turn around a corner from a second one to a third.
    fn turn(&self, at: u32, from: u32, to: u32) -> i8;
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
///
/// Of two starts whose sequences agree in k corners and then differ, neither the larger one nor the k
/// after it are the smallest: each comparison of two corners removes a start or grows k, so there are
/// at most three for each corner.
pub fn start_at_smallest<T>(ring: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let count = ring.len();
    let (mut best, mut other, mut k) = (0, 1, 0);
    while best < count && other < count && k < count {
        match compare(&ring[(best + k) % count], &ring[(other + k) % count]) {
            Ordering::Equal => {
                k += 1;
                continue;
            }
            Ordering::Greater => best += k + 1,
            Ordering::Less => other += k + 1,
        }
        k = 0;
        if best == other {
            other += 1;
        }
    }
    ring.rotate_left(best.min(other));
}
