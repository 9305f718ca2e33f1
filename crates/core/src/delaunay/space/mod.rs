//! 3-D Delaunay triangulations of points, exact and canonical.
//!
//! Each lifted point is lowered by an infinitesimal that is larger the smaller the point is in
//! lexicographic order. The lower hull then consists of tetrahedra only, none of them flat, for
//! every input, and is independent of the order of insertion.

mod cavity;
mod dispatch;
mod heights;
mod insertion;
mod join;
mod lattice;
mod rounds;
mod seam;
mod sphere;
mod triangulate;
pub mod validate;

pub use triangulate::{Triangulation3, triangulate};
