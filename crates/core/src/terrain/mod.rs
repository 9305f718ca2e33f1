//! Heights over triangles: contour lines, volumes between surfaces and fewer triangles.

pub mod contour;
pub mod simplify;
pub mod volume;
