//! Queries of the present triangulation: the tetrahedron of a point, and the nearest vertex.

use delone_predicates::{Point3, Sign, nearer3, orient3d};

use super::Space;
use super::mesh::{INFINITE, Mesh};
use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::memory::{make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::live::rows::NONE;
use crate::locate::is_finite;
use crate::locate::space::{Place, barycentric};
use crate::mesh::space::FACETS;

/// Queries between two checks for interruption.
const LOT: usize = 1 << 10;

/// The corners of the tetrahedra of queries.
#[derive(Debug, Default)]
pub struct Corners {
    /// Rows of the corners of a tetrahedron that contains each query, -1 outside.
    pub rows: Vec<[i64; 4]>,
    /// Their weights, NaN outside.
    pub weights: Vec<[f64; 4]>,
}

impl Space {
    /// For each query, a tetrahedron that contains it inside or on its boundary.
    pub fn corners(&mut self, queries: &[Point3], watch: &Watch) -> Result<Corners> {
        let mut found = Corners {
            rows: with_room(queries.len())?,
            weights: with_room(queries.len())?,
        };
        let mut pace = Pace::new(watch, LOT);
        for &q in queries {
            pace.spend(1)?;
            let (rows, weights) = match self.simplex_of(q, watch)? {
                Some(t) => self.weights(t, q),
                None => ([-1; 4], [f64::NAN; 4]),
            };
            found.rows.push(rows);
            found.weights.push(weights);
        }
        Ok(found)
    }

    /// The tetrahedron of a query, if there is one.
    fn simplex_of(&mut self, q: Point3, watch: &Watch) -> Result<Option<u32>> {
        if self.mesh.is_flat() || !is_finite(&q) {
            return Ok(None);
        }
        let t = self.mesh.find(q, watch)?;
        Ok((!self.mesh.corners(t).contains(&INFINITE)).then_some(t))
    }

    /// The rows of the corners of a tetrahedron, and the weights of a point in it.
    fn weights(&self, t: u32, q: Point3) -> ([i64; 4], [f64; 4]) {
        let corners = self.mesh.corners(t);
        let rows = corners.map(|v| i64::from(self.mesh.sites[v as usize].head));
        let points = corners.map(|v| self.mesh.at(v));
        let on = FACETS.map(|facet| {
            let [a, b, c] = facet.map(|k| points[k]);
            orient3d(a, b, c, q).is_zero()
        });
        let given = Given {
            points: &points,
            simplices: &[[0, 1, 2, 3]],
            neighbors: &[],
        };
        (rows, barycentric(&given, &Place { simplex: 0, on }, q))
    }

    /// For each query, the row of the nearest point, the smallest of several; -1 if the query is not
    /// finite or there is no point.
    pub fn nearest(&mut self, queries: &[Point3], watch: &Watch) -> Result<Vec<i64>> {
        let mut found = with_room(queries.len())?;
        let mut pace = Pace::new(watch, LOT);
        let mut ties = Vec::new();
        for &q in queries {
            pace.spend(1)?;
            let finite = is_finite(&q) && !self.is_empty();
            found.push(match finite {
                false => -1,
                true if self.mesh.is_flat() => self.nearest_flat(q, &mut pace)?,
                true => {
                    let t = self.mesh.find(q, watch)?;
                    self.mesh.nearest(t, q, &mut ties, &mut pace)?
                }
            });
        }
        Ok(found)
    }

    /// The nearest point if there is no tetrahedron.
    fn nearest_flat(&self, q: Point3, pace: &mut Pace) -> Result<i64> {
        let mut best = self.flat[0];
        for &v in &self.flat[1..] {
            pace.spend(1)?;
            if self.mesh.is_better(q, v, best) {
                best = v;
            }
        }
        Ok(i64::from(self.mesh.sites[best as usize].head))
    }
}

impl Mesh {
    /// Whether vertex `v` is nearer to `q` than `best`, or as near with a smaller row.
    fn is_better(&self, q: Point3, v: u32, best: u32) -> bool {
        match nearer3(q, self.at(v), self.at(best)) {
            Sign::Positive => true,
            Sign::Zero => self.sites[v as usize].head < self.sites[best as usize].head,
            Sign::Negative => false,
        }
    }

    /// The nearest vertex to `q`, from a corner of `t`: as long as a vertex is not the nearest, one of
    /// its neighbors is nearer (see `locate::nearest`). Of several, all are joined by edges.
    fn nearest(&mut self, t: u32, q: Point3, ties: &mut Vec<u32>, pace: &mut Pace) -> Result<i64> {
        let mut list = Vec::new();
        let mut best = NONE;
        for v in self.corners(t) {
            if v != INFINITE && (best == NONE || self.is_better(q, v, best)) {
                best = v;
            }
        }
        let mut here = best;
        loop {
            self.around(here, &mut list, pace)?;
            for &v in &list {
                if self.is_better(q, v, best) {
                    best = v;
                }
            }
            if best == here {
                break;
            }
            here = best;
        }
        ties.clear();
        push(ties, best)?;
        let mut done = 0;
        while done < ties.len() {
            self.around(ties[done], &mut list, pace)?;
            for &v in &list {
                if nearer3(q, self.at(v), self.at(best)) == Sign::Zero && !ties.contains(&v) {
                    push(ties, v)?;
                }
            }
            done += 1;
        }
        let head = |&v: &u32| self.sites[v as usize].head;
        Ok(ties.iter().map(head).min().map_or(-1, i64::from))
    }

    /// Lists the neighbors of a vertex but the one at infinity, ascending.
    fn around(&mut self, v: u32, list: &mut Vec<u32>, pace: &mut Pace) -> Result<()> {
        self.gather(v)?;
        pace.spend(self.patch.rim.len())?;
        list.clear();
        for &e in &self.patch.rim {
            make_room(list, 3)?;
            list.extend(self.facet(e));
        }
        list.retain(|&w| w != INFINITE);
        list.sort_unstable();
        list.dedup();
        Ok(())
    }
}
