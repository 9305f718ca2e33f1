//! The requests: what is too large or badly shaped, worst first, and how it is improved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use delone_predicates::Point3;

use super::cavity::{Cavity, Encroached, Start};
use super::judge::{EDGES, Shape, distance, lowest};
use super::mesh::{Corners, Mesh, NONE, Side};
use super::place::{Found, middle, walk};
use super::{Counts, Tell, is_wall, repeated};
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
/// Points are put on the boundary for ratios above this, or above the bound if that is larger: with
/// less, those that the points request in turn come closer and closer (Shewchuk 1998).
const FORCING: f64 = 2.0;
/// Points on the boundary for shapes are at least this share of a length at the vertices of the input
/// from all others. On public machine parts, 0.25 gave up to 1.5 times the tetrahedra, and angles that
/// are not larger.
const FLOOR: f64 = 0.5;
/// Heights of walls below this share of the shortest edge do not count. On twelve machine parts, the
/// median of the smallest angles was 10.7 degrees with 1, 12.1 with 1/4 and 11.4 with 1/16.
const LOWEST: f64 = 0.25;

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

/// What a request allows on the boundary.
#[derive(Debug, Clone, Copy, Default)]
pub struct Border {
    /// Whether points may be put there.
    pub open: bool,
    /// The least distance of these to vertices.
    pub least: f64,
    /// The floor of the new vertex.
    floor: f64,
}

/// The state of a refinement.
#[derive(Debug)]
pub struct Work {
    pub mesh: Mesh,
    pub counts: Counts,
    pub cavity: Cavity,
    split: bool,
    radius_edge: f64,
    /// For each vertex, how near others on the boundary may be put for shapes that it causes: a share
    /// of its shortest edge in the input, or that of the vertex that caused it.
    floor: Vec<f64>,
    /// For each vertex that was put on a segment of the input, the ends of that.
    pub root: Vec<[u32; 2]>,
    /// What the tetrahedron that is served causes: points on the boundary or none, how near others,
    /// and the floor of the new vertex.
    pub border: Border,
    made: Vec<u32>,
    queue: BinaryHeap<Request>,
    age: u64,
}

impl Work {
    pub fn new(mesh: Mesh, split: bool, radius_edge: f64) -> Result<Self> {
        Ok(Self {
            floor: floors(&mesh)?,
            root: repeated(mesh.points.len(), [NONE; 2])?,
            border: Border::default(),
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
        let (least, floor) = match cause {
            Cause::Size => (SHARE * size, FLOOR * SHARE * size),
            Cause::Shape => (shape.shortest, self.floor_of(corners)),
        };
        self.border = match cause {
            Cause::Size => Border {
                open: self.split,
                least,
                floor,
            },
            Cause::Shape => Border {
                open: self.split
                    && shape.radius > FORCING * shape.shortest
                    && !self.is_between_shells(corners),
                least: floor,
                floor,
            },
        };
        // What is on the boundary first: points inside are placed with regard to it.
        if self.border.open {
            let done = match cause {
                Cause::Size => self.split_border(t, size, least)?,
                Cause::Shape => self.split_encroached(t)?,
            };
            if done {
                return Ok(true);
            }
        }
        if shape.center.iter().all(|x| x.is_finite()) {
            let done = match walk(&self.mesh, t, shape.center) {
                Found::Inside(at) => self.insert_inside(t, at, shape.center, (least, cause))?,
                Found::Wall(side) if self.opens(side, shape.center, cause) => {
                    self.split_wall(side, None, self.border.least)?
                }
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

    /// Whether a point is put on a wall that hides the center of a tetrahedron. For shapes, the
    /// diametral sphere of the wall must contain the center, or the vertex before the wall: others
    /// could be split again and again while the tetrahedron stays.
    fn opens(&self, side: Side, p: Point3, cause: Cause) -> bool {
        if !self.border.open || cause == Cause::Size {
            return self.border.open;
        }
        let apex = self.mesh.corners[side.0 as usize][side.1];
        let all = [p, self.mesh.points[apex as usize]];
        all.into_iter().any(|x| self.is_before(side, x))
    }

    /// Inserts a point inside for a tetrahedron; where points may be put on the boundary, one that is
    /// too near to a segment or a wall is replaced by a point on it.
    fn insert_inside(
        &mut self,
        t: u32,
        at: u32,
        p: Point3,
        (least, cause): (f64, Cause),
    ) -> Result<bool> {
        let mut start = Start::default();
        push(&mut start.cells, at)?;
        if !self.cavity.build(&self.mesh, p, &start)? {
            // It is on a wall of its tetrahedron, or nearly.
            return Ok(self.border.open && self.split_near(at, p)?);
        }
        if !self.cavity.contains(t) {
            return Ok(false);
        }
        if self.border.open {
            let near = self.border.least;
            let done = match self.cavity.encroached(&self.mesh, p, true) {
                Some(Encroached::Segment(t, ends)) => self.split_segment(t, ends, near)?,
                Some(Encroached::Wall(side)) => self.split_wall(side, Some(p), near)?,
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
        let done = self
            .cavity
            .insert(&mut self.mesh, p, start, &mut self.made)?;
        if done {
            push(&mut self.floor, self.border.floor)?;
            push(&mut self.root, [NONE; 2])?;
        }
        Ok(done)
    }

    /// Whether the shortest edge joins two segments of the input that meet at a sharp angle, at equal
    /// distances from there: it gets no longer by points on them.
    fn is_between_shells(&self, corners: Corners) -> bool {
        let lengths = EDGES.map(|e| {
            let ends = e.map(|i| corners[i]);
            let [p, q] = self.mesh.places_of(ends);
            (distance(p, q), ends)
        });
        let shortest = lengths
            .into_iter()
            .reduce(|a, b| if b.0 < a.0 { b } else { a });
        let Some((length, ends)) = shortest else {
            return false;
        };
        let [one, two] = ends.map(|v| self.root[v as usize]);
        let Some(&apex) = one.iter().find(|v| **v != NONE && two.contains(v)) else {
            return false;
        };
        let [p, q, a] = self.mesh.places_of([ends[0], ends[1], apex]);
        let (near, far) = (distance(p, a), distance(q, a));
        one != two && (near - far).abs() < 1e-6 * near && length < near
    }

    /// The floor of a tetrahedron: the larger one of the ends of its shortest edge.
    fn floor_of(&self, corners: Corners) -> f64 {
        let floors = EDGES.map(|e| {
            let ends = e.map(|i| corners[i]);
            let [p, q] = self.mesh.places_of(ends);
            let [f, g] = ends.map(|v| self.floor[v as usize]);
            (distance(p, q), f.max(g))
        });
        let shortest = floors
            .into_iter()
            .reduce(|a, b| if b.0 < a.0 { b } else { a });
        shortest.map_or(0.0, |found| found.1)
    }
}

/// A share of the shortest edge at each vertex, or of the smallest height of a wall there, but not of
/// much smaller ones.
fn floors(mesh: &Mesh) -> Result<Vec<f64>> {
    let mut shortest = repeated(mesh.points.len(), f64::INFINITY)?;
    let mut height = repeated(mesh.points.len(), f64::INFINITY)?;
    for t in (0..mesh.places()).filter(|&t| mesh.is_there(t)) {
        let corners = mesh.corners[t as usize];
        for ends in EDGES.map(|e| e.map(|i| corners[i])) {
            let [p, q] = mesh.places_of(ends);
            for v in ends {
                let least = &mut shortest[v as usize];
                *least = least.min(distance(p, q));
            }
        }
        for k in (0..4).filter(|&k| is_wall(mesh, t, k)) {
            let face = mesh.face((t, k));
            let low = lowest(mesh.places_of(face));
            for v in face {
                let least = &mut height[v as usize];
                *least = least.min(low);
            }
        }
    }
    for (floor, low) in shortest.iter_mut().zip(height) {
        *floor = FLOOR * low.clamp(LOWEST * *floor, *floor);
    }
    Ok(shortest)
}
