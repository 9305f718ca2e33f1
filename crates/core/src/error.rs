//! Errors of the core, with the rows that the caller needs to name.

use delone_predicates::Point2;

/// Result of the core.
pub type Result<T> = std::result::Result<T, Error>;

/// The ways in which a call of the core can fail.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// Coordinates that are NaN or infinite: the first rows, and how many there are.
    #[error("{} a coordinate that is NaN or infinite", agreed(*count, "row has", "rows have"))]
    NonFinite {
        /// The first bad rows, ascending.
        rows: Vec<u32>,
        /// How many rows are bad.
        count: usize,
    },
    /// Fewer than three distinct points: their rows in lexicographic order.
    #[error("{} too few", agreed(chain.len(), "distinct point is", "distinct points are"))]
    TooFew {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// Fewer than four distinct points in 3-D: their rows in lexicographic order.
    #[error("{} too few", agreed(chain.len(), "distinct point is", "distinct points are"))]
    TooFewInSpace {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// All points in 3-D lie in one plane, but not on one line.
    #[error("all {} distinct points lie in one plane", chain.len())]
    Coplanar {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// All points lie on one line: their rows in the order along it.
    #[error("all {} distinct points lie on one line", chain.len())]
    Collinear {
        /// First rows of the distinct points, in order along the line.
        chain: Vec<u32>,
    },
    /// Vectors that are zero and have no direction: the first rows, and how many there are.
    #[error("{} zero and has no direction", agreed(*count, "row is", "rows are"))]
    ZeroVectors {
        /// The first such rows, ascending.
        rows: Vec<u32>,
        /// How many there are.
        count: usize,
    },
    /// All directions are on one great circle: their rows in the order around it.
    #[error("all {} distinct directions are on one great circle", chain.len())]
    OneGreatCircle {
        /// First rows of the distinct directions, in order around the circle.
        chain: Vec<u32>,
    },
    /// More points than the mesh's 32-bit codes can address.
    #[error("{found} points exceed the limit of {limit} for one triangulation")]
    TooMany {
        /// Points given.
        found: usize,
        /// Points that can be held.
        limit: usize,
    },
    /// More tetrahedra than the mesh's 32-bit codes can address.
    #[error("the tetrahedra exceed the limit of {limit} for one triangulation")]
    TooManyTetrahedra {
        /// Tetrahedra that can be held, ghosts included.
        limit: usize,
    },
    /// Segments that cross: the pairs of their rows, and the points where they cross.
    #[error("{} pairs of segments cross", pairs.len())]
    Crossing {
        /// Both rows of each pair, the smaller first; ascending.
        pairs: Vec<[u32; 2]>,
        /// The crossing of each, rounded.
        points: Vec<Point2>,
    },
    /// Arcs of great circles that cross: the pairs of their rows.
    #[error("{} pairs of arcs cross", pairs.len())]
    CrossingArcs {
        /// Both rows of each pair, the smaller first; ascending.
        pairs: Vec<[u32; 2]>,
    },
    /// Arcs between opposite directions, which many great circles join.
    #[error("the ends of {count} arcs are opposite")]
    OppositeEnds {
        /// The first rows of such arcs.
        rows: Vec<u32>,
        /// How many there are.
        count: usize,
    },
    /// More vertices than the caller allows.
    #[error("found {found} {what}, more than the limit of {limit} vertices allows")]
    Budget {
        /// What exceeds the limit.
        what: &'static str,
        /// The limit.
        limit: usize,
        /// How many there were when the limit was exceeded.
        found: usize,
        /// The segments that need most of them.
        crowd: Crowd,
    },
    /// An invalid argument; the message names the row.
    #[error("{0}")]
    Shape(String),
    /// The system refused memory.
    #[error("out of memory: could not allocate {bytes} bytes")]
    Memory {
        /// Bytes requested.
        bytes: usize,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// An invariant of the core was violated: always a bug.
    #[error("{0}")]
    Internal(String),
}

/// The segments that need most of the added vertices when a limit is exceeded.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Crowd {
    /// Their rows, in descending order of the number of vertices.
    pub segments: Vec<u32>,
    /// The point where the first two of them meet, or where the last vertex would have been.
    pub place: Option<Point2>,
    /// Whether `place` is the point where they meet.
    pub corner: bool,
}

/// A count and the singular or plural that agrees with it.
fn agreed(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
