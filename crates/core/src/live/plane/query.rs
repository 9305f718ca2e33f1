//! The nearest vertex among segments.

use std::collections::HashSet;

use delone_predicates::Point2;

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::watch::Pace;
use crate::live::kernel::Kernel;
use crate::locate::squared;
use crate::mesh::plane::{half_edges, triangle};

/// More than the error of squared distances to edges.
const SLACK: f64 = 1.0 + 1e-6;

impl Mesh {
    /// The nearest vertex to `q` where segments may separate it from its neighbors.
    ///
    /// The part of the hull in a disk around `q` is convex, so the triangles that meet it are joined
    /// by edges that meet it: from those of a vertex on its border, all nearer vertices are found.
    pub fn nearest_among_segments(&self, t: u32, q: Point2, pace: &mut Pace) -> Result<i64> {
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
            for e in half_edges(t) {
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
}

/// The squared distance from `q` to an edge, less a bound of its error.
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
