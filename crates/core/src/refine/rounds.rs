//! Refinement in rounds, for sizes that only the caller can evaluate: the mesh stays here, and the
//! caller is asked only about new triangles.
//!
//! In each round, no triangle becomes smaller than a fraction of what it was, so that variable
//! sizes are sampled before triangles are smaller than the distance over which sizes change. A
//! triangle complies if it is no larger than the area wanted at its center and at the samples that
//! it contains.
//!
//! # The same triangles as from separate refinements
//!
//! A round gives the same result as `refine` of the arrays of the previous round. Both number
//! vertices in the order in which they came, and both keep the order of the triangles, on which the
//! order of work depends: an export leaves ghosts out, an import adds them at the end, and nothing
//! is done for ghosts. The data of vertices are derived again from the pieces of the segments, as
//! an import does ([`Work::begin_again`]). Fences are not kept. They depend on the triangles at the
//! beginning of a round and are all removed at its end, and finding them again takes less time than
//! visiting each triangle.
//!
//! Only what depends on a triangle alone is kept: its area, and the area wanted at its center. A
//! record with the same corners as before is the same triangle. Samples are located again in each
//! round, because one on an edge belongs to the first triangle there, which may be new while the
//! other one is not.

use delone_predicates::{Point2, Sign, orient2d};

use super::task::{Refined, Task, Tell};
use super::work::Work;
use super::{LOT, begin, export};
use crate::base::error::Result;
use crate::base::memory::{copied, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::marked::turn;
use crate::measure;
use crate::mesh::plane::{half_edge, triangle};

/// Samples between two checks for interruption; locating one may be a long walk.
const WATCH_EVERY: usize = 1 << 10;

/// The largest factor by which a triangle is made smaller in one round.
const STEP: f64 = 4.0;

/// Corners of no triangle.
const NONE: [u32; 3] = [u32::MAX; 3];

/// Positions in the domain and the area wanted there.
#[derive(Debug, Clone, Copy)]
pub struct Samples<'a> {
    /// The positions.
    pub positions: &'a [Point2],
    /// The largest area of a triangle with that position.
    pub areas: &'a [f64],
}

/// Triangles of the domain that are new since the previous round.
#[derive(Debug)]
pub struct Fresh {
    /// Their centers.
    pub centers: Vec<Point2>,
    /// Their labels.
    pub labels: Vec<i32>,
}

/// A refinement in rounds.
#[derive(Debug)]
pub struct Rounds {
    work: Work,
    /// The row of each vertex of the input, and the number of rows.
    rows: Vec<u32>,
    given: usize,
    samples: Vec<Sample>,
    /// For each record, the corners of the triangle that was seen last, its area, and the area
    /// wanted at its center.
    known: Vec<[u32; 3]>,
    areas: Vec<f64>,
    wanted: Vec<f64>,
    /// The records of new triangles.
    fresh: Vec<u32>,
    exhausted: bool,
}

/// A sample, and a triangle near it.
#[derive(Debug, Clone, Copy)]
struct Sample {
    position: Point2,
    area: f64,
    near: u32,
}

impl Rounds {
    /// A refinement before its first round; the areas and the limit on vertices of the task are
    /// ignored.
    pub fn new(task: Task, samples: Samples, watch: &Watch) -> Result<Self> {
        let (work, rows) = begin(task, watch)?;
        let given = samples.positions.iter().zip(samples.areas);
        let mut all = with_room(samples.positions.len())?;
        all.extend(given.map(|(&position, &area)| Sample {
            position,
            area,
            near: 0,
        }));
        Ok(Self {
            work,
            rows,
            given: task.points.len(),
            samples: all,
            known: Vec::new(),
            areas: Vec::new(),
            wanted: Vec::new(),
            fresh: Vec::new(),
            exhausted: false,
        })
    }

    /// The triangles of the domain that are new since the last call.
    pub fn fresh(&mut self, workers: usize, watch: &Watch) -> Result<Fresh> {
        let triangles = self.work.marked.triangles();
        let more = triangles as usize - self.known.len();
        make_room(&mut self.known, more)?;
        self.known.resize(triangles as usize, NONE);
        for values in [&mut self.areas, &mut self.wanted] {
            make_room(values, more)?;
            values.resize(triangles as usize, f64::INFINITY);
        }
        self.fresh.clear();
        let (mut simplices, mut labels) = (Vec::new(), Vec::new());
        let mut pace = Pace::new(watch, LOT);
        let mesh = self.work.marked.mesh.resume(triangles);
        for t in 0..triangles {
            pace.spend(1)?;
            let (label, corners) = (mesh.label(t), mesh.corners(t));
            if label == 0 || self.known[t as usize] == corners {
                continue;
            }
            self.known[t as usize] = corners;
            push(&mut self.fresh, t)?;
            push(&mut simplices, corners.map(|v| v as i32))?;
            push(&mut labels, label as i32 - 1)?;
        }
        let points = &self.work.marked.points;
        let areas = measure::areas(points, &simplices, workers, watch)?;
        for (&t, area) in self.fresh.iter().zip(areas) {
            self.areas[t as usize] = area;
        }
        let mut centers = with_room(simplices.len())?;
        centers.extend(simplices.iter().map(|s| {
            let [a, b, c] = s.map(|v| points[v as usize].map(|x| x / 3.0));
            [0, 1].map(|k| a[k] + b[k] + c[k])
        }));
        Ok(Fresh { centers, labels })
    }

    /// Sets the areas wanted at the centers of the triangles that [`Self::fresh`] returned; whether
    /// all triangles comply.
    pub fn comply(&mut self, wanted: &[f64], watch: &Watch) -> Result<bool> {
        for (&t, &wanted) in self.fresh.iter().zip(wanted) {
            self.wanted[t as usize] = wanted;
        }
        let mut least = copied(&self.wanted)?;
        self.sample(&mut least, watch)?;
        let triangles = self.work.marked.triangles();
        let mesh = self.work.marked.mesh.resume(triangles);
        let (caps, mut large) = (&mut self.work.caps, false);
        for (t, cap) in (0..triangles).zip(caps) {
            let (area, wanted) = (self.areas[t as usize], least[t as usize]);
            *cap = f64::INFINITY;
            if mesh.label(t) != 0 && area > wanted {
                *cap = 2.0 * wanted.max(area / STEP);
                large = true;
            }
        }
        Ok(!large)
    }

    /// Adds at most this many vertices, until no angle is small and no triangle is larger than this
    /// round allows. Returns whether that was enough.
    pub fn refine(&mut self, max_vertices: usize, watch: &Watch, tell: Tell) -> Result<bool> {
        self.work.begin_again(max_vertices)?;
        self.exhausted = !self.work.run(watch, tell)?;
        Ok(!self.exhausted)
    }

    /// The number of vertices added.
    pub fn added(&self) -> usize {
        self.work.marked.count - self.rows.len()
    }

    /// The triangulation, with the vertices of all rounds.
    pub fn export(&mut self, watch: &Watch) -> Result<Refined> {
        let exhausted = self.exhausted;
        export(&mut self.work, &self.rows, self.given, exhausted, watch)
    }

    /// Lowers the area of each triangle to that of the samples in it.
    fn sample(&mut self, least: &mut [f64], watch: &Watch) -> Result<()> {
        let mut near = 0;
        for i in 0..self.samples.len() {
            if i.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            let sample = self.samples[i];
            // At first, the triangles of samples are not known, but consecutive samples are close
            // together.
            near = if sample.near == 0 { near } else { sample.near };
            near = self.first_around(sample.position, near)?;
            self.samples[i].near = near;
            let least = &mut least[near as usize];
            *least = least.min(sample.area);
        }
        Ok(())
    }

    /// The first of the triangles that contain `p`; a ghost if none does.
    fn first_around(&mut self, p: Point2, near: u32) -> Result<u32> {
        let home = self.work.marked.find(p, near)?;
        let marked = &mut self.work.marked;
        let triangles = marked.triangles();
        let (mesh, points) = (marked.mesh.resume(triangles), &marked.points);
        let corners = mesh.corners(home);
        if corners.contains(&mesh.infinite()) {
            return Ok(home);
        }
        let at = corners.map(|v| points[v as usize]);
        let finite = |t: &u32| !mesh.corners(*t).contains(&mesh.infinite());
        if let Some(k) = at.iter().position(|a| *a == p) {
            let start = half_edge(home, k as u32);
            let (mut first, mut corner) = (home, turn(&mesh, start));
            while corner != start {
                first = Some(triangle(corner))
                    .filter(finite)
                    .map_or(first, |t| first.min(t));
                corner = turn(&mesh, corner);
            }
            return Ok(first);
        }
        let on = (0..3).find(|k| orient2d(at[(k + 1) % 3], at[(k + 2) % 3], p) == Sign::Zero);
        let beyond = on.map(|k| triangle(mesh.opposite(half_edge(home, k as u32))));
        Ok(beyond.filter(finite).map_or(home, |t| home.min(t)))
    }
}
