//! Rings that cross themselves where they touch themselves: at common corners, and at corners in
//! sides.
//!
//! A ring may touch itself if it has two winding numbers, one more than the other: then its area is
//! that of what it goes around. Sides that cross elsewhere are found pair by pair; what remains is
//! decided here by signs, after sides are cut at the corners in them, into pieces that are apart or
//! the same.
//!
//! Pieces that are passed in both directions cancel. The winding number is one more to the left of
//! each piece that remains than to its right, so around each place they must leave and arrive in
//! turn. Pieces that are connected by such places have the same two numbers. Others are connected by
//! pieces that cancel, such as bridges to holes, which lie in one region: it must have the larger
//! number at all of their ends, or the smaller one at all.

use std::cmp::Ordering;

use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::sets::Sets;
use crate::base::watch::Watch;

use super::outline::{Lie, Prepared};
use super::sides::any_pair;

/// Whether two sides of a cell cross, or run the same way in a common part, or a ring crosses itself
/// where it touches itself.
pub fn crossing<C: Prepared<D>, const D: usize>(cell: &C, watch: &Watch) -> Result<bool> {
    if cell.convex() {
        return Ok(false);
    }
    let mut touches = Touches::default();
    let crossed = any_pair(
        cell,
        |e, f| {
            let lie = cell.lie(e, f);
            if lie == Lie::Touching {
                touches.add(cell, e, f)?;
            }
            Ok(lie == Lie::Crossing)
        },
        watch,
    )?;
    Ok(crossed || touches.cross(cell)?)
}

/// Where rings of a cell touch themselves.
#[derive(Default)]
struct Touches {
    /// Pairs of equal corners.
    equal: Vec<[u32; 2]>,
    /// Sides and corners in them.
    inside: Vec<[u32; 2]>,
}

/// A piece at one of its ends.
struct Spoke {
    place: u32,
    /// The place of its other end.
    end: u32,
    /// 1 if it leaves, -1 if it arrives, 0 if it cancels.
    flow: i32,
    piece: u32,
}

impl Touches {
    fn add<C: Prepared<D>, const D: usize>(&mut self, cell: &C, e: u32, f: u32) -> Result<()> {
        let ring = |k: u32| cell.later_rings().partition_point(|&start| start <= k);
        // How rings of a cell lie to each other is not decided here.
        if ring(e) != ring(f) {
            return Ok(());
        }
        if cell.equal(e, f) {
            push(&mut self.equal, [e, f])?;
        }
        for [side, corner] in [[e, f], [f, e]] {
            if cell.inside(side, corner) {
                push(&mut self.inside, [side, corner])?;
            }
        }
        Ok(())
    }

    /// Whether a ring has other winding numbers than two that follow each other.
    fn cross<C: Prepared<D>, const D: usize>(mut self, cell: &C) -> Result<bool> {
        if self.equal.is_empty() && self.inside.is_empty() {
            return Ok(false);
        }
        let Some(mut spokes) = spokes(&self.steps(cell)?)? else {
            return Ok(true);
        };
        let mut regions = Sets::of(spokes.len() / 2)?;
        // Pieces that cancel, and whether the region has the larger number at an end.
        let mut levels: Vec<(u32, bool)> = Vec::new();
        for around in spokes.chunk_by_mut(|p, q| p.place == q.place) {
            let Some(first) = around.iter().position(|spoke| spoke.flow != 0) else {
                for pair in around.windows(2) {
                    regions.join(pair[0].piece, pair[1].piece);
                }
                continue;
            };
            if around.len() == 2 {
                continue;
            }
            around.swap(0, first);
            sort_around(cell, around);
            let mut last = -around[0].flow;
            for spoke in around.iter() {
                if spoke.flow == last {
                    return Ok(true);
                }
                if spoke.flow == 0 {
                    // To the left of a piece that leaves, and to the right of one that arrives.
                    push(&mut levels, (spoke.piece, last > 0))?;
                } else {
                    last = spoke.flow;
                }
            }
        }
        let mut known: Vec<Option<bool>> = filled(spokes.len() / 2, None)?;
        Ok(levels.iter().any(|&(piece, level)| {
            let own = &mut known[regions.root(piece) as usize];
            *own.get_or_insert(level) != level
        }))
    }

    /// The sides, cut at the corners in them: pairs of places, each the first of its equal corners.
    fn steps<C: Prepared<D>, const D: usize>(&mut self, cell: &C) -> Result<Vec<[u32; 2]>> {
        let mut places = Sets::of(cell.count())?;
        for &[k, l] in &self.equal {
            places.join(k, l);
        }
        self.inside.sort_unstable_by(|&[e, k], &[f, l]| {
            e.cmp(&f).then_with(|| cell.along(e, k, l)).then(k.cmp(&l))
        });
        let mut steps = with_room(cell.count() + self.inside.len())?;
        let mut inside = self.inside.iter().peekable();
        for e in 0..cell.count() as u32 {
            let mut last = places.root(e);
            while let Some(&[_, corner]) = inside.next_if(|x| x[0] == e) {
                let place = places.root(corner);
                if place != last {
                    steps.push([last, place]);
                }
                last = place;
            }
            steps.push([last, places.root(cell.next(e))]);
        }
        Ok(steps)
    }
}

/// Both ends of each piece, by place; none if a piece is passed more often in one direction than in
/// the other, and more than once.
fn spokes(steps: &[[u32; 2]]) -> Result<Option<Vec<Spoke>>> {
    let mut directed = with_room(steps.len())?;
    directed.extend(steps.iter().map(|&[a, b]| (a.min(b), a.max(b), a < b)));
    directed.sort_unstable();
    let mut spokes = with_room(2 * steps.len())?;
    let pieces = directed.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1));
    for (piece, same) in (0..).zip(pieces) {
        let (low, high, _) = same[0];
        let flow: i32 = same.iter().map(|x| if x.2 { 1 } else { -1 }).sum();
        if flow.abs() > 1 {
            return Ok(None);
        }
        for (place, end, flow) in [(low, high, flow), (high, low, -flow)] {
            spokes.push(Spoke {
                place,
                end,
                flow,
                piece,
            });
        }
    }
    spokes.sort_unstable_by_key(|spoke| (spoke.place, spoke.piece));
    Ok(Some(spokes))
}

/// Sorts pieces counterclockwise around their place, from the first one on. Two that run the same way
/// are the same.
fn sort_around<C: Prepared<D>, const D: usize>(cell: &C, around: &mut [Spoke]) {
    let (place, first) = (around[0].place, around[0].end);
    // Ahead, to the left, behind, to the right.
    let quarter = |end: u32| match (end == first, cell.turn(place, first, end)) {
        (true, _) => 0,
        (_, 1) => 1,
        (_, 0) => 2,
        _ => 3,
    };
    around.sort_by(|p, q| {
        quarter(p.end)
            .cmp(&quarter(q.end))
            .then_with(|| match cell.turn(place, p.end, q.end) {
                1 => Ordering::Less,
                0 => Ordering::Equal,
                _ => Ordering::Greater,
            })
    });
}
