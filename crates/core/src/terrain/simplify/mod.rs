//! Simplification of surfaces with a bound on the error: greedy insertion.
//!
//! A coarse triangulation of the vertices that stay gets the other points one by one, always the one
//! whose height is farthest from the surface: M. Garland and P. S. Heckbert, "Fast polygonal
//! approximation of terrains and height fields", CMU-CS-95-181 (1995). Each triangle has the list of
//! the points in it and the worst of them, and all worst points are in a heap; an insertion moves the
//! points of the triangles that it changes.
//!
//! Errors are vertical distances as `plane` computes them: doubles that are proven to be at least
//! the true distance, so a bound that they satisfy is satisfied. Triangles are constrained
//! Delaunay, with ties broken by coordinates; of points with equal errors, the lexicographically
//! smallest comes first, and a point on an edge belongs to the triangle on its left seen from the
//! vertex that made the edge, or from its smaller end. So the order does not depend on that of the
//! rows, and each prefix of it is a level of detail.
//!
//! Terminates: each step inserts a point. A step takes time linear in the number of points in the
//! triangles that it changes: for n points of terrain, O(n log n) altogether; O(n^2) at worst.

mod heap;
mod plane;
mod task;
mod work;

pub use self::task::{Simplified, Task};

use self::work::Work;
use crate::base::error::Result;
use crate::base::watch::Watch;

/// Simplifies a surface.
pub fn simplify(task: Task, watch: &Watch) -> Result<Simplified> {
    let mut work = Work::start(task, watch)?;
    work.run(watch)?;
    Ok(work.found)
}

#[cfg(test)]
mod tests;
