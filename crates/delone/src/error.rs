//! Errors, each with the rows that it is about.

use delone_core::error as core;

use crate::Point2;

/// The result of a call.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a call has no result. Rows are counted from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Coordinates are NaN or infinite.
    #[error(
        "{count} of the rows have a coordinate that is NaN or infinite, first row {}",
        first(rows)
    )]
    #[non_exhaustive]
    NonFinite {
        /// The first of these rows, ascending.
        rows: Vec<usize>,
        /// How many rows there are.
        count: usize,
    },
    /// There are fewer distinct points than a simplex has corners.
    #[error("{} distinct points are too few for a triangulation, rows {rows:?}", rows.len())]
    #[non_exhaustive]
    TooFew {
        /// The first row of each distinct point.
        rows: Vec<usize>,
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
    /// There are more points, or would be more simplices, than a triangulation can hold.
    #[error("{0}")]
    TooLarge(String),
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
    /// More points would have to be added than `max_points` allows.
    #[error(
        "{found} {what} exceed the limit of {limit} added points; most are on segments {segments:?}"
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
        /// A place where many of them are.
        place: Option<Point2>,
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
    /// The system refused memory.
    #[error("no memory for {bytes} bytes")]
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

fn wide(rows: Vec<u32>) -> Vec<usize> {
    rows.into_iter().map(|row| row as usize).collect()
}

impl From<core::Error> for Error {
    fn from(error: core::Error) -> Self {
        let text = error.to_string();
        match error {
            core::Error::NonFinite { rows, count } => Self::NonFinite {
                rows: wide(rows),
                count,
            },
            core::Error::TooFew { chain } | core::Error::TooFewInSpace { chain } => {
                Self::TooFew { rows: wide(chain) }
            }
            core::Error::Collinear { chain } => Self::Collinear { rows: wide(chain) },
            core::Error::Coplanar { chain } => Self::Coplanar { rows: wide(chain) },
            core::Error::TooMany { .. } | core::Error::TooManyTetrahedra { .. } => {
                Self::TooLarge(text)
            }
            core::Error::Crossing { pairs, points } => Self::Crossing {
                pairs: pairs.iter().map(|p| p.map(|s| s as usize)).collect(),
                points,
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
            },
            core::Error::Memory { bytes } => Self::Memory { bytes },
            core::Error::Interrupted => Self::Interrupted,
            // Arrays come from the core itself, so one that does not fit is a bug, too.
            core::Error::Shape(text) | core::Error::Internal(text) => Self::Internal(text),
        }
    }
}
