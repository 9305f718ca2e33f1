//! Meshes with ghosts: topology alone, neither coordinates nor predicates.

pub mod plane;
pub mod space;
