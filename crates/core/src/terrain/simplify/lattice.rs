//! Points of a lattice, such as the nodes of a raster: each triangle is scanned column by column.
//!
//! There are no lists, and a scan reads heights one after the other. A point on the edge of two triangles
//! counts in both, so when it becomes a vertex, both change. The numbers of points ascend with their
//! coordinates, first x, then y.
//!
//! Where a column enters and leaves a triangle is estimated, and decided by the exact sides of nodes. If all
//! steps are equal and sides are computed without rounding, vertices have whole numbers of columns and rows,
//! and the quotient n / d at which an edge crosses a column needs no decision: with numbers below 2^15, it is
//! a whole number or at least 2^-15 away from one, and its rounding error is below 2^-37.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::plane::{Raised, is_exact};
use super::points::{Points, Star, Wedge};
use super::task::Task;
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};

/// A lattice has at most this many nodes per point, and some more.
const SPARSE: usize = 2;
const MORE: usize = 64;
/// Coordinates and heights up to this, 2^200, have offsets that are finite.
const LARGEST: f64 = f64::from_bits((1023 + 200) << 52);
/// The most columns, and the most rows. They are kept in order as they are found, so the time for many in
/// random order is quadratic; and fewer than 2^32 nodes have numbers.
const MOST: usize = 1 << 15;
/// Points between two checks for interruption.
const LOT: usize = 1 << 16;

/// Points on the nodes of a lattice.
#[derive(Debug)]
pub struct Lattice {
    axes: [Axis; 2],
    /// The height of each node, column by column; NaN if it has no point.
    z: Vec<f64>,
    /// The row of each node's point.
    rows: Vec<u32>,
    exact: bool,
    /// The column and row of each vertex, if quotients decide; else empty.
    vertices: Vec<[u32; 2]>,
}

/// Coordinates of nodes, ascending.
#[derive(Debug, Default)]
struct Axis {
    at: Vec<f64>,
    /// The number of steps per unit of length, on average.
    dense: f64,
}

impl Axis {
    /// Takes a coordinate up, and returns its number at present; `last` is that of the one before. Points in
    /// the order of a raster need no search.
    fn take(&mut self, x: f64, last: usize) -> Result<usize> {
        for k in [last, last + 1, 0] {
            if self.at.get(k) == Some(&x) {
                return Ok(k);
            }
        }
        let k = self.at.partition_point(|&y| y < x);
        if self.at.get(k) != Some(&x) {
            make_room(&mut self.at, 1)?;
            self.at.insert(k, x);
        }
        Ok(k)
    }

    /// Measures the steps.
    fn close(&mut self) {
        if let [first, .., last] = self.at[..] {
            self.dense = (self.at.len() - 1) as f64 / (last - first);
        }
    }

    /// Whether all steps are equal, if differences are computed without rounding.
    fn is_even(&self) -> bool {
        let [first, second, ..] = self.at[..] else {
            return self.at.len() == 1;
        };
        let mut numbered = self.at.iter().enumerate();
        let even = |(k, x): (usize, &f64)| x - first == k as f64 * (second - first);
        numbered.all(even)
    }

    /// The number of a coordinate.
    fn number(&self, x: f64) -> Option<u32> {
        let k = self.at.partition_point(|&y| y < x);
        (self.at.get(k) == Some(&x)).then_some(k as u32)
    }

    /// The first number whose coordinate is `reached`, as are all after it; near `x`.
    #[inline]
    fn first(&self, x: f64, reached: impl Fn(f64) -> bool) -> usize {
        let n = self.at.len();
        // Casts saturate.
        let guess = ((x - self.at[0]) * self.dense).ceil() as usize;
        let (mut low, mut high) = (0, guess.min(n));
        let mut step = 1;
        if high < n && !reached(self.at[high]) {
            // Upward, in steps that grow.
            (low, high) = (high + 1, n);
            while low + step <= n {
                if reached(self.at[low + step - 1]) {
                    high = low + step - 1;
                    break;
                }
                low += step;
                step *= 2;
            }
        } else {
            // Downward.
            while high > 0 {
                let next = high.saturating_sub(step);
                if !reached(self.at[next]) {
                    low = next + 1;
                    break;
                }
                high = next;
                step *= 2;
            }
        }
        low + self.at[low..high].partition_point(|&y| !reached(y))
    }
}

/// An edge of a triangle, and how it rises.
#[derive(Debug, Clone, Copy)]
struct Edge {
    ends: [Point2; 2],
    slope: f64,
}

impl Edge {
    fn of([u, v]: [Point2; 2]) -> Self {
        Self {
            ends: [u, v],
            slope: (v[1] - u[1]) / (v[0] - u[0]),
        }
    }

    /// About where it is at a column.
    #[inline]
    fn at(&self, x: f64) -> f64 {
        let [x0, y0] = self.ends[0];
        y0 + (x - x0) * self.slope
    }
}

impl Lattice {
    /// The points as a lattice, if there are any, and they fill half of the nodes of one.
    pub fn of(task: &Task, watch: &Watch) -> Result<Option<Self>> {
        if task.points.is_empty() {
            return Ok(None);
        }
        let mut pace = Pace::new(watch, LOT);
        let most = SPARSE * task.points.len() + MORE;
        let mut axes = [Axis::default(), Axis::default()];
        let mut last = [0; 2];
        let extent = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let flat = [task.points, task.coarse.points].map(<[Point2]>::as_flattened);
        if flat
            .into_iter()
            .chain([task.z, task.heights])
            .any(|all| extent(all) > LARGEST)
        {
            return Ok(None);
        }
        for p in task.points {
            pace.spend(1)?;
            for k in 0..2 {
                last[k] = axes[k].take(p[k], last[k])?;
            }
            let [across, along] = [0, 1].map(|k| axes[k].at.len());
            if across.max(along) > MOST || across * along > most {
                return Ok(None);
            }
        }
        axes.iter_mut().for_each(Axis::close);
        let high = axes[1].at.len();
        let count = axes[0].at.len() * high;
        let (mut z, mut rows) = (filled(count, f64::NAN)?, filled(count, 0)?);
        for (row, p) in task.points.iter().enumerate() {
            pace.spend(1)?;
            for k in 0..2 {
                last[k] = axes[k].take(p[k], last[k])?;
            }
            let node = last[0] * high + last[1];
            (z[node], rows[node]) = (task.z[row], row as u32);
        }
        let all = |k: usize| {
            let fixed = task.coarse.points.iter().map(move |p| p[k]);
            fixed.chain(axes[k].at.iter().copied())
        };
        let exact = is_exact(all(0), all(1), task.heights.iter().chain(task.z).copied());
        let mut vertices = with_room(task.coarse.points.len())?;
        if exact && axes.iter().all(Axis::is_even) {
            for p in task.coarse.points {
                if let (Some(i), Some(j)) = (axes[0].number(p[0]), axes[1].number(p[1])) {
                    vertices.push([i, j]);
                }
            }
            // Other vertices may be on lines, between the nodes.
            if vertices.len() < task.coarse.points.len() {
                vertices.clear();
            }
        }
        Ok(Some(Self {
            axes,
            z,
            rows,
            exact,
            vertices,
        }))
    }

    /// Whether sides and offsets are computed without rounding.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// Judges the points of a column in rows `first` to `end`.
    #[inline]
    fn judge_column(&self, wedge: &mut Wedge, i: usize, [first, end]: [usize; 2]) {
        let [across, along] = &self.axes;
        let start = i * along.at.len();
        if first < end {
            let z = &self.z[start + first..start + end];
            let y = &along.at[first..end];
            let found = wedge.plane.worst_of(across.at[i], y, z, wedge.offset);
            if let Some((k, offset)) = found {
                (wedge.offset, wedge.worst) = (offset, (start + first + k) as u32);
            }
        }
    }

    /// Judges the points of a triangle whose corners have whole numbers.
    fn judge_even(&self, wedge: &mut Wedge, pace: &mut Pace) -> Result<()> {
        let mut sorted = wedge.vertices.map(|v| self.vertices[v as usize]);
        sorted.sort_unstable();
        let [a, m, b] = sorted.map(|[i, j]| [f64::from(i), f64::from(j)]);
        let above = (b[0] - a[0]) * (m[1] - a[1]) - (b[1] - a[1]) * (m[0] - a[0]) > 0.0;
        let at = |[u, v]: [Point2; 2], x: f64| u[1] + (x - u[0]) * (v[1] - u[1]) / (v[0] - u[0]);
        // A column with a single corner has no other node of the triangle.
        let columns = sorted.map(|[i, _]| i);
        let start = columns[0] + u32::from(columns[0] < columns[1]);
        let stop = columns[2] + u32::from(columns[1] == columns[2]);
        for i in start..stop {
            let x = f64::from(i);
            let bent = if x < m[0] || m[0] == b[0] {
                [a, m]
            } else {
                [m, b]
            };
            let crossed = [at([a, b], x), at(bent, x)];
            let [low, up] = if above {
                crossed
            } else {
                [crossed[1], crossed[0]]
            };
            let whole = low as usize;
            let first = whole + usize::from(low > whole as f64);
            let end = up as usize + 1;
            pace.spend(1 + end.saturating_sub(first))?;
            self.judge_column(wedge, i as usize, [first, end]);
        }
        Ok(())
    }

    /// Whether a point is on a line or to its left.
    #[inline]
    fn is_left(&self, [u, v]: [Point2; 2], p: Point2) -> bool {
        if self.exact {
            return (v[0] - u[0]) * (p[1] - u[1]) - (v[1] - u[1]) * (p[0] - u[0]) >= 0.0;
        }
        orient2d(u, v, p) != Sign::Negative
    }
}

impl Points for Lattice {
    fn raised(&self, i: u32) -> Raised {
        let high = self.axes[1].at.len();
        let i = i as usize;
        [
            self.axes[0].at[i / high],
            self.axes[1].at[i % high],
            self.z[i],
        ]
    }

    fn row(&self, i: u32) -> u32 {
        self.rows[i as usize]
    }

    #[inline]
    fn is_smaller(&self, i: u32, j: u32) -> bool {
        i < j
    }

    fn judge(&self, wedge: &mut Wedge, pace: &mut Pace) -> Result<()> {
        if !self.vertices.is_empty() {
            return self.judge_even(wedge, pace);
        }
        // From the smallest corner to the greatest, and the one between.
        let mut sorted = wedge.corners;
        sorted.sort_unstable_by(|&p, &q| lexicographic(p, q));
        let [a, m, b] = sorted;
        let [whole, before, after] = [[a, b], [a, m], [m, b]].map(Edge::of);
        let above = self.is_left([a, b], m);
        let [across, along] = &self.axes;
        let start = across.first(a[0], |x| x >= a[0]);
        for (i, &x) in across.at.iter().enumerate().skip(start) {
            if x > b[0] {
                break;
            }
            // The middle corner has two edges, of which one is at this column. The other one may be vertical.
            let bent = if x < m[0] || m[0] == b[0] {
                before
            } else {
                after
            };
            let [low, up] = if above { [whole, bent] } else { [bent, whole] };
            // The nodes on or above the lower edge, and on or below the upper one.
            let [u, v] = low.ends;
            let first = along.first(low.at(x), |y| self.is_left([u, v], [x, y]));
            let [u, v] = up.ends;
            let end = along.first(up.at(x), |y| !self.is_left([v, u], [x, y]));
            pace.spend(1 + end.saturating_sub(first))?;
            self.judge_column(wedge, i, [first, end]);
        }
        Ok(())
    }

    /// Judges each triangle.
    fn spread(&mut self, became: u32, star: &mut Star, pace: &mut Pace) -> Result<()> {
        self.z[became as usize] = f64::NAN;
        if !self.vertices.is_empty() {
            let high = self.axes[1].at.len() as u32;
            push(&mut self.vertices, [became / high, became % high])?;
        }
        for wedge in &mut star.wedges {
            self.judge(wedge, pace)?;
        }
        Ok(())
    }
}
