//! Exact validation of a periodic triangulation: Delaunay or, with weights, regular.
//!
//! Why these checks suffice: triangles that are glued at their edges form a surface, which maps to
//! the torus (with one period, to a strip closed to a cylinder). If all triangles are
//! counterclockwise and the boundary of the surface maps to that of the strip, the map covers each
//! place equally often. With two periods, this number is the sum of the areas divided by that of
//! the cell; with one, it is the length of the lower boundary divided by the period. Both are whole
//! numbers, so rounded sums determine them: a term has an error below 2^-40, and there are fewer
//! than 2^30 terms. If the number is one, the triangles tile, and a tiling that is locally regular
//! at each edge is regular. Points that are not vertices are judged as in `validate`.

use delone_predicates::{Point2, Sign};

use super::heaviest::{Heaviest, heaviest};
use super::insertion::Sites;
use super::periodic::Images;
use super::validate::others;
use crate::base::error::{Error, Result};
use crate::base::memory::filled;
use crate::base::points;
use crate::base::proof::{Expected, Findings, Verdict};
use crate::base::watch::{Pace, Watch};
use crate::order::arrange;

/// Triangles, or steps of walks, between two checks for interruption.
const STEPS: usize = 1 << 14;

/// A periodic triangulation that is given. Vertices must be rows of `points`, neighbors triangles
/// or -1, partners edges or -1; points must lie within one period.
#[derive(Debug, Clone, Copy)]
pub struct Wrapped<'a> {
    /// Coordinates, finite.
    pub points: &'a [Point2],
    /// Finite weights; empty for none.
    pub weights: &'a [f64],
    /// Lengths of the periods, 0 for none.
    pub periods: Point2,
    /// The vertices of each triangle.
    pub simplices: &'a [[i32; 3]],
    /// By how many periods each corner is moved: x and y of the first, then of the others.
    pub offsets: &'a [[i32; 6]],
    /// The triangle opposite each corner, -1 outside.
    pub neighbors: &'a [[i32; 3]],
    /// 3 u + l for each corner, if the edge opposite it is also opposite corner l of triangle u; -1
    /// outside.
    pub partners: &'a [[i32; 3]],
}

/// Faults by kind; all are empty if the triangulation is right.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct PeriodicFindings {
    /// Triangles whose first corner is moved, or with another corner that is moved by more than one
    /// period or in a direction without one. If there are any, nothing else is checked.
    pub offsets: Vec<u32>,
    /// Faults as without periods: `neighbors` has triangles whose neighbors or partners are wrong,
    /// `hull` edges without a partner that are not on the boundary of the strip, and `count`
    /// expects 2 n - h triangles.
    pub faults: Findings<2>,
    /// How often the triangles cover the plane, if not once.
    pub layers: Vec<u32>,
}

/// A corner: its row, and by how many periods it is moved.
type Corner = (u32, [i32; 2]);

impl Wrapped<'_> {
    fn corner(&self, t: usize, k: usize) -> Corner {
        let moved = &self.offsets[t];
        (
            self.simplices[t][k] as u32,
            [moved[2 * k], moved[2 * k + 1]],
        )
    }

    fn corners(&self, t: usize) -> [Corner; 3] {
        [0, 1, 2].map(|k| self.corner(t, k))
    }

    /// What is opposite corner k of t: an edge, coded as in `partners`, and by how much its
    /// triangle must be moved to meet t there. `None` where the arrays contradict each other.
    fn across(&self, t: usize, k: usize) -> Option<(usize, [i32; 2])> {
        let code = usize::try_from(self.partners[t][k]).ok()?;
        let (s, j) = (code / 3, code % 3);
        let joined = self.neighbors[t][k] == s as i32 && self.partners[s][j] == (3 * t + k) as i32;
        let corner = |t: usize, k: usize| self.corner(t, k % 3);
        let (u, v) = (corner(t, k + 1), corner(t, k + 2));
        let (x, y) = (corner(s, j + 2), corner(s, j + 1));
        let shift = minus(u.1, x.1);
        let same = u.0 == x.0 && v.0 == y.0 && shift == minus(v.1, y.1);
        (joined && same).then_some((code, shift))
    }

    /// Whether the offsets of a triangle are possible.
    fn is_placed(&self, t: usize) -> bool {
        let moved = &self.offsets[t];
        let possible = |i: usize| match self.periods[i % 2] {
            0.0 => moved[i] == 0,
            _ => (-1..=1).contains(&moved[i]),
        };
        moved[..2] == [0, 0] && (2..6).all(possible)
    }

    /// The axis without a period.
    fn open_axis(&self) -> Option<usize> {
        (0..2).find(|&k| self.periods[k] == 0.0)
    }
}

fn minus(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn plus(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// The state of a validation: four sites at a time, and what has been found.
struct Check<'a> {
    given: Wrapped<'a>,
    sites: Images<'a>,
    found: PeriodicFindings,
    /// Triangles and corners opposite edges without a partner.
    boundary: Vec<(usize, usize)>,
}

/// Checks everything that makes `given` the canonical periodic triangulation of its points.
pub fn validate_periodic(given: Wrapped, watch: &Watch) -> Result<PeriodicFindings> {
    points::scan(given.points)?;
    let mut check = Check {
        given,
        sites: Images {
            points: given.points,
            periods: given.periods,
            weights: given.weights,
            of: vec![(0, [0, 0]); 4],
        },
        found: PeriodicFindings::default(),
        boundary: Vec::new(),
    };
    let mut pace = Pace::new(watch, STEPS);
    check.offsets(&mut pace)?;
    if check.found.offsets.is_empty() {
        let (unused, vertices) = check.vertices(watch)?;
        check.triangles(&mut pace)?;
        check.tiling(vertices, &mut pace)?;
        check.unused(unused, &mut pace)?;
    }
    Ok(check.found)
}

impl Check<'_> {
    fn offsets(&mut self, pace: &mut Pace) -> Result<()> {
        for t in 0..self.given.simplices.len() {
            pace.spend(1)?;
            if !self.given.is_placed(t) {
                self.found.offsets.push(t as u32);
            }
        }
        Ok(())
    }

    /// The rows that are not vertices, along a curve, and the number of vertices.
    fn vertices(&mut self, watch: &Watch) -> Result<(Vec<u32>, usize)> {
        let arranged = arrange(self.given.points, 1, watch)?;
        let none;
        let weights = if self.given.weights.is_empty() {
            none = filled(self.given.points.len(), 0.0)?;
            &none
        } else {
            self.given.weights
        };
        let Heaviest {
            rows, stands_for, ..
        } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
        let expected = Expected {
            rows: &rows,
            others: &others(&stands_for),
            may_hide: true,
        };
        let unused =
            expected.unused(self.given.simplices, &mut self.found.faults.repeats, watch)?;
        let vertices = rows.len() - unused.len();
        Ok((unused, vertices))
    }

    fn triangles(&mut self, pace: &mut Pace) -> Result<()> {
        for t in 0..self.given.simplices.len() {
            pace.spend(1)?;
            self.sites.of[..3].copy_from_slice(&self.given.corners(t));
            if self.sites.turn([0, 1, 2]) != Sign::Positive {
                self.found.faults.orientation.push(t as u32);
            }
            let edges = [0, 1, 2].map(|k| self.edge(t, k));
            if edges.contains(&false) {
                self.found.faults.neighbors.push(t as u32);
            }
        }
        Ok(())
    }

    /// Checks the edge opposite corner k of t, whose corners are in `sites`; false if its arrays
    /// contradict each other.
    fn edge(&mut self, t: usize, k: usize) -> bool {
        if self.given.partners[t][k] < 0 {
            self.boundary.push((t, k));
            return self.given.neighbors[t][k] < 0;
        }
        let Some((code, shift)) = self.given.across(t, k) else {
            return false;
        };
        if 3 * t + k < code {
            let (apex, moved) = self.given.corner(code / 3, code % 3);
            self.sites.of[3] = (apex, plus(moved, shift));
            let around = [k, (k + 1) % 3, (k + 2) % 3, 3].map(|i| i as u32);
            let pair = [t as u32, (code / 3) as u32];
            match self.sites.verdict(around) {
                Verdict::Wrong => self.found.faults.delaunay.push(pair),
                Verdict::Tie => self.found.faults.ties.push(pair),
                Verdict::Right => {}
            }
        }
        true
    }

    /// Checks that the triangles cover the plane once, and how many there are.
    fn tiling(&mut self, vertices: usize, pace: &mut Pace) -> Result<()> {
        let found = self.given.simplices.len();
        let expected = (2 * vertices).saturating_sub(self.boundary.len());
        if expected != found {
            self.found
                .faults
                .count
                .push([expected as u32, found as u32]);
        }
        let lower = self.lower_boundary();
        let fits = &self.found.faults;
        if !(fits.orientation.is_empty() && fits.neighbors.is_empty() && fits.hull.is_empty()) {
            return Ok(());
        }
        let mut layers = lower;
        if self.given.open_axis().is_none() {
            layers = 0.0;
            for t in 0..found {
                pace.spend(1)?;
                layers += self.area(t);
            }
        }
        let layers = layers.round() as u32;
        if layers != 1 {
            self.found.layers.push(layers);
        }
        Ok(())
    }

    /// The difference of two corners, in periods.
    fn in_periods(&self, to: Corner, from: Corner) -> Point2 {
        let [p, q] = [to, from].map(|(row, _)| self.given.points[row as usize]);
        let moved = minus(to.1, from.1);
        [0, 1].map(|k| (p[k] - q[k]) / self.given.periods[k] + f64::from(moved[k]))
    }

    /// The area of a triangle, in cells.
    fn area(&self, t: usize) -> f64 {
        let [a, b, c] = self.given.corners(t);
        let (b, c) = (self.in_periods(b, a), self.in_periods(c, a));
        (b[0] * c[1] - b[1] * c[0]) / 2.0
    }

    /// Checks that edges without a partner lie on the boundary of the strip, which is straight;
    /// returns the length of its lower side in periods.
    fn lower_boundary(&mut self) -> f64 {
        let axis = self.given.open_axis();
        let heights = self.given.points.iter().map(|p| axis.map_or(0.0, |k| p[k]));
        let low = heights.clone().fold(f64::INFINITY, f64::min);
        let high = heights.fold(f64::NEG_INFINITY, f64::max);
        let mut length = 0.0;
        for &(t, k) in &self.boundary {
            let ends = [1, 2].map(|i| self.given.corner(t, (k + i) % 3));
            let rows = ends.map(|(row, _)| row);
            let at = |height: f64| {
                let here =
                    |row: u32| axis.is_some_and(|k| self.given.points[row as usize][k] == height);
                rows.into_iter().all(here)
            };
            if at(low) {
                let along = self.in_periods(ends[1], ends[0]);
                length += along[1 - axis.unwrap_or(0)].abs();
            } else if !at(high) {
                self.found.faults.hull.push(rows);
            }
        }
        length
    }

    /// Judges the rows that are not vertices.
    fn unused(&mut self, rows: Vec<u32>, pace: &mut Pace) -> Result<()> {
        if self.given.weights.is_empty() {
            self.found.faults.missing = rows;
            self.found.faults.missing.sort_unstable();
        } else if self.found == PeriodicFindings::default() {
            let mut place = (0, [0, 0]);
            for p in rows {
                place = self.holder(p, place, pace)?;
                if self.sites.is_below([0, 1, 2, 3]) {
                    self.found.faults.hidden.push(p);
                }
            }
            self.found.faults.hidden.sort_unstable();
        }
        Ok(())
    }

    /// The triangle that contains a point, and by how much it is moved, by a walk from another one.
    /// Its corners and the point are left in `sites`. All points lie in the strip, so walks do not
    /// leave it.
    fn holder(
        &mut self,
        p: u32,
        from: (usize, [i32; 2]),
        pace: &mut Pace,
    ) -> Result<(usize, [i32; 2])> {
        let (mut t, mut moved) = from;
        self.sites.of[3] = (p, [0, 0]);
        loop {
            pace.spend(1)?;
            let corners = self.given.corners(t);
            let placed = corners.map(|(row, own)| (row, plus(own, moved)));
            self.sites.of[..3].copy_from_slice(&placed);
            let beyond = |k: u32| self.sites.turn([(k + 1) % 3, (k + 2) % 3, 3]) == Sign::Negative;
            let Some(k) = (0..3).find(|&k| beyond(k)) else {
                return Ok((t, moved));
            };
            let Some((code, shift)) = self.given.across(t, k as usize) else {
                return Err(Error::Internal("a walk leaves the strip".into()));
            };
            (t, moved) = (code / 3, plus(moved, shift));
        }
    }
}
