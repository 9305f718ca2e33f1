//! Weights in the tangent plane of the query, not normalized.
//!
//! Names are those of `frame`. In the tangent plane, the cell of q is the polygon of the y with
//! p y <= m for all neighbors. It lies in the open hemisphere of q, so all of it is in the plane; where q
//! comes to the boundary of a hull it becomes unbounded, and the walls toward the two ends of the
//! edge outweigh all others, as in the plane.
//!
//! **Laplace**: the length of the wall toward s over |p|. A closed polygon has walls whose normals,
//! weighted by their lengths, sum to 0: so the weighted sum of the p is 0.
//!
//! **Sibson**: the area that the cell takes from that of s. Let h(y) be 1 minus the largest q s + p y, of all
//! s: it is positive in the cell and 0 on its boundary, so the integral of its gradient is 0. The
//! gradient is -p in what the cell takes from s: again the weighted sum of the p is 0. (In the plane this
//! is Sibson's identity, 1980.)
//!
//! **Linear**: the areas of the triangles of q and two corners, for which the same is true.
//!
//! So in each case the weighted sum of the sites is a multiple of q: N. T. Langer, A. Belyaev and
//! H.-P. Seidel, "Spherical barycentric coordinates", 2006, derive such weights from planar ones.

use super::cavity::Cavity;
use super::frame::Seen;
use crate::base::vector::{cross2 as cross, minus};
use crate::interpolate::Number;

/// Ratio of the size of all terms to their sum above which too many digits are lost: 1e-7 is left.
const LOST: f64 = (1_u64 << 29) as f64;

/// The y with p y = m and p' y = m'.
#[inline]
fn meet<N: Number>(p: [N; 2], m: N, other: [N; 2], n: N) -> [N; 2] {
    let det = cross(p, other);
    [
        (m * other[1] - n * p[1]) / det,
        (n * p[0] - m * other[0]) / det,
    ]
}

/// The weights of the corners of the triangle that contains the query.
pub fn linear<N: Number>([a, b, c]: [Seen<N>; 3]) -> [N; 3] {
    [cross(b.p, c.p), cross(c.p, a.p), cross(a.p, b.p)]
}

/// Buffers for the corners of cells.
#[derive(Debug, Default)]
pub struct Corners<N> {
    /// Of the cell of the query: on each edge of the rim.
    new: Vec<[N; 2]>,
    /// Of the old cells: one in each triangle.
    old: Vec<[N; 2]>,
}

impl<N: Number> Corners<N> {
    /// The weights of natural neighbors, by areas or by walls; false if too many digits are lost.
    pub fn weights(
        &mut self,
        cavity: &Cavity,
        seen: &[Seen<N>],
        by_area: bool,
        weights: &mut Vec<N>,
    ) -> bool {
        weights.clear();
        weights.resize(seen.len(), N::constant(0.0));
        self.new.clear();
        let rim = cavity.edges.iter().filter(|edge| edge.right.is_none());
        self.new.extend(rim.map(|edge| {
            let [u, v] = edge.ends.map(|i| seen[i]);
            meet(u.p, u.m, v.p, v.m)
        }));
        let size = if by_area {
            self.add_areas(cavity, seen, weights)
        } else {
            self.add_walls(cavity, seen, weights)
        };
        let sum: f64 = weights.iter().map(|w| w.value()).sum();
        sum > 0.0 && sum.is_finite() && size <= LOST * sum
    }

    /// For each neighbor its wall: from the corner of the edge that ends there to that of the next.
    fn each_wall(&self, cavity: &Cavity, mut visit: impl FnMut(usize, [N; 2], [N; 2])) {
        let Some(mut last) = self.new.last().copied() else {
            return;
        };
        let rim = cavity.edges.iter().filter(|edge| edge.right.is_none());
        for (edge, &next) in rim.zip(&self.new) {
            visit(edge.ends[0], last, next);
            last = next;
        }
    }

    fn add_walls(&self, cavity: &Cavity, seen: &[Seen<N>], weights: &mut [N]) -> f64 {
        let mut size = 0.0;
        self.each_wall(cavity, |v, from, to| {
            let p = seen[v].p;
            let square = p[0] * p[0] + p[1] * p[1];
            weights[v] = cross(p, minus(to, from)) / square;
            let reach = |c: [N; 2]| c[0].value().abs() + c[1].value().abs();
            size += (reach(from) + reach(to)) / square.value().sqrt();
        });
        size
    }

    /// Twice the areas. The boundary of what is taken from a site goes along the wall, and back from
    /// corner to corner of its old cell.
    fn add_areas(&mut self, cavity: &Cavity, seen: &[Seen<N>], weights: &mut [N]) -> f64 {
        self.old.clear();
        self.old.extend(cavity.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| seen[i]);
            let (p, q) = (minus(a.p, c.p), minus(b.p, c.p));
            meet(p, a.m - c.m, q, b.m - c.m)
        }));
        let mut size = 0.0;
        let mut new = self.new.iter();
        for edge in &cavity.edges {
            let from = self.old[edge.left];
            let to = match edge.right {
                Some(right) => self.old[right],
                None => new.next().copied().unwrap_or(from),
            };
            let term = cross(from, to);
            size += term.value().abs();
            let [u, v] = edge.ends;
            weights[u] = weights[u] - term;
            weights[v] = weights[v] + term;
        }
        self.each_wall(cavity, |v, from, to| {
            let term = cross(from, to);
            size += term.value().abs();
            weights[v] = weights[v] + term;
        });
        size
    }
}
