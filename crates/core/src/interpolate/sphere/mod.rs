//! Interpolation on the sphere: weights of the sites at directions, linear and of natural neighbors.
//!
//! The weights are computed in the tangent plane of the query (see `frame`), where the sphere around it
//! is projected from the center. The part of a Voronoi diagram near the query becomes a power diagram
//! there, and the formulas become those of the plane (see `formulas`).

mod cavity;
mod formulas;
mod frame;
mod rows;

pub use rows::{Kind, Queries, weights};
