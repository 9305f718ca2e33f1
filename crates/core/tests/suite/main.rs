//! Properties of triangulations, hulls, live meshes and refinement, against slow or exact answers.
//!
//! One program for all of them: what they share is compiled and linked once.

mod constrained;
mod crossings;
mod delaunay_plane;
mod delaunay_space;
mod hull;
mod improve;
mod interpolate;
mod interruption;
mod live;
mod live3;
mod locate;
mod locate_space;
mod ndim;
mod overlap;
mod refine;
mod sweep_and_lifting;
mod tier;
