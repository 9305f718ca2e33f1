//! A live Delaunay triangulation in 3-D.
//!
//! Every state is the lower hull of the lifted points at heights that depend on coordinates only
//! (see the head of `live`, and of `delaunay::space::cavity` for ghosts over coplanar hull facets):
//! so any order of edits ends in the tetrahedra of a fresh build. `insert` empties the cavity of a
//! point and fills it with a star; `remove` empties the star of a vertex and fills the hole, and
//! its head says why that is the lower hull; `link` puts both into the mesh. Points in one plane
//! have no tetrahedron; they are kept in lexicographic order until a point outside their plane is
//! inserted.

mod build;
mod insert;
mod kernel;
mod link;
mod mesh;
mod patch;
mod remove;
mod walk;

use mesh::Mesh;

/// A live Delaunay triangulation of points in 3-D.
pub type Space = super::Live<Mesh, 3, 4>;
/// A snapshot.
pub type State = super::State<Mesh, 3, 4>;
