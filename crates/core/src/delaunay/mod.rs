//! Delaunay triangulations from points: the triangles of the plane and the tetrahedra of space.

pub mod plane;
pub mod space;
