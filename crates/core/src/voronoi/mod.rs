//! 2-D Voronoi and power diagrams: the dual of a triangulation, its cells clipped, their measures.
//!
//! A triangulation is given as arrays; with weights it must be the regular one. Cocircular
//! triangles share one vertex, which an exact test decides. Only the coordinates of vertices are
//! rounded (see `center`), and the combinatorics is independent of them.
//!
//! If an edge of a cell does not end within the range of doubles, its end is a *ray*: a direction
//! in which it is unbounded, or leads to a vertex out of range.

mod axis;
mod clip;
mod dual;
mod given;
mod measure;
mod outline;
mod pieces;
mod regions;
mod ridges;
pub mod space;
mod torus;
pub(crate) mod vertices;

pub use clip::{Cells, Polygons, clip};
pub use dual::{Diagram, diagram};
pub use given::Given;
pub use measure::{Measures, measures};
pub use outline::touched;
pub use pieces::{Convex, Left, Outline, Pieces, pieces};
pub use torus::centers;
