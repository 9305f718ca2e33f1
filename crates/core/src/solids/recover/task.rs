//! The input and the result of a recovery.

use delone_predicates::Point3;

/// Faces to recover, and options.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates: finite and distinct.
    pub points: &'a [Point3],
    /// Triangles that meet only in common vertices and edges.
    pub faces: &'a [[i32; 3]],
    /// The maximum number of added points at any time.
    pub max_points: usize,
    /// Whether faces and edges are recovered by flips before points are added.
    pub flips: bool,
    /// The number of threads of the Delaunay triangulation.
    pub workers: usize,
}

/// What happened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Edges of faces that the Delaunay triangulation lacks.
    pub missing_edges: usize,
    /// Faces that it lacks.
    pub missing_faces: usize,
    /// Changes by flips.
    pub flips: usize,
    /// Edges recovered by flips.
    pub flipped_edges: usize,
    /// Faces recovered by flips.
    pub flipped_faces: usize,
    /// Points that were temporarily put on edges.
    pub segment_points: usize,
    /// Points that were temporarily put in faces.
    pub face_points: usize,
    /// Sectors whose point on the boundary moved into the inside.
    pub suppressed: usize,
    /// Sectors that were joined to a vertex without a point.
    pub joined: usize,
    /// Interior points that were removed again.
    pub thinned: usize,
}

/// A mesh that has all faces.
#[derive(Debug)]
pub struct Recovered {
    /// The points of the input, followed by those that were added.
    pub points: Vec<Point3>,
    /// Positively oriented tetrahedra.
    pub tetrahedra: Vec<[i32; 4]>,
    /// The tetrahedron opposite each corner, -1 if there is none.
    pub neighbors: Vec<[i32; 4]>,
    /// The face of the input opposite each corner, -1 if there is none.
    pub walls: Vec<[i32; 4]>,
    /// What happened.
    pub counts: Counts,
    /// Faces near which no double is left for a point: then there are no tetrahedra.
    pub crowded: Vec<u32>,
}
