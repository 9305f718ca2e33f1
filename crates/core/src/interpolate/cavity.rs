//! The cavity of a query: the Delaunay triangles whose circumcircles contain it.
//!
//! These are the triangles that its insertion would remove (A. Bowyer and D. F. Watson, both 1981).
//!
//! Only points strictly inside count. That suffices on any Delaunay triangulation, however
//! cocircular polygons are triangulated: the triangles are connected through their edges, the query
//! sees each boundary edge from strictly inside (a query on the line of such an edge would be in
//! the circle beyond, too), and triangles left out because of a tie would contribute no area. No
//! vertex is inside the cavity, so its triangles form a tree, and each adds one vertex to the
//! boundary. A barrier bounds the cavity like the hull; the triangles are then constrained
//! Delaunay.

use delone_predicates::{Point2, Sign, incircle};

use crate::base::arrays::{Side, Triangles};
use crate::base::error::{Error, Result};
use crate::base::watch::Pace;
use crate::locate::{next, prev};

/// Edges that are closed, by the opposite corner; empty if there are none.
pub type Barrier<'a> = &'a [[bool; 3]];

/// Whether the edge opposite a corner is closed.
#[inline]
pub fn is_closed(barrier: Barrier, side: Side) -> bool {
    barrier
        .get(side.simplex)
        .is_some_and(|row| row[side.corner])
}

/// A cavity. Its vertices have slots, in the order in which they were found.
#[derive(Debug, Default)]
pub struct Cavity {
    /// The vertex in each slot.
    pub vertices: Vec<i32>,
    /// Its coordinates.
    pub points: Vec<Point2>,
    /// The triangles, by slots, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The boundary, by slots, counterclockwise.
    pub ring: Vec<u32>,
    /// The edge of the ring, by the slot at which it starts, that is closed and contains the query.
    pub flat: Option<u32>,
    /// Edges yet to be crossed, with the slots of their ends, and the cavity on their left.
    open: Vec<(Side, u32, u32)>,
}

impl Cavity {
    /// Finds the cavity of `q`, which is in the closed triangle `seed`, on its edge opposite `on`
    /// if given, and not at a vertex. The triangles count as work.
    pub fn find(
        &mut self,
        given: &Triangles,
        barrier: Barrier,
        seed: usize,
        on: Option<usize>,
        q: Point2,
        pace: &mut Pace,
    ) -> Result<()> {
        self.vertices.clear();
        self.points.clear();
        self.triangles.clear();
        self.ring.clear();
        self.flat = None;
        self.open.clear();
        self.vertices.extend_from_slice(&given.simplices[seed]);
        self.points.extend_from_slice(&given.corners(seed));
        self.triangles.push([0, 1, 2]);
        // Pushed in reverse: the edge from slot 0 to slot 1 is popped first.
        for k in [1, 0, 2] {
            let side = Side {
                simplex: seed,
                corner: k,
            };
            self.open.push((side, next(k) as u32, prev(k) as u32));
        }
        while let Some((side, u, v)) = self.open.pop() {
            let beyond = if is_closed(barrier, side) {
                None
            } else {
                given.beyond(side)
            };
            let Some(there) = beyond else {
                if side.simplex == seed && on == Some(side.corner) {
                    self.flat = Some(u);
                }
                self.ring.push(u);
                continue;
            };
            let vertex = given.vertex(there);
            let p = given.point(vertex);
            let (pu, pv) = (self.points[u as usize], self.points[v as usize]);
            if incircle(pv, pu, p, q) != Sign::Positive {
                self.ring.push(u);
                continue;
            }
            if self.triangles.len() > given.simplices.len() {
                self.open.clear();
                return Err(Error::Internal(
                    "natural neighbors need a Delaunay triangulation".into(),
                ));
            }
            pace.spend(1)?;
            let w = self.vertices.len() as u32;
            self.vertices.push(vertex);
            self.points.push(p);
            self.triangles.push([w, v, u]);
            let side = |corner| Side { corner, ..there };
            self.open.push((side(prev(there.corner)), w, v));
            self.open.push((side(next(there.corner)), u, w));
        }
        Ok(())
    }
}
