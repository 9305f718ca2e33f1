//! A triangle mesh with ghosts: topology only, no coordinates and no predicates.
//!
//! Every hull edge has a *ghost* triangle to one infinite vertex, so each triangle has three
//! neighbors and a mesh of n vertices has 2 n - 2 triangles. A triangle is a record of eight `u32`:
//! three vertices counterclockwise, its marks, three opposite codes, padding. The *code* of a
//! half-edge is `8 t + k`: triangle t, the edge opposite its corner k, which runs from corner k + 1
//! to corner k + 2. So `vertex(code)` is the apex, `opposite(code)` the same edge seen from the
//! other side, and the apex across an edge is one load away.
//!
//! The records of a contiguous block of vertices are a *patch*. Patches are disjoint, so threads
//! can fill them in parallel; two adjacent ones can be joined.

pub mod export;
mod flip;
mod hull;
pub mod import;
mod marks;
mod storage;

pub use storage::{
    Code, Mesh2, OPPOSITE, Patch, RECORD, half_edge, half_edges, next, prev, triangle,
};
