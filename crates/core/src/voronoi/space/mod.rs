//! 3-D Voronoi and power diagrams: the dual of a triangulation, measures, cells clipped to a
//! polyhedron.
//!
//! A triangulation is given as arrays; with weights it must be the regular one. Cospherical
//! tetrahedra share one vertex, which an exact test decides. Only the coordinates of vertices are
//! rounded (see `center`), and the combinatorics is independent of them.
//!
//! A face of a cell, here *ridge*, is a polygon between two sites: the dual of an edge. If it does
//! not end within the range of doubles, it has two *rays*: directions in which its boundary is
//! unbounded, or leads to a vertex out of range.

mod clip;
mod dual;
mod measure;
mod meeting;
mod polyhedron;
mod regions;
mod ridges;

pub use clip::{Clip, Clipped, clip};
pub use dual::{Diagram, diagram};
pub use measure::{Cells, Measures, measures};
