//! Live triangulations: points are inserted, removed and moved, and every state is canonical.
//!
//! # Why every order of edits ends in the same triangles
//!
//! Ties are broken by coordinates only (see `delaunay::plane`): each point has a perturbed height that does
//! not depend on the other points, no two of which are tied. So a set of points has one triangulation,
//! the lower hull of its lifted points, and an edit that turns the lower hull of the points before it
//! into that of the points after it leaves nothing of the history behind. Each of the edits does:
//!
//! - *Insertion.* The facets of the lower hull that the new lifted point sees are replaced by the cone
//!   from it to their border.
//! - *Removal.* A facet that does not have the removed point as a corner stays below all other points,
//!   hence a facet. The hole is the star of the point. A facet that fills it was hidden by the point,
//!   and all of its corners were neighbors of it: otherwise one would see the facet past the star. The
//!   facet at a border edge of the hole is spanned by the corner for which no other is below, and the
//!   corner is unique because no four perturbed points are coplanar; so the hole is filled from edge to
//!   edge, by comparisons among its corners.
//! - *Movement.* Where the star of a vertex keeps its orientation, the moved surface is a triangulation
//!   of the moved points, and flips turn any triangulation into the lower hull (see
//!   `delaunay::plane::lawson`); a surface without an edge to flip is the lower hull already. Otherwise a
//!   movement is a removal and an insertion.
//! - *A rebuild* computes the lower hull from the points.
//!
//! A ghost is a facet through the point at infinity, and the hull of points in a plane is not
//! perturbed, so all of this holds at the hull, too. Points on one line have no triangle; they are
//! kept in order along the line until a point restores the plane.
//!
//! # All or nothing
//!
//! Edits reserve memory before they change anything. A batch that fails in the middle, because
//! memory is refused or the caller wants to stop, is undone by the inverse edits in reverse order;
//! as each state is unique, they lead to the triangles of the start. Among segments, what an edit
//! replaces is recorded (see `journal`).

//! # One code for 2-D and 3-D
//!
//! [`Live`] is generic over the mesh of a dimension, a [`Kernel`], which inserts, removes, moves and finds.
//! Batches, snapshots, queries and exports are the same in both.

mod build;
pub mod chunks;
mod edit;
mod export;
mod journal;
mod kernel;
pub mod plane;
mod query;
pub mod rows;
pub mod space;
mod state;
mod store;

pub use export::Exported;
pub use kernel::{Built, Constraints, Kernel, Move};
pub use query::Corners;
pub use state::{Changes, State};
pub use store::{Place, Removed, Store};

use delone_predicates::lexicographic;

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points;
use crate::base::watch::Watch;
use rows::{NONE, Rows};

/// A live Delaunay triangulation by the mesh `K` of simplices with `N` corners of `D` coordinates.
#[derive(Debug)]
pub struct Live<K: Kernel<D, N>, const D: usize, const N: usize> {
    mesh: K,
    rows: Rows,
    /// If there is no simplex, the vertices in lexicographic order.
    flat: Vec<u32>,
    /// Segments among the points; only in 2-D.
    segments: K::Segments,
    /// The state at the last call of `changes`.
    seen: Option<State<K, D, N>>,
    /// During an edit that may be taken back, what it has replaced as a whole.
    before: Option<Option<Built<K>>>,
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> Live<K, D, N> {
    /// The triangulation of `points`, any number, whose rows are 0, 1, and so on.
    pub fn new(input: &[[f64; D]], workers: usize, watch: &Watch) -> Result<Self> {
        points::scan(input)?;
        let mut rows = with_room(input.len())?;
        rows.extend(0..input.len() as u32);
        Self::of(input, &rows, input.len(), workers, watch)
    }

    /// The triangulation of `points` at `rows`, ascending, where `total` rows have ever been
    /// inserted.
    pub fn of(
        input: &[[f64; D]],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        points::scan(input)?;
        let (mesh, rows, flat) = K::built(input, rows, total, workers, watch)?;
        Ok(Self {
            mesh,
            rows,
            flat,
            segments: K::Segments::none()?,
            seen: None,
            before: None,
        })
    }

    /// The number of present rows.
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

    /// The number of triangles or tetrahedra; 0 if all points are in one line or plane.
    pub fn simplices(&self) -> usize {
        self.mesh.counts.simplices as usize
    }

    /// Whether a row is present.
    pub fn has(&self, row: i64) -> bool {
        self.rows.vertex(row).is_some()
    }

    /// Records visited so far; for measurements.
    pub fn work(&self) -> usize {
        self.mesh.work
    }

    /// Checks the data structure; for tests.
    pub fn check(&self) -> std::result::Result<(), String> {
        self.mesh.check()?;
        let flat = self.mesh.is_flat();
        if flat != (self.flat.len() == self.vertices()) && self.vertices() > 0 {
            return Err(format!("{} vertices in the list", self.flat.len()));
        }
        if flat && self.mesh.counts.site != NONE {
            return Err("a free site without simplices, which `restore` would list".into());
        }
        let at = |v: &u32| self.mesh.at(*v);
        let sorted = |w: &[[f64; D]]| lexicographic(w[0], w[1]).is_lt();
        let line: Vec<_> = self.flat.iter().map(at).collect();
        if !line.windows(2).all(sorted) {
            return Err("the list is not in order".into());
        }
        Ok(())
    }
}
