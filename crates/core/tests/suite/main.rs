//! Properties of triangulations, hulls, live meshes and refinement, against slow or exact answers.
//!
//! One program for all of them: what they share is compiled and linked once.

mod constrained;
mod crossings;
mod delaunay2;
mod delaunay3;
mod hull;
mod improve;
mod interpolate;
mod interruption;
mod live;
mod live3;
mod locate;
mod locate3;
mod ndim;
mod overlap;
mod refine;
mod sweep_and_lifting;
mod tier;
