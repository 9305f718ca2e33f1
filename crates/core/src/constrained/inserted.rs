//! The result of inserting segments: subsegments, vertices on segments, crossings.

/// The result of inserting segments, in vertices of the mesh.
#[derive(Debug, Default)]
pub struct Inserted {
    /// Subsegments as pairs of vertices, each with a row that covers it and directed as that row;
    /// an edge occurs once for each of its rows.
    pub pieces: Vec<([u32; 2], u32)>,
    /// Whether they are sorted by row and along it.
    pub sorted: bool,
    /// Whether an edge may occur more than once.
    pub repeated: bool,
    /// Segment and vertex: the segment passes through the vertex, which is not one of its ends.
    pub through: Vec<[u32; 2]>,
    /// Two segments and the vertex where they cross.
    pub crossings: Vec<[u32; 3]>,
}
