//! A live Delaunay triangulation in 2-D, with segments.

mod atomic;
mod build;
mod constrained;
mod detach;
mod ears;
mod insert;
mod kernel;
mod marks;
mod mesh;
mod near;
mod query;
mod reinsert;
mod remove;
mod retriangulate;
mod segments;
mod shift;
mod walk;

use mesh::Mesh;

/// A live Delaunay triangulation of points in 2-D.
pub type Plane = super::Live<Mesh, 2, 3>;
/// A snapshot.
pub type State = super::State<Mesh, 2, 3>;
