//! Clusters of points by density: hierarchies of merges and what remains of them at one distance.
//!
//! A hierarchy consists of the edges of a spanning tree in the order of their weights (`hierarchy`).
//! For single linkage these are the edges of the Euclidean spanning tree of `graphs`. For HDBSCAN
//! `reach` finds a minimum spanning tree of all pairs by mutual reachability, from core distances
//! (`cores`), and `condense` removes the small parts. `density` has DBSCAN, which needs no tree.
//!
//! Every weight is the distance of two points, so all comparisons are those of squared distances,
//! exact. Merges with the same weight are one step: which of several minimum spanning trees is used
//! does not matter, so no result depends on rows or threads.

mod condense;
mod cores;
mod density;
mod hierarchy;
mod link;
mod reach;

pub use condense::{Condensed, condense};
pub use cores::{Cores, cores};
pub use density::{Density, density};
pub use hierarchy::{Hierarchy, hierarchy, linkage, single_links};
pub use link::Link;
pub use reach::reach_tree;
