//! Queries of the current triangulation: the simplex of a point, and the nearest vertex.

use delone_predicates::Sign;

use super::Live;
use super::kernel::Kernel;
use super::rows::NONE;
use super::store::{INFINITE, corners};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::locate::is_finite;

/// Queries between two checks for interruption.
const LOT: usize = 1 << 10;

/// The corners of the simplices of queries.
#[derive(Debug, Default)]
pub struct Corners<const N: usize> {
    /// Rows of the corners of a simplex that contains each query, -1 outside.
    pub rows: Vec<[i64; N]>,
    /// Their weights, NaN outside.
    pub weights: Vec<[f64; N]>,
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> Live<K, D, N> {
    /// For each query, a simplex that contains it inside or on its boundary.
    pub fn corners(&mut self, queries: &[[f64; D]], watch: &Watch) -> Result<Corners<N>> {
        let mut found = Corners {
            rows: with_room(queries.len())?,
            weights: with_room(queries.len())?,
        };
        let mut pace = Pace::new(watch, LOT);
        for &q in queries {
            pace.spend(1)?;
            let (rows, weights) = match self.simplex_of(q, watch)? {
                Some(t) => self.weights(t, q),
                None => ([-1; N], [f64::NAN; N]),
            };
            found.rows.push(rows);
            found.weights.push(weights);
        }
        Ok(found)
    }

    /// The simplex of a query, if there is one.
    fn simplex_of(&mut self, q: [f64; D], watch: &Watch) -> Result<Option<u32>> {
        if self.mesh.is_flat() || !is_finite(&q) {
            return Ok(None);
        }
        let t = self.mesh.find(q, watch)?;
        Ok((!self.corners_of(t).contains(&INFINITE)).then_some(t))
    }

    fn corners_of(&self, t: u32) -> [u32; N] {
        corners(&self.mesh.records[t as usize])
    }

    /// The rows of the corners of a simplex, and the weights of a point in it.
    fn weights(&self, t: u32, q: [f64; D]) -> ([i64; N], [f64; N]) {
        let corners = self.corners_of(t);
        let rows = corners.map(|v| i64::from(self.mesh.sites[v as usize].head));
        (rows, K::weights(corners.map(|v| self.mesh.at(v)), q))
    }

    /// The row of the point nearest to each query; of points as near, the smallest row. It is -1 for a
    /// query that is not finite, and for all queries of an empty triangulation.
    pub fn nearest(&mut self, queries: &[[f64; D]], watch: &Watch) -> Result<Vec<i64>> {
        let mut found = with_room(queries.len())?;
        let mut pace = Pace::new(watch, LOT);
        let mut lists = Lists::default();
        for &q in queries {
            pace.spend(1)?;
            let finite = is_finite(&q) && !self.is_empty();
            found.push(match finite {
                false => -1,
                true if self.mesh.is_flat() => self.nearest_flat(q, &mut pace)?,
                true => {
                    let t = self.mesh.find(q, watch)?;
                    match self.mesh.nearest_among(t, q, &mut pace)? {
                        Some(row) => row,
                        None => self.nearest_from(t, q, &mut lists, &mut pace)?,
                    }
                }
            });
        }
        Ok(found)
    }

    /// The nearest point if there is no simplex.
    fn nearest_flat(&self, q: [f64; D], pace: &mut Pace) -> Result<i64> {
        let mut best = self.flat[0];
        for &v in &self.flat[1..] {
            pace.spend(1)?;
            if self.mesh.is_better(q, v, best) {
                best = v;
            }
        }
        Ok(i64::from(self.mesh.sites[best as usize].head))
    }

    /// The nearest vertex to `q`, from a corner of `t`: as long as a vertex is not the nearest, one of
    /// its neighbors is nearer (see `locate::nearest`). Of several, all are joined by edges.
    fn nearest_from(
        &mut self,
        t: u32,
        q: [f64; D],
        lists: &mut Lists,
        pace: &mut Pace,
    ) -> Result<i64> {
        let Lists { around, ties } = lists;
        let mut best = NONE;
        for v in self.corners_of(t) {
            if v != INFINITE && (best == NONE || self.mesh.is_better(q, v, best)) {
                best = v;
            }
        }
        // Continue to the nearest neighbor, until none is nearer.
        let mut here = best;
        loop {
            self.mesh.around(here, around, pace)?;
            for &v in around.iter() {
                if self.mesh.is_better(q, v, best) {
                    best = v;
                }
            }
            if best == here {
                break;
            }
            here = best;
        }
        // Then visit all vertices that are as near.
        ties.clear();
        push(ties, best)?;
        let mut done = 0;
        while done < ties.len() {
            self.mesh.around(ties[done], around, pace)?;
            for &v in around.iter() {
                let order = K::nearer(q, self.mesh.at(v), self.mesh.at(best));
                if order == Sign::Zero && !ties.contains(&v) {
                    push(ties, v)?;
                }
            }
            done += 1;
        }
        let head = |&v: &u32| self.mesh.sites[v as usize].head;
        Ok(ties.iter().map(head).min().map_or(-1, i64::from))
    }
}

/// Memory that queries share.
#[derive(Default)]
struct Lists {
    /// The neighbors of a vertex.
    around: Vec<u32>,
    /// Vertices that are as near as the nearest.
    ties: Vec<u32>,
}
