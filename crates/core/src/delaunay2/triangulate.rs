//! From rows of coordinates to arrays of triangles: scan, order, build, export.

use std::time::{Duration, Instant};

use delone_predicates::Point2;

use super::bowyer_watson;
use crate::error::{Error, Result};
use crate::mesh2::export;
use crate::order::curve;
use crate::points;
use crate::watch::Watch;

/// How a triangulation is built; the triangles are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// What is fastest: cavity insertion along the curve.
    Auto,
    /// Cavity insertion along the curve.
    BowyerWatson,
}

impl Method {
    /// The names by which callers ask for methods.
    pub const NAMES: [(&'static str, Self); 2] =
        [("auto", Self::Auto), ("bowyer-watson", Self::BowyerWatson)];

    /// The method of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES
            .iter()
            .find(|(n, _)| *n == name)
            .map(|&(_, m)| m)
    }
}

/// A part of the work and the time it took.
pub type Stage = (&'static str, Duration);

/// Triangles in the rows of the input.
#[derive(Debug)]
pub struct Triangulation {
    /// Triangles and their neighbours.
    pub arrays: export::Arrays,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// Where the time went.
    pub stages: Vec<Stage>,
}

/// The canonical Delaunay triangulation of `input`.
pub fn triangulate(input: &[Point2], method: Method, watch: &Watch) -> Result<Triangulation> {
    let mut clock = Clock::start();
    let extent = points::scan(input)?;
    clock.lap("scan");
    let mut ordered = curve::along_curve(input, &extent, watch)?;
    clock.lap("order");
    let mesh = match method {
        Method::Auto | Method::BowyerWatson => {
            bowyer_watson::build(&mut ordered.points, &extent, watch)?
        }
    };
    let Some(mesh) = mesh else {
        return Err(points::degenerate(&ordered.points, &ordered.rows));
    };
    clock.lap("build");
    watch.check()?;
    if mesh.len() != 2 * ordered.rows.len() - 2 {
        return Err(Error::Internal(format!(
            "{} triangles were made",
            mesh.len()
        )));
    }
    drop(ordered.points);
    let arrays = export::arrays(&mesh, &ordered.rows)?;
    clock.lap("export");
    Ok(Triangulation {
        arrays,
        duplicates: ordered.duplicates,
        stages: clock.stages,
    })
}

/// Times the stages one after the other.
struct Clock {
    last: Instant,
    stages: Vec<Stage>,
}

impl Clock {
    fn start() -> Self {
        Self {
            last: Instant::now(),
            stages: Vec::with_capacity(4),
        }
    }

    fn lap(&mut self, name: &'static str) {
        let now = Instant::now();
        self.stages
            .push((name, now - std::mem::replace(&mut self.last, now)));
    }
}
