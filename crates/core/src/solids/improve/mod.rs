//! Improves tetrahedral meshes: edge and face removal, smoothing, edge contraction and vertex insertion,
//! as long as the worst tetrahedron improves. `relax` coarsens and smooths meshes instead.
//!
//! L. A. Freitag and C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and
//! smoothing", International Journal for Numerical Methods in Engineering 40 (1997); J. R.
//! Shewchuk, "Two discrete optimization algorithms for the topological improvement of tetrahedral
//! meshes" (2002); B. M. Klingner and J. R. Shewchuk, "Aggressive tetrahedral mesh improvement",
//! 16th International Meshing Roundtable (2007).
//!
//! # Invariants
//!
//! Tetrahedra are positively oriented, exactly. Walls do not change, except that two coplanar ones
//! may be flipped, and vertices slide in exactly flat facets and straight edges (see `slide`), if the task
//! permits it. With a tolerance, tetrahedra at the boundary are removed (see `peel`). Any other change is made only if the
//! bounds of `measure` prove, rounding included, that the worst quality of the new tetrahedra is
//! above that of the old ones, and that their smallest dihedral angle is not smaller. So the
//! smallest angle of the mesh never decreases. Since old and new tetrahedra fill the same region
//! and all new ones are positive, they cover it once.
//!
//! # Why it terminates
//!
//! Each change makes the ascending list of all qualities lexicographically larger, where the end of
//! a list counts as infinite, also that of a tetrahedron that is only removed, so no mesh repeats. The number of added vertices is limited, so there
//! are finitely many meshes on doubles. The number of passes is also limited, and a pass that
//! changes nothing is the last one.
//!
//! # Determinism
//!
//! Vertices and tetrahedra are first sorted by coordinates, and everything runs in that order on
//! one thread: the result is independent of the order of the rows.

mod contract;
mod edge;
mod exude;
mod face;
mod insert;
mod measure;
mod order;
mod peel;
mod relax;
mod slide;
mod smooth;
mod store;
mod task;
mod work;

pub(crate) use order::{Imported, import, rotated};
pub use task::{Counts, Improved, Task, Tell};

use crate::base::error::{Error, Result};
use crate::base::target::Target;
use crate::base::watch::Watch;

/// Improves tetrahedra.
pub fn improve(task: Task, watch: &Watch, tell: Tell) -> Result<Improved> {
    changed(task, |work| work.run(watch, &mut *tell))
}

/// Removes vertices of tetrahedra, no two of which are neighbors, where the bound allows it.
pub fn coarsen(task: Task, watch: &Watch) -> Result<Improved> {
    changed(task, |work| work.coarsen(watch).map(|()| true))
}

/// Moves vertices of tetrahedra to their targets, as far as the bound allows, in up to `task.passes`
/// rounds.
pub fn relax(task: Task, target: Target, watch: &Watch) -> Result<Improved> {
    changed(task, |work| {
        for _ in 0..task.passes {
            if !work.relax(target, watch)? {
                break;
            }
        }
        Ok(true)
    })
}

/// Imports tetrahedra, changes them and exports them; `change` returns whether it was completed.
fn changed<'a>(
    task: Task<'a>,
    mut change: impl FnMut(&mut work::Work<'a>) -> Result<bool>,
) -> Result<Improved> {
    for (given, n, name) in [
        (task.labels.len(), task.simplices.len(), "labels"),
        (task.fixed.len(), task.points.len(), "fixed"),
        (task.removable.len(), task.points.len(), "removable"),
    ] {
        if given != 0 && given != n {
            return Err(Error::Shape(format!("{name} has {given} entries, not {n}")));
        }
    }
    // Once more without scaling only if a coordinate of the result would be rounded, as it is
    // subnormal: a tetrahedron might be turned over.
    let mut tiny = true;
    loop {
        let imported = import(task, tiny)?;
        let scaled = Task {
            tolerance: task.tolerance * imported.scale,
            ..task
        };
        let mut work = work::Work::new(imported.store, scaled, &imported.rows)?;
        let exhausted = !change(&mut work)?;
        if !tiny || order::is_exact(&work.store.points, imported.scale) {
            return order::export(work, task, imported.rows, imported.scale, exhausted);
        }
        tiny = false;
    }
}
