//! The requests: what is too large or badly shaped, worst first, and how it is improved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use delone_predicates::Point3;

use super::cavity::{Cavity, Encroached, Start};
use super::judge::Shape;
use super::mesh::{Corners, Mesh};
use super::place::{Found, middle, walk};
use super::{Counts, Tell, repeated};
use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::base::watch::Watch;

/// Requests between two checks for interruption.
const WATCH_EVERY: usize = 1 << 8;
/// Requests between two calls of `tell`.
const TELL_EVERY: usize = 1 << 12;
/// New edges are at least this share of the size that requests them.
const SHARE: f64 = 0.5;
/// Points inside are at least this share of that length above walls.
const HEIGHT: f64 = 0.5;

/// A tetrahedron to refine.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Request {
    /// By which factor a bound is missed.
    urgency: f64,
    /// Older requests come first.
    age: u64,
    t: u32,
    corners: Corners,
}

impl Eq for Request {}

impl Ord for Request {
    fn cmp(&self, other: &Self) -> Ordering {
        let urgency = self.urgency.total_cmp(&other.urgency);
        urgency.then(other.age.cmp(&self.age))
    }
}

impl PartialOrd for Request {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Why a point is added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    Size,
    Shape,
}

/// The state of a refinement.
#[derive(Debug)]
pub struct Work {
    pub mesh: Mesh,
    pub counts: Counts,
    pub cavity: Cavity,
    split: bool,
    radius_edge: f64,
    made: Vec<u32>,
    queue: BinaryHeap<Request>,
    age: u64,
}

impl Work {
    pub fn new(mesh: Mesh, split: bool, radius_edge: f64) -> Result<Self> {
        Ok(Self {
            mesh,
            counts: Counts::default(),
            split,
            radius_edge,
            cavity: Cavity::default(),
            made: repeated(0, 0)?,
            queue: BinaryHeap::new(),
            age: 0,
        })
    }

    /// Refines until nothing more can be done (true) or `limit` points were added (false).
    pub fn run(&mut self, limit: usize, watch: &Watch, tell: Tell) -> Result<bool> {
        let before = self.counts.total();
        self.queue.clear();
        for t in 0..self.mesh.places() {
            if self.mesh.is_there(t) {
                self.ask(t)?;
            }
        }
        let mut steps = 0;
        while let Some(request) = self.queue.pop() {
            steps += 1;
            if steps % WATCH_EVERY == 0 {
                watch.check()?;
            }
            if steps % TELL_EVERY == 0 {
                tell(self.counts.total())?;
            }
            // A record that has been replaced since then requests nothing.
            if self.mesh.corners[request.t as usize] != request.corners {
                continue;
            }
            if self.counts.total() - before >= limit {
                return Ok(false);
            }
            if self.serve(request.t)? {
                for i in 0..self.made.len() {
                    self.ask(self.made[i])?;
                }
                // It may have been asked for the sake of this one, which is still there.
                if self.mesh.corners[request.t as usize] == request.corners {
                    self.ask(request.t)?;
                }
            }
        }
        Ok(true)
    }

    /// Adds a request for a tetrahedron if it misses a bound.
    fn ask(&mut self, t: u32) -> Result<()> {
        let corners = self.mesh.corners[t as usize];
        let shape = Shape::of(self.mesh.places_of(corners));
        let size = self.mesh.size[t as usize];
        let excess = shape.excess(size);
        let ratio = shape.radius / shape.shortest / self.radius_edge;
        // Sizes come first: shapes are better when they are reached.
        let urgency = if excess > 1.0 {
            1e300 * (1.0 - 1.0 / (1.0 + excess))
        } else if ratio > 1.0 {
            ratio.min(1e200)
        } else {
            return Ok(());
        };
        self.age += 1;
        let bytes = self.queue.len() * size_of::<Request>();
        let room = self.queue.try_reserve(1);
        room.map_err(|_| Error::Memory { bytes })?;
        self.queue.push(Request {
            urgency,
            age: self.age,
            t,
            corners,
        });
        Ok(())
    }

    /// Adds a point for a tetrahedron; false if there is no place for one.
    fn serve(&mut self, t: u32) -> Result<bool> {
        let corners = self.mesh.corners[t as usize];
        let places = self.mesh.places_of(corners);
        let shape = Shape::of(places);
        let size = self.mesh.size[t as usize];
        let cause = if shape.is_larger_than(size) {
            Cause::Size
        } else {
            Cause::Shape
        };
        let least = match cause {
            Cause::Size => SHARE * size,
            Cause::Shape => shape.shortest,
        };
        let size = (self.split && cause == Cause::Size).then_some(size);
        // What is on the boundary first: points inside are placed with regard to it.
        if let Some(size) = size
            && self.split_border(t, size, least)?
        {
            return Ok(true);
        }
        if shape.center.iter().all(|x| x.is_finite()) {
            let done = match walk(&self.mesh, t, shape.center) {
                Found::Inside(at) => self.insert_inside(t, at, shape.center, (least, cause))?,
                Found::Wall(side) if size.is_some() => self.split_wall(side, None, least)?,
                Found::Wall(_) | Found::Nothing => false,
            };
            if done {
                return Ok(true);
            }
        }
        if cause == Cause::Shape {
            return Ok(false);
        }
        self.insert_inside(t, t, middle(places), (least, cause))
    }

    /// Inserts a point inside for a tetrahedron; for the sake of a size, one that is too near to a
    /// segment or a wall is replaced by a point on it.
    fn insert_inside(
        &mut self,
        t: u32,
        at: u32,
        p: Point3,
        (least, cause): (f64, Cause),
    ) -> Result<bool> {
        let mut start = Start::default();
        push(&mut start.cells, at)?;
        if !self.cavity.build(&self.mesh, p, &start)? || !self.cavity.contains(t) {
            return Ok(false);
        }
        if self.split && cause == Cause::Size {
            let done = match self.cavity.encroached(&self.mesh, p, true) {
                Some(Encroached::Segment(t, ends)) => self.split_segment(t, ends, least)?,
                Some(Encroached::Wall(side)) => self.split_wall(side, Some(p), least)?,
                None => false,
            };
            if done {
                return Ok(true);
            }
            // The cavity may be that of another point now.
            if !self.cavity.build(&self.mesh, p, &start)? {
                return Ok(false);
            }
        }
        if self.cavity.clearance(&self.mesh, p) < least
            || self.cavity.height(&self.mesh, p) < HEIGHT * least
        {
            return Ok(false);
        }
        let done = self.insert(p, &start)?;
        match cause {
            Cause::Size => self.counts.for_sizes += usize::from(done),
            Cause::Shape => self.counts.for_shapes += usize::from(done),
        }
        Ok(done)
    }

    /// Inserts a point into the cavity that was built for it.
    pub fn insert(&mut self, p: Point3, start: &Start) -> Result<bool> {
        self.cavity.insert(&mut self.mesh, p, start, &mut self.made)
    }
}
