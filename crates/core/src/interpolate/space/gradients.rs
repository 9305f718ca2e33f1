//! Gradients at vertices of a 3-D triangulation, estimated from the values around them.
//!
//! The method is that of `interpolate::gradients` for planes: a least squares fit to the neighbors.
//! A wider ring is used if the neighbors are too sensitive to the rounding of the values; if the
//! points span fewer than three directions, the gradient is along those.

use std::array::from_fn;
use std::collections::HashMap;

use delone_predicates::{Point3, lexicographic};

use crate::base::error::Result;
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::interpolate::{Adjacency, CLOSE, Field, NEAR, NOISY, WIDE, WIDER};
use crate::locate::{Output, in_unit, length, longest_side, unit_of};

/// Vertices per task.
const SHARE: usize = 1 << 9;

/// Visited neighbors between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;

/// The number of neighbors above which a vertex is a hub, of which each neighbor uses at most as
/// many. A vertex among uniform points has 15.5.
const MANY: usize = 64;

/// Share of the largest singular value below which a direction is not spanned.
const DEPENDENT: f64 = 1e-10;

/// Gradients at the vertices `rows`, three numbers for each row and column, of the linear functions
/// through the vertex that best fit the values around it, weighted by the inverse squared distance.
/// Zero across the directions that the points around do not span, and if doubles cannot represent
/// the gradient.
pub fn local_gradients(
    points: &[Point3],
    adjacency: Adjacency,
    field: Field,
    rows: &[i32],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    let out = Output::filled(3 * rows.len() * field.columns, 0.0, watch)?;
    let unit = unit_of(points);
    let around = Around {
        points,
        unit,
        least: CLOSE * longest_side(points, unit),
        hubs: hubs(points, adjacency, watch)?,
        adjacency,
    };
    let tasks = (0..).step_by(SHARE).zip(rows.chunks(SHARE)).collect();
    parallel::map_watched(workers, tasks, watch, |(first, rows): (usize, &[i32])| {
        let mut pace = Pace::new(watch, WATCH_EVERY);
        for (i, &v) in (first..).zip(rows) {
            pace.spend(adjacency.neighbors(v as usize).len())?;
            for (column, g) in around.gradients(&field, v).into_iter().enumerate() {
                out.set_all(3 * (i * field.columns + column), &g);
            }
        }
        Ok(())
    })?;
    Ok(out.into_vec())
}

/// The neighbors of hubs in lexicographic order.
fn hubs(points: &[Point3], adjacency: Adjacency, watch: &Watch) -> Result<HashMap<i32, Vec<i32>>> {
    let mut found = HashMap::new();
    for v in 0..points.len() {
        if v % WATCH_EVERY == 0 {
            watch.check()?;
        }
        let near = adjacency.neighbors(v);
        if near.len() > MANY {
            let mut sorted = near.to_vec();
            let at = |u: i32| points[u as usize];
            sorted.sort_unstable_by(|&a, &b| lexicographic(at(a), at(b)));
            found.insert(v as i32, sorted);
        }
    }
    Ok(found)
}

/// The surroundings of vertices.
struct Around<'a> {
    points: &'a [Point3],
    unit: f64,
    /// The least size of a ring that is large enough.
    least: f64,
    adjacency: Adjacency<'a>,
    hubs: HashMap<i32, Vec<i32>>,
}

impl Around<'_> {
    /// The gradient of each column at a vertex.
    fn gradients(&self, field: &Field, v: i32) -> Vec<[f64; 3]> {
        let near = self.adjacency.neighbors(v as usize);
        let common = self.fit(v, |_| true);
        let gradient = |column: usize| {
            let known = |u: i32| field.value(u, column).is_finite();
            let own;
            let fit = if near.iter().chain(&common.ring).all(|&u| known(u)) {
                &common
            } else {
                own = self.fit(v, known);
                &own
            };
            let g = fit.gradient(field, v, column).map(|x| x / self.unit);
            if g.iter().all(|x| x.is_finite()) {
                g
            } else {
                [0.0; 3]
            }
        };
        (0..field.columns).map(gradient).collect()
    }

    /// The fit to the neighbors that count, or to a wider ring if that is steady and this is not:
    /// one with their neighbors, and further ones if all of them nearly coincide.
    fn fit(&self, v: i32, counts: impl Fn(i32) -> bool) -> Fit {
        let mut ring = self.adjacency.neighbors(v as usize).to_vec();
        let of = |ring: &[i32]| {
            let ring = ring.iter().copied().filter(|&u| counts(u)).collect();
            Fit::of(self.points, self.unit, v, ring)
        };
        let near = of(&ring);
        if near.is_steady(self.least) {
            return near;
        }
        for _ in 0..WIDER {
            ring = self.wider(v, ring);
            let wide = of(&ring);
            if wide.is_steady(self.least) {
                return wide;
            }
            if wide.size >= self.least || ring.len() > WIDE {
                break;
            }
        }
        near
    }

    /// A ring around a vertex extended by the neighbors of all in it, but of a hub only those
    /// before and after the vertex and as many that are spread evenly: using all of them would take
    /// quadratic time.
    fn wider(&self, v: i32, mut ring: Vec<i32>) -> Vec<i32> {
        for i in 0..ring.len() {
            let u = ring[i];
            let Some(sorted) = self.hubs.get(&u) else {
                ring.extend_from_slice(self.adjacency.neighbors(u as usize));
                continue;
            };
            let at = |u: i32| self.points[u as usize];
            let place = sorted.partition_point(|&w| lexicographic(at(w), at(v)).is_lt());
            let (n, half) = (sorted.len(), MANY / 2);
            let first = (place + n - half / 2) % n;
            ring.extend((0..half).map(|i| sorted[(first + i) % n]));
            ring.extend((0..half).map(|i| sorted[i * n / half]));
        }
        ring.sort_unstable();
        ring.dedup();
        ring.retain(|&u| u != v);
        ring
    }
}

/// The factors that turn differences to surrounding values into a gradient.
struct Fit {
    ring: Vec<i32>,
    factors: Vec<Point3>,
    /// The distance of the farthest.
    size: f64,
    /// How many directions the ring spans.
    rank: usize,
}

impl Fit {
    /// Solves the least squares problem of a ring by the singular value decomposition of its
    /// matrix: the shortest of all solutions.
    fn of(points: &[Point3], unit: f64, v: i32, ring: Vec<i32>) -> Self {
        let p = points[v as usize];
        let ways = ring.iter().map(|&u| in_unit(p, points[u as usize], unit));
        let ways: Vec<Point3> = ways.collect();
        let size = ways.iter().map(|&w| length(w)).fold(0.0, f64::max);
        let mut factors = vec![[0.0; 3]; ring.len()];
        let mut rank = 0;
        if size > 0.0 && size.is_finite() {
            let weight = |w: &Point3| size / length(*w).max(NEAR * size);
            let weights: Vec<f64> = ways.iter().map(weight).collect();
            let rows = ways.iter().zip(&weights);
            let mut rows: Vec<Point3> = rows.map(|(w, f)| w.map(|x| x / size * f)).collect();
            let axes = orthogonal(&mut rows);
            let squares: Point3 = from_fn(|k| rows.iter().map(|r| r[k] * r[k]).sum());
            let least = squares.iter().fold(0.0_f64, |m, &s| m.max(s)) * (DEPENDENT * DEPENDENT);
            for k in (0..3).filter(|&k| squares[k] > least) {
                rank += 1;
                for ((factor, row), weight) in factors.iter_mut().zip(&rows).zip(&weights) {
                    let share = row[k] / squares[k] * weight / size;
                    *factor = from_fn(|i| factor[i] + axes[k][i] * share);
                }
            }
        }
        Self {
            ring,
            factors,
            size,
            rank,
        }
    }

    /// Whether it spans all directions, is at least as large as `least`, and the rounding of values
    /// is negligible.
    fn is_steady(&self, least: f64) -> bool {
        let factors = self.factors.as_flattened();
        let norm = factors.iter().fold(0.0, |norm: f64, f| norm.hypot(*f));
        self.rank == 3 && self.size >= least && norm * self.size <= NOISY
    }

    fn gradient(&self, field: &Field, v: i32, column: usize) -> Point3 {
        let value = field.value(v, column);
        let mut g = [0.0; 3];
        for (f, &u) in self.factors.iter().zip(&self.ring) {
            let rise = field.value(u, column) - value;
            g = from_fn(|k| g[k] + f[k] * rise);
        }
        g
    }
}

/// Rotates the axes until the columns of a matrix are orthogonal (one-sided Jacobi rotations: M. R.
/// Hestenes, "Inversion of matrices by biorthogonalization and related results", 1958), which
/// preserves the digits of small singular values; returns the new axes.
fn orthogonal(rows: &mut [Point3]) -> [Point3; 3] {
    /// Cosines below this are zero up to rounding.
    const STILL: f64 = 1e-15;
    /// More sweeps than three columns need; convergence is quadratic.
    const SWEEPS: usize = 30;
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        let mut still = true;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (mut pp, mut qq, mut pq) = (0.0, 0.0, 0.0);
            for row in rows.iter() {
                pp += row[p] * row[p];
                qq += row[q] * row[q];
                pq += row[p] * row[q];
            }
            if pq.abs() <= STILL * (pp * qq).sqrt() {
                continue;
            }
            still = false;
            let zeta = (qq - pp) / (2.0 * pq);
            let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            let turn = |x: f64, y: f64| (cosine * x - sine * y, sine * x + cosine * y);
            for row in rows.iter_mut() {
                (row[p], row[q]) = turn(row[p], row[q]);
            }
            let (one, other) = (axes[p], axes[q]);
            axes[p] = from_fn(|k| turn(one[k], other[k]).0);
            axes[q] = from_fn(|k| turn(one[k], other[k]).1);
        }
        if still {
            break;
        }
    }
    axes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fit of a linear function to a ring around the first point.
    fn slope(points: &[Point3], g: Point3) -> (Point3, usize) {
        let values: Vec<f64> = points
            .iter()
            .map(|p| (0..3).map(|k| p[k] * g[k]).sum())
            .collect();
        let field = Field::of_rows(points.len(), &values, None, 1).unwrap();
        let fit = Fit::of(points, 1.0, 0, (1..points.len() as i32).collect());
        (fit.gradient(&field, 0, 0), fit.rank)
    }

    #[test]
    fn linear_functions_have_their_slope_along_what_is_spanned() {
        let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 4.0]];
        let (found, rank) = slope(&corner, [1.0, 2.0, 3.0]);
        assert_eq!(rank, 3);
        (0..3).for_each(|k| assert!((found[k] - [1.0, 2.0, 3.0][k]).abs() < 1e-14));
        let plane = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [3.0, 2.0, 1.0]];
        let (found, rank) = slope(&plane, [1.0, 1.0, 1.0]);
        // The shortest: without its component along the normal (1, -1, -1) / sqrt(3).
        assert_eq!(rank, 2);
        (0..3).for_each(|k| assert!((found[k] - [4.0, 2.0, 2.0][k] / 3.0).abs() < 1e-14));
        let (found, rank) = slope(&[[0.0; 3], [1.0, 2.0, 2.0]], [1.0, 1.0, 1.0]);
        assert_eq!(rank, 1);
        (0..3).for_each(|k| assert!((found[k] - [5.0, 10.0, 10.0][k] / 9.0).abs() < 1e-14));
        assert_eq!(slope(&[[0.0; 3]], [1.0; 3]), ([0.0; 3], 0));
    }

    #[test]
    fn a_near_duplicate_counts_no_more_than_rounding_allows() {
        let twin = 2f64.powi(-52);
        let points = [
            [1.0, 1.0, 1.0],
            [1.0 + twin, 1.0, 1.0],
            [2.0, 1.0, 1.0],
            [1.0, 2.0, 1.0],
            [1.0, 1.0, 2.0],
        ];
        let (found, rank) = slope(&points, [0.1, 0.2, 0.3]);
        assert_eq!(rank, 3);
        (0..3).for_each(|k| assert!((found[k] - [0.1, 0.2, 0.3][k]).abs() < 1e-10));
    }
}
