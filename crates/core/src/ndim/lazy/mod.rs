//! Point location without a triangulation, in any dimension: the simplex of the canonical Delaunay
//! triangulation that contains a query, or a proof that there is none.
//!
//! The simplex is the optimal basis of a linear program (K. L. Clarkson, P. W. Shor, 1989, for the
//! duality). The primal simplex method in doubles proposes one for the nearest sites; a tree of boxes
//! finds the sites in its sphere, exactly, which join; when there are none, it is proven. T. H. Chang,
//! L. T. Watson and others ("Algorithm 1012: DELAUNAYSPARSE", 2020) walk to it by the dual method,
//! with tolerances. Where roundings defeat the proposals, exact pivots find a simplex and an exact
//! walk leads from it to the query.
//!
//! The number of coordinates is not a constant here, as it has no limit in principle.

mod program;
mod proven;
mod search;
mod sites;
mod tree;

pub use search::{Counts, Limits};

use search::{Search, Worker};

use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::parallel::map_watched;
use crate::base::watch::Watch;

/// Queries of one task: neighbors in a batch are often in the same simplex.
const SHARE: usize = 64;

/// The locations of queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// Rows of the corners, `d + 1` for each query; -1 outside.
    pub rows: Vec<i32>,
    /// The weights of the corners; NaN outside.
    pub weights: Vec<f64>,
    /// How the queries were answered.
    pub counts: Counts,
}

/// Points that are asked for the simplices of queries.
pub struct Lazy {
    search: Search,
}

impl Lazy {
    /// From finite points of `d` coordinates each, row by row, which must span the space.
    pub fn new(points: &[f64], d: usize, watch: &Watch) -> Result<Self> {
        Self::limited(points, d, Limits::USUAL, watch)
    }

    /// The same with other limits, which do not change the simplices.
    pub fn limited(points: &[f64], d: usize, limits: Limits, watch: &Watch) -> Result<Self> {
        Ok(Self {
            search: Search::new(points, d, limits, watch)?,
        })
    }

    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        self.search.sites.d
    }

    /// Rows that repeat earlier rows, ascending, and the first of these.
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.search.sites.duplicates
    }

    /// Locates queries, row by row; those that are not finite are outside.
    pub fn locate(&self, queries: &[f64], workers: usize, watch: &Watch) -> Result<Located> {
        let d = self.dimension();
        let (count, w) = (queries.len() / d, d + 1);
        let mut rows = filled(count * w, -1)?;
        let mut weights = filled(count * w, f64::NAN)?;
        let parts = queries.chunks(SHARE * d);
        let out = rows
            .chunks_mut(SHARE * w)
            .zip(weights.chunks_mut(SHARE * w));
        let tasks = parts.zip(out).collect();
        let done = map_watched(workers, tasks, watch, |(part, (rows, weights))| {
            let mut worker = Worker::default();
            let out = rows.chunks_exact_mut(w).zip(weights.chunks_exact_mut(w));
            for (q, (rows, weights)) in part.chunks_exact(d).zip(out) {
                if !q.iter().all(|x| x.is_finite()) {
                    continue;
                }
                if let Some(inside) = self.search.find(q, &mut worker, watch)? {
                    for (row, &p) in rows.iter_mut().zip(&inside.corners) {
                        *row = self.search.sites.rows[p as usize] as i32;
                    }
                    weights.copy_from_slice(&inside.weights);
                }
            }
            Ok(worker.counts)
        })?;
        let mut counts = Counts::default();
        for part in done {
            counts.again += part.again;
            counts.proposed += part.proposed;
            counts.pivots += part.pivots;
            counts.apart += part.apart;
            counts.walks += part.walks;
        }
        Ok(Located {
            rows,
            weights,
            counts,
        })
    }
}
