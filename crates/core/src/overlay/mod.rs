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

use clip::{Candidates, Polygon, WATCH_EVERY, extent_from};
use prism::{Linear, Sums};

/// Triangles that look for overlaps together.
const GROUP: usize = 16;
/// Groups per task.
const SHARE: usize = 1 << 8;

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
#[derive(Default)]
struct Near {
    origin: Point2,
    /// Triangles of the region.
    within: Candidates,
    /// Triangles of the other surface.
    over: Candidates,
    /// Its heights over them.
    above: Vec<Linear>,
}

impl Work<'_> {
    /// The results of the triangles of a task.
    fn rows(&self, order: &[u32], watch: &Watch) -> Result<Vec<[f64; 5]>> {
        let mut rows = with_room(order.len())?;
        let mut near = Near::default();
        for group in order.chunks(GROUP) {
            watch.check()?;
            self.look_around(group, &mut near)?;
            for &t in group {
                rows.push(self.row(t as usize, &mut near, watch)?);
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
        let around = extent_from(&extent, origin);
        near.within.clear();
        near.over.clear();
        near.above.clear();
        let mut end = Ok(());
        if let (Some(region), Some(boxes)) = (self.region, &self.within) {
            boxes.meeting(&extent, |t| {
                if end.is_ok() {
                    let corners = region.corners(t);
                    end = near.within.add(corners, origin, &around).map(|_| ());
                }
            });
        }
        if let (Other::Surface(other), Some(boxes)) = (self.other, &self.over) {
            boxes.meeting(&extent, |t| {
                if end.is_ok() {
                    let corners = other.given.corners(t);
                    end = near.over.add(corners, origin, &around).and_then(|meets| {
                        if !meets {
                            return Ok(());
                        }
                        let linear = Linear::over(corners, other.heights_of(t), origin);
                        push(&mut near.above, linear)
                    });
                }
            });
        }
        end
    }

    /// The results of a triangle.
    fn row(&self, t: usize, near: &mut Near, watch: &Watch) -> Result<[f64; 5]> {
        let corners = self.surface.given.corners(t);
        let whole = Polygon::triangle(corners, near.origin);
        let below = Linear::over(corners, self.surface.heights_of(t), near.origin);
        let mut sums = Sums::default();
        let Near {
            origin,
            within,
            over,
            above,
        } = near;
        let mut add = |part: &Polygon| -> Result<()> {
            if let Other::Plane(plane) = self.other {
                sums.add(part, &below, &Linear::plane(plane, *origin));
                return Ok(());
            }
            let mut space = [Polygon::EMPTY; 3];
            let (rows, corners) = over.meeting(&part.extent(), watch)?;
            for (i, &row) in rows.iter().enumerate() {
                if i % WATCH_EVERY == WATCH_EVERY - 1 {
                    watch.check()?;
                }
                let row = row as usize;
                if let Some(common) = part.clipped(&corners[row], &mut space) {
                    sums.add(common, &below, &above[row]);
                }
            }
            Ok(())
        };
        if self.region.is_none() {
            add(&whole)?;
            return Ok(sums.row());
        }
        let mut space = [Polygon::EMPTY; 3];
        let (rows, corners) = within.meeting(&whole.extent(), watch)?;
        for &row in rows {
            if let Some(part) = whole.clipped(&corners[row as usize], &mut space) {
                add(part)?;
            }
        }
        Ok(sums.row())
    }
}

impl Surface<'_> {
    fn heights_of(&self, t: usize) -> [f64; 3] {
        self.given.simplices[t].map(|v| self.heights[v as usize])
    }
}
