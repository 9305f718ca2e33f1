//! The input and the result of an improvement.

use delone_predicates::Point3;

use crate::base::error::Result;

/// Tetrahedra to improve, and options.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates, finite.
    pub points: &'a [Point3],
    /// Positively oriented tetrahedra that do not overlap.
    pub simplices: &'a [[i32; 4]],
    /// A label of each; faces between labels are kept. Empty if all have the same.
    pub labels: &'a [i32],
    /// For each row, whether it is fixed. Empty if none is.
    pub fixed: &'a [bool],
    /// For each row, whether it may be removed if it is not fixed or on a wall. Empty if none may.
    pub removable: &'a [bool],
    /// Tetrahedra with a smaller dihedral angle, in degrees, are improved; so are those with an
    /// obtuse angle of a smaller weighted sine.
    pub min_angle: f64,
    /// Whether edges and faces are removed.
    pub flips: bool,
    /// Whether vertices move.
    pub smooth: bool,
    /// Whether interior vertices are given weights first.
    pub exude: bool,
    /// Whether only the surface of walls is kept: coplanar faces of the boundary may be flipped, and
    /// vertices inside flat facets and straight edges move in them.
    pub turn: bool,
    /// The distance from its original place within which the boundary must remain if tetrahedra
    /// there are removed; none are if this is 0.
    pub tolerance: f64,
    /// The limit on passes.
    pub passes: usize,
    /// The limit on new vertices.
    pub most: usize,
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
    /// Moves of vertices on walls among them.
    pub slides: usize,
    /// Tetrahedra removed at the boundary.
    pub peeled: usize,
    /// Weights assigned.
    pub weights: usize,
    /// Vertices added.
    pub added: usize,
    /// Vertices removed.
    pub removed: usize,
    /// Passes.
    pub passes: usize,
    /// Changes that would have raised the worst quality but were not made, because the smallest
    /// angle would have become smaller or rounding left it undecided.
    pub refused: usize,
}

/// Improved tetrahedra.
#[derive(Debug)]
pub struct Improved {
    /// Rows of coordinates, with the moved ones at their new positions, then those of added vertices.
    /// Removed vertices keep their rows, which no tetrahedron uses.
    pub points: Vec<Point3>,
    /// Tetrahedra in rows.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
    /// The label of each.
    pub labels: Vec<i32>,
    /// An upper bound on the distance between the boundary and the original one.
    pub distance: f64,
    /// The weight of each row, zero for most.
    pub weights: Vec<f64>,
    /// Counts of the changes.
    pub counts: Counts,
    /// Whether the limit on passes was reached while passes still improved the mesh.
    pub exhausted: bool,
}

/// Called after each pass with its number and the number of tetrahedra below the bound; an error
/// ends the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize, usize) -> Result<()>;
