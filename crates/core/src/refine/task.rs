//! What is to be refined, and what has been.

use delone_predicates::Point2;

use crate::error::Result;

/// Straight lines that segments have been cut from before, as an earlier refinement does it.
#[derive(Debug, Clone, Copy)]
pub struct Lines<'a> {
    /// The line of each segment.
    pub of: &'a [i32],
    /// The two ends of each line, as vertices.
    pub ends: &'a [[u32; 2]],
    /// For each row of points the line that it was put on, or -1.
    pub on: &'a [i32],
}

/// Called now and then with the number of vertices added and a way to ask for the smallest angle that
/// there is now, in degrees; an error ends the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize, &mut dyn FnMut() -> f64) -> Result<()>;

/// A constrained triangulation to be refined, and how.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates.
    pub points: &'a [Point2],
    /// Triangles that tile the hull of the points.
    pub simplices: &'a [[i32; 3]],
    /// For each, a label of its part of the domain, the same on both sides of each edge that is no
    /// segment; below 0 outside.
    pub labels: &'a [i32],
    /// For each, the largest area that its part may keep.
    pub areas: &'a [f64],
    /// Edges that are kept, as vertices.
    pub segments: &'a [[u32; 2]],
    /// The lines that they are parts of; without it each is its own.
    pub lines: Option<Lines<'a>>,
    /// For each line, whether it may not be split.
    pub frozen: &'a [bool],
    /// No smaller angle is left, in degrees; below 60.
    pub min_angle: f64,
    /// Whether the circles over subsegments are emptied, not only lenses: then all triangles are
    /// Delaunay, also across segments.
    pub circles: bool,
    /// Whether a triangle may stay too large where only a vertex beside a frozen line would make it
    /// smaller; otherwise that vertex is inserted, however thin the triangles there become.
    pub sizes_yield: bool,
    /// Most vertices that may be added.
    pub max_vertices: usize,
}

/// Which vertices were added for what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// On segments.
    pub segment: usize,
    /// Inside, for angles.
    pub angle: usize,
    /// Inside, for sizes.
    pub size: usize,
}

/// A refined triangulation of the hull, in rows of the points given, added vertices behind them.
#[derive(Debug)]
pub struct Refined {
    /// Vertices added.
    pub added: Vec<Point2>,
    /// For each of those, the line that it lies on, or -1.
    pub on: Vec<i32>,
    /// Triangles.
    pub simplices: Vec<[i32; 3]>,
    /// The triangle opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 3]>,
    /// For each corner the line that the edge opposite is a part of, or -1.
    pub sides: Vec<[i32; 3]>,
    /// The label of each triangle; -1 outside of the domain.
    pub labels: Vec<i32>,
    /// For each triangle the number of the needle that it was left in, or -1.
    pub needles: Vec<i32>,
    /// Vertices by cause.
    pub counts: Counts,
    /// Whether the limit on vertices ended it.
    pub exhausted: bool,
}
