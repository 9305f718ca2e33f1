//! The volume between two triangulated surfaces, or a surface and a plane.
//!
//! Triangles are intersected in pairs. Over each intersection both surfaces are linear, so the volume
//! between them is that of prisms, which are split where the surfaces cross. The results are
//! measures and rounded; coordinates are relative to a point nearby, so that large coordinates lose
//! nothing.
//!
//! Triangles are processed in groups along the curve; a tree of boxes finds the triangles of the
//! other surface that may overlap a group. Each triangle of the first surface gets its own
//! results, which are independent of the number of threads.

mod clip;
mod prism;

use crate::arrays::Triangles;
use crate::error::Result;
use crate::locate::boxes::Boxes;
use crate::memory::{push, with_room, zeroed};
use crate::order::order_of;
use crate::parallel;
use crate::points::Extent;
use crate::watch::Watch;
use delone_predicates::Point2;

use clip::{Candidate, Polygon};
use prism::{Linear, Sums};

/// Triangles that look for overlaps together.
const GROUP: usize = 16;
/// Groups per task.
const SHARE: usize = 1 << 8;
/// Candidates between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;

/// A triangulated surface.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// Its triangles.
    pub given: Triangles<'a>,
    /// The height of each point.
    pub heights: &'a [f64],
}

/// What a surface is compared with.
#[derive(Clone, Copy)]
pub enum Other<'a> {
    /// The plane z = c + a x + b y, by [a, b, c].
    Plane([f64; 3]),
    /// Another surface.
    Surface(Surface<'a>),
}

/// Columns with a value for each triangle of the first surface: the volume below it and above the
/// other surface, the volume above it and below the other, the areas where that is so, and the area
/// of its overlap with the other surface.
pub type Volumes = [Vec<f64>; 5];

/// The volumes between `surface` and `other`, within the triangles of `region` if there is one.
pub fn volumes(
    surface: Surface,
    other: Other,
    region: Option<Triangles>,
    workers: usize,
    watch: &Watch,
) -> Result<Volumes> {
    let centers: Vec<Point2> = (0..surface.given.simplices.len())
        .map(|t| center(surface.given.corners(t)))
        .collect();
    let order = order_of::<2>(&centers, workers, watch)?.concat();
    let over = match other {
        Other::Plane(_) => None,
        Other::Surface(other) => Some(tree(other.given, watch)?),
    };
    let within = region.map(|region| tree(region, watch)).transpose()?;
    let work = Work {
        surface,
        other,
        region,
        over,
        within,
    };
    let tasks = order.chunks(GROUP * SHARE).collect();
    let rows = parallel::map_watched(workers, tasks, watch, |order| work.rows(order, watch))?;
    let mut found = [const { Vec::new() }; 5];
    for column in &mut found {
        *column = zeroed(order.len())?;
    }
    for (&t, row) in order.iter().zip(rows.iter().flatten()) {
        for (column, value) in found.iter_mut().zip(row) {
            column[t as usize] = *value;
        }
    }
    Ok(found)
}

fn center(corners: [Point2; 3]) -> Point2 {
    std::array::from_fn(|k| corners.iter().map(|p| p[k] / 3.0).sum())
}

fn tree(given: Triangles, watch: &Watch) -> Result<Boxes<2>> {
    let extent = |t: usize| Extent::of(given.corners(t));
    Boxes::over(given.simplices.len(), extent, watch)
}

/// What all tasks share.
struct Work<'a> {
    surface: Surface<'a>,
    other: Other<'a>,
    region: Option<Triangles<'a>>,
    over: Option<Boxes<2>>,
    within: Option<Boxes<2>>,
}

/// What may overlap the triangles of a group, relative to an origin near them.
struct Near {
    origin: Point2,
    /// Triangles of the region.
    within: Vec<Candidate>,
    /// Triangles of the other surface, and its heights over them.
    over: Vec<(Candidate, Linear)>,
}

impl Work<'_> {
    /// The results of the triangles of a task.
    fn rows(&self, order: &[u32], watch: &Watch) -> Result<Vec<[f64; 5]>> {
        let mut rows = with_room(order.len())?;
        let mut near = Near {
            origin: [0.0; 2],
            within: Vec::new(),
            over: Vec::new(),
        };
        for group in order.chunks(GROUP) {
            watch.check()?;
            self.look_around(group, &mut near)?;
            for &t in group {
                rows.push(self.row(t as usize, &near, watch)?);
            }
        }
        Ok(rows)
    }

    /// Finds what may overlap the triangles of a group.
    fn look_around(&self, group: &[u32], near: &mut Near) -> Result<()> {
        let corners = |t: &u32| self.surface.given.corners(*t as usize);
        let extent = Extent::of(group.iter().flat_map(corners));
        near.origin = corners(&group[0])[0];
        let origin = near.origin;
        let around = Candidate::extent_of(&extent, origin);
        near.within.clear();
        near.over.clear();
        let mut end = Ok(());
        if let (Some(region), Some(boxes)) = (self.region, &self.within) {
            boxes.meeting(&extent, |t| {
                if end.is_ok() {
                    end = push(&mut near.within, Candidate::new(region.corners(t), origin));
                }
            });
        }
        if let (Other::Surface(other), Some(boxes)) = (self.other, &self.over) {
            boxes.meeting(&extent, |t| {
                if end.is_ok() {
                    let corners = other.given.corners(t);
                    let candidate = Candidate::new(corners, origin);
                    if candidate.meets(&around) {
                        let linear = Linear::over(corners, other.heights_of(t), origin);
                        end = push(&mut near.over, (candidate, linear));
                    }
                }
            });
        }
        end
    }

    /// The results of a triangle.
    fn row(&self, t: usize, near: &Near, watch: &Watch) -> Result<[f64; 5]> {
        let corners = self.surface.given.corners(t);
        let whole = Polygon::triangle(corners, near.origin);
        let below = Linear::over(corners, self.surface.heights_of(t), near.origin);
        let mut sums = Sums::default();
        if self.region.is_none() {
            self.add(&whole, &below, near, &mut sums, watch)?;
            return Ok(sums.row());
        }
        let extent = whole.extent();
        for (i, candidate) in near.within.iter().enumerate() {
            if i % WATCH_EVERY == WATCH_EVERY - 1 {
                watch.check()?;
            }
            if candidate.meets(&extent)
                && let Some(part) = whole.clipped(&candidate.corners)
            {
                self.add(&part, &below, near, &mut sums, watch)?;
            }
        }
        Ok(sums.row())
    }

    /// Adds what is between the surfaces over a polygon.
    fn add(
        &self,
        part: &Polygon,
        below: &Linear,
        near: &Near,
        sums: &mut Sums,
        watch: &Watch,
    ) -> Result<()> {
        if let Other::Plane(plane) = self.other {
            sums.add(part, below, &Linear::plane(plane, near.origin));
            return Ok(());
        }
        let extent = part.extent();
        for (i, (candidate, above)) in near.over.iter().enumerate() {
            if i % WATCH_EVERY == WATCH_EVERY - 1 {
                watch.check()?;
            }
            if candidate.meets(&extent)
                && let Some(common) = part.clipped(&candidate.corners)
            {
                sums.add(&common, below, above);
            }
        }
        Ok(())
    }
}

impl Surface<'_> {
    fn heights_of(&self, t: usize) -> [f64; 3] {
        self.given.simplices[t].map(|v| self.heights[v as usize])
    }
}
