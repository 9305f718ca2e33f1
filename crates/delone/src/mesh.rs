//! Quality meshes: a constrained triangulation refined until angles and areas meet their bounds.

use std::borrow::Cow;
use std::ops::Deref;

use delone_core::arrays::{Arrays, Given};
use delone_core::error::Result as CoreResult;
use delone_core::memory::{filled, push, with_room};
use delone_core::refine::Refined;
use delone_core::watch::Watch;

use crate::areas::Part;
use crate::arrays::Domain;
use crate::dimension::Made;
use crate::{Constrained, Error, Options, Result, Tiling};

/// A mesh of a domain by Delaunay refinement: its triangles have no small angles, except where the
/// angles of the input force them.
///
/// Its methods are those of [`Tiling`], too.
///
/// ```
/// use delone::{Constrained, Options};
///
/// let domain = Constrained::polygon(&[[[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [0.0, 1.0]]])?;
/// let mesh = Options::new().min_angle(25.0).max_area(0.05).mesh(&domain)?;
/// assert!(mesh.is_complete());
/// assert!(mesh.min_angles()?.into_iter().all(|angle| angle >= 25.0));
/// assert!(mesh.sizes()?.into_iter().all(|area| area <= 0.05));
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Mesh {
    tiling: Tiling<'static>,
    walls: Vec<[bool; 3]>,
    complete: bool,
}

impl Mesh {
    /// Meshes the triangles that a constrained triangulation keeps, with a smallest angle of 30
    /// degrees; [`Options::mesh`] has other bounds. Refinement uses one thread.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::TooLarge`].
    pub fn new(domain: &Constrained) -> Result<Self> {
        Options::new().mesh(domain)
    }

    /// For each triangle, whether the edge opposite each corner is part of a segment or of the
    /// boundary of the domain.
    pub fn is_constrained(&self) -> &[[bool; 3]] {
        &self.walls
    }

    /// Whether refinement ended by itself; otherwise it reached the limit on points.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    pub(crate) fn of(domain: &Constrained, options: &Options) -> Result<Self> {
        within(options)?;
        let refined = options.watched(|watch| refined(domain, options, watch))?;
        let (given, added) = (domain.points(), &refined.added);
        let mut points = with_room(given.len() + added.len())?;
        points.extend_from_slice(given);
        points.extend_from_slice(added);
        let mut kept = with_room(refined.labels.len())?;
        kept.extend(refined.labels.iter().map(|label| *label >= 0));
        let all = Arrays {
            simplices: refined.simplices,
            neighbors: refined.neighbors,
        };
        let part = options.watched(|watch| Part::of(&all, &kept, watch))?;
        let mut walls = with_room(part.of.len())?;
        let sides = part.of.iter().map(|&t| refined.sides[t as usize]);
        walls.extend(sides.map(|sides| sides.map(|line| line >= 0)));
        let made = Made {
            arrays: part.arrays,
            duplicates: Vec::new(),
            stages: Vec::new(),
        };
        Ok(Self {
            tiling: Tiling::of(Cow::Owned(points), made, added.len(), options),
            walls,
            complete: !refined.exhausted,
        })
    }
}

/// Refuses bounds that are out of range.
pub(crate) fn within(options: &Options) -> Result<()> {
    let (angle, area) = (options.min_angle, options.max_area);
    if !(0.0..60.0).contains(&angle) {
        let text = format!("min_angle must be at least 0 and below 60 degrees, got {angle}");
        return Err(Error::Option(text));
    }
    if area.is_nan() || area <= 0.0 {
        let text = format!("max_area must be positive, got {area}");
        return Err(Error::Option(text));
    }
    Ok(())
}

fn refined(domain: &Constrained, options: &Options, watch: &Watch) -> CoreResult<Refined> {
    let (hull, walls, kept) = domain.whole();
    let mut labels = filled(hull.simplices.len(), 0)?;
    if let Some(kept) = kept {
        let outside = labels.iter_mut().zip(kept).filter(|(_, kept)| !**kept);
        outside.for_each(|(label, _)| *label = -1);
    }
    let segments = lines(domain, hull, walls, &labels)?;
    let domain = Domain {
        points: hull.points,
        simplices: hull.simplices,
        neighbors: Some(hull.neighbors),
        labels: &labels,
        areas: &filled(labels.len(), options.max_area)?,
        segments: &segments,
        frozen: &filled(segments.len(), false)?,
        ..Domain::default()
    };
    domain.refined(options, watch)
}

impl Deref for Mesh {
    type Target = Tiling<'static>;

    fn deref(&self) -> &Self::Target {
        &self.tiling
    }
}

impl From<Mesh> for Tiling<'static> {
    fn from(mesh: Mesh) -> Self {
        mesh.tiling
    }
}

/// The edges that are kept: subsegments, and edges of the hull that bound the domain.
fn lines(
    domain: &Constrained,
    hull: Given<2, 3>,
    walls: &[[bool; 3]],
    labels: &[i32],
) -> CoreResult<Vec<[u32; 2]>> {
    let subsegments = domain.subsegment_ends();
    let mut found = with_room(subsegments.len())?;
    found.extend(subsegments.iter().map(|ends| ends.map(|v| v as u32)));
    for (t, simplex) in hull
        .simplices
        .iter()
        .enumerate()
        .filter(|(t, _)| labels[*t] >= 0)
    {
        for k in (0..3).filter(|&k| hull.neighbors[t][k] < 0 && !walls[t][k]) {
            push(&mut found, [1, 2].map(|j| simplex[(k + j) % 3] as u32))?;
        }
    }
    Ok(found)
}
