//! The boundary of a 3-D tiling: whether it is convex, and its nearest point to a query, exactly.
//!
//! For a general boundary all faces are searched (`excess`), for a convex one there is a walk from
//! face to face. From a face that does not have the query behind it, the walk goes on to faces with
//! nearer points: if the foot is on an edge, to the face across it if the query is on that face's
//! side of the edge; if it is a corner x, to a face there that does not have the query behind it
//! and along one of whose edges the query q lies ahead. It terminates because distances decrease.
//! At its end the point is the nearest one of the body. Otherwise some direction d from x into the
//! body has d . (q - x) > 0. As q - x does not point inside, moving from d in that direction leaves
//! the cone of the body at x through a face that does not have q behind it, at a d' with d' . (q -
//! x) > 0; and d' lies between two edges of that face, one of which would have been taken.

use std::sync::OnceLock;

use delone_predicates::{Point3, Sign, orient3d};

use super::excess;
use super::face::on_face;
use super::foot::{Foot, Triangle};
use crate::base::arrays::{OUTWARD, Side, Tetrahedra};
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::{Boxes, kept, outer_sides};

/// Square root of the distance, in sizes of the boundary, up to which rounded distances distinguish
/// faces.
const REMOTE: f64 = 1024.0;

/// Tetrahedra between two checks for interruption.
const LOT: usize = 1 << 16;

/// The boundary faces of a tiling.
#[derive(Debug)]
pub struct Boundary {
    /// Each boundary face, ascending.
    sides: Vec<Side>,
    /// Whether the tetrahedra fill one convex body, so that a point strictly outside a face is
    /// outside all.
    pub convex: bool,
    /// For a convex body: the face across each edge, first across that from the first corner to the
    /// next.
    across: Vec<[u32; 3]>,
    extent: Extent<3>,
    /// The faces in boxes, for nearest-face queries.
    boxes: OnceLock<Boxes<3>>,
}

impl Boundary {
    /// Extracts the boundary from the arrays.
    pub fn of(given: &Tetrahedra, watch: &Watch) -> Result<Self> {
        let sides = outer_sides(given, watch)?;
        let across = across_edges(given, &sides, watch)?;
        let corners = sides.iter().flat_map(|&side| given.face(side));
        Ok(Self {
            extent: Extent::of(corners.map(|v| given.point(v))),
            convex: across.is_some(),
            across: across.unwrap_or_default(),
            sides,
            boxes: OnceLock::new(),
        })
    }

    /// The boundary face nearest to `q`, the first of several, and the weights of its corners in
    /// the nearest point; `last` is the answer for the previous query, which is nearby.
    pub fn nearest(
        &self,
        given: &Tetrahedra,
        q: Point3,
        last: &mut Option<usize>,
        watch: &Watch,
    ) -> Result<Option<(Side, [f64; 3])>> {
        if !self.convex {
            let found = self.of_general_boundary(given, q, *last, watch)?;
            *last = found.map(|(i, _)| i);
            return Ok(found.map(|(i, shares)| (self.sides[i], shares)));
        }
        let in_front = |&i: &usize| self.turn(given, i, q) != Sign::Negative;
        let beyond = |&i: &usize| self.turn(given, i, q) == Sign::Positive;
        let mut start = last.filter(in_front);
        let mut found = None;
        if start.is_none() && !self.is_remote(q) {
            found = self.by_boxes(given, q, *last, watch)?;
            start = found.map(|(i, _)| i).filter(in_front);
        }
        start = start.or_else(|| (0..self.sides.len()).find(beyond));
        found = start.map(|i| self.walk(given, i, q)).or(found);
        *last = found.map(|(i, _)| i);
        Ok(found.map(|(i, shares)| (self.sides[i], shares)))
    }

    /// The same by rounded distances, with boxes.
    fn by_boxes(
        &self,
        given: &Tetrahedra,
        q: Point3,
        last: Option<usize>,
        watch: &Watch,
    ) -> Result<Option<(usize, [f64; 3])>> {
        let corners = |i: usize| given.face(self.sides[i]).map(|v| given.point(v));
        let boxes = self.boxes(given, watch)?;
        Ok(boxes.nearest(q, last, |i, unit| on_face(corners(i), q, unit)))
    }

    /// The same by exact distances, for any boundary.
    fn of_general_boundary(
        &self,
        given: &Tetrahedra,
        q: Point3,
        last: Option<usize>,
        watch: &Watch,
    ) -> Result<Option<(usize, [f64; 3])>> {
        let face = |i: usize| {
            let vertices = given.face(self.sides[i]);
            (vertices, vertices.map(|v| given.point(v)))
        };
        let boxes = self.boxes(given, watch)?;
        Ok(excess::nearest(boxes, &self.extent, q, last, face))
    }

    fn boxes(&self, given: &Tetrahedra, watch: &Watch) -> Result<&Boxes<3>> {
        let corners = |i: usize| given.face(self.sides[i]).map(|v| given.point(v));
        kept(&self.boxes, || {
            Boxes::over(self.sides.len(), |i| Extent::of(corners(i)), watch)
        })
    }

    /// Whether `q` is so far away that rounded distances do not distinguish the faces.
    fn is_remote(&self, q: Point3) -> bool {
        let Extent { min, max } = self.extent;
        let size = |k: usize| max[k] / REMOTE - min[k] / REMOTE;
        let size = (0..3).fold(0.0, |most: f64, k| most.max(size(k)));
        (0..3).any(|k| (q[k] / 4.0 - min[k] / 4.0).abs() > size * (REMOTE / 4.0 * REMOTE))
    }

    /// On which side of a face `q` is; positive is outside.
    fn turn(&self, given: &Tetrahedra, i: usize, q: Point3) -> Sign {
        let [a, b, c] = given.face(self.sides[i]).map(|v| given.point(v));
        orient3d(a, b, c, q)
    }

    /// The face of a convex body nearest to `q`, by a walk from one that does not have `q` behind
    /// it.
    fn walk(&self, given: &Tetrahedra, start: usize, q: Point3) -> (usize, [f64; 3]) {
        let triangle = |i: usize| {
            let face = given.face(self.sides[i]);
            Triangle::new(face.map(|v| given.point(v)), q)
        };
        let mut here = start;
        let first = loop {
            let (foot, first) = match triangle(here).foot() {
                Foot::Face => (None, here),
                Foot::Edge(k) => {
                    let (next, edge) = self.beyond(given, here, k);
                    let nearer = triangle(next).side(edge) == Sign::Positive;
                    (nearer.then_some(next), here.min(next))
                }
                Foot::Corner(k) => {
                    // Rotate around the corner until a face leads to a nearer point.
                    let mut around = (here, k);
                    let mut first = here;
                    let nearer = loop {
                        let (i, k) = around;
                        let face = triangle(i);
                        let ahead = |to: usize| face.along(k, (k + to) % 3) == Sign::Positive;
                        if (ahead(1) || ahead(2)) && self.turn(given, i, q) != Sign::Negative {
                            break Some(i);
                        }
                        first = first.min(i);
                        let (next, edge) = self.beyond(given, i, k);
                        around = (next, (edge + 1) % 3);
                        if next == here {
                            break None;
                        }
                    };
                    (nearer, first)
                }
            };
            match foot {
                Some(next) => here = next,
                None => break first,
            }
        };
        let face = triangle(first);
        (first, face.shares(face.foot()))
    }

    /// The face across edge `k` of another, and the index of the shared edge there.
    fn beyond(&self, given: &Tetrahedra, i: usize, k: usize) -> (usize, usize) {
        let next = self.across[i][k] as usize;
        let start = given.face(self.sides[i])[(k + 1) % 3];
        let face = given.face(self.sides[next]);
        let edge = face.iter().position(|&v| v == start).unwrap_or(0);
        (next, edge)
    }
}

/// The faces across the edges of all boundary faces, if these are one surface that is convex at
/// each edge: then it is the convex hull (Tietze's theorem), and all other tetrahedra are inside
/// it.
fn across_edges(
    given: &Tetrahedra,
    sides: &[Side],
    watch: &Watch,
) -> Result<Option<Vec<[u32; 3]>>> {
    if sides.is_empty() {
        return Ok(None);
    }
    let mut pace = Pace::new(watch, LOT >> 4);
    let mut across = vec![[0; 3]; sides.len()];
    let mut met = vec![false; sides.len()];
    let mut open = vec![0];
    met[0] = true;
    let mut count = 1;
    while let Some(here) = open.pop() {
        let side = sides[here];
        let [a, b, c] = OUTWARD[side.corner].map(|corner| Side { corner, ..side });
        for (k, (u, v, w)) in [(a, b, c), (b, c, a), (c, a, b)].into_iter().enumerate() {
            let (next, steps) = around_edge(given, side, w);
            pace.spend(steps)?;
            let Some(next) = next else {
                return Ok(None);
            };
            let [u, v, w] = [u, v, w].map(|s| given.at(s));
            let shared = given.simplices[side.simplex];
            for corner in OUTWARD[next.corner] {
                let far = given.vertex(Side { corner, ..next });
                // Seen from outside, faces are counterclockwise; positive is outside.
                let beyond = orient3d(u, v, w, given.point(far));
                if !shared.contains(&far) && beyond == Sign::Positive {
                    return Ok(None);
                }
            }
            let Ok(i) = sides.binary_search(&next) else {
                return Ok(None);
            };
            across[here][k] = i as u32;
            if !met[i] {
                met[i] = true;
                count += 1;
                open.push(i);
            }
        }
    }
    Ok((count == sides.len()).then_some(across))
}

/// The boundary face on the other side of the edge of `side` opposite its corner `w`, found through
/// the tetrahedra around the edge, and their number; `None` if they form a cycle.
fn around_edge(given: &Tetrahedra, side: Side, w: Side) -> (Option<Side>, usize) {
    // The edge is opposite the corners side.corner and w.corner: leave through the face opposite w.
    let mut exit = w.corner;
    let mut entry = side.corner;
    let mut simplex = side.simplex;
    for step in 1..=given.simplices.len() {
        let leave = Side {
            simplex,
            corner: exit,
        };
        let Some(next) = given.beyond(leave) else {
            return (Some(leave), step);
        };
        // In the next one the edge is opposite the corner across and the vertex at the old entry.
        let pivot = given.simplices[simplex][entry];
        let corners = given.simplices[next.simplex];
        let Some(corner) = corners.iter().position(|&v| v == pivot) else {
            return (None, step);
        };
        exit = corner;
        entry = next.corner;
        simplex = next.simplex;
    }
    (None, given.simplices.len())
}
