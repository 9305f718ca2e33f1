//! Improvement of tetrahedral meshes: edge and face removal and smoothing, as long as the worst
//! tetrahedron involved gets better.
//!
//! L. A. Freitag and C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing",
//! International Journal for Numerical Methods in Engineering 40 (1997); J. R. Shewchuk, "Two
//! discrete optimization algorithms for the topological improvement of tetrahedral meshes" (2002);
//! B. M. Klingner and J. R. Shewchuk, "Aggressive tetrahedral mesh improvement", 16th International
//! Meshing Roundtable (2007).
//!
//! # What holds at every moment
//!
//! Tetrahedra are positively oriented, exactly; walls stay. A change takes place only if the bounds of
//! `measure` prove, rounding included, that the worst quality of what comes is above that of what
//! goes, and that the smallest dihedral angle among them is not smaller. So the mesh's smallest angle
//! never falls. As old and new tetrahedra fill the same place and all new ones are positive, they
//! cover it once.
//!
//! # Why it ends
//!
//! Each change makes the ascending list of all qualities larger in lexicographic order, so none comes
//! back, and there are finitely many meshes on doubles. Passes are limited as well, and a pass that
//! gains nothing is the last one.
//!
//! # One answer
//!
//! Vertices and tetrahedra are first put in the order of their coordinates, and everything goes on in
//! that order on one thread: the result does not hang on the order of the rows.

mod edge;
mod exude;
mod face;
mod measure;
mod order;
mod smooth;
mod store;
mod task;
mod work;

pub use task::{Counts, Improved, Task, Tell};

use crate::error::{Error, Result};
use crate::watch::Watch;

/// Improves tetrahedra.
pub fn improve(task: Task, watch: &Watch, tell: Tell) -> Result<Improved> {
    for (given, n, name) in [
        (task.labels.len(), task.simplices.len(), "labels"),
        (task.fixed.len(), task.points.len(), "fixed"),
    ] {
        if given != 0 && given != n {
            return Err(Error::Shape(format!("{name} has {given} entries, not {n}")));
        }
    }
    let imported = order::import(task)?;
    let mut work = work::Work::new(imported.store, task)?;
    let exhausted = !work.run(watch, tell)?;
    order::export(work, task, imported.rows, imported.scale, exhausted)
}
