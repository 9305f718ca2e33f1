//! The nearest vertex, by a greedy walk over the edges of a Delaunay triangulation.
//!
//! If a vertex is not the nearest, some Delaunay neighbor is nearer: the segment to the query
//! leaves the vertex's cell through the face to such a neighbor. So a walk that always goes to a
//! nearer neighbor ends at a nearest vertex; it terminates because distances decrease. All nearest
//! vertices lie on an empty circle around the query, and consecutive ones are joined by Delaunay
//! edges, so they are found from one to the next.
//!
//! The last vertex is known to be the nearest only after all of its neighbors are tested, which may
//! be very many. So a walk gives up after a few dozen tests, and boxes over the vertices are used.

use delone_predicates::{Point2, Sign, nearer};

use super::range::squared;
use super::{Batch, Locator, Output, Plane};
use crate::base::arrays::{Side, Triangles};
use crate::base::error::Result;

/// Neighbors that a walk tests. Among uniform points it needs about ten, and boxes cost as much as
/// thirty.
const PATIENCE: usize = 64;
/// How far a walk goes, in lengths of an edge at the last vertex, squared; beyond that the tree of
/// starting points is cheaper.
const REACH: f64 = 64.0;

/// For each query the nearest vertex, the first row of several; -1 if the query is not finite.
pub fn nearest(batch: &Batch) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1, batch.watch)?;
    if batch.locator.given.simplices.is_empty() {
        return Ok(found.into_vec());
    }
    let walk = || Walk {
        locator: &batch.locator,
        here: None,
        last: [f64::NAN; 2],
        reach: 0.0,
        hint: None,
        ties: Vec::new(),
    };
    batch.along(walk, |walk, row, q| {
        found.set(row, walk.nearest(q)?);
        Ok(())
    })?;
    Ok(found.into_vec())
}

/// Answers the queries of a batch one after another.
struct Walk<'a> {
    locator: &'a Locator<'a, Plane, 2, 3>,
    /// A corner at the nearest vertex of the previous query, and that query.
    here: Option<Side>,
    last: Point2,
    reach: f64,
    /// The same for the boxes.
    hint: Option<usize>,
    /// Buffer for vertices that are equally near.
    ties: Vec<Side>,
}

impl Walk<'_> {
    fn nearest(&mut self, q: Point2) -> Result<i32> {
        let mut left = PATIENCE;
        let start = self.start(q);
        if let Some(vertex) = self.walk(start, q, &mut left) {
            return Ok(vertex);
        }
        if let Some(sites) = self.locator.sites_after(PATIENCE)? {
            return Ok(sites.nearest(q, &mut self.hint, nearer));
        }
        let mut left = usize::MAX;
        if let Some(vertex) = self.walk(start, q, &mut left) {
            self.locator.sites_after(usize::MAX - left)?;
            return Ok(vertex);
        }
        // Too many neighbors, or too many equally near vertices: use boxes.
        let sites = self.locator.sites_after(self.locator.given.points.len())?;
        Ok(sites.map_or(-1, |sites| sites.nearest(q, &mut self.hint, nearer)))
    }

    /// A corner near `q`.
    fn start(&self, q: Point2) -> Side {
        // False for NaN, initially and if squares overflow: then the tree gives the start.
        if squared(q, self.last) <= self.reach
            && let Some(here) = self.here
        {
            return here;
        }
        Side {
            simplex: self.locator.near(q),
            corner: 0,
        }
    }

    /// The nearest vertex to `q`, the first row of several, by a walk from `best`; `None` after
    /// `left` neighbors.
    fn walk(&mut self, mut best: Side, q: Point2, left: &mut usize) -> Option<i32> {
        let given = &self.locator.given;
        let at = |side: Side| given.at(side);
        loop {
            let here = at(best);
            let mut closer = None;
            self.ties.clear();
            neighbors(given, best, |side| {
                match nearer(q, at(side), here) {
                    Sign::Positive => closer = Some(side),
                    Sign::Zero => self.ties.push(side),
                    Sign::Negative => {}
                }
                *left -= 1;
                closer.is_none() && *left > 0
            });
            match closer {
                _ if *left == 0 => return None,
                Some(side) => best = side,
                None => break,
            }
        }
        let [a, b, _] = given.corners(best.simplex);
        (self.here, self.last, self.reach) = (Some(best), q, REACH * squared(a, b));
        if self.ties.is_empty() {
            return Some(given.vertex(best));
        }
        first_of_ties(given, best, q, &mut self.ties, left)
    }
}

/// Calls `visit` on the neighbors of the vertex at a corner until it answers `false`; some occur
/// twice.
fn neighbors(given: &Triangles, start: Side, mut visit: impl FnMut(Side) -> bool) {
    given.around(start, |side| {
        let [u, v] = given.ends(side);
        visit(u) && (given.neighbors[side.simplex][u.corner] >= 0 || visit(v))
    });
}

/// The first row among all vertices as near as the one at `start`, if no vertex is nearer; `None`
/// if they are many, or `left` neighbors do not suffice.
#[cold]
fn first_of_ties(
    given: &Triangles,
    start: Side,
    q: Point2,
    open: &mut Vec<Side>,
    left: &mut usize,
) -> Option<i32> {
    let here = given.at(start);
    let mut met = vec![given.vertex(start)];
    while let Some(side) = open.pop() {
        let vertex = given.vertex(side);
        if met.contains(&vertex) {
            continue;
        }
        met.push(vertex);
        neighbors(given, side, |side| {
            let p = given.at(side);
            if nearer(q, p, here) == Sign::Zero {
                open.push(side);
            }
            *left -= 1;
            *left > 0
        });
        if *left == 0 || met.len() > PATIENCE {
            return None;
        }
    }
    met.into_iter().min()
}
