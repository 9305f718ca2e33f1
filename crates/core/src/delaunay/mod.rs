//! Delaunay triangulations from points: the triangles of the plane and the tetrahedra of space.

pub mod plane;
pub mod space;
mod stages;

pub(crate) use stages::Clock;
pub use stages::{Stage, Triangulated};
