//! The volume between two triangulated surfaces, or a surface and a plane.
//!
//! Triangles are intersected in pairs. Over each intersection both surfaces are linear, so the volume
//! between them is that of prisms, which are split where the surfaces cross. The results are
//! measures and rounded; coordinates are relative to the triangle, so that large coordinates lose
//! nothing.
//!
//! Triangles are processed in groups along the curve; a tree of boxes finds the triangles of the
//! other surface that may overlap a group. Each triangle of the first surface gets its own
//! results, which are independent of the number of threads.

mod clip;
mod prism;

use crate::Point2;
use crate::arrays::Triangles;
use crate::error::Result;
use crate::locate::boxes::Boxes;
use crate::memory::{push, zeroed};
use crate::order::order_of;
use crate::parallel;
use crate::points::Extent;
use crate::watch::Watch;

use clip::Polygon;
use prism::{Linear, Sums};

/// Triangles that look for overlaps together.
const GROUP: usize = 8;
/// Groups per task.
const SHARE: usize = 1 << 9;

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

impl Work<'_> {
    /// The results of the triangles of a task.
    fn rows(&self, order: &[u32], watch: &Watch) -> Result<Vec<[f64; 5]>> {
        let mut rows = Vec::new();
        let (mut over, mut within) = (Vec::new(), Vec::new());
        for group in order.chunks(GROUP) {
            let corners = group
                .iter()
                .flat_map(|&t| self.surface.given.corners(t as usize));
            let extent = Extent::of(corners);
            overlapping(self.over.as_ref(), &extent, &mut over, watch)?;
            overlapping(self.within.as_ref(), &extent, &mut within, watch)?;
            for &t in group {
                push(&mut rows, self.row(t as usize, &over, &within, watch)?)?;
            }
        }
        Ok(rows)
    }

    /// The results of a triangle, given what may overlap it.
    fn row(&self, t: usize, over: &[u32], within: &[u32], watch: &Watch) -> Result<[f64; 5]> {
        let corners = self.surface.given.corners(t);
        let origin = corners[0];
        let whole = Polygon::triangle(corners, origin);
        let below = Linear::over(corners, self.heights(self.surface, t), origin);
        let mut sums = Sums::default();
        let Some(region) = self.region else {
            self.add(&whole, &below, origin, over, &mut sums, watch)?;
            return Ok(sums.row());
        };
        for (i, &r) in within.iter().enumerate() {
            if i % 4096 == 4095 {
                watch.check()?;
            }
            let part = whole.clipped(region.corners(r as usize), origin);
            if !part.is_empty() {
                self.add(&part, &below, origin, over, &mut sums, watch)?;
            }
        }
        Ok(sums.row())
    }

    /// Adds what is between the surfaces over a polygon.
    fn add(
        &self,
        part: &Polygon,
        below: &Linear,
        origin: Point2,
        over: &[u32],
        sums: &mut Sums,
        watch: &Watch,
    ) -> Result<()> {
        match self.other {
            Other::Plane(plane) => sums.add(part, below, &Linear::plane(plane, origin)),
            Other::Surface(other) => {
                let extent = part.extent();
                for (i, &u) in over.iter().enumerate() {
                    if i % 4096 == 4095 {
                        watch.check()?;
                    }
                    let corners = other.given.corners(u as usize);
                    if clip::apart(&extent, corners, origin) {
                        continue;
                    }
                    let common = part.clipped(corners, origin);
                    if !common.is_empty() {
                        let above = Linear::over(corners, self.heights(other, u as usize), origin);
                        sums.add(&common, below, &above);
                    }
                }
            }
        }
        Ok(())
    }

    fn heights(&self, surface: Surface, t: usize) -> [f64; 3] {
        surface.given.simplices[t].map(|v| surface.heights[v as usize])
    }
}

/// Lists the triangles whose boxes meet `extent`.
fn overlapping(
    boxes: Option<&Boxes<2>>,
    extent: &Extent<2>,
    found: &mut Vec<u32>,
    watch: &Watch,
) -> Result<()> {
    found.clear();
    watch.check()?;
    if let Some(boxes) = boxes {
        boxes.meeting(extent, |t| found.push(t as u32));
    }
    Ok(())
}
