//! 2-D Delaunay triangulations of points, exact and canonical.
//!
//! All methods return the same triangles: ties between cocircular points are broken by coordinates,
//! as if each lifted point were lowered by an infinitesimal that is larger the smaller the point is
//! in lexicographic order.

mod bowyer_watson;
mod cavity;
mod divide_conquer;
mod first;
mod incremental;
pub mod lawson;
mod leaf;
mod lifting;
mod merge;
mod part;
mod sweep;
mod ties;
mod triangulate;
pub mod validate;
pub(crate) mod walk;

pub(crate) use triangulate::{Built, mesh};
pub use triangulate::{Method, Triangulation, triangulate};
