//! 3-D Delaunay triangulations of points, exact and canonical.
//!
//! Each lifted point is lowered by an infinitesimal that is larger the smaller the point is in
//! lexicographic order; the lower hull is then made of tetrahedra alone, none of them flat, whatever
//! the points, and is the same for every order of insertion.

mod cavity;
mod dispatch;
mod insertion;
mod join;
mod lattice;
mod rounds;
mod seam;
mod sphere;
mod triangulate;
pub mod validate;

pub use triangulate::{Stage, Triangulation3, triangulate};
