//! The nearest vertex, by a walk over the edges of a Delaunay triangulation.
//!
//! From any vertex that is not the nearest, some Delaunay neighbour is nearer: the segment to the
//! point leaves the vertex's cell through the face to such a one. So a walk that always goes to a
//! nearer neighbour ends at a nearest vertex; distances fall, so it ends. All nearest ones lie on an
//! empty circle around the point, whose polygon has Delaunay edges alone, so they are found from one
//! to the next.

use delone_predicates::{Point2, Sign, nearer};

use super::tiling::{Side, next, prev};
use super::{Batch, Located, Output};
use crate::arrays::Triangles;
use crate::error::Result;

/// For each query the nearest vertex, of several the first row; -1 for what is not finite.
pub fn nearest(batch: &Batch) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1)?;
    let given = &batch.locator.given;
    batch.each(Vec::new, |ties, row, q, at| {
        let start = match at {
            Located::Inside(place) => match place.site() {
                Some(corner) => {
                    let triangle = place.triangle;
                    found.set(row, given.vertex(Side { triangle, corner }));
                    return Ok(());
                }
                None => place.triangle,
            },
            Located::Outside(side) => side.triangle,
        };
        found.set(row, nearest_from(given, start, q, ties));
        Ok(())
    })?;
    Ok(found.into_vec())
}

/// The nearest vertex to `q`, on the way from the corners of a triangle; `ties` is scratch room.
fn nearest_from(given: &Triangles, triangle: usize, q: Point2, ties: &mut Vec<Side>) -> i32 {
    let at = |side: Side| given.point(given.vertex(side));
    let mut best = Side {
        triangle,
        corner: 0,
    };
    for corner in 1..3 {
        let side = Side { triangle, corner };
        if nearer(q, at(side), at(best)) == Sign::Positive {
            best = side;
        }
    }
    loop {
        let here = at(best);
        let mut closer = None;
        ties.clear();
        neighbours(given, best, |side| {
            match nearer(q, at(side), here) {
                Sign::Positive => closer = Some(side),
                Sign::Zero => ties.push(side),
                Sign::Negative => {}
            }
            closer.is_none()
        });
        match closer {
            Some(side) => best = side,
            None if ties.is_empty() => return given.vertex(best),
            None => return first_of_ties(given, best, q, ties),
        }
    }
}

/// The neighbours of the vertex at a corner, until `visit` answers `false`; some twice.
fn neighbours(given: &Triangles, start: Side, mut visit: impl FnMut(Side) -> bool) {
    given.around(start, |side| {
        let [u, v] = [next(side.corner), prev(side.corner)].map(|corner| Side { corner, ..side });
        visit(u) && (given.neighbors[side.triangle][u.corner] >= 0 || visit(v))
    });
}

/// The first row among all vertices as near as the one at `start`, where that is the least.
#[cold]
fn first_of_ties(given: &Triangles, start: Side, q: Point2, open: &mut Vec<Side>) -> i32 {
    let here = given.point(given.vertex(start));
    let mut met = vec![given.vertex(start)];
    while let Some(side) = open.pop() {
        let vertex = given.vertex(side);
        if met.contains(&vertex) {
            continue;
        }
        met.push(vertex);
        neighbours(given, side, |side| {
            let p = given.point(given.vertex(side));
            if nearer(q, p, here) == Sign::Zero {
                open.push(side);
            }
            true
        });
    }
    met.into_iter().min().unwrap_or(-1)
}
