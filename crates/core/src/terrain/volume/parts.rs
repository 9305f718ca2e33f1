//! The input of all steps of an overlay.

use crate::base::arrays::Triangles;
use delone_predicates::Point2;

/// A triangulated surface.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// Its triangles.
    pub given: Triangles<'a>,
    /// The height of each point.
    pub heights: &'a [f64],
}

impl Surface<'_> {
    /// The heights of the corners of a triangle.
    pub fn heights_of(&self, t: usize) -> [f64; 3] {
        self.given.simplices[t].map(|v| self.heights[v as usize])
    }
}

/// The center of a triangle, rounded.
pub fn center(corners: [Point2; 3]) -> Point2 {
    std::array::from_fn(|k| corners.iter().map(|p| p[k] / 3.0).sum())
}
