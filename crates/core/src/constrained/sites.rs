//! What the insertion of segments needs to know about vertices: the plane and the sphere differ
//! only in this.
//!
//! In the plane segments are straight; on the sphere they are the shorter arcs of great circles. The
//! arguments of `segment` carry over. The vertices on one side of an arc are in an open half-space,
//! whose central projection to a plane keeps the sides of all great circles; tilted slightly toward the
//! middle of the arc, it holds the ends, too. So each half of a cavity is a polygon in a plane.

use delone_predicates::{Point2, Sign, incircle_canonical, lexicographic, orient2d};

/// Vertices by number.
pub trait Sites {
    /// Whether three turn left.
    fn orient(&self, vertices: [u32; 3]) -> Sign;
    /// Whether the last of four lies in the circle of the others, which turn left. Ties are broken
    /// canonically.
    fn in_circle(&self, vertices: [u32; 4]) -> bool;
    /// Whether `v`, on the line through `a` and `b`, is seen from a in the direction of b.
    fn ahead(&self, a: u32, b: u32, v: u32) -> bool;
}

impl Sites for Vec<Point2> {
    #[inline]
    fn orient(&self, vertices: [u32; 3]) -> Sign {
        let [a, b, c] = vertices.map(|v| self[v as usize]);
        orient2d(a, b, c)
    }

    #[inline]
    fn in_circle(&self, vertices: [u32; 4]) -> bool {
        let [a, b, c, d] = vertices.map(|v| self[v as usize]);
        incircle_canonical(a, b, c, d) == Sign::Positive
    }

    #[inline]
    fn ahead(&self, a: u32, b: u32, v: u32) -> bool {
        let [a, b, v] = [a, b, v].map(|v| self[v as usize]);
        lexicographic(a, b) == lexicographic(a, v)
    }
}
