//! What becomes of segments that are laid.

/// What becomes of the segments, in vertices of the mesh.
#[derive(Debug, Default)]
pub struct Laid {
    /// Subsegments as vertices, each with a row that covers it and directed as that; an edge once for
    /// each of its rows.
    pub pieces: Vec<([u32; 2], u32)>,
    /// Whether they go by row and along it.
    pub sorted: bool,
    /// Whether an edge may come more than once.
    pub repeated: bool,
    /// Segment and vertex: a segment goes through a vertex that it does not end in.
    pub through: Vec<[u32; 2]>,
    /// Two segments and the vertex where they cross.
    pub crossings: Vec<[u32; 3]>,
}
