//! Proximity graphs of points: which pairs are neighbors, decided exactly.
//!
//! Gabriel graphs, relative neighborhood graphs and beta skeletons are filters of the Delaunay
//! graph (`regions`); what they need beyond the neighbors of a vertex is found in a tree of boxes
//! (`tree`). In 2-D, `triangles` has the filters that need no more than the triangles, Urquhart graphs
//! among them. Spanning trees (`spanning`) are inside the Delaunay graph, too.
//! `antipodes` has the edges of open Gabriel graphs that are not in the triangulation, `nearest`
//! the k nearest neighbors, and `influence` spheres of influence; these need no triangulation.
//!
//! All graphs are on distinct points: the first row of equal ones is the vertex. Edges are pairs of
//! rows, the smaller first, ascending. Tasks depend on the input only, and each writes its own
//! part, so that the result is independent of the number of threads.

mod antipodes;
pub mod cluster;
mod components;
mod edges;
mod influence;
mod nearest;
mod regions;
mod spanning;
mod tree;
mod triangles;

pub use antipodes::antipodes;
pub use components::components;
pub use edges::{Skeleton, not_longer};
pub use influence::influence;
pub(crate) use nearest::each;
pub use nearest::{Neighbors, nearest};
pub use regions::{Region, filter};
pub use spanning::{spanning_tree, spanning_tree_of_triangles};
pub use tree::{Distinct, Tree};
pub(crate) use tree::{certainly_above, squared, squared_gap};
pub use triangles::{Rule, of_triangles};
