//! Leave-one-out weights: those of all other vertices for the value at each vertex.
//!
//! Cross-validation needs them, without a triangulation for each vertex.
//!
//! The star of an inner vertex becomes a hole when the vertex is removed, and the Delaunay
//! triangles of that hole are those that the vertex, taken as a query, would remove: the hole is
//! the cavity. It is triangulated ear by ear: an ear whose circumcircle contains no vertex of the
//! hole is a Delaunay triangle. Ties are broken as everywhere, by coordinates, so the triangles are
//! those of a triangulation that never contained the vertex.

use delone_predicates::{Point2, Sign, incircle_canonical, nearer, orient2d};

use super::Rows;
use super::cavity::Cavity;
use super::kind::Kind;
use super::rows::Part;
use super::weights::Weights;
use crate::base::arrays::{Side, Triangles};
use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::delaunay::plane::{self, triangulate};
use crate::locate::{Kept, Located, Locator, barycentric_weights, next, prev};

/// Vertices per task.
const SHARE: usize = 1 << 10;
/// Vertices of holes between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;
/// Initial triangles between two checks for interruption.
const LOT: usize = 1 << 16;
/// The most vertices of a hole for which ears are tried one by one, in cubic time.
const SMALL: usize = 32;

/// The interpolation method that is validated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Linear interpolation.
    Linear,
    /// The nearest vertex.
    Nearest,
    /// Natural neighbors.
    Natural(Kind),
}

impl Method {
    /// The method with this name; kinds with gradients are excluded, as their gradients depend on
    /// the vertex, too.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "linear" => Some(Self::Linear),
            "nearest" => Some(Self::Nearest),
            _ => Kind::named(name)
                .filter(|kind| !kind.is_smooth())
                .map(Self::Natural),
        }
    }
}

/// For each vertex the weights of the others; empty for corners of the hull and for rows that are
/// not vertices. The triangulation must be Delaunay.
pub fn leave_one_out(
    given: Triangles,
    method: Method,
    workers: usize,
    watch: &Watch,
) -> Result<Rows> {
    let n = given.points.len();
    let mut stars = filled(n, None)?;
    for (simplex, vertices) in given.simplices.iter().enumerate() {
        if simplex.is_multiple_of(LOT) {
            watch.check()?;
        }
        for (corner, &v) in vertices.iter().enumerate() {
            stars[v as usize] = Some(Side { simplex, corner });
        }
    }
    let tasks = (0..n).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, tasks, watch, |start: usize| {
        let mut pace = Pace::new(watch, WATCH_EVERY);
        let mut part = Part::default();
        let mut hole = Hole::default();
        for (i, star) in stars[start..n.min(start + SHARE)].iter().enumerate() {
            if let Some(side) = *star {
                hole.open(&given, side);
                pace.spend(hole.cavity.ring.len())?;
                hole.weigh(&given, method, &mut part, &mut pace)?;
            }
            part.close(start + i);
        }
        Ok(part)
    })?;
    Rows::of_parts(n, &parts, false, workers, watch)
}

/// The star of a vertex without the vertex.
#[derive(Default)]
struct Hole {
    /// The vertex.
    vertex: i32,
    /// Whether it is on the hull.
    is_outer: bool,
    cavity: Cavity,
    weights: Weights<f64>,
    rest: Vec<u32>,
}

impl Hole {
    /// The ring around the vertex at a corner, counterclockwise; on the hull from boundary to
    /// boundary.
    fn open(&mut self, given: &Triangles, side: Side) {
        self.vertex = given.vertex(side);
        let mut first = side;
        self.is_outer = given.around(side, |_| true);
        if self.is_outer {
            while let Some(right) = given.turn_right(first) {
                first = right;
            }
        }
        let cavity = &mut self.cavity;
        cavity.vertices.clear();
        cavity.triangles.clear();
        cavity.flat = None;
        let mut last = first;
        given.around(first, |side| {
            let corner = next(side.corner);
            cavity.vertices.push(given.vertex(Side { corner, ..side }));
            last = side;
            true
        });
        if self.is_outer {
            let corner = prev(last.corner);
            cavity.vertices.push(given.vertex(Side { corner, ..last }));
        }
        cavity.points.clear();
        let points = cavity.vertices.iter().map(|&v| given.point(v));
        cavity.points.extend(points);
        cavity.ring.clear();
        cavity.ring.extend(0..cavity.vertices.len() as u32);
    }

    fn weigh(
        &mut self,
        given: &Triangles,
        method: Method,
        part: &mut Part,
        pace: &mut Pace,
    ) -> Result<()> {
        let q = given.point(self.vertex);
        if method == Method::Nearest {
            part.entry(self.nearest(q), 1.0, [0.0; 2]);
            return Ok(());
        }
        if self.is_outer {
            self.between_ends(q, part);
            return Ok(());
        }
        if self.cavity.points.len() > SMALL {
            return self.weigh_large(q, method, part, pace);
        }
        self.clip_ears();
        match method {
            Method::Natural(kind) => {
                if self.weights.compute(kind, &self.cavity, q, pace)? {
                    for (&v, &w) in self.cavity.vertices.iter().zip(&self.weights.values) {
                        part.entry(v, w, [0.0; 2]);
                    }
                }
            }
            _ => self.linear(q, part),
        }
        Ok(())
    }

    /// The nearest neighbor, the first row of several: the nearest vertex is always a Delaunay
    /// neighbor.
    fn nearest(&self, q: Point2) -> i32 {
        let slots = self.cavity.vertices.iter().zip(&self.cavity.points);
        let best = slots.reduce(|a, b| match nearer(q, *a.1, *b.1) {
            Sign::Positive => a,
            Sign::Negative => b,
            Sign::Zero => std::cmp::min_by_key(a, b, |x| x.0),
        });
        best.map_or(-1, |(&v, _)| v)
    }

    /// On the hull: no entry, unless the vertex is in the interior of a side.
    fn between_ends(&self, q: Point2, part: &mut Part) {
        let points = &self.cavity.points;
        let (Some(&a), Some(&b)) = (points.first(), points.last()) else {
            return;
        };
        if orient2d(a, q, b) != Sign::Zero {
            return;
        }
        let length = |p: Point2| (p[0] - q[0]).hypot(p[1] - q[1]);
        let (from, to) = (length(a), length(b));
        let share = from / (from + to);
        let share = if share.is_finite() { share } else { 0.5 };
        let vertices = &self.cavity.vertices;
        part.entry(vertices[0], 1.0 - share, [0.0; 2]);
        part.entry(vertices[points.len() - 1], share, [0.0; 2]);
    }

    /// Triangulates the hole with Delaunay triangles.
    fn clip_ears(&mut self) {
        let Cavity {
            points, triangles, ..
        } = &mut self.cavity;
        self.rest.clear();
        self.rest.extend(0..points.len() as u32);
        while self.rest.len() > 3 {
            let n = self.rest.len();
            let ear = (0..n).find(|&i| {
                let slots = [(i + n - 1) % n, i, (i + 1) % n].map(|j| self.rest[j] as usize);
                let [a, b, c] = slots.map(|s| points[s]);
                orient2d(a, b, c) == Sign::Positive
                    && self.rest.iter().all(|&s| {
                        slots.contains(&(s as usize))
                            || incircle_canonical(a, b, c, points[s as usize]) != Sign::Positive
                    })
            });
            // A hole of a Delaunay triangulation always has one.
            let Some(i) = ear else { break };
            triangles.push([
                self.rest[(i + n - 1) % n],
                self.rest[i],
                self.rest[(i + 1) % n],
            ]);
            self.rest.remove(i);
        }
        if let [a, b, c] = self.rest[..] {
            triangles.push([a, b, c]);
        }
    }

    /// The weights in the triangle of the hole that contains the vertex.
    fn linear(&self, q: Point2, part: &mut Part) {
        for slots in &self.cavity.triangles {
            let corners = slots.map(|s| self.cavity.points[s as usize]);
            let [a, b, c] = corners;
            let signs = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)];
            if signs.contains(&Sign::Negative) {
                continue;
            }
            let on = signs.map(|s| s == Sign::Zero);
            for (&slot, w) in slots.iter().zip(barycentric_weights(corners, on, q)) {
                part.entry(self.cavity.vertices[slot as usize], w, [0.0; 2]);
            }
            return;
        }
    }

    /// The same by a triangulation of the ring, which contains all natural neighbors.
    fn weigh_large(
        &mut self,
        q: Point2,
        method: Method,
        part: &mut Part,
        pace: &mut Pace,
    ) -> Result<()> {
        let ring = self.cavity.points.clone();
        let made = triangulate(&ring, plane::Method::Auto, 1, pace.watch())?;
        let given = Triangles {
            points: &ring,
            simplices: &made.arrays.simplices,
            neighbors: &made.arrays.neighbors,
        };
        let kept = Kept::of(&given, pace.watch())?;
        let Some(Located::Inside(place)) = Locator::new(given, &kept, pace.watch()).locate(q)?
        else {
            return Ok(());
        };
        let names = self.cavity.vertices.clone();
        let name = |slot: i32| names[slot as usize];
        if let Method::Natural(kind) = method {
            let cavity = &mut self.cavity;
            cavity.find(&given, &[], place.simplex, place.edge(), q, pace)?;
            if self.weights.compute(kind, cavity, q, pace)? {
                for (&v, &w) in cavity.vertices.iter().zip(&self.weights.values) {
                    part.entry(name(v), w, [0.0; 2]);
                }
            }
        } else {
            let weights = crate::locate::barycentric(&given, &place, q);
            let corners = given.simplices[place.simplex];
            for (v, w) in corners.into_iter().zip(weights) {
                part.entry(name(v), w, [0.0; 2]);
            }
        }
        Ok(())
    }
}
