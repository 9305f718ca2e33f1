//! Errors of the core, with the rows that the caller needs to name. Their words are those that users
//! read in Python and on pages: what is wrong, where, and what to do.

use std::fmt;

use delone_predicates::Point2;

/// Result of the core.
pub type Result<T> = std::result::Result<T, Error>;

/// The ways in which a call of the core can fail.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// Coordinates that are NaN or infinite: the first rows, and how many there are.
    #[error("{}", not_finite(rows, *count))]
    NonFinite {
        /// The first bad rows, ascending.
        rows: Vec<u32>,
        /// How many rows are bad.
        count: usize,
    },
    /// Fewer than three distinct points: their rows in lexicographic order.
    #[error("{} too few for a triangle: at least three that are not collinear are needed",
            agreed(chain.len(), "distinct point is", "distinct points are"))]
    TooFew {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// Fewer than four distinct points in 3-D: their rows in lexicographic order.
    #[error("{} too few for a tetrahedron: at least four that are not coplanar are needed",
            agreed(chain.len(), "distinct point is", "distinct points are"))]
    TooFewInSpace {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// All points in 3-D lie in one plane, but not on one line.
    #[error("all {} distinct points lie in one plane, so there is no tetrahedron; triangulate them in 2-D, \
             in that plane", chain.len())]
    Coplanar {
        /// First rows of the distinct points, lexicographic.
        chain: Vec<u32>,
    },
    /// All points lie on one line: their rows in the order along it.
    #[error("all {} distinct points lie on one line, so there is no triangle; `error.chain` has their \
             rows in order along it", chain.len())]
    Collinear {
        /// First rows of the distinct points, in order along the line.
        chain: Vec<u32>,
    },
    /// Vectors that are zero and have no direction: the first rows, and how many there are.
    #[error("{} no direction, first row {}: drop such rows",
            agreed(*count, "vector is zero and has", "vectors are zero and have"), first(rows))]
    ZeroVectors {
        /// The first such rows, ascending.
        rows: Vec<u32>,
        /// How many there are.
        count: usize,
    },
    /// All directions are on one great circle: their rows in the order around it.
    #[error("{}", one_great_circle(chain.len()))]
    OneGreatCircle {
        /// First rows of the distinct directions, in order around the circle.
        chain: Vec<u32>,
    },
    /// More points than the mesh's 32-bit codes can address.
    #[error(
        "{found} points exceed the limit of {limit} for one triangulation: use delone.distributed in \
             2-D, or fewer points"
    )]
    TooMany {
        /// Points given.
        found: usize,
        /// Points that can be held.
        limit: usize,
    },
    /// More tetrahedra than the mesh's 32-bit codes can address.
    #[error(
        "the tetrahedra exceed the limit of {limit} for one triangulation: triangulate fewer points"
    )]
    TooManyTetrahedra {
        /// Tetrahedra that can be held, ghosts included.
        limit: usize,
    },
    /// Points in four or more dimensions that all lie in a flat of fewer dimensions.
    #[error("{}", flat(*dimension, *distinct, rows))]
    Flat {
        /// The number of coordinates.
        dimension: usize,
        /// The number of distinct points.
        distinct: usize,
        /// Rows that span the flat, ascending: one more than its dimension.
        rows: Vec<u32>,
    },
    /// More simplices in four or more dimensions than the mesh's 32-bit codes can address.
    #[error(
        "the simplices exceed the limit of {limit} for one triangulation: triangulate fewer points"
    )]
    TooManySimplices {
        /// Simplices that can be held, ghosts included.
        limit: usize,
    },
    /// Segments that cross: the pairs of their rows, and the points where they cross.
    #[error("{}", crossing(pairs, points))]
    Crossing {
        /// Both rows of each pair, the smaller first; ascending.
        pairs: Vec<[u32; 2]>,
        /// The crossing of each, rounded.
        points: Vec<Point2>,
    },
    /// Arcs of great circles that cross: the pairs of their rows.
    #[error("{} pairs of arcs cross, first {:?}", pairs.len(), pairs.first())]
    CrossingArcs {
        /// Both rows of each pair, the smaller first; ascending.
        pairs: Vec<[u32; 2]>,
    },
    /// Arcs between opposite directions, which many great circles join.
    #[error("{} opposite directions, which no single shorter arc joins: add a point between them",
            opposite(rows, *count))]
    OppositeEnds {
        /// The first rows of such arcs.
        rows: Vec<u32>,
        /// How many there are.
        count: usize,
    },
    /// More vertices than the caller allows.
    #[error(
        "found {found} {what}, more than the limit of {limit} vertices allows{densest}: allow more, or \
             make the input simpler there"
    )]
    Budget {
        /// What exceeds the limit.
        what: &'static str,
        /// The limit.
        limit: usize,
        /// How many there were when the limit was exceeded.
        found: usize,
        /// The segments that need most of them.
        densest: Densest,
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
pub struct Densest {
    /// Their rows, in descending order of the number of vertices.
    pub segments: Vec<u32>,
    /// The point where the first two of them meet, or where the last vertex would have been.
    pub place: Option<Point2>,
    /// Whether `place` is the point where they meet.
    pub corner: bool,
}

impl Error {
    /// The name of the exception that Python raises, and that pages show.
    pub fn class(&self) -> &'static str {
        match self {
            Self::NonFinite { .. } => "NonFiniteError",
            Self::ZeroVectors { .. } | Self::OppositeEnds { .. } => "DirectionError",
            Self::TooFew { .. }
            | Self::TooFewInSpace { .. }
            | Self::Collinear { .. }
            | Self::Coplanar { .. }
            | Self::Flat { .. }
            | Self::OneGreatCircle { .. } => "DegenerateInputError",
            Self::TooMany { .. }
            | Self::TooManyTetrahedra { .. }
            | Self::TooManySimplices { .. } => "LimitError",
            Self::Crossing { .. } | Self::CrossingArcs { .. } => "CrossingSegmentsError",
            Self::Budget { .. } => "BudgetExceededError",
            Self::Shape(_) => "ShapeError",
            Self::Memory { .. } => "MemoryError",
            Self::Interrupted => "KeyboardInterrupt",
            Self::Internal(_) => "InternalError",
        }
    }

    /// The rows that it names.
    pub fn rows(&self) -> &[u32] {
        match self {
            Self::NonFinite { rows, .. }
            | Self::Flat { rows, .. }
            | Self::ZeroVectors { rows, .. }
            | Self::OppositeEnds { rows, .. } => rows,
            Self::TooFew { chain }
            | Self::TooFewInSpace { chain }
            | Self::Collinear { chain }
            | Self::Coplanar { chain }
            | Self::OneGreatCircle { chain } => chain,
            Self::Crossing { pairs, .. } | Self::CrossingArcs { pairs } => pairs.as_flattened(),
            Self::Budget { densest, .. } => &densest.segments,
            _ => &[],
        }
    }
}

impl fmt::Display for Densest {
    /// Names the segments with most of the vertices that exceed the limit; nothing if there are none.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.segments.iter().map(u32::to_string).collect();
        let names = match names.len() {
            0 => return Ok(()),
            1 => format!("segment {}", names[0]),
            _ => format!("segments {}", names.join(", ")),
        };
        write!(f, "; most are on {names}")?;
        match (self.place, self.corner) {
            (Some([x, y]), true) => write!(f, ", the first two of which meet at ({x}, {y})"),
            (Some([x, y]), false) => write!(f, ", the last one at ({x}, {y})"),
            (None, _) => Ok(()),
        }
    }
}

/// A count and the singular or plural that agrees with it.
fn agreed(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn first(rows: &[u32]) -> u32 {
    rows.first().copied().unwrap_or_default()
}

fn not_finite(rows: &[u32], count: usize) -> String {
    let (what, row) = ("a coordinate that is NaN or infinite", first(rows));
    match count {
        1 => format!("1 row has {what}: row {row}; drop or repair it"),
        _ => format!("{count} rows have {what}; the first is row {row}: drop or repair them"),
    }
}

fn one_great_circle(count: usize) -> String {
    if count < 3 {
        let few = agreed(count, "distinct direction is", "distinct directions are");
        return format!(
            "{few} too few for a triangle: at least three that are not on one great circle are \
             needed; `error.chain` has the first row of each"
        );
    }
    format!(
        "all {count} distinct directions are on one great circle, so there is no triangle; \
         `error.chain` has their rows in order around it"
    )
}

fn opposite(rows: &[u32], count: usize) -> String {
    let row = first(rows);
    match count {
        1 => format!("segment {row} joins"),
        _ => format!("{count} segments join, first row {row},"),
    }
}

/// Says in which flat the points lie.
fn flat(dimension: usize, distinct: usize, rows: &[u32]) -> String {
    if distinct <= dimension {
        return format!(
            "{} too few for a simplex in {dimension}-D: at least {} that span all dimensions are needed",
            agreed(distinct, "distinct point is", "distinct points are"),
            dimension + 1
        );
    }
    format!(
        "all {distinct} distinct points lie in a flat of dimension {}, spanned by rows {rows:?}, so there \
         is no simplex in {dimension}-D: leave out coordinates that depend on the others",
        rows.len().saturating_sub(1)
    )
}

/// Names the first pair of segments that cross.
fn crossing(pairs: &[[u32; 2]], points: &[Point2]) -> String {
    let (count, [s, t]) = (pairs.len(), pairs.first().copied().unwrap_or_default());
    let [x, y] = points.first().copied().unwrap_or_default();
    let what = match count {
        1 => format!("segments {s} and {t} cross at ({x}, {y})"),
        _ => format!("{count} pairs of segments cross, first {s} and {t} at ({x}, {y})"),
    };
    format!("{what}; crossing=\"split\" makes crossings vertices")
}
