//! Queries for tiled triangulations: disks rounded outward, and the points deepest in
//! circumcircles.
//!
//! A tile certifies a triangle if the triangle's `disk` lies in the region that the tile knows; it
//! queries every other tile that the disk touches for the `deepest` points. The caller manages the
//! tiles and the messages between them.

mod deepest;
mod disk;

pub use deepest::{Answers, deepest};
pub use disk::{disk, within};
