//! Sparse rows of weights, and of their derivatives, for many queries.

use delone_predicates::Point3;
use delone_predicates::sphere::{Unit, same};

use super::cavity::Cavity;
use super::formulas::{Corners, linear};
use super::frame::{Frame, Seen};
use crate::base::error::{Error, Result};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::interpolate::{Jet, Number, Part, Rows};
use crate::sphere::locate::Index;

/// Queries per task.
const SHARE: usize = 1 << 10;
/// Triangles of cavities between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;
/// Below this distance a query may be the same as a site.
const CLOSE: f64 = 1e-14;

/// The kind of weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Of the corners of the triangle.
    Linear,
    /// Of natural neighbors: areas.
    Sibson,
    /// Of natural neighbors: lengths over distances.
    Laplace,
}

impl Kind {
    /// The kinds by name.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("linear", Self::Linear),
        ("sibson", Self::Sibson),
        ("laplace", Self::Laplace),
    ];

    /// The kind of that name.
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMES.iter().find(|(n, _)| *n == name);
        found.map(|&(_, kind)| kind)
    }
}

/// Directions, and the triangle that contains each; -1 for none.
#[derive(Debug, Clone, Copy)]
pub struct Queries<'a> {
    /// Vectors, finite and not zero where there is a triangle.
    pub vectors: &'a [Point3],
    /// Triangles; one that only touches the query, beyond the boundary of a hull, will do.
    pub simplices: &'a [i32],
}

/// The weights of sites at queries; if `sloped`, with their derivatives toward east and north per radian,
/// NaN where they do not exist. Rows are empty without a triangle, and where corners are one point after
/// rounding.
pub fn weights(
    index: &Index,
    kind: Kind,
    queries: Queries,
    sloped: bool,
    workers: usize,
    watch: &Watch,
) -> Result<Rows> {
    let count = queries.vectors.len();
    let triangles = index.arrays().simplices.len();
    let known = |&t: &i32| usize::try_from(t).map_or(t == -1, |t| t < triangles);
    if queries.simplices.len() != count || !queries.simplices.iter().all(known) {
        return Err(Error::Shape(
            "there must be one triangle for each query".into(),
        ));
    }
    let tasks = (0..count).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, tasks, watch, |start: usize| {
        let rows = start..count.min(start + SHARE);
        if sloped {
            Room::<Jet>::default().part(index, kind, queries, rows, watch)
        } else {
            Room::<f64>::default().part(index, kind, queries, rows, watch)
        }
    })?;
    Rows::of_parts(count, &parts, sloped, workers, watch)
}

/// Buffers of a task.
#[derive(Default)]
struct Room<N> {
    cavity: Cavity,
    corners: Corners<N>,
    seen: Vec<Seen<N>>,
    weights: Vec<N>,
}

impl<N: Number + Default> Room<N> {
    const SLOPED: bool = N::PARTS > 1;

    fn part(
        &mut self,
        index: &Index,
        kind: Kind,
        queries: Queries,
        rows: std::ops::Range<usize>,
        watch: &Watch,
    ) -> Result<Part> {
        let mut part = Part::with_slopes(Self::SLOPED);
        let mut pace = Pace::new(watch, WATCH_EVERY);
        for row in rows {
            let Ok(t) = usize::try_from(queries.simplices[row]) else {
                continue;
            };
            let vector = queries.vectors[row];
            self.row(
                index,
                kind,
                (vector, Unit::of(vector)),
                t,
                &mut part,
                &mut pace,
            )?;
            part.close(row);
        }
        Ok(part)
    }

    /// Adds the entries of a query in (or at) triangle `t`.
    fn row(
        &mut self,
        index: &Index,
        kind: Kind,
        q: (Point3, Unit),
        t: usize,
        part: &mut Part,
        pace: &mut Pace,
    ) -> Result<()> {
        let frame = Frame::of(q.1);
        let corners = index.arrays().simplices[t];
        let seen = corners.map(|v| frame.see::<N>(&index.ray(v as u32).1));
        let is_site = |k: &usize| {
            let [x, y] = seen[*k].p.map(|x| x.value().abs());
            x + y < CLOSE && same(index.ray(corners[*k] as u32).0, q.0)
        };
        let site = (0..3).find(is_site);
        if let Some(k) = site.filter(|_| kind != Kind::Linear || !Self::SLOPED) {
            // Natural neighbor interpolants have no derivative at a site.
            part.entry(corners[k], 1.0, [f64::NAN; 2]);
            return Ok(());
        }
        if kind != Kind::Linear && self.natural(index, kind, &frame, q, t, pace)? {
            normalize(&mut self.weights);
            for (&v, w) in self.cavity.vertices.iter().zip(&self.weights) {
                part.entry(v as i32, w.value(), w.gradient());
            }
            return Ok(());
        }
        let mut weights = linear(seen);
        if normalize(&mut weights) {
            for (&v, w) in corners.iter().zip(&weights) {
                part.entry(v, w.value(), w.gradient());
            }
        }
        Ok(())
    }

    fn natural(
        &mut self,
        index: &Index,
        kind: Kind,
        frame: &Frame,
        q: (Point3, Unit),
        t: usize,
        pace: &mut Pace,
    ) -> Result<bool> {
        if !self.cavity.find(index, t, q, pace)? {
            return Ok(false);
        }
        self.seen.clear();
        let vertices = self.cavity.vertices.iter();
        self.seen
            .extend(vertices.map(|&v| frame.see::<N>(&index.ray(v).1)));
        let by_area = kind == Kind::Sibson;
        Ok(self
            .corners
            .weights(&self.cavity, &self.seen, by_area, &mut self.weights))
    }
}

/// Divides weights by their sum; false if it is not positive. Negative ones are rounding.
fn normalize<N: Number>(weights: &mut [N]) -> bool {
    let mut sum = N::constant(0.0);
    for w in weights.iter_mut() {
        if w.value() < 0.0 {
            *w = w.with_value(0.0);
        }
        sum = sum + *w;
    }
    if !(sum.value() > 0.0 && sum.value().is_finite()) {
        return false;
    }
    for w in weights.iter_mut() {
        *w = *w / sum;
    }
    true
}
