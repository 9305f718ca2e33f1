//! A live Delaunay triangulation in 2-D.

mod atomic;
mod build;
mod constrained;
mod detach;
mod ears;
mod edit;
mod export;
mod insert;
mod marks;
mod mesh;
mod near;
mod query;
mod reinsert;
mod remove;
mod retriangulate;
mod segments;
mod shift;
mod state;
mod walk;

use delone_predicates::Point2;

pub use export::Exported;
pub use query::Corners;
pub use state::{Changes, State};

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points;
use crate::base::watch::Watch;
use crate::live::rows::Rows;
use mesh::Mesh;
use segments::Segments;

/// The triangulation before an edit that may be taken back.
#[derive(Debug, Default)]
struct Before {
    is_kept: bool,
    /// What has been replaced as a whole: the mesh, the rows, and the line.
    replaced: Option<(Mesh, Rows, Vec<u32>)>,
}

/// A live Delaunay triangulation of points in 2-D.
#[derive(Debug)]
pub struct Plane {
    mesh: Mesh,
    rows: Rows,
    /// If there is no triangle, the vertices in order along their line.
    line: Vec<u32>,
    segments: Segments,
    /// The state at the last call of `changes`.
    seen: Option<State>,
    /// During an edit that may be taken back, what has been replaced.
    before: Before,
}

impl Plane {
    /// The triangulation of `points`, any number, whose rows are 0, 1, and so on.
    pub fn new(input: &[Point2], workers: usize, watch: &Watch) -> Result<Self> {
        points::scan(input)?;
        let mut rows = with_room(input.len())?;
        rows.extend(0..input.len() as u32);
        Self::of(input, &rows, input.len(), workers, watch)
    }

    /// The triangulation of `points` at `rows`, ascending, where `total` rows have been inserted ever.
    pub fn of(
        input: &[Point2],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        points::scan(input)?;
        let (mesh, rows, line) = build::built(input, rows, total, workers, watch)?;
        Ok(Self {
            mesh,
            rows,
            line,
            segments: Segments::new(false)?,
            seen: None,
            before: Before::default(),
        })
    }

    /// The number of rows that are there.
    pub fn len(&self) -> usize {
        self.rows.live()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of the next row to be inserted.
    pub fn total(&self) -> usize {
        self.rows.total()
    }

    /// The number of distinct points.
    pub fn vertices(&self) -> usize {
        self.mesh.counts.vertices as usize
    }

    /// The number of triangles; 0 if all points are on one line.
    pub fn triangles(&self) -> usize {
        if self.mesh.is_flat() {
            return 0;
        }
        (2 * self.mesh.counts.vertices - 2 - self.mesh.counts.ghosts) as usize
    }

    /// Whether a row is there.
    pub fn has(&self, row: i64) -> bool {
        self.rows.vertex(row).is_some()
    }

    /// Triangles visited so far; for measurements.
    pub fn work(&self) -> usize {
        self.mesh.work
    }

    /// Checks the data structure; for tests.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.mesh.check()?;
        let flat = self.mesh.is_flat();
        if flat != (self.line.len() == self.vertices()) && self.vertices() > 0 {
            return Err(format!("{} vertices in line", self.line.len()));
        }
        let at = |v: &u32| self.mesh.at(*v);
        let sorted = |w: &[Point2]| delone_predicates::lexicographic(w[0], w[1]).is_lt();
        let line: Vec<_> = self.line.iter().map(at).collect();
        if !line.windows(2).all(sorted) {
            return Err("the line is not in order".into());
        }
        Ok(())
    }
}
