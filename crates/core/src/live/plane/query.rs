//! Queries of the present triangulation: the triangle of a point, and the nearest vertex.

use std::collections::HashSet;

use delone_predicates::{Point2, Sign, nearer, orient2d};

use super::Plane;
use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::live::rows::NONE;
use crate::locate::{barycentric_weights, is_finite, squared};
use crate::mesh::plane::{Code, next, triangle};

/// Queries between two checks for interruption.
const LOT: usize = 1 << 10;

/// More than the error of squared distances to edges.
const SLACK: f64 = 1.0 + 1e-6;

/// The corners of the triangles of queries.
#[derive(Debug, Default)]
pub struct Corners {
    /// Rows of the corners of a triangle that contains each query, -1 outside.
    pub rows: Vec<[i64; 3]>,
    /// Their weights, NaN outside.
    pub weights: Vec<[f64; 3]>,
}

impl Plane {
    /// For each query, a triangle that contains it inside or on its boundary.
    pub fn corners(&mut self, queries: &[Point2], watch: &Watch) -> Result<Corners> {
        let mut found = Corners {
            rows: with_room(queries.len())?,
            weights: with_room(queries.len())?,
        };
        let mut pace = Pace::new(watch, LOT);
        for &q in queries {
            pace.spend(1)?;
            let (rows, weights) = match self.triangle_of(q, watch)? {
                Some(t) => self.weights(t, q),
                None => ([-1; 3], [f64::NAN; 3]),
            };
            found.rows.push(rows);
            found.weights.push(weights);
        }
        Ok(found)
    }

    /// The triangle of a query, if there is one.
    fn triangle_of(&mut self, q: Point2, watch: &Watch) -> Result<Option<u32>> {
        if self.mesh.is_flat() || !is_finite(&q) {
            return Ok(None);
        }
        let t = self.mesh.find(q, watch)?;
        Ok((!self.mesh.corners(t).contains(&INFINITE)).then_some(t))
    }

    /// The rows of the corners of a triangle, and the weights of a point in it.
    fn weights(&self, t: u32, q: Point2) -> ([i64; 3], [f64; 3]) {
        let corners = self.mesh.corners(t);
        let rows = corners.map(|v| i64::from(self.mesh.sites[v as usize].head));
        let [a, b, c] = corners.map(|v| self.mesh.at(v));
        let on = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)].map(Sign::is_zero);
        (rows, barycentric_weights([a, b, c], on, q))
    }

    /// For each query, the row of the nearest point, the smallest of several; -1 if the query is not
    /// finite or there is no point.
    pub fn nearest(&mut self, queries: &[Point2], watch: &Watch) -> Result<Vec<i64>> {
        let mut found = with_room(queries.len())?;
        let mut pace = Pace::new(watch, LOT);
        let mut ties = Vec::new();
        for &q in queries {
            pace.spend(1)?;
            let finite = is_finite(&q) && !self.is_empty();
            found.push(match finite {
                false => -1,
                true if self.mesh.is_flat() => self.nearest_in_line(q, &mut pace)?,
                true => {
                    let t = self.mesh.find(q, watch)?;
                    match self.mesh.has_segments {
                        true => self.mesh.nearest_among_segments(t, q, &mut pace)?,
                        false => self.mesh.nearest(t, q, &mut ties, &mut pace)?,
                    }
                }
            });
        }
        Ok(found)
    }

    /// The nearest point if there is no triangle.
    fn nearest_in_line(&self, q: Point2, pace: &mut Pace) -> Result<i64> {
        let mut best = self.line[0];
        for &v in &self.line[1..] {
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
    fn is_better(&self, q: Point2, v: u32, best: u32) -> bool {
        match nearer(q, self.at(v), self.at(best)) {
            Sign::Positive => true,
            Sign::Zero => self.sites[v as usize].head < self.sites[best as usize].head,
            Sign::Negative => false,
        }
    }

    /// The nearest vertex to `q`, from a corner of `t`: as long as a vertex is not the nearest, one of
    /// its neighbors is nearer (see `locate::nearest`). Of several, all are joined by edges.
    fn nearest(&self, t: u32, q: Point2, ties: &mut Vec<u32>, pace: &mut Pace) -> Result<i64> {
        let mut best = NONE;
        for v in self.corners(t) {
            if v != INFINITE && (best == NONE || self.is_better(q, v, best)) {
                best = v;
            }
        }
        let mut here = best;
        loop {
            self.around(here, pace, |v| {
                if self.is_better(q, v, best) {
                    best = v;
                }
                Ok(())
            })?;
            if best == here {
                break;
            }
            here = best;
        }
        ties.clear();
        push(ties, best)?;
        let mut done = 0;
        while done < ties.len() {
            self.around(ties[done], pace, |v| {
                if nearer(q, self.at(v), self.at(best)) == Sign::Zero && !ties.contains(&v) {
                    push(ties, v)?;
                }
                Ok(())
            })?;
            done += 1;
        }
        let head = |&v: &u32| self.sites[v as usize].head;
        Ok(ties.iter().map(head).min().map_or(-1, i64::from))
    }

    /// The nearest vertex to `q` where segments may separate it from its neighbors.
    ///
    /// The part of the hull in a disk around `q` is convex, so the triangles that meet it are joined
    /// by edges that meet it: from those of a vertex on its border, all nearer vertices are found.
    fn nearest_among_segments(&self, t: u32, q: Point2, pace: &mut Pace) -> Result<i64> {
        let finite = |t: u32| self.corners(t).into_iter().filter(|&v| v != INFINITE);
        let mut best = finite(t).next().unwrap_or(INFINITE);
        for v in finite(t) {
            if self.is_better(q, v, best) {
                best = v;
            }
        }
        let mut seen = HashSet::new();
        let mut open = Vec::new();
        let start = best;
        let mut corner = self.sites[start as usize].near;
        loop {
            push(&mut open, triangle(corner))?;
            corner = self.turn(corner);
            if corner == self.sites[start as usize].near {
                break;
            }
        }
        while let Some(t) = open.pop() {
            if !seen.insert(t) {
                continue;
            }
            pace.spend(1)?;
            for v in finite(t) {
                if self.is_better(q, v, best) {
                    best = v;
                }
            }
            let reach = squared(q, self.at(best)) * SLACK;
            for e in 8 * t..8 * t + 3 {
                let [u, v] = self.ends(e);
                if u == INFINITE || v == INFINITE {
                    continue;
                }
                let distance = squared_to_edge(q, self.at(u), self.at(v));
                if distance <= reach || !distance.is_finite() || !reach.is_normal() {
                    push(&mut open, triangle(self.opposite(e)))?;
                }
            }
        }
        Ok(i64::from(self.sites[best as usize].head))
    }

    /// Calls `visit` with each neighbor of a vertex but the one at infinity.
    fn around(
        &self,
        v: u32,
        pace: &mut Pace,
        mut visit: impl FnMut(u32) -> Result<()>,
    ) -> Result<()> {
        let first: Code = self.sites[v as usize].near;
        let mut corner = first;
        loop {
            pace.spend(1)?;
            debug_assert!(self.is_live(triangle(corner)));
            let neighbor = self.vertex(next(corner));
            if neighbor != INFINITE {
                visit(neighbor)?;
            }
            corner = self.turn(corner);
            if corner == first {
                return Ok(());
            }
        }
    }
}

/// The squared distance from `q` to an edge, less what it may be wrong by.
fn squared_to_edge(q: Point2, a: Point2, b: Point2) -> f64 {
    let (ab, qa) = ([b[0] - a[0], b[1] - a[1]], [a[0] - q[0], a[1] - q[1]]);
    let length = ab[0] * ab[0] + ab[1] * ab[1];
    let along = -(ab[0] * qa[0] + ab[1] * qa[1]) / length;
    let at = along.clamp(0.0, 1.0);
    let foot = [ab[0].mul_add(at, qa[0]), ab[1].mul_add(at, qa[1])];
    let size = ab[0].abs() + ab[1].abs() + qa[0].abs() + qa[1].abs();
    let distance = foot[0].hypot(foot[1]) - 16.0 * f64::EPSILON * size;
    let least = squared(q, a).min(squared(q, b));
    least.min(distance.max(0.0) * distance.max(0.0))
}
