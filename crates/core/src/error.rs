//! Errors of the core, each with the rows that the caller needs to name.

use delone_predicates::Point2;

/// Result of the core.
pub type Result<T> = std::result::Result<T, Error>;

/// Every way in which a call of the core ends without an answer.
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
    /// Fewer than four distinct points of space: their rows in lexicographic order.
    #[error("{} too few", agreed(chain.len(), "distinct point is", "distinct points are"))]
    TooFewInSpace {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// All points of space lie in one plane, but not on one line.
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
    /// More points than the 32-bit codes of the mesh can address.
    #[error("{found} points are more than the {limit} that one triangulation can hold")]
    TooMany {
        /// Points given.
        found: usize,
        /// Points that can be held.
        limit: usize,
    },
    /// More tetrahedra than the 32-bit codes of the mesh can address.
    #[error("more tetrahedra than the {limit} that one triangulation can hold")]
    TooManyTetrahedra {
        /// Tetrahedra that can be held, ghosts included.
        limit: usize,
    },
    /// Segments that cross: the pairs of their rows, and where they do.
    #[error("{} pairs of segments cross", pairs.len())]
    Crossing {
        /// Both rows of each pair, the smaller first; ascending.
        pairs: Vec<[u32; 2]>,
        /// The crossing of each, rounded.
        points: Vec<Point2>,
    },
    /// More vertices than the caller allows.
    #[error("found {found} {what}, more than the limit of {limit} vertices allows")]
    Budget {
        /// What there is too much of.
        what: &'static str,
        /// The limit.
        limit: usize,
        /// How many when it was passed.
        found: usize,
        /// Where most of them are.
        crowd: Crowd,
    },
    /// An array that does not fit its role, in words that name the row.
    #[error("{0}")]
    Shape(String),
    /// Memory that the system refused.
    #[error("no memory for {bytes} bytes")]
    Memory {
        /// Bytes asked for.
        bytes: usize,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// A promise of the core that did not hold: always a bug.
    #[error("{0}")]
    Internal(String),
}

/// The segments that take most of the vertices that are too many.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Crowd {
    /// Their rows, those with the most first.
    pub segments: Vec<u32>,
    /// The point where the first two of them meet, or where the last vertex was to be.
    pub place: Option<Point2>,
    /// Whether the place is where they meet.
    pub corner: bool,
}

/// A number with the words that go with it.
fn agreed(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
