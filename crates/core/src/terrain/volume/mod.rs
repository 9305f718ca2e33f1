//! The volume between two triangulated surfaces, or a surface and a plane.
//!
//! Triangles are intersected in pairs. Over each intersection both surfaces are linear, so the volume
//! between them is that of prisms, which are split where the surfaces cross. The results are
//! measures and rounded; coordinates are relative to a point nearby, so that large coordinates lose
//! nothing.
//!
//! Triangles are processed along the curve; a walk through the other surface finds those that may
//! overlap each. Each triangle of the first surface gets its own results, summed in the order of the
//! rows of the other one, relative to its own corner: they depend on no other triangle and not on
//! the number of threads.

mod clip;
mod packed;
mod parts;
mod prism;
mod walk;

use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::locate::{Boxes, Output};
use crate::order::order_of;
use delone_predicates::Point2;

pub use parts::Surface;

use clip::{Candidates, Polygon};
use packed::Packed;
use parts::center;
use prism::{Linear, Sums};
use walk::{Ground, Walk};

/// Triangles per task.
const SHARE: usize = 1 << 12;
/// Triangles between two checks for interruption.
const GROUP: usize = 16;

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
    let here = || order.iter().map(|&t| t as usize);
    let packed = Packed::of(&surface, here(), watch)?;
    let beside = match other {
        Other::Plane(_) => None,
        Other::Surface(other) => {
            let rows = 0..other.given.simplices.len();
            Some((Packed::of(&other, rows, watch)?, other.given.neighbors))
        }
    };
    let beside = beside
        .as_ref()
        .map(|(packed, neighbors)| packed.surface(neighbors));
    let column = || Output::filled(order.len(), 0.0, watch);
    let work = Work {
        surface: packed.surface(surface.given.neighbors),
        other: match (other, beside) {
            (Other::Surface(_), Some(beside)) => Other::Surface(beside),
            (other, _) => other,
        },
        region,
        over: beside
            .map(|beside| Ground::of(beside.given, watch))
            .transpose()?,
        within: region.map(|region| tree(region, watch)).transpose()?,
        found: [column()?, column()?, column()?, column()?, column()?],
    };
    let tasks = order.chunks(SHARE).collect();
    parallel::map_watched(workers, tasks, watch, |order| work.rows(order, watch))?;
    Ok(work.found.map(Output::into_vec))
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
    over: Option<Ground<'a>>,
    within: Option<Boxes<2>>,
    found: [Output<f64>; 5],
}

impl Work<'_> {
    /// Computes the rows of the triangles of a task.
    fn rows(&self, order: &[u32], watch: &Watch) -> Result<()> {
        let over = self.over.as_ref();
        let mut walk = over.map(|over| Walk::new(over, watch)).transpose()?;
        let mut within = Candidates::default();
        for group in order.chunks(GROUP) {
            watch.check()?;
            if let (Some(region), Some(boxes)) = (self.region, &self.within) {
                let corners = |&t: &u32| self.surface.given.corners(t as usize);
                let extent = Extent::of(group.iter().flat_map(corners));
                within.gather(region, boxes, &extent)?;
            }
            for &t in group {
                let sums = self.row(t as usize, &mut within, walk.as_mut(), watch)?;
                for (column, value) in self.found.iter().zip(sums.row()) {
                    column.set(t as usize, value);
                }
            }
        }
        Ok(())
    }

    /// The sums of a triangle.
    fn row(
        &self,
        t: usize,
        within: &mut Candidates,
        walk: Option<&mut Walk>,
        watch: &Watch,
    ) -> Result<Sums> {
        let corners = self.surface.given.corners(t);
        let origin = corners[0];
        let whole = Polygon::triangle(corners, origin);
        let below = Linear::over(corners, self.surface.heights_of(t), origin);
        let mut sums = Sums::default();
        let mut space = [Polygon::EMPTY; 3];
        let mut parts: Vec<Polygon> = Vec::new();
        if self.region.is_some() {
            for near in within.meeting(&corners, &whole.extent(), watch)? {
                if let Some(part) = whole.clipped(near, &mut space) {
                    push(&mut parts, *part)?;
                }
            }
            if parts.is_empty() {
                return Ok(sums);
            }
        }
        match (self.other, walk) {
            (Other::Plane(plane), _) => {
                let above = Linear::plane(plane, origin);
                let whole = self.region.is_none().then_some(&whole);
                whole
                    .into_iter()
                    .chain(&parts)
                    .for_each(|part| sums.add(part, &below, &above));
            }
            (Other::Surface(other), Some(walk)) => walk.meeting(corners, |t, pair| {
                let above = || Linear::over(other.given.corners(t), other.heights_of(t), origin);
                if self.region.is_none() {
                    if let Some(common) = whole.in_pair(&pair.corners, &pair.sides, &mut space) {
                        sums.add(common, &below, &above());
                    }
                    return;
                }
                for part in &parts {
                    if let Some(common) = part.clipped(&pair.corners, &mut space) {
                        sums.add(common, &below, &above());
                    }
                }
            })?,
            (Other::Surface(_), None) => (),
        }
        Ok(sums)
    }
}
