//! The nearest vertex, by a walk over the edges of a Delaunay triangulation.
//!
//! From any vertex that is not the nearest, some Delaunay neighbour is nearer: the segment to the
//! point leaves the vertex's cell through the face to such a one. So a walk that always goes to a
//! nearer neighbour ends at a nearest vertex; distances fall, so it ends. All nearest ones lie on an
//! empty sphere around the point and are the corners of a polytope that tetrahedra fill, so they are
//! found from one to the next.

use delone_predicates::{Point3, Sign, nearer3};

use super::Located;
use super::batch::Batch;
use super::star::{Place, around};
use super::tiling::{Side, Tetrahedra};
use crate::error::Result;
use crate::locate::Output;

/// For each query the nearest vertex, of several the first row; -1 for what is not finite.
pub fn nearest(batch: &Batch) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1)?;
    let given = &batch.locator.given;
    batch.each(
        || (),
        |(), row, q, at| {
            let start = match at {
                Located::Inside(place) => match place.site() {
                    Some(corner) => {
                        let simplex = place.simplex;
                        found.set(row, given.vertex(Side { simplex, corner }));
                        return Ok(());
                    }
                    None => place.simplex,
                },
                Located::Outside(side) => side.simplex,
            };
            found.set(row, nearest_from(given, start, q));
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}

/// The nearest vertex to `q`, on the way from the corners of a tetrahedron.
fn nearest_from(given: &Tetrahedra, simplex: usize, q: Point3) -> i32 {
    let at = |side: Side| given.point(given.vertex(side));
    let mut best = Side { simplex, corner: 0 };
    for corner in 1..4 {
        let side = Side { simplex, corner };
        if nearer3(q, at(side), at(best)) == Sign::Positive {
            best = side;
        }
    }
    loop {
        let here = at(best);
        let mut closer = None;
        let mut ties = Vec::new();
        neighbours(given, best, |side| {
            match nearer3(q, at(side), here) {
                Sign::Positive => closer = Some(side),
                Sign::Zero if given.vertex(side) != given.vertex(best) => ties.push(side),
                _ => {}
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

/// The neighbours of the vertex at a corner, most of them several times, until `visit` answers
/// `false`.
fn neighbours(given: &Tetrahedra, start: Side, mut visit: impl FnMut(Side) -> bool) {
    let place = Place {
        simplex: start.simplex,
        on: std::array::from_fn(|k| k != start.corner),
    };
    around(given, place, |place| {
        place.is_none_or(|Place { simplex, on }| {
            let others = (0..4).filter(|&corner| on[corner]);
            others
                .into_iter()
                .all(|corner| visit(Side { simplex, corner }))
        })
    });
}

/// The first row among all vertices as near as the one at `start`, where that is the least.
#[cold]
fn first_of_ties(given: &Tetrahedra, start: Side, q: Point3, mut open: Vec<Side>) -> i32 {
    let here = given.point(given.vertex(start));
    let mut met = std::collections::HashSet::from([given.vertex(start)]);
    while let Some(side) = open.pop() {
        if !met.insert(given.vertex(side)) {
            continue;
        }
        neighbours(given, side, |side| {
            let vertex = given.vertex(side);
            if !met.contains(&vertex) && nearer3(q, given.point(vertex), here) == Sign::Zero {
                open.push(side);
            }
            true
        });
    }
    met.into_iter().min().unwrap_or(-1)
}
