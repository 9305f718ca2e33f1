//! The foundation of all rooms: errors, arrays, points, boxes, failed allocations, interruption and
//! workers.

pub mod arrays;
pub(crate) mod boxes;
pub mod consistency;
pub mod error;
pub mod joins;
pub mod memory;
pub(crate) mod parallel;
pub mod points;
pub mod proof;
#[cfg(test)]
pub(crate) mod random;
pub(crate) mod sets;
pub mod target;
pub(crate) mod vector;
pub mod watch;
pub(crate) mod wide;
