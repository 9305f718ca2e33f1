//! The points that are not vertices, and the triangles among which they are divided.

use delone_predicates::{Point2, lexicographic};

use super::plane::{NONE, Plane, Raised, below};
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::constrained::marked::Marked;
use crate::mesh::plane::{Code, next, prev, triangle};

/// Points by number, and those of each triangle.
pub trait Points {
    /// A point that is not a vertex.
    fn raised(&self, i: u32) -> Raised;

    /// The row of a point.
    fn row(&self, i: u32) -> u32;

    /// Whether a point is lexicographically smaller than another.
    fn is_smaller(&self, i: u32, j: u32) -> bool;

    /// Judges all points of a triangle.
    fn judge(&self, wedge: &mut Wedge, pace: &mut Pace) -> Result<()>;

    /// Divides the points of the triangles of a star among them and judges them, after a point at its center
    /// `became` a vertex.
    fn spread(&mut self, became: u32, star: &mut Star, pace: &mut Pace) -> Result<()>;
}

/// A triangle, and the worst of its points that were judged.
#[derive(Debug)]
pub struct Wedge {
    pub triangle: u32,
    pub vertices: [u32; 3],
    /// Its corners counterclockwise; in a star, the center is first.
    pub corners: [Point2; 3],
    pub plane: Plane,
    /// The greatest offset so far, below 0 before the first point; and the point that has it.
    pub offset: f64,
    pub worst: u32,
}

/// The triangles around a vertex, counterclockwise.
#[derive(Debug, Default)]
pub struct Star {
    pub wedges: Vec<Wedge>,
    /// Whether they go all around.
    pub closed: bool,
    /// Whether signs are computed without rounding.
    pub exact: bool,
}

impl Wedge {
    /// The triangle of a corner, seen from there, before any point is judged.
    pub fn of(corner: Code, marked: &mut Marked, heights: &[f64], exact: bool) -> Self {
        let triangles = marked.triangles();
        let mesh = marked.mesh.resume(triangles);
        let vertices = [corner, next(corner), prev(corner)].map(|c| mesh.vertex(c));
        let corners = vertices.map(|v| {
            let [x, y] = marked.points[v as usize];
            [x, y, heights.get(v as usize).copied().unwrap_or(f64::NAN)]
        });
        Self {
            triangle: triangle(corner),
            vertices,
            corners: corners.map(below),
            plane: Plane::of(corners, exact),
            offset: -1.0,
            worst: NONE,
        }
    }

    /// Compares a point with the worst one so far; of equal ones the smaller counts.
    #[inline]
    pub fn meet(&mut self, i: u32, points: impl Fn(u32) -> Raised) {
        let point = points(i);
        let mut offset = self.plane.offset(point);
        if offset < self.offset {
            return;
        }
        if offset.is_nan() {
            offset = f64::INFINITY;
        }
        let first = |other: u32| lexicographic(below(point), below(points(other))).is_lt();
        if offset > self.offset || (offset == self.offset && first(self.worst)) {
            (self.offset, self.worst) = (offset, i);
        }
    }
}
