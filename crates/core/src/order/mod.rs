//! Insertion orders with spatial locality: blocks of a k-d tree, and the Hilbert curve in each.
//!
//! Independent of meshes.

mod arrange;
pub mod blocks;
mod cells;
pub mod curve;
mod distribute;
mod hilbert;
mod hilbert3;
pub mod hilbert_n;
mod radix;
mod rounds;
mod rows;
mod sort;
pub mod space;
pub mod space_blocks;

pub use arrange::{Arranged, arrange};
pub use rounds::{Rounds, random};
pub use rows::order_of;
pub use sort::{sort, sort_by, sort_shared};
