//! Simplification of surfaces with a bound on the error: greedy insertion.
//!
//! A coarse triangulation of the vertices that stay gets the other points one by one, always the one
//! whose height is farthest from the surface: M. Garland and P. S. Heckbert, "Fast polygonal
//! approximation of terrains and height fields", CMU-CS-95-181 (1995). The worst points of all triangles
//! are in a heap. Each triangle has the list of the points in it, and an insertion divides those of the
//! triangles that it changes among the new ones (`lists`). Points of a lattice have no lists: the triangles
//! that change are scanned (`lattice`).
//!
//! Errors are vertical distances as `plane` computes them: doubles that are proven to be at least
//! the true distance, so a bound that they satisfy is satisfied. Triangles are constrained
//! Delaunay, with ties broken by coordinates; of points with equal errors, the lexicographically
//! smallest comes first. In lists, a point on an edge belongs to the triangle on its left seen from the
//! vertex that made the edge, or from its smaller end; in a lattice, to both. So the order does not
//! depend on that of the rows, and each prefix of it is a level of detail.
//!
//! Terminates: each step inserts a point. A step takes time linear in the number of points, or of the
//! columns and nodes of a lattice, in the triangles that it changes: for n points of terrain, O(n log n)
//! altogether; O(n^2) at worst.

mod heap;
mod lattice;
mod lists;
mod plane;
mod points;
mod task;
mod work;

pub use self::task::{Simplified, Task};

use self::lattice::Lattice;
use self::lists::Lists;
use self::plane::is_exact;
use self::work::Work;
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::constrained::marked::Marked;
use crate::mesh::plane::import;

/// Simplifies a surface.
pub fn simplify(task: Task, watch: &Watch) -> Result<Simplified> {
    let mut marked = coarse(&task, watch)?;
    if let Some(lattice) = Lattice::of(&task, watch)? {
        let exact = lattice.is_exact();
        let mut work = Work::start(task, marked, lattice, exact, watch)?;
        work.run(watch)?;
        return Ok(work.found);
    }
    let all = |k: usize| {
        task.coarse
            .points
            .iter()
            .chain(task.points)
            .map(move |p| p[k])
    };
    let exact = is_exact(all(0), all(1), task.heights.iter().chain(task.z).copied());
    let lists = Lists::of(&task, &mut marked, watch)?;
    let mut work = Work::start(task, marked, lists, exact, watch)?;
    work.run(watch)?;
    Ok(work.found)
}

/// The coarse surface, with the edges that stay.
fn coarse(task: &Task, watch: &Watch) -> Result<Marked> {
    let Triangles {
        points: corners,
        simplices,
        neighbors,
    } = task.coarse;
    let mut vertices = with_room(corners.len() + 1)?;
    vertices.extend_from_slice(corners);
    vertices.push([f64::NAN; 2]);
    let (mesh, _) = import::mesh(simplices, Some(neighbors), corners.len(), watch)?;
    let mut marked = Marked::new(mesh, vertices, watch)?;
    for &[u, v] in task.segments {
        let e = marked.edge(u, v)?;
        marked.patch().mark(e, true);
    }
    Ok(marked)
}

#[cfg(test)]
mod tests;
