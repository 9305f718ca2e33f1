//! From rows of coordinates to arrays of tetrahedra: scan, order, build, export.

use std::time::{Duration, Instant};

use delone_predicates::Point3;

use super::insertion;
use crate::error::Result;
use crate::mesh3::export;
use crate::order::space::arrange;
use crate::points;
use crate::watch::Watch;

/// A part of the work and the time it took.
pub type Stage = (&'static str, Duration);

/// Tetrahedra in the rows of the input.
#[derive(Debug)]
pub struct Triangulation3 {
    /// Tetrahedra and their neighbours.
    pub arrays: export::Arrays,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// Where the time went.
    pub stages: Vec<Stage>,
}

/// The canonical Delaunay triangulation of `input`; the same arrays for any number of workers.
pub fn triangulate(input: &[Point3], workers: usize, watch: &Watch) -> Result<Triangulation3> {
    let mut last = Instant::now();
    let mut stages = Vec::with_capacity(4);
    let mut lap = |name: &'static str| {
        let now = Instant::now();
        stages.push((name, now - std::mem::replace(&mut last, now)));
    };
    points::scan(input)?;
    lap("scan");
    let mut arranged = arrange(input, watch)?;
    lap("order");
    // The vertex at infinity.
    arranged.points.push([f64::NAN; 3]);
    let Some(mesh) = insertion::build(&arranged.points, watch)? else {
        arranged.points.pop();
        return Err(points::degenerate_in_space(
            &arranged.points,
            &arranged.rows,
        ));
    };
    lap("build");
    let arrays = export::arrays(mesh, &arranged.rows, workers)?;
    lap("export");
    Ok(Triangulation3 {
        arrays,
        duplicates: arranged.duplicates,
        stages,
    })
}
