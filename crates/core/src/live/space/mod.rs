//! A live Delaunay triangulation in 3-D.
//!
//! Every state is the lower hull of the lifted points at heights that depend on coordinates only (see
//! the head of `live`, and of `delaunay::space::cavity` for ghosts over coplanar hull facets): so any order of
//! edits ends in the tetrahedra of a fresh build. `insert` empties the cavity of a point and fills it
//! with a star; `remove` empties the star of a vertex and fills the hole, and its head says why that is
//! the lower hull; `link` puts both into the mesh. Points in one plane have no tetrahedron; they are kept in
//! lexicographic order until a point beside their plane comes.

mod build;
mod edit;
mod export;
mod insert;
mod link;
mod mesh;
mod patch;
mod query;
mod remove;
mod state;
mod walk;

use delone_predicates::Point3;

pub use export::Exported;
pub use query::Corners;
pub use state::{Changes, State};

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points;
use crate::base::watch::Watch;
use crate::live::rows::Rows;
use mesh::Mesh;

/// A live Delaunay triangulation of points in 2-D.
#[derive(Debug)]
pub struct Space {
    mesh: Mesh,
    rows: Rows,
    /// If there is no tetrahedron, the vertices in lexicographic order.
    flat: Vec<u32>,
    /// The state at the last call of `changes`.
    seen: Option<State>,
}

impl Space {
    /// The triangulation of `points`, any number, whose rows are 0, 1, and so on.
    pub fn new(input: &[Point3], workers: usize, watch: &Watch) -> Result<Self> {
        points::scan(input)?;
        let mut rows = with_room(input.len())?;
        rows.extend(0..input.len() as u32);
        Self::of(input, &rows, input.len(), workers, watch)
    }

    /// The triangulation of `points` at `rows`, ascending, where `total` rows have been inserted ever.
    pub fn of(
        input: &[Point3],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        points::scan(input)?;
        let (mesh, rows, flat) = build::built(input, rows, total, workers, watch)?;
        Ok(Self {
            mesh,
            rows,
            flat,
            seen: None,
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

    /// The number of tetrahedra; 0 if all points are in one plane.
    pub fn tetrahedra(&self) -> usize {
        self.mesh.counts.tetrahedra as usize
    }

    /// Whether a row is there.
    pub fn has(&self, row: i64) -> bool {
        self.rows.vertex(row).is_some()
    }

    /// Checks the data structure; for tests.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.mesh.check()?;
        let flat = self.mesh.is_flat();
        if flat != (self.flat.len() == self.vertices()) && self.vertices() > 0 {
            return Err(format!("{} vertices in the list", self.flat.len()));
        }
        let at = |v: &u32| self.mesh.at(*v);
        let sorted = |w: &[Point3]| delone_predicates::lexicographic(w[0], w[1]).is_lt();
        let line: Vec<_> = self.flat.iter().map(at).collect();
        if !line.windows(2).all(sorted) {
            return Err("the list is not in order".into());
        }
        Ok(())
    }
}
