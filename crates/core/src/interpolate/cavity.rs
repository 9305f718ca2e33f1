//! The cavity of a query: the Delaunay triangles whose circles have it inside, which are those that
//! its insertion would remove (A. Bowyer and D. F. Watson, both 1981).
//!
//! Strictly inside counts. That is enough on any Delaunay triangulation, however cocircular
//! polygons are cut: the triangles are connected through their edges, the query sees each boundary
//! edge from strictly inside (one on the line of such an edge would be in the circle beyond, too),
//! and triangles left out for a tie would take no area from anyone. No vertex is inside the cavity,
//! so its triangles form a tree, and each adds one vertex to the boundary. A barrier ends the cavity
//! like the hull; the triangles are then Delaunay among what the query can see.

use delone_predicates::{Point2, Sign, incircle};

use crate::arrays::Triangles;
use crate::error::{Error, Result};
use crate::locate::{Side, next, prev};
use crate::watch::Pace;

/// Edges that are closed, by the corner opposite; empty where none is.
pub type Barrier<'a> = &'a [[bool; 3]];

/// Whether the edge opposite a corner is closed.
#[inline]
pub fn is_closed(barrier: Barrier, side: Side) -> bool {
    barrier
        .get(side.triangle)
        .is_some_and(|row| row[side.corner])
}

/// A cavity. Its vertices have slots, in the order found.
#[derive(Debug, Default)]
pub struct Cavity {
    /// The vertex in each slot.
    pub vertices: Vec<i32>,
    /// Its coordinates.
    pub points: Vec<Point2>,
    /// The triangles, by slots, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The boundary, by slots, counter-clockwise.
    pub ring: Vec<u32>,
    /// Which edge of the ring has the query on it, by the slot it starts at: a closed edge.
    pub flat: Option<u32>,
    /// Edges to look beyond, with the slots of their ends, the cavity on their left.
    open: Vec<(Side, u32, u32)>,
}

impl Cavity {
    /// Finds the cavity of `q`, which is in the closed triangle `seed`, on its edge opposite `on`
    /// where there is such, and at no vertex. The triangles count as work.
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
        // The last comes first: the edge from slot 0 to slot 1.
        for k in [1, 0, 2] {
            let side = Side {
                triangle: seed,
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
                if side.triangle == seed && on == Some(side.corner) {
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
                    "natural neighbours need a Delaunay triangulation".into(),
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
