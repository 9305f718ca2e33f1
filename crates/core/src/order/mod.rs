//! Orders of points in which neighbours are near in the plane, so that what walks from one to the
//! next stays in the cache: blocks of a k-d tree, and the Hilbert curve in each. Knows no mesh.

mod arrange;
pub mod blocks;
pub mod curve;
mod hilbert;
pub mod radix;

pub use arrange::{Arranged, arrange};
