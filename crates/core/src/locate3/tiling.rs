//! Exported arrays as a 3-D tiling: steps from tetrahedron to tetrahedron across faces.

use std::ops::Range;

use delone_predicates::{Point3, Sign, orient3d};

pub use crate::arrays::OUTWARD as FACES;

pub use crate::arrays::Tetrahedra;

/// A corner of a tetrahedron, and the opposite face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The tetrahedron.
    pub simplex: usize,
    /// The corner, 0 to 3.
    pub corner: usize,
}

impl Tetrahedra<'_> {
    /// The vertex at a corner.
    #[inline]
    pub fn vertex(&self, side: Side) -> i32 {
        self.simplices[side.simplex][side.corner]
    }

    /// The same face seen from the tetrahedron beyond; `None` at the boundary.
    #[inline]
    pub fn beyond(&self, side: Side) -> Option<Side> {
        let t = self.neighbors[side.simplex][side.corner];
        if t < 0 {
            return None;
        }
        let back = &self.neighbors[t as usize];
        let here = side.simplex as i32;
        // Invalid arrays, in which no face is shared, must not lead out of range.
        let corner = back.iter().position(|&s| s == here).unwrap_or(3);
        Some(Side {
            simplex: t as usize,
            corner,
        })
    }

    /// On which side of the face opposite each corner `q` is: positive is inside.
    #[inline]
    pub fn sides(&self, t: usize, q: Point3) -> [Sign; 4] {
        let [a, b, c, d] = self.corners(t);
        [
            orient3d(q, b, c, d),
            orient3d(a, q, c, d),
            orient3d(a, b, q, d),
            orient3d(a, b, c, q),
        ]
    }

    /// The vertices of the face opposite a corner, counterclockwise seen from outside.
    #[inline]
    pub fn face(&self, side: Side) -> [i32; 3] {
        FACES[side.corner].map(|corner| self.vertex(Side { corner, ..side }))
    }

    /// The boundary faces of some tetrahedra.
    pub fn boundary(&self, simplices: Range<usize>) -> impl Iterator<Item = Side> {
        simplices.flat_map(move |simplex| {
            let outer = (0..4).filter(move |&corner| self.neighbors[simplex][corner] < 0);
            outer.map(move |corner| Side { simplex, corner })
        })
    }
}
