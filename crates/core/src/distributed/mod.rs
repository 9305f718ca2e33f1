//! Queries for triangulations in tiles: disks rounded outward, and the points deepest in circles.
//!
//! A tile certifies a triangle where `disk` lies in the space that the tile knows; of every other
//! tile that the disk touches it asks for the `deepest` points. Which tiles there are, and what goes
//! between them, is the business of the caller.

mod deepest;
mod disk;

pub use deepest::{Answers, deepest};
pub use disk::{disk, within};
