//! Merges nodes that rounding moved to the wrong side of a contour.
//!
//! The contours cut a triangle into *cells* of three to five places; fans cut cells into small
//! triangles. If each small triangle is positively oriented or collapsed to an edge or a point,
//! then the map from the exact surface to the rounded one preserves orientation, so that over each
//! point that is not on an edge lies exactly one small triangle: the edges of the fans, contours
//! among them, may touch but cannot cross.
//!
//! If no fan of a cell is like that, the two nearest of its places that can be united are united:
//! one takes the position of the other, and vertices stay. Positions become fewer with each union,
//! so the passes end. Unions happen where nodes are a few units in the last place apart.
//!
//! In a triangle that is thinner than the resolution of the coordinates, a cell may be left with
//! vertices alone and still be tangled: a node of a longer edge was united with the vertex beside it,
//! which lies on the other side of that edge. Or it has only places far apart, and uniting these would
//! displace contours. Such triangles are returned. The caller leaves them out, if they lie at the
//! outline, allows unions far apart, or has the nodes on their edges collapsed (see [`Nodes::new`]).

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use delone_predicates::{Sign, orient2d};

use super::nodes::{Crossed, Nodes, SHARE};
use crate::base::error::{Error, Result};
use crate::base::memory::{push, room_for_one};
use crate::base::parallel::map_watched;
use crate::base::watch::Watch;

/// Places are near if they are this share of their coordinates apart, 1,024 units in the last place.
const NEAR: f64 = 1.0 / (1_u64 << 42) as f64;

/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;

/// Unites places until no contours cross, and lets each place refer to its representative. Returns
/// the triangles in which this is not possible, ascending; unless `far`, places that are further
/// apart than a few units in the last place are not united.
///
/// Passes over the triangles in their order end with one in which only equal positions are united.
/// A pass skips a triangle that was valid and none of whose places has moved since.
pub fn untangle(
    nodes: &mut Nodes,
    far: bool,
    (workers, watch): (usize, &Watch),
) -> Result<Vec<i32>> {
    let mut tangled = Vec::new();
    let mut due = due(nodes, (workers, watch))?;
    if due.is_empty() {
        return Ok(tangled);
    }
    let mut moves = Moves::default();
    // Terminates: each pass but the last one unites places, which become fewer.
    loop {
        let mut changed = false;
        tangled.clear();
        let mut earlier = due.drain(..).peekable();
        let mut last = None;
        for turn in 0_usize.. {
            if turn.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            // The next triangle of the pass: of those known at its start, or one that has changed since.
            let known = earlier.peek().copied();
            let touched = moves.ahead.peek().map(|&Reverse(t)| t);
            let Some(t) = known.into_iter().chain(touched).min() else {
                break;
            };
            if known == Some(t) {
                earlier.next();
            } else {
                moves.ahead.pop();
            }
            if last == Some(t) {
                continue;
            }
            last = Some(t);
            moves.current = t;
            if let Some(crossed) = nodes.crossed(t as usize) {
                let (united, possible) =
                    untangle_triangle(nodes, t as usize, &crossed, far, &mut moves)?;
                changed |= united;
                if !possible {
                    push(&mut tangled, t as i32)?;
                    push(&mut moves.again, t)?;
                }
            }
        }
        drop(earlier);
        if !changed {
            nodes.flatten();
            return Ok(tangled);
        }
        std::mem::swap(&mut due, &mut moves.again);
        due.sort_unstable();
        due.dedup();
    }
}

/// The triangles in which places must be united, ascending.
fn due(nodes: &Nodes, (workers, watch): (usize, &Watch)) -> Result<Vec<u32>> {
    let parts = map_watched(workers, nodes.shares(SHARE), watch, |share| {
        let mut found = Vec::new();
        for t in share {
            if nodes
                .crossed(t)
                .is_some_and(|crossed| !is_valid(nodes, t, &crossed))
            {
                push(&mut found, t as u32)?;
            }
        }
        Ok(found)
    })?;
    let mut found = Vec::new();
    found
        .try_reserve_exact(parts.iter().map(Vec::len).sum())
        .map_err(|_| Error::Memory {
            bytes: 4 * nodes.triangles(),
        })?;
    parts.iter().for_each(|part| found.extend_from_slice(part));
    Ok(found)
}

/// Whether all cells of a triangle are valid, and no equal positions are to be united.
fn is_valid(nodes: &Nodes, t: usize, crossed: &Crossed) -> bool {
    (crossed.ranks[0]..=crossed.ranks[2]).all(|level| {
        let cell = cell(nodes, t, crossed, level);
        equal(nodes, cell.places()).is_none() && untangled(nodes, cell.places(), crossed.even)
    })
}

/// What unions have changed.
#[derive(Default)]
struct Moves {
    /// The triangle of this turn.
    current: u32,
    /// Triangles that have changed and whose turn comes in this pass.
    ahead: BinaryHeap<Reverse<u32>>,
    /// Triangles whose next turn is in the next pass.
    again: Vec<u32>,
    /// The places that were united with each representative.
    members: HashMap<u32, Vec<u32>>,
}

impl Moves {
    /// Unites two representatives, and notes the triangles with places that change their representative.
    fn unite(&mut self, nodes: &mut Nodes, a: u32, b: u32) -> Result<()> {
        let (kept, gone) = (a.min(b), a.max(b));
        nodes.unite(a, b);
        let mut moved = self.members.remove(&gone).unwrap_or_default();
        push(&mut moved, gone)?;
        // Only nodes are united with another representative, so all that move are nodes.
        for &node in &moved {
            for t in nodes.beside(node).into_iter().flatten() {
                let t = t as u32;
                if t > self.current {
                    self.ahead.try_reserve(1).map_err(|_| Error::Memory {
                        bytes: 8 * self.ahead.len(),
                    })?;
                    self.ahead.push(Reverse(t));
                } else {
                    push(&mut self.again, t)?;
                }
            }
        }
        // A vertex never moves.
        if kept >= nodes.vertices() {
            room_for_one(&mut self.members)?;
            let members = self.members.entry(kept).or_default();
            for node in moved {
                push(members, node)?;
            }
        }
        Ok(())
    }
}

/// Unites equal positions in the cells of a triangle, and places of cells that are tangled; returns
/// whether the latter happened, and whether all cells are then valid.
fn untangle_triangle(
    nodes: &mut Nodes,
    t: usize,
    crossed: &Crossed,
    far: bool,
    moves: &mut Moves,
) -> Result<(bool, bool)> {
    let (mut changed, mut possible) = (false, true);
    for level in crossed.ranks[0]..=crossed.ranks[2] {
        let cell = cell(nodes, t, crossed, level);
        while let Some([a, b]) = equal(nodes, cell.places()) {
            moves.unite(nodes, a, b)?;
        }
        while !untangled(nodes, cell.places(), crossed.even) {
            let Some([a, b]) = nearest(nodes, cell.places(), far) else {
                possible = false;
                break;
            };
            moves.unite(nodes, a, b)?;
            changed = true;
        }
    }
    Ok((changed, possible))
}

/// The places around a cell, in the order of the corners from low to high along the right side.
struct Cell {
    around: [u32; 5],
    len: usize,
}

impl Cell {
    fn push(&mut self, place: u32) {
        self.around[self.len] = place;
        self.len += 1;
    }

    fn places(&self) -> &[u32] {
        &self.around[..self.len]
    }
}

/// The cell below the contour of `level`, or above all, counterclockwise if `crossed` is even.
fn cell(nodes: &Nodes, t: usize, crossed: &Crossed, level: u32) -> Cell {
    let [low, mid, high] = crossed.corners.map(|k| nodes.corner(t, k));
    let mut cell = Cell {
        around: [0; 5],
        len: 0,
    };
    let below = (level > crossed.ranks[0]).then(|| crossed.chord(level - 1));
    let above = (level < crossed.ranks[2]).then(|| crossed.chord(level));
    match below {
        Some([left, right]) => {
            cell.push(left);
            cell.push(right);
        }
        None => cell.push(low),
    }
    if level == crossed.ranks[1] {
        cell.push(mid);
    }
    match above {
        Some([left, right]) => {
            cell.push(right);
            cell.push(left);
        }
        None => cell.push(high),
    }
    cell
}

/// Two representatives of places of a cell that have the same position and can be united.
fn equal(nodes: &Nodes, cell: &[u32]) -> Option<[u32; 2]> {
    for i in 1..cell.len() {
        for j in 0..i {
            let [a, b] = [cell[i], cell[j]].map(|place| nodes.find(place));
            if a != b && nodes.at(a) == nodes.at(b) && is_free(nodes, a.max(b)) {
                return Some([a, b]);
            }
        }
    }
    None
}

/// Whether a representative is a node, and not a vertex.
fn is_free(nodes: &Nodes, place: u32) -> bool {
    place >= nodes.vertices()
}

/// Whether all triangles of some fan of the cell are positively oriented or collapsed.
fn untangled(nodes: &Nodes, cell: &[u32], even: bool) -> bool {
    let count = cell.len();
    (0..count).any(|apex| {
        (1..count - 1).all(|i| {
            let corners = [apex, apex + i, apex + i + 1].map(|k| nodes.find(cell[k % count]));
            right_way_round(nodes, corners, even)
        })
    })
}

/// Whether a small triangle is positively oriented or collapsed.
fn right_way_round(nodes: &Nodes, [a, b, c]: [u32; 3], even: bool) -> bool {
    a == b
        || b == c
        || c == a
        || orient2d(nodes.at(a), nodes.at(b), nodes.at(c)).flip_if(!even) == Sign::Positive
}

/// The two nearest representatives of places of a cell of which one may move; none if there are none,
/// or none that are near.
fn nearest(nodes: &Nodes, cell: &[u32], far: bool) -> Option<[u32; 2]> {
    let mut nearest = None;
    for i in 1..cell.len() {
        for j in 0..i {
            let [a, b] = [cell[i], cell[j]].map(|place| nodes.find(place));
            if a == b || !is_free(nodes, a.max(b)) {
                continue;
            }
            let ([x, y], [u, v]) = (nodes.at(a), nodes.at(b));
            let distance = (x - u).abs().max((y - v).abs());
            let size = x.abs().max(y.abs()).max(u.abs()).max(v.abs());
            if !far && distance > NEAR * size {
                continue;
            }
            if nearest.is_none_or(|(least, _)| distance < least) {
                nearest = Some((distance, [a, b]));
            }
        }
    }
    nearest.map(|(_, pair)| pair)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::arrays::{Given, Triangles};

    /// A sheared lattice, a few units in the last place apart, with its triangles and heights.
    struct Sheet {
        points: Vec<[f64; 2]>,
        simplices: Vec<[i32; 3]>,
        neighbors: Vec<[i32; 3]>,
        heights: Vec<f64>,
    }

    impl Sheet {
        fn new(side: i32, unit: f64) -> Self {
            let (mut points, mut heights) = (Vec::new(), Vec::new());
            for i in 0..side {
                for j in 0..side {
                    let (x, y) = (f64::from(i), f64::from(j));
                    points.push([
                        1e9 + unit * (5.0 * x + 3.0 * y),
                        1e9 + unit * (3.0 * x + 2.0 * y),
                    ]);
                    heights.push(f64::from((i * 7 + j * 5 + i * j) % 11));
                }
            }
            let (mut simplices, mut neighbors) = (Vec::new(), Vec::new());
            let cells = side - 1;
            for i in 0..cells {
                for j in 0..cells {
                    let (a, t) = (i * side + j, 2 * (i * cells + j));
                    let [b, c, d] = [a + side, a + side + 1, a + 1];
                    let if_any = |some: bool, u: i32| if some { u } else { -1 };
                    simplices.push([a, b, c]);
                    let right = if_any(i + 1 < cells, t + 2 * cells + 1);
                    neighbors.push([right, t + 1, if_any(j > 0, t - 1)]);
                    simplices.push([a, c, d]);
                    let above = if_any(j + 1 < cells, t + 2);
                    neighbors.push([above, if_any(i > 0, t - 2 * cells), t]);
                }
            }
            Self {
                points,
                simplices,
                neighbors,
                heights,
            }
        }

        fn nodes<'a>(&'a self, levels: &[f64], collapsed: &[bool]) -> Nodes<'a> {
            let given: Triangles = Given {
                points: &self.points,
                simplices: &self.simplices,
                neighbors: &self.neighbors,
            };
            let threads = (1, &Watch::idle());
            Nodes::new(given, &self.heights, (levels, collapsed), 1 << 20, threads).unwrap()
        }
    }

    /// All triangles in each pass, until none changes.
    fn in_full_passes(nodes: &mut Nodes, far: bool) -> Vec<i32> {
        loop {
            let (mut changed, mut tangled) = (false, Vec::new());
            for t in 0..nodes.triangles() {
                if let Some(crossed) = nodes.crossed(t) {
                    let mut moves = Moves::default();
                    let (united, possible) =
                        untangle_triangle(nodes, t, &crossed, far, &mut moves).unwrap();
                    changed |= united;
                    if !possible {
                        tangled.push(t as i32);
                    }
                }
            }
            if !changed {
                nodes.flatten();
                return tangled;
            }
        }
    }

    #[test]
    fn triangles_that_are_skipped_would_not_change() {
        let (mut unions, mut impossible) = (0, 0);
        // The last sheet has more triangles than a share.
        for (side, power) in [
            (12, -23),
            (12, -22),
            (12, -21),
            (12, -20),
            (12, -19),
            (100, -21),
        ] {
            let count = if side > 12 { 4 } else { 40 };
            let levels: Vec<f64> = (0..count)
                .map(|k| 0.13 + 10.8 / f64::from(count) * f64::from(k))
                .collect();
            let sheet = Sheet::new(side, 2.0_f64.powi(power));
            let some: Vec<bool> = (0..sheet.simplices.len()).map(|t| t % 5 == 0).collect();
            for (far, collapsed) in [(false, &[][..]), (true, &[]), (false, &some), (true, &some)] {
                let (mut a, mut b) = (
                    sheet.nodes(&levels, collapsed),
                    sheet.nodes(&levels, collapsed),
                );
                let tangled = untangle(&mut a, far, (1, &Watch::idle())).unwrap();
                assert_eq!(tangled, in_full_passes(&mut b, far));
                for place in 0..a.len() as u32 {
                    assert_eq!(a.find(place), b.find(place));
                    unions += usize::from(a.find(place) != place);
                }
                impossible += tangled.len();
            }
        }
        assert!(unions > 1_000 && impossible > 10, "{unions} {impossible}");
    }

    #[test]
    fn nodes_know_the_triangles_beside_them() {
        let sheet = Sheet::new(9, 1.0);
        let nodes = sheet.nodes(&[1.5, 2.5, 2.75, 7.0, 9.5], &[]);
        let mut sides = vec![Vec::new(); nodes.len()];
        for t in 0..nodes.triangles() {
            for k in 0..3 {
                let ranks = nodes.ends(t, k).map(|v| nodes.rank(v));
                for level in ranks[0].min(ranks[1])..ranks[0].max(ranks[1]) {
                    sides[nodes.node(t, k, level) as usize].push(t);
                }
            }
        }
        for (node, want) in sides.iter().enumerate().skip(nodes.vertices() as usize) {
            let found: Vec<usize> = nodes.beside(node as u32).into_iter().flatten().collect();
            assert_eq!(&found, want);
        }
    }
}
