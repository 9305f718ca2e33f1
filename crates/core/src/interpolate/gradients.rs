//! Estimates gradients at the vertices from the values around them.

use delone_predicates::Point2;

use super::adjacency::Adjacency;
use super::field::Field;
use super::hubs::Hubs;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::locate::{Output, in_unit, longest_side, unit_of};

/// Vertices between two checks for interruption, and per task.
const SHARE: usize = 1 << 12;

/// Visited edges between two checks for interruption.
const EDGES: usize = 1 << 17;

/// Share of the longest edge below which an edge counts in a local fit only as if it were that
/// long. The rounding of two values causes a slope between them, which is larger the nearer they
/// are; and the nearer they are, the more weight they would have. So about 1e-11 of the values over
/// the distances is left of that slope.
pub const NEAR: f64 = 1e-5;

/// An edge from a vertex.
#[derive(Debug, Clone, Copy)]
struct Edge {
    way: [f64; 2],
    /// The inverse of the cube of its length.
    weight: f64,
}

/// Gradients that minimize the total bending of the curves along all edges: G. M. Nielson, "A
/// method for interpolating scattered data based upon a minimum norm network", 1983.
///
/// A cubic along an edge of length L with end values f, f' and derivatives p, p' along the edge
/// (not per unit of length) bends by 4 (p^2 + p p' + p'^2 - 3 (p + p')(f' - f) + 3 (f' - f)^2) /
/// L^3. The minimum over one gradient, all others fixed, is a system of two equations. Sweeps over
/// all vertices continue until none changes its gradient by more than `tol` of that gradient, or of
/// a floor if that is larger (R. J. Renka and A. K. Cline, 1984, and SciPy, whose sweeps are the
/// same). `floor` is 1 in SciPy, which depends on the units of points and values; if it is not
/// given, it is the slope of a plane with the range of the values over the longer side of the box
/// of the points. Returns gradients, and for each column the number of sweeps, or 0 if `maxiter`
/// did not suffice.
#[expect(clippy::too_many_arguments, reason = "two ends, threads and the watch")]
pub fn global_gradients(
    points: &[Point2],
    adjacency: Adjacency,
    field: Field,
    tol: f64,
    floor: Option<f64>,
    maxiter: usize,
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<f64>, Vec<i64>)> {
    let unit = unit_of(points);
    let plan = Sweeps {
        points,
        adjacency,
        unit,
        side: longest_side(points, unit),
        tol,
        floor,
        maxiter,
    };
    // All columns without missing values share the same equations.
    let common = Network::of(&plan, |_| true, watch)?;
    let columns = (0..field.columns).collect();
    let solved = parallel::map(workers, columns, |column| {
        let known = |v: i32| field.value(v, column).is_finite();
        if (0..points.len() as i32).all(known) {
            return common.sweep(&plan, &field, column, watch);
        }
        Network::of(&plan, known, watch)?.sweep(&plan, &field, column, watch)
    });
    let mut gradients = filled(2 * points.len() * field.columns, 0.0)?;
    let mut counts = Vec::with_capacity(field.columns);
    let mut pace = Pace::new(watch, EDGES);
    for (column, solved) in solved.into_iter().enumerate() {
        let (found, count) = solved?;
        counts.push(count);
        for (v, g) in found.into_iter().enumerate() {
            pace.spend(1)?;
            if let Some(g) = finite(g.map(|x| x / plan.unit)) {
                let i = 2 * (v * field.columns + column);
                gradients[i..i + 2].copy_from_slice(&g);
            }
        }
    }
    Ok((gradients, counts))
}

/// A gradient, if doubles can represent it. If not, the estimate is zero.
fn finite(g: [f64; 2]) -> Option<[f64; 2]> {
    (g[0].is_finite() && g[1].is_finite()).then_some(g)
}

/// The parameters that all sweeps share.
struct Sweeps<'a> {
    points: &'a [Point2],
    adjacency: Adjacency<'a>,
    unit: f64,
    side: f64,
    tol: f64,
    floor: Option<f64>,
    maxiter: usize,
}

impl Sweeps<'_> {
    /// The size of gradients of a column below which changes are measured against it instead.
    fn floor(&self, field: &Field, column: usize) -> f64 {
        if let Some(floor) = self.floor {
            return floor;
        }
        let values = (0..self.points.len() as i32).map(|v| field.value(v, column));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            (low, high) = (low.min(value), high.max(value));
        }
        let floor = (high - low).min(f64::MAX) / self.side;
        // Missing or constant values have no slope, and neither do coincident points.
        if floor.is_finite() { floor } else { 0.0 }
    }
}

/// The equations of all vertices.
struct Network {
    /// Parallel to the indices of the adjacency; the weight is zero if they lead to an unknown
    /// value.
    edges: Vec<Edge>,
    /// For each vertex the inverse of its matrix: xx, xy, yy.
    inverses: Vec<[f64; 3]>,
}

/// The inverse of a symmetric matrix (xx, xy, yy); on its line if all edges are collinear.
fn inverse([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let det = xx * yy - xy * xy;
    if det > 0.0 {
        return [yy / det, -xy / det, xx / det];
    }
    let trace = xx + yy;
    [xx, xy, yy].map(|x| x / trace / trace)
}

impl Network {
    /// Sets them up for the vertices whose values are known.
    fn of(plan: &Sweeps, known: impl Fn(i32) -> bool, watch: &Watch) -> Result<Self> {
        let mut pace = Pace::new(watch, EDGES);
        let mut edges = with_room(plan.adjacency.indices.len())?;
        let mut inverses = with_room(plan.points.len())?;
        for (v, &p) in plan.points.iter().enumerate() {
            pace.spend(1 + plan.adjacency.neighbors(v).len())?;
            let mut m = [0.0; 3];
            for &other in plan.adjacency.neighbors(v) {
                let way = in_unit(p, plan.points[other as usize], plan.unit);
                let length = way[0].hypot(way[1]);
                let weight = if known(other) {
                    1.0 / (length * length * length)
                } else {
                    0.0
                };
                m[0] += 4.0 * way[0] * way[0] * weight;
                m[1] += 4.0 * way[0] * way[1] * weight;
                m[2] += 4.0 * way[1] * way[1] * weight;
                edges.push(Edge { way, weight });
            }
            inverses.push(inverse(m));
        }
        Ok(Self { edges, inverses })
    }

    /// Sweeps over one column until its gradients converge.
    fn sweep(
        &self,
        plan: &Sweeps,
        field: &Field,
        column: usize,
        watch: &Watch,
    ) -> Result<(Vec<[f64; 2]>, i64)> {
        let mut pace = Pace::new(watch, EDGES);
        let n = self.inverses.len();
        let floor = plan.floor(field, column);
        let mut gradients = filled(n, [0.0; 2])?;
        for sweep in 1..=plan.maxiter {
            let mut worst: f64 = 0.0;
            for v in 0..n {
                pace.spend(1 + plan.adjacency.neighbors(v).len())?;
                let Some(new) = self.solve(plan, field, column, v, &gradients) else {
                    continue;
                };
                let old = std::mem::replace(&mut gradients[v], new);
                let change = (new[0] - old[0]).abs().max((new[1] - old[1]).abs());
                let size = new[0].abs().max(new[1].abs()).max(floor);
                if change > 0.0 {
                    worst = worst.max(change / size);
                }
            }
            if worst < plan.tol {
                return Ok((gradients, sweep as i64));
            }
        }
        Ok((gradients, 0))
    }

    /// The best gradient at one vertex; `None` if there is none or the value is unknown.
    #[inline]
    fn solve(
        &self,
        plan: &Sweeps,
        field: &Field,
        column: usize,
        v: usize,
        gradients: &[[f64; 2]],
    ) -> Option<[f64; 2]> {
        let range = plan.adjacency.range(v);
        let value = field.value(v as i32, column);
        let mut s = [0.0; 2];
        let others = &plan.adjacency.indices[range.clone()];
        for (edge, &other) in self.edges[range].iter().zip(others) {
            if edge.weight == 0.0 {
                continue;
            }
            let g = gradients[other as usize];
            let slope = edge.way[0] * g[0] + edge.way[1] * g[1];
            let rise = field.value(other, column) - value;
            let pull = (6.0 * rise - 2.0 * slope) * edge.weight;
            s[0] += pull * edge.way[0];
            s[1] += pull * edge.way[1];
        }
        let [xx, xy, yy] = self.inverses[v];
        finite([xx * s[0] + xy * s[1], xy * s[0] + yy * s[1]])
    }
}

/// Gradients of polynomials of degree 1 or 2 through each vertex that fit its surroundings by least
/// squares, weighted by the inverse squared distance.
///
/// Degree 1 uses the neighbors. Degree 2 also uses their neighbors, but of a hub's neighbors only
/// those around the vertex: see `hubs`. If those do not determine it, or hardly, degree 1 is used:
/// see `SWING`. The total time is O(n log n).
pub fn local_gradients(
    points: &[Point2],
    adjacency: Adjacency,
    field: Field,
    degree: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    let out = Output::filled(2 * points.len() * field.columns, 0.0, watch)?;
    let unit = unit_of(points);
    let least = CLOSE * longest_side(points, unit);
    let hubs = Hubs::of(points, adjacency, watch)?;
    let tasks = (0..points.len()).step_by(SHARE).collect();
    let ends = parallel::map(workers, tasks, |start: usize| {
        watch.check()?;
        let mut wide = Vec::new();
        let mut work = 0;
        for v in start..points.len().min(start + SHARE) {
            let near = adjacency.neighbors(v);
            wide.clear();
            wide.extend_from_slice(near);
            let is_steady = |ring: &[i32]| {
                Fit::of(points, unit, v, ring, 1).is_some_and(|plane| plane.is_steady(least))
            };
            let near_is_steady = is_steady(near);
            if degree > 1 || !near_is_steady {
                hubs.widen(v, &mut wide);
            }
            // Neighbors that do not determine a plane need a wider ring, and further ones if all of
            // them nearly coincide, or lie on one line but for those that nearly coincide.
            let mut times = 1;
            while !near_is_steady && times < WIDER && wide.len() < WIDE && !is_steady(&wide) {
                hubs.widen(v, &mut wide);
                times += 1;
            }
            work += wide.len();
            if work > 16 * SHARE {
                work = 0;
                watch.check()?;
            }
            let common = Fit::best(points, unit, least, v, near, &wide, degree);
            // Columns without missing values share one fit.
            for column in 0..field.columns {
                let known = |u: &i32| field.value(*u, column).is_finite();
                let gradient = if wide.iter().all(known) {
                    common
                        .as_ref()
                        .and_then(|fit| fit.gradient(&field, v, column))
                } else {
                    let [near, wide] =
                        [near, &wide].map(|ring| ring.iter().copied().filter(known).collect());
                    let (near, wide): (Vec<i32>, Vec<i32>) = (near, wide);
                    Fit::best(points, unit, least, v, &near, &wide, degree)
                        .and_then(|fit| fit.gradient(&field, v, column))
                };
                if let Some(g) = gradient.and_then(|g| finite(g.map(|x| x / unit))) {
                    out.set_all(2 * (v * field.columns + column), &g);
                }
            }
        }
        Ok(())
    });
    ends.into_iter().collect::<Result<()>>()?;
    Ok(out.into_vec())
}

/// How much more the gradient of a quadric may change with the values than that of the plane. For
/// scattered and gridded points it changes about half as much inside and up to 2.4 times as much on
/// the hull, so quadrics are reproduced; between survey tracks it is up to 10^12 times, and the
/// quadric oscillates. There any bound from 0.7 to 10 is as good.
const SWING: f64 = 3.0;

/// How much a gradient may change with the values, over their distances, before the plane of a
/// wider ring is used: as when the neighbors are collinear except for one that nearly coincides.
pub const NOISY: f64 = 1e5;

/// Share of the longest side of the bounding box below which a ring is too small for the rounding
/// of values, which would be more than 1e-6 of their slope.
pub const CLOSE: f64 = 1e-10;

/// Rings of this many vertices are not widened.
pub const WIDE: usize = 1 << 10;

/// A ring is widened at most this many times.
pub const WIDER: usize = 8;

/// The factors that turn differences to surrounding values into a gradient.
struct Fit<'a> {
    /// The distance of the farthest.
    size: f64,
    ring: &'a [i32],
    factors: Vec<[f64; 2]>,
}

impl<'a> Fit<'a> {
    /// The fit of the wider ring, if that is of degree 2 and steady; otherwise that of the
    /// neighbors.
    fn best(
        points: &[Point2],
        unit: f64,
        least: f64,
        v: usize,
        near: &'a [i32],
        wide: &'a [i32],
        degree: usize,
    ) -> Option<Self> {
        let plane = Self::of(points, unit, v, near, 1);
        let plane = if plane.as_ref().is_none_or(|fit| !fit.is_steady(least)) {
            let further = Self::of(points, unit, v, wide, 1).filter(|fit| fit.is_steady(least));
            further
                .or(plane)
                .or_else(|| Self::along(points, unit, v, near))
        } else {
            plane
        };
        if degree > 1
            && let Some(quadric) = Self::of(points, unit, v, wide, 2)
            && plane
                .as_ref()
                .is_none_or(|plane| quadric.is_steady_beside(plane))
        {
            return Some(quadric);
        }
        plane
    }

    /// The slope along the line on which all of them lie, up to rounding.
    fn along(points: &[Point2], unit: f64, v: usize, ring: &'a [i32]) -> Option<Self> {
        let p = points[v];
        let edges_along = ring.iter().map(|&u| in_unit(p, points[u as usize], unit));
        let edges_along: Vec<Point2> = edges_along.collect();
        let length = |w: &Point2| w[0].hypot(w[1]);
        let far = *edges_along
            .iter()
            .max_by(|a, b| length(a).total_cmp(&length(b)))?;
        let size = length(&far);
        let line = far.map(|x| x / size);
        // With weights by inverse distance, each counts by the sign of its direction only.
        let signs = edges_along
            .iter()
            .map(|w| (w[0] * line[0] + w[1] * line[1]) / length(w));
        let signs: Vec<f64> = signs.collect();
        let sum: f64 = signs.iter().map(|s| s * s).sum();
        let factors = signs.iter().zip(&edges_along);
        let factors = factors
            .map(|(s, w)| line.map(|x| x * s / length(w) / sum))
            .collect();
        Some(Self {
            size,
            ring,
            factors,
        })
    }

    /// Solves the least squares problem by orthogonal columns (modified Gram-Schmidt), for the
    /// gradient only; the first two unknowns are eliminated last.
    fn of(points: &[Point2], unit: f64, v: usize, ring: &'a [i32], degree: usize) -> Option<Self> {
        let p = points[v];
        let edges_along = ring.iter().map(|&u| in_unit(p, points[u as usize], unit));
        let edges_along: Vec<Point2> = edges_along.collect();
        let size = edges_along
            .iter()
            .fold(0.0, |most: f64, w| most.max(w[0].hypot(w[1])));
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let weight = |w: &Point2| size / w[0].hypot(w[1]).max(NEAR * size);
        let weights: Vec<f64> = edges_along.iter().map(weight).collect();
        let column = |f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            let scaled = edges_along.iter().map(|w| f(w[0] / size, w[1] / size));
            scaled.zip(&weights).map(|(x, w)| x * w).collect()
        };
        let mut basis: Vec<Vec<f64>> = Vec::new();
        if degree > 1 {
            basis.push(column(&|x, _| x * x));
            basis.push(column(&|x, y| x * y));
            basis.push(column(&|_, y| y * y));
        }
        basis.push(column(&|x, _| x));
        basis.push(column(&|_, y| y));
        let (gx, gy) = last_two(&mut basis)?;
        let factors = gx.iter().zip(&gy).zip(&weights);
        Some(Self {
            size,
            ring,
            factors: factors
                .map(|((x, y), w)| [x * w / size, y * w / size])
                .collect(),
        })
    }

    /// Whether errors of the values change its gradient little more than that of a plane.
    fn is_steady_beside(&self, plane: &Self) -> bool {
        self.norm() <= SWING * plane.norm()
    }

    /// Whether it is at least as large as `least`, and the rounding of values is negligible.
    fn is_steady(&self, least: f64) -> bool {
        self.size >= least && self.norm() * self.size <= NOISY
    }

    /// The square root of the sum of squares of all factors.
    fn norm(&self) -> f64 {
        let factors = self.factors.as_flattened();
        factors.iter().fold(0.0, |norm: f64, f| norm.hypot(*f))
    }

    fn gradient(&self, field: &Field, v: usize, column: usize) -> Option<[f64; 2]> {
        let value = field.value(v as i32, column);
        let mut g = [0.0; 2];
        for (f, &u) in self.factors.iter().zip(self.ring) {
            let rise = field.value(u, column) - value;
            g = [g[0] + f[0] * rise, g[1] + f[1] * rise];
        }
        finite(g)
    }
}

/// The rows of the pseudo-inverse for the last two of the columns; `None` if the columns are
/// dependent, or nearly so.
fn last_two(columns: &mut [Vec<f64>]) -> Option<(Vec<f64>, Vec<f64>)> {
    /// Below this share of its length, a column depends on those before.
    const DEPENDENT: f64 = 1e-10;
    /// Squared lengths below this have lost digits to underflow.
    const LEAST: f64 = 1e-140;
    let n = columns.len();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let mut corner = 0.0; // The last entry of the triangular factor above its diagonal.
    let mut diagonal = 1.0;
    for i in 0..n {
        let (before, rest) = columns.split_at_mut(i);
        let column = &mut rest[0];
        let length = dot(column, column).sqrt();
        let mut left = length;
        loop {
            let longer = left;
            for (j, q) in before.iter().enumerate() {
                let part = dot(q, column);
                if i == n - 1 && j == n - 2 {
                    corner += part;
                }
                column.iter_mut().zip(q).for_each(|(x, y)| *x -= part * y);
            }
            left = dot(column, column).sqrt();
            // If little is left, rounding has made it non-orthogonal: orthogonalize again.
            if left.is_nan() || left > 0.5 * longer || left <= DEPENDENT * length {
                break;
            }
        }
        if left.is_nan() || left <= LEAST || left <= DEPENDENT * length {
            return None;
        }
        column.iter_mut().for_each(|x| *x /= left);
        if i == n - 2 {
            diagonal = left;
        }
        if i == n - 1 {
            // R [gx, gy] = Q^T b, from the bottom.
            let gy: Vec<f64> = column.iter().map(|x| x / left).collect();
            let gx = before[n - 2].iter().zip(&gy);
            let gx = gx.map(|(q, y)| (q - corner * y) / diagonal).collect();
            return Some((gx, gy));
        }
    }
    None
}
