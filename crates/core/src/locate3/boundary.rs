//! The boundary of a tiling: whether it is convex, and its nearest point.

use std::sync::OnceLock;

use delone_predicates::{Point3, Sign, orient3d};

use super::face::on_face;
use super::tiling::{FACES, Side, Tetrahedra};
use crate::error::Result;
use crate::locate::{Boxes, kept};
use crate::points::Extent;

/// The boundary faces of a tiling.
#[derive(Debug)]
pub struct Boundary {
    /// Each boundary face, ascending.
    sides: Vec<Side>,
    /// Whether the tetrahedra fill one convex body, so that nothing lies beyond what is strictly
    /// outside.
    pub convex: bool,
    /// The faces by place, for the nearest one.
    boxes: OnceLock<Boxes<3>>,
}

impl Boundary {
    /// Reads the boundary off the arrays.
    pub fn of(given: &Tetrahedra) -> Self {
        let sides: Vec<Side> = given.boundary().collect();
        Self {
            convex: is_convex(given, &sides),
            sides,
            boxes: OnceLock::new(),
        }
    }

    /// The boundary face with the nearest point to `q`, and how its corners share in that; `last` is the
    /// one before, of a query near by.
    pub fn nearest(
        &self,
        given: &Tetrahedra,
        q: Point3,
        last: &mut Option<usize>,
    ) -> Result<Option<(Side, [f64; 3])>> {
        let corners = |i: usize| given.face(self.sides[i]).map(|v| given.point(v));
        let boxes = kept(&self.boxes, || {
            Boxes::over(self.sides.len(), |i| Extent::of(corners(i)))
        })?;
        let found = boxes.nearest(q, *last, |i, unit| on_face(corners(i), q, unit));
        *last = found.map(|(i, _)| i);
        Ok(found.map(|(i, shares)| (self.sides[i], shares)))
    }
}

/// Whether the boundary faces are one surface that is convex at each edge: then it is the convex hull
/// (Tietze's theorem), and all other tetrahedra are inside of it.
fn is_convex(given: &Tetrahedra, sides: &[Side]) -> bool {
    let Some(&first) = sides.first() else {
        return false;
    };
    let mut met = vec![false; sides.len()];
    let mut open = vec![first];
    met[0] = true;
    let mut count = 1;
    while let Some(side) = open.pop() {
        let [a, b, c] = FACES[side.corner].map(|corner| Side { corner, ..side });
        for (u, v, w) in [(a, b, c), (b, c, a), (c, a, b)] {
            let Some(next) = around_edge(given, side, w) else {
                return false;
            };
            let [u, v, w] = [u, v, w].map(|s| given.point(given.vertex(s)));
            let shared = given.simplices[side.simplex];
            for corner in FACES[next.corner] {
                let far = given.vertex(Side { corner, ..next });
                // Seen from outside, faces are counter-clockwise; what is positive is beyond.
                let beyond = orient3d(u, v, w, given.point(far));
                if !shared.contains(&far) && beyond == Sign::Positive {
                    return false;
                }
            }
            let Ok(i) = sides.binary_search(&next) else {
                return false;
            };
            if !met[i] {
                met[i] = true;
                count += 1;
                open.push(next);
            }
        }
    }
    count == sides.len()
}

/// The boundary face on the other side of the edge of `side` opposite its corner `w`, through the
/// tetrahedra around the edge; nothing where these go in circles.
fn around_edge(given: &Tetrahedra, side: Side, w: Side) -> Option<Side> {
    // The edge is opposite the corners side.corner and w.corner: leave across the face opposite w.
    let mut exit = w.corner;
    let mut entry = side.corner;
    let mut simplex = side.simplex;
    for _ in 0..given.simplices.len() {
        let leave = Side {
            simplex,
            corner: exit,
        };
        let Some(next) = given.beyond(leave) else {
            return Some(leave);
        };
        // In the next one the edge is opposite the corner across, and the vertex at the old entry.
        let pivot = given.simplices[simplex][entry];
        exit = given.simplices[next.simplex]
            .iter()
            .position(|&v| v == pivot)?;
        entry = next.corner;
        simplex = next.simplex;
    }
    None
}
