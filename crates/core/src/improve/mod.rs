//! Improvement of tetrahedra: edges and faces between vertices are removed and vertices are moved,
//! as long as the worst tetrahedron that is touched becomes better.
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
mod work;

use delone_predicates::Point3;

use crate::error::{Error, Result};
use crate::watch::Watch;

/// Tetrahedra to be improved, and how.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Rows of coordinates, finite.
    pub points: &'a [Point3],
    /// Positively oriented tetrahedra that do not overlap.
    pub simplices: &'a [[i32; 4]],
    /// A label of each; faces between labels stay. Empty where all have one.
    pub labels: &'a [i32],
    /// For each row, whether it stays where it is. Empty where none must.
    pub fixed: &'a [bool],
    /// Tetrahedra with a smaller dihedral angle are worked on, in degrees; and with an obtuse angle
    /// of a smaller weighted sine.
    pub min_angle: f64,
    /// Whether edges and faces are removed.
    pub flips: bool,
    /// Whether vertices move.
    pub smooth: bool,
    /// Whether vertices inside get weights, before all else.
    pub exude: bool,
    /// Whether faces of the boundary in one plane may be flipped.
    pub turn: bool,
    /// Most passes.
    pub passes: usize,
}

/// Changes by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Edges removed.
    pub edges: usize,
    /// Edges of the boundary among them.
    pub boundary: usize,
    /// Removals of faces.
    pub faces: usize,
    /// Moves of vertices.
    pub moves: usize,
    /// Weights given.
    pub weights: usize,
    /// Passes.
    pub passes: usize,
    /// Changes that would have raised the worst quality and were not made: a smallest angle would
    /// have become smaller, or rounding did not allow to tell.
    pub refused: usize,
}

/// Improved tetrahedra.
#[derive(Debug)]
pub struct Improved {
    /// Rows of coordinates, where moved ones are.
    pub points: Vec<Point3>,
    /// Tetrahedra in rows.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
    /// The label of each.
    pub labels: Vec<i32>,
    /// The weight of each row, nought for most.
    pub weights: Vec<f64>,
    /// What was done.
    pub counts: Counts,
    /// Whether the limit on passes ended it while it still gained.
    pub exhausted: bool,
}

/// Called after each pass with its number and how many tetrahedra are below the bound; an error ends
/// the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize, usize) -> Result<()>;

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
