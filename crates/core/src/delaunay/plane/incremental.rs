//! Randomized incremental insertion: locate the triangle of the next point, split it, flip.
//!
//! L. J. Guibas, D. E. Knuth and M. Sharir, "Randomized incremental construction of Delaunay and
//! Voronoi diagrams", Algorithmica 7 (1992): with the points in random order the expected number of
//! flips is O(n) and the expected work is O(n log n), whatever the points. N. Amenta, S. Choi and
//! G. Rote, "Incremental constructions con BRIO" (2003): a biased randomized order keeps the
//! expectation. Each point is in the last round with probability 1/2, else in the one before with
//! probability 1/2, and so on. Within a round the order is arbitrary; here it follows the curve, so
//! that the walk from one point to the next is short. The coin tosses are a hash of the point's
//! place along the curve, so the order depends on the coordinates only.
//!
//! Unlike in `cavity`, the mesh is a triangulation of the points so far after every step.

use std::ops::Range;

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use super::first::first_triangle;
use super::walk::walk;
use crate::base::error::{Error, Result};
use crate::base::memory::filled;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, half_edge, half_edges, next, prev, triangle};
use crate::order::random;

/// Insertions between two checks for interruption.
const WATCH_EVERY: usize = 4096;

/// Fills `mesh` with the triangulation of vertices `block` and returns a ghost; `None` if the block
/// is collinear. `points` end with NaN for infinity.
pub fn build(
    points: &[Point2],
    block: Range<u32>,
    mut mesh: Patch,
    watch: &Watch,
) -> Result<Option<Code>> {
    let order = brio(block.clone())?;
    let Some(first) = first_triangle(points, order.iter().copied()) else {
        return Ok(None);
    };
    let ghost = mesh.triangle(first);
    let mut flipper = Flipper {
        points,
        mesh,
        stack: Vec::new(),
    };
    let mut near = triangle(ghost);
    let others = order.iter().filter(|v| !first.contains(v));
    for (i, &p) in others.enumerate() {
        if i % WATCH_EVERY == 0 {
            watch.check()?;
        }
        near = flipper.insert(p, near)?;
    }
    ghost_of(&flipper.mesh).map(Some)
}

/// The vertices of a block in a biased randomized order, by a counting sort by round.
fn brio(block: Range<u32>) -> Result<Vec<u32>> {
    // One round more for each doubling, so that the first has about one point.
    let last = block.len().max(1).ilog2();
    let round = |v: u32| last - random(v - block.start).trailing_zeros().min(last);
    let mut ends = vec![0u32; last as usize + 2];
    for v in block.clone() {
        ends[round(v) as usize + 1] += 1;
    }
    for r in 0..=last as usize {
        ends[r + 1] += ends[r];
    }
    let mut order = filled(block.len(), 0u32)?;
    for v in block.clone() {
        let at = &mut ends[round(v) as usize];
        order[*at as usize] = v;
        *at += 1;
    }
    Ok(order)
}

/// The infinite corner of some ghost.
fn ghost_of(mesh: &Patch) -> Result<Code> {
    let inf = mesh.infinite();
    let infinite_corner = |t| {
        let k = mesh.corners(t).iter().position(|&v| v == inf)?;
        Some(half_edge(t, k as u32))
    };
    let ghost = mesh.taken().find_map(infinite_corner);
    ghost.ok_or_else(|| Error::Internal("the mesh has no ghost".into()))
}

/// A Delaunay triangulation into which points are inserted one at a time.
struct Flipper<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    stack: Vec<Code>,
}

impl Flipper<'_> {
    /// Inserts vertex `p`, which is not in the mesh yet; the search starts at triangle `near`.
    /// Returns one of its triangles.
    fn insert(&mut self, p: u32, near: u32) -> Result<u32> {
        let (home, _) = walk(&self.mesh, self.points, near, self.at(p));
        let on = self.edge_containing(p, home)?;
        self.stack.clear();
        match on {
            None => self.stack.extend(self.mesh.split_triangle(home, p)),
            Some(e) => self.stack.extend(self.mesh.split_edge(e, p)),
        }
        // Each flip adds an edge at p and removes none there, so there are fewer flips than
        // vertices. The edges on the stack are opposite p, and only their own flips change them.
        while let Some(e) = self.stack.pop() {
            if self.conflicts(e, p) {
                let other = self.mesh.flip(e);
                self.stack.extend([e, other]);
            }
        }
        Ok(home)
    }

    fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    /// The edge of triangle `home` on which `p` lies, if any; if `home` is a ghost, p is strictly
    /// outside its hull edge.
    fn edge_containing(&self, p: u32, home: u32) -> Result<Option<Code>> {
        if self.mesh.corners(home).contains(&self.mesh.infinite()) {
            return Ok(None);
        }
        let mut on = None;
        for e in half_edges(home) {
            let ends = [next(e), prev(e)].map(|c| self.at(self.mesh.vertex(c)));
            let side = orient2d(ends[0], ends[1], self.at(p));
            if side == Sign::Negative || side == Sign::Zero && on.is_some() {
                return Err(Error::Internal(format!("no triangle contains vertex {p}")));
            }
            on = if side == Sign::Zero { Some(e) } else { on };
        }
        Ok(on)
    }

    /// Whether the triangle across `e`, an edge opposite `p`, is in conflict with p.
    ///
    /// If so, e may be flipped. The part of the circumcircle of the triangle across e that is on
    /// p's side lies within the angle at its apex q, so the quadrilateral is strictly convex, even
    /// on a tie. A ghost across from another is in conflict if p sees its hull edge, which makes a
    /// left turn with p; a ghost across from a triangle never is, since p lies on the inner side.
    fn conflicts(&self, e: Code, p: u32) -> bool {
        //        p
        //      /   \
        //     u --- v
        //      \   /
        //        q
        let inf = self.mesh.infinite();
        let q = self.mesh.vertex(self.mesh.opposite(e));
        let [u, v] = [next(e), prev(e)].map(|c| self.mesh.vertex(c));
        let [at_u, at_v, at_q, at_p] = [u, v, q, p].map(|v| self.at(v));
        let turn = |a, b| orient2d(a, b, at_p) == Sign::Positive;
        if q == inf {
            false
        } else if u == inf {
            turn(at_q, at_v)
        } else if v == inf {
            turn(at_u, at_q)
        } else {
            incircle_canonical(at_v, at_u, at_q, at_p) == Sign::Positive
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_names_each_vertex_once_in_rounds_along_the_curve() {
        for n in [0, 1, 2, 3, 100, 4096] {
            let order = brio(7..7 + n).unwrap();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(7..7 + n));
            // A round ends where the order decreases.
            let falls = order.windows(2).filter(|w| w[0] > w[1]).count();
            assert!(falls <= n.max(1).ilog2() as usize);
        }
    }

    #[test]
    fn about_half_of_the_points_are_in_the_last_round() {
        let order = brio(0..4096).unwrap();
        let last = order.windows(2).rposition(|w| w[0] > w[1]).unwrap();
        let share = (order.len() - last - 1) as f64 / order.len() as f64;
        assert!((0.45..0.55).contains(&share), "{share}");
    }

    #[test]
    fn every_step_leaves_a_mesh() {
        // Points outside, on hull edges, beyond their ends, inside and on inner edges.
        let points = [
            [0.0, 0.0],
            [4.0, 0.0],
            [0.0, 4.0],
            [2.0, 0.0],
            [6.0, 0.0],
            [-3.0, 0.0],
            [1.0, 1.0],
            [2.0, 2.0],
            [9.0, -9.0],
            [3.0, 1.0],
            [f64::NAN; 2],
        ];
        let mut mesh = crate::mesh::plane::Mesh2::with_vertices(10).unwrap();
        let mut mesh = mesh.patch();
        mesh.triangle([0, 1, 2]);
        let (points, stack) = (&points[..], Vec::new());
        let mut flipper = Flipper {
            points,
            mesh,
            stack,
        };
        let mut near = 0;
        for p in 3..10 {
            near = flipper.insert(p, near).unwrap();
            let taken = flipper.mesh.taken();
            assert_eq!(taken.end, 2 * (p + 1) - 2);
            flipper.mesh.check(taken.end as usize).unwrap();
            assert!(flipper.mesh.corners(near).contains(&p));
            for t in taken {
                let corners = flipper.mesh.corners(t);
                if !corners.contains(&10) {
                    let [a, b, c] = corners.map(|v| points[v as usize]);
                    assert_eq!(orient2d(a, b, c), Sign::Positive);
                }
            }
        }
        assert!(
            flipper.insert(0, near).is_err(),
            "vertex 0 is already in the mesh"
        );
    }
}
