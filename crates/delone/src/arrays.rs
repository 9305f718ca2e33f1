//! What this crate computes as plain arrays, without copies: rows are integers of 32 bits, as NumPy,
//! file formats and graphics cards take them. The Python package is built on these.
//!
//! | arrays | from |
//! |---|---|
//! | corners and neighbors of simplices | [`Tiling::into_arrays`](crate::Tiling::into_arrays) |
//! | [`Segments`] | [`Constrained::into_parts`](crate::Constrained::into_parts) |
//! | [`Diagram2`], [`Diagram3`] | `from` a [`Voronoi`](crate::Voronoi) |
//! | [`Filled`] | [`Options::fill`](crate::Options::fill) |
//! | [`Refined`], for a [`Domain`] | [`Options::refine`](crate::Options::refine) |
//! | [`Rounds`], for a [`Domain`] | [`Options::rounds`](crate::Options::rounds) |
//!
//! The other way, [`Tiling::from_arrays`](crate::Tiling::from_arrays) borrows such arrays.

use delone_core::error::Result as CoreResult;
use delone_core::refine::{Task, refine_telling};
use delone_core::watch::Watch;

use crate::checks::{has_length, in_range};
use crate::{Options, Point2, Result};

pub use delone_core::constrained::{Filled, Rule};
pub use delone_core::refine::{Fresh, Lines, Refined, Rounds, Samples};
pub use delone_core::voronoi::Diagram as Diagram2;
pub use delone_core::voronoi3::Diagram as Diagram3;

/// What segments have become: subsegments, each with the segments that cover it, in the order of the
/// first of these and directed as it is.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct Segments {
    /// The two vertices of each subsegment.
    pub ends: Vec<[i32; 2]>,
    /// Where the segments of each begin in `sources`, and the end.
    pub starts: Vec<i64>,
    /// The rows of the segments that cover each, ascending.
    pub sources: Vec<i32>,
    /// For each of these, whether it has the direction of the subsegment.
    pub forward: Vec<bool>,
    /// The rows of segments whose ends coincide.
    pub zero: Vec<u32>,
    /// `[segment, row]`: points of the input inside segments, ascending.
    pub through: Vec<[u32; 2]>,
    /// `[segment, segment, vertex]`: segments that crossed, and the vertex where they do, ascending.
    pub crossings: Vec<[u32; 3]>,
}

/// Triangles to refine, as arrays: they tile the convex hull of the points, and each has a label and
/// a largest area.
#[derive(Debug, Clone, Copy, Default)]
pub struct Domain<'a> {
    /// The points.
    pub points: &'a [Point2],
    /// Triangles that tile the convex hull, as rows of the points.
    pub simplices: &'a [[i32; 3]],
    /// The triangle opposite each corner, -1 outside; found if not given.
    pub neighbors: Option<&'a [[i32; 3]]>,
    /// For each triangle, the label of its region, which is the same on both sides of each edge that
    /// is not a segment; negative outside of the domain.
    pub labels: &'a [i32],
    /// For each triangle, the largest area of triangles in its region.
    pub areas: &'a [f64],
    /// Edges that are kept, as rows of the points.
    pub segments: &'a [[u32; 2]],
    /// The lines of which they are parts; without it each segment is its own line.
    pub lines: Option<Lines<'a>>,
    /// For each line, whether it must not be split.
    pub frozen: &'a [bool],
    /// Whether the diametral circles of subsegments must be empty, not only their lenses: then all
    /// triangles are Delaunay, even across segments.
    pub circles: bool,
    /// Whether a triangle may stay too large if only a vertex next to a frozen line would make it
    /// smaller; otherwise that vertex is inserted, however thin the triangles there become.
    pub sizes_yield: bool,
}

impl Domain<'_> {
    pub(crate) fn check(&self) -> Result<()> {
        let (points, triangles) = (self.points.len(), self.simplices.len());
        in_range(self.simplices, 0, points, "simplices")?;
        if let Some(neighbors) = self.neighbors {
            has_length(neighbors, triangles, "neighbors")?;
            in_range(neighbors, -1, triangles, "neighbors")?;
        }
        has_length(self.labels, triangles, "labels")?;
        in_range(self.segments, 0, points, "segments")?;
        let Some(lines) = self.lines else {
            return has_length(self.frozen, self.segments.len(), "frozen");
        };
        has_length(self.frozen, lines.ends.len(), "frozen")?;
        has_length(lines.of, self.segments.len(), "of")?;
        in_range(lines.of.as_chunks::<1>().0, 0, lines.ends.len(), "of")?;
        has_length(lines.on, points, "on")?;
        in_range(lines.on.as_chunks::<1>().0, -1, lines.ends.len(), "on")?;
        in_range(lines.ends, 0, points, "ends")
    }

    pub(crate) fn task(&self, options: &Options) -> Task<'_> {
        Task {
            points: self.points,
            simplices: self.simplices,
            neighbors: self.neighbors,
            labels: self.labels,
            areas: self.areas,
            segments: self.segments,
            lines: self.lines,
            frozen: self.frozen,
            min_angle: options.min_angle,
            circles: self.circles,
            sizes_yield: self.sizes_yield,
            max_vertices: options.most_refined(),
        }
    }

    pub(crate) fn refined(self, options: &Options, watch: &Watch) -> CoreResult<Refined> {
        let mut tell = |added: usize, smallest: &mut dyn FnMut() -> f64| {
            if let Some(progress) = options.progress {
                progress(added, smallest);
            }
            watch.check()
        };
        refine_telling(self.task(options), watch, &mut tell)
    }
}
