//! What is to be improved, and what has been.

use delone_predicates::Point3;

use crate::error::Result;

/// Tetrahedra to be improved, and how.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates, finite.
    pub points: &'a [Point3],
    /// Positively oriented tetrahedra that do not overlap.
    pub simplices: &'a [[i32; 4]],
    /// A label of each; faces between labels stay. Empty where all have one.
    pub labels: &'a [i32],
    /// For each row, whether it stays where it is. Empty where none must.
    pub fixed: &'a [bool],
    /// Tetrahedra with a smaller dihedral angle are worked on, in degrees; and with an obtuse angle
    /// of a smaller weighted sine.
    pub min_angle: f64,
    /// Whether edges and faces are removed.
    pub flips: bool,
    /// Whether vertices move.
    pub smooth: bool,
    /// Whether vertices inside get weights, before all else.
    pub exude: bool,
    /// Whether faces of the boundary in one plane may be flipped.
    pub turn: bool,
    /// Most passes.
    pub passes: usize,
}

/// Changes by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Edges removed.
    pub edges: usize,
    /// Edges of the boundary among them.
    pub boundary: usize,
    /// Removals of faces.
    pub faces: usize,
    /// Moves of vertices.
    pub moves: usize,
    /// Weights given.
    pub weights: usize,
    /// Passes.
    pub passes: usize,
    /// Changes that would have raised the worst quality and were not made: a smallest angle would
    /// have become smaller, or rounding did not allow to tell.
    pub refused: usize,
}

/// Improved tetrahedra.
#[derive(Debug)]
pub struct Improved {
    /// Rows of coordinates, where moved ones are.
    pub points: Vec<Point3>,
    /// Tetrahedra in rows.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
    /// The label of each.
    pub labels: Vec<i32>,
    /// The weight of each row, nought for most.
    pub weights: Vec<f64>,
    /// What was done.
    pub counts: Counts,
    /// Whether the limit on passes ended it while it still gained.
    pub exhausted: bool,
}

/// Called after each pass with its number and how many tetrahedra are below the bound; an error ends
/// the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize, usize) -> Result<()>;
