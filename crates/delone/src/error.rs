//! Errors, each with the rows that it is about.

use delone_core::error as core;

use crate::Point2;

/// The result of a call.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Why a call has no result. Rows are counted from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Coordinates are NaN or infinite.
    #[error("{}", nonfinite(rows, *count))]
    #[non_exhaustive]
    NonFinite {
        /// The first of these rows, ascending.
        rows: Vec<usize>,
        /// How many rows there are.
        count: usize,
    },
    /// There are fewer distinct points than a simplex has corners.
    #[error("{} too few for a {}", distinct(rows), simplex(*dimension))]
    #[non_exhaustive]
    TooFew {
        /// The first row of each distinct point.
        rows: Vec<usize>,
        /// The dimension of the points.
        dimension: usize,
    },
    /// All points lie on one line.
    #[error("all {} distinct points lie on one line, from row {} to row {}", rows.len(), first(rows), last(rows))]
    #[non_exhaustive]
    Collinear {
        /// The first row of each distinct point, in order along the line.
        rows: Vec<usize>,
    },
    /// All points of a 3-D triangulation lie in one plane.
    #[error("all {} distinct points lie in one plane", rows.len())]
    #[non_exhaustive]
    Coplanar {
        /// The first row of each distinct point, in lexicographic order.
        rows: Vec<usize>,
    },
    /// Vectors are zero and have no direction.
    #[error(
        "{count} rows are zero and have no direction; the first is row {}",
        first(rows)
    )]
    #[non_exhaustive]
    ZeroVectors {
        /// The first of these rows, ascending.
        rows: Vec<usize>,
        /// How many rows there are.
        count: usize,
    },
    /// All directions are on one great circle.
    #[error("all {} distinct directions are on one great circle", rows.len())]
    #[non_exhaustive]
    OneGreatCircle {
        /// The first row of each distinct direction, in order around the circle.
        rows: Vec<usize>,
    },
    /// There are more points, or would be more simplices, than a triangulation can hold.
    #[error("{}{what} exceed the limit of {limit} for one triangulation", counted(*found))]
    #[non_exhaustive]
    TooLarge {
        /// Points or tetrahedra.
        what: &'static str,
        /// How many there are, if that is known.
        found: Option<usize>,
        /// How many there may be.
        limit: usize,
    },
    /// A segment ends at a row that does not exist.
    #[error("segment {segment} ends at row {row}, but there are {points} points")]
    #[non_exhaustive]
    NoSuchPoint {
        /// The row of the segment.
        segment: usize,
        /// The row of the point.
        row: usize,
        /// The number of points.
        points: usize,
    },
    /// Segments cross, and splitting them was not asked for.
    #[error("{} pairs of segments cross, first {:?} at {:?}", pairs.len(), pairs.first(), points.first())]
    #[non_exhaustive]
    Crossing {
        /// The rows of the segments of each pair, ascending.
        pairs: Vec<[usize; 2]>,
        /// Where they cross, rounded.
        points: Vec<Point2>,
    },
    /// Arcs on the sphere cross.
    #[error("{} pairs of arcs cross, first {:?}", pairs.len(), pairs.first())]
    #[non_exhaustive]
    CrossingArcs {
        /// The rows of the arcs of each pair, ascending.
        pairs: Vec<[usize; 2]>,
    },
    /// The ends of arcs are opposite directions, which many great circles join.
    #[error(
        "the ends of {count} arcs are opposite; the first is row {}",
        first(rows)
    )]
    #[non_exhaustive]
    OppositeEnds {
        /// The first of these rows, ascending.
        rows: Vec<usize>,
        /// How many rows there are.
        count: usize,
    },
    /// More points would have to be added than `max_points` allows.
    #[error(
        "found {found} {what}, more than the limit of {limit} vertices allows; most are on segments {segments:?}"
    )]
    #[non_exhaustive]
    Budget {
        /// What exceeds the limit.
        what: &'static str,
        /// The limit.
        limit: usize,
        /// How many there were when the limit was exceeded.
        found: usize,
        /// The rows of the segments on which most of them are.
        segments: Vec<usize>,
        /// The point where the first two of these meet, or where the last point would have been.
        place: Option<Point2>,
        /// Whether they meet there.
        corner: bool,
    },
    /// The segments enclose no triangle, or the holes remove all of them.
    #[error("the domain is empty: the segments enclose no triangle that is in no hole")]
    EmptyDomain,
    /// The seed of a hole is on a segment or outside of the convex hull.
    #[error("the seed of hole {hole} is on a segment or outside of the convex hull")]
    #[non_exhaustive]
    Seed {
        /// The row of the seed.
        hole: usize,
    },
    /// An option is out of range.
    #[error("{0}")]
    Option(String),
    /// Arrays that are given do not fit together; the text names the first row that is wrong.
    #[error("{0}")]
    Shape(String),
    /// The system refused memory.
    #[error("out of memory: could not allocate {bytes} bytes")]
    #[non_exhaustive]
    Memory {
        /// The bytes that were requested.
        bytes: usize,
    },
    /// The function of [`Options::interrupt`](crate::Options::interrupt) returned true.
    #[error("interrupted")]
    Interrupted,
    /// An invariant of delone is violated: a bug, please report it.
    #[error("internal error: {0}")]
    Internal(String),
}

fn first(rows: &[usize]) -> usize {
    rows.first().copied().unwrap_or_default()
}

fn last(rows: &[usize]) -> usize {
    rows.last().copied().unwrap_or_default()
}

fn nonfinite(rows: &[usize], count: usize) -> String {
    let row = first(rows);
    match count {
        1 => format!("1 row has a coordinate that is NaN or infinite: row {row}"),
        _ => format!(
            "{count} rows have a coordinate that is NaN or infinite; the first is row {row}"
        ),
    }
}

fn distinct(rows: &[usize]) -> String {
    match rows.len() {
        1 => "1 distinct point is".into(),
        count => format!("{count} distinct points are"),
    }
}

fn simplex(dimension: usize) -> &'static str {
    if dimension == 2 {
        "triangle"
    } else {
        "tetrahedron"
    }
}

fn counted(found: Option<usize>) -> String {
    found.map_or_else(|| "the ".into(), |count| format!("{count} "))
}

fn wide(rows: Vec<u32>) -> Vec<usize> {
    rows.into_iter().map(|row| row as usize).collect()
}

impl From<core::Error> for Error {
    fn from(error: core::Error) -> Self {
        match error {
            core::Error::NonFinite { rows, count } => Self::NonFinite {
                rows: wide(rows),
                count,
            },
            core::Error::TooFew { chain } => Self::TooFew {
                rows: wide(chain),
                dimension: 2,
            },
            core::Error::TooFewInSpace { chain } => Self::TooFew {
                rows: wide(chain),
                dimension: 3,
            },
            core::Error::Collinear { chain } => Self::Collinear { rows: wide(chain) },
            core::Error::Coplanar { chain } => Self::Coplanar { rows: wide(chain) },
            core::Error::ZeroVectors { rows, count } => Self::ZeroVectors {
                rows: wide(rows),
                count,
            },
            core::Error::OneGreatCircle { chain } => Self::OneGreatCircle { rows: wide(chain) },
            core::Error::TooMany { found, limit } => Self::TooLarge {
                what: "points",
                found: Some(found),
                limit,
            },
            core::Error::TooManyTetrahedra { limit } => Self::TooLarge {
                what: "tetrahedra",
                found: None,
                limit,
            },
            core::Error::Crossing { pairs, points } => Self::Crossing {
                pairs: pairs.iter().map(|p| p.map(|s| s as usize)).collect(),
                points,
            },
            core::Error::CrossingArcs { pairs } => Self::CrossingArcs {
                pairs: pairs.iter().map(|p| p.map(|s| s as usize)).collect(),
            },
            core::Error::OppositeEnds { rows, count } => Self::OppositeEnds {
                rows: wide(rows),
                count,
            },
            core::Error::Budget {
                what,
                limit,
                found,
                crowd,
            } => Self::Budget {
                what,
                limit,
                found,
                segments: wide(crowd.segments),
                place: crowd.place,
                corner: crowd.corner,
            },
            core::Error::Shape(text) => Self::Shape(text),
            core::Error::Memory { bytes } => Self::Memory { bytes },
            core::Error::Interrupted => Self::Interrupted,
            core::Error::Internal(text) => Self::Internal(text),
        }
    }
}
