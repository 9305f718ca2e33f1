//! The input and the result of a refinement.

use delone_predicates::Point2;

use crate::base::error::Result;

/// Lines that the segments are parts of, for example after an earlier refinement.
#[derive(Debug, Clone, Copy)]
pub struct Lines<'a> {
    /// The line of each segment.
    pub of: &'a [i32],
    /// The two ends of each line, as vertices.
    pub ends: &'a [[u32; 2]],
    /// For each row of points the line on which it was placed, or -1.
    pub on: &'a [i32],
}

/// Called at intervals with the number of added vertices and a function that returns the current
/// smallest angle in degrees; an error ends the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize, &mut dyn FnMut() -> f64) -> Result<()>;

/// A constrained triangulation to refine, and options.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates.
    pub points: &'a [Point2],
    /// Triangles that tile the hull of the points.
    pub simplices: &'a [[i32; 3]],
    /// The triangle opposite each corner, -1 outside; found if not given.
    pub neighbors: Option<&'a [[i32; 3]]>,
    /// For each triangle, the label of its region, which is the same on both sides of each edge
    /// that is not a segment; negative outside.
    pub labels: &'a [i32],
    /// For each triangle, the largest area allowed in its region.
    pub areas: &'a [f64],
    /// Edges that are kept, as pairs of vertices.
    pub segments: &'a [[u32; 2]],
    /// The lines of which they are parts; without it each segment is its own line.
    pub lines: Option<Lines<'a>>,
    /// For each line, whether splitting it is forbidden.
    pub frozen: &'a [bool],
    /// The smallest allowed angle, in degrees; below 60.
    pub min_angle: f64,
    /// Whether the diametral circles of subsegments must be empty, not only their lenses: then all
    /// triangles are Delaunay, even across segments.
    pub circles: bool,
    /// Whether a triangle may stay too large if only a vertex next to a fixed line would make it
    /// smaller; otherwise that vertex is inserted, however thin the triangles there become.
    pub sizes_yield: bool,
    /// The limit on added vertices.
    pub max_vertices: usize,
}

/// The options of a [`Task`] that refinement needs until its end.
#[derive(Debug)]
pub struct Rules {
    /// For each line, whether splitting it is forbidden.
    pub frozen: Vec<bool>,
    /// See [`Task`].
    pub min_angle: f64,
    /// See [`Task`].
    pub circles: bool,
    /// See [`Task`].
    pub sizes_yield: bool,
    /// The limit on added vertices.
    pub max_vertices: usize,
}

/// The number of vertices added for each reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// On segments.
    pub segment: usize,
    /// Inside, for angles.
    pub angle: usize,
    /// Inside, for sizes.
    pub size: usize,
}

/// A refined triangulation of the hull, in rows of the given points, with added vertices after
/// them.
#[derive(Debug)]
pub struct Refined {
    /// Vertices added.
    pub added: Vec<Point2>,
    /// For each of those, the line on which it lies, or -1.
    pub on: Vec<i32>,
    /// Triangles.
    pub simplices: Vec<[i32; 3]>,
    /// The triangle opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 3]>,
    /// For each corner the line of which the opposite edge is a part, or -1.
    pub sides: Vec<[i32; 3]>,
    /// The label of each triangle; -1 outside the domain.
    pub labels: Vec<i32>,
    /// For each triangle the number of the needle in which it was left, or -1.
    pub needles: Vec<i32>,
    /// Vertices by reason.
    pub counts: Counts,
    /// Whether the limit on vertices ended the refinement.
    pub exhausted: bool,
}
