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

use delone_predicates::{Sign, orient2d};

use super::nodes::{Crossed, Nodes};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::watch::Watch;

/// Places are near if they are this share of their coordinates apart, 1,024 units in the last place.
const NEAR: f64 = 1.0 / (1_u64 << 42) as f64;

/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;

/// Unites places until no contours cross, and lets each place refer to its representative. Returns
/// the triangles in which this is not possible, ascending; unless `far`, places that are further
/// apart than a few units in the last place are not united.
pub fn untangle(nodes: &mut Nodes, far: bool, watch: &Watch) -> Result<Vec<i32>> {
    let mut tangled = Vec::new();
    loop {
        let mut changed = false;
        tangled.clear();
        for t in 0..nodes.triangles() {
            if t.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            let crossed = nodes.crossed(t);
            if crossed.ranks[0] < crossed.ranks[2] {
                let (united, possible) = untangle_triangle(nodes, t, &crossed, far);
                changed |= united;
                if !possible {
                    push(&mut tangled, t as i32)?;
                }
            }
        }
        if !changed {
            nodes.flatten();
            return Ok(tangled);
        }
    }
}

/// Unites equal positions in the cells of a triangle, and places of cells that are tangled; returns
/// whether the latter happened, and whether all cells are then valid.
fn untangle_triangle(nodes: &mut Nodes, t: usize, crossed: &Crossed, far: bool) -> (bool, bool) {
    let (mut changed, mut possible) = (false, true);
    for level in crossed.ranks[0]..=crossed.ranks[2] {
        let cell = cell(nodes, t, crossed, level);
        unite_equal(nodes, cell.places());
        while !untangled(nodes, cell.places(), crossed.even) {
            if !unite_nearest(nodes, cell.places(), far) {
                possible = false;
                break;
            }
            changed = true;
        }
    }
    (changed, possible)
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
    let below = (level > crossed.ranks[0]).then(|| nodes.chord(t, crossed, level - 1));
    let above = (level < crossed.ranks[2]).then(|| nodes.chord(t, crossed, level));
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

/// Unites places of a cell that have the same position.
fn unite_equal(nodes: &mut Nodes, cell: &[u32]) {
    for i in 1..cell.len() {
        for j in 0..i {
            let [a, b] = [cell[i], cell[j]].map(|place| nodes.find(place));
            if a != b && nodes.at(a) == nodes.at(b) && is_free(nodes, a.max(b)) {
                nodes.unite(a, b);
            }
        }
    }
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

/// Unites the two nearest places of a cell of which one may move; false if there are none, or none
/// that are near.
fn unite_nearest(nodes: &mut Nodes, cell: &[u32], far: bool) -> bool {
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
            if nearest.is_none_or(|(least, _, _)| distance < least) {
                nearest = Some((distance, a, b));
            }
        }
    }
    if let Some((_, a, b)) = nearest {
        nodes.unite(a, b);
    }
    nearest.is_some()
}
