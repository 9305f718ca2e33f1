//! The input and the result of a simplification.

use delone_predicates::Point2;

use crate::base::arrays::Triangles;

/// A surface to simplify.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// The constrained Delaunay triangulation of the vertices that stay, all of which it uses; it tiles
    /// their hull.
    pub coarse: Triangles<'a>,
    /// The heights of these.
    pub heights: &'a [f64],
    /// Edges that stay, as pairs of vertices. No other point lies on them.
    pub segments: &'a [[u32; 2]],
    /// How many triangles are part of the surface; all other points lie in these.
    pub triangles: usize,
    /// The other points, each once.
    pub points: &'a [Point2],
    /// Their heights.
    pub z: &'a [f64],
    /// The insertion ends when no point is farther from the surface.
    pub max_error: f64,
    /// It ends before there are more triangles.
    pub max_triangles: usize,
    /// The number of threads for sorting and locating points.
    pub workers: usize,
}

/// The points in the order of their insertion.
#[derive(Debug, Default)]
pub struct Simplified {
    /// The points that are inserted, as rows.
    pub order: Vec<i32>,
    /// A bound on the distance of all points before the first insertion and after each.
    pub errors: Vec<f64>,
    /// The number of triangles before the first insertion and after each.
    pub triangles: Vec<i32>,
}
