//! Quality meshes: a constrained triangulation refined until angles and areas meet their bounds.

use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;

use delone_core::arrays::{Arrays, Given};
use delone_core::error::Result as CoreResult;
use delone_core::memory::{filled, push, with_room};
use delone_core::refine::{Refined, Task, refine_telling};
use delone_core::watch::Watch;

use crate::areas::Part;
use crate::tiling::{Tiling, watched};
use crate::{Constrained, Error, Options, Result};

/// The points that may be added unless the caller sets another limit.
const MOST_ADDED: usize = 5_000_000;

/// A mesh of a domain by Delaunay refinement: its triangles have no small angles, except where the
/// angles of the input force them.
///
/// Its methods are those of [`Tiling`], too.
///
/// ```
/// use delone::{Constrained, Mesh};
///
/// let domain = Constrained::polygon(&[[[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [0.0, 1.0]]])?;
/// let mesh = Mesh::builder().min_angle(25.0).max_area(0.05).build(&domain)?;
/// assert!(mesh.is_complete());
/// assert!(mesh.min_angles()?.into_iter().all(|angle| angle >= 25.0));
/// assert!(mesh.areas()?.into_iter().all(|area| area <= 0.05));
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Mesh {
    tiling: Tiling<'static, 2, 3>,
    added: usize,
    walls: Vec<[bool; 3]>,
    complete: bool,
}

impl Mesh {
    /// Meshes the triangles that a constrained triangulation keeps, with a smallest angle of 30
    /// degrees.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::TooLarge`].
    pub fn new(domain: &Constrained) -> Result<Self> {
        Self::builder().build(domain)
    }

    /// Options for angles, areas and the number of points.
    pub fn builder<'o>() -> MeshBuilder<'o> {
        MeshBuilder {
            options: Options::new(),
            min_angle: 30.0,
            max_area: f64::INFINITY,
            max_points: MOST_ADDED,
            progress: None,
        }
    }

    /// The number of points that refinement added: the last rows of [`points`](Tiling::points).
    pub fn added(&self) -> usize {
        self.added
    }

    /// For each triangle, whether the edge opposite each corner is part of a segment or of the
    /// boundary of the domain.
    pub fn is_constrained(&self) -> impl ExactSizeIterator<Item = [bool; 3]> + '_ {
        self.walls.iter().copied()
    }

    /// Whether refinement ended by itself; otherwise it reached the limit on points.
    pub fn is_complete(&self) -> bool {
        self.complete
    }
}

impl Deref for Mesh {
    type Target = Tiling<'static, 2, 3>;

    fn deref(&self) -> &Self::Target {
        &self.tiling
    }
}

impl From<Mesh> for Tiling<'static, 2, 3> {
    fn from(mesh: Mesh) -> Self {
        mesh.tiling
    }
}

/// Options of a mesh; made by [`Mesh::builder`].
#[derive(Clone, Copy)]
pub struct MeshBuilder<'o> {
    options: Options<'o>,
    min_angle: f64,
    max_area: f64,
    max_points: usize,
    progress: Option<&'o (dyn Fn(usize) + Sync)>,
}

impl<'o> MeshBuilder<'o> {
    /// Sets threads and interruption. Refinement itself uses one thread.
    #[must_use]
    pub fn options(mut self, options: Options<'o>) -> Self {
        self.options = options;
        self
    }

    /// The smallest angle in degrees, up to rounding; at least 0 and below 60, by default 30. Termination is proven
    /// up to about 26 degrees and usual up to 33; above, `max_points` often ends the work.
    #[must_use]
    pub fn min_angle(mut self, degrees: f64) -> Self {
        self.min_angle = degrees;
        self
    }

    /// The largest area of a triangle, in the square of the unit of the points; by default without
    /// a limit.
    #[must_use]
    pub fn max_area(mut self, area: f64) -> Self {
        self.max_area = area;
        self
    }

    /// The most points that may be added, by default 5,000,000. If more are needed, the mesh is what
    /// has been reached, and [`Mesh::is_complete`] is false.
    #[must_use]
    pub fn max_points(mut self, most: usize) -> Self {
        self.max_points = most;
        self
    }

    /// A function that is called now and then with the number of points that have been added.
    #[must_use]
    pub fn progress(mut self, tell: &'o (dyn Fn(usize) + Sync)) -> Self {
        self.progress = Some(tell);
        self
    }

    /// Meshes the triangles that a constrained triangulation keeps.
    ///
    /// # Errors
    /// [`Error::Option`] if a number is out of range, [`Error::Interrupted`], [`Error::Memory`],
    /// [`Error::TooLarge`].
    pub fn build(&self, domain: &Constrained) -> Result<Mesh> {
        let (angle, area) = (self.min_angle, self.max_area);
        if !(0.0..60.0).contains(&angle) {
            let text = format!("min_angle must be at least 0 and below 60 degrees, got {angle}");
            return Err(Error::Option(text));
        }
        if area.is_nan() || area <= 0.0 {
            return Err(Error::Option(format!(
                "max_area must be positive, got {area}"
            )));
        }
        let refined = watched(&self.options, |watch| self.refined(domain, watch))?;
        self.mesh(domain, refined)
    }

    fn refined(&self, domain: &Constrained, watch: &Watch) -> CoreResult<Refined> {
        let (hull, walls, kept) = domain.whole();
        let mut labels = filled(hull.simplices.len(), 0)?;
        if let Some(kept) = kept {
            let outside = labels.iter_mut().zip(kept).filter(|(_, kept)| !**kept);
            outside.for_each(|(label, _)| *label = -1);
        }
        let segments = lines(domain, hull, walls, &labels)?;
        let task = Task {
            points: hull.points,
            simplices: hull.simplices,
            labels: &labels,
            areas: &filled(labels.len(), self.max_area)?,
            segments: &segments,
            lines: None,
            frozen: &filled(segments.len(), false)?,
            min_angle: self.min_angle,
            circles: false,
            sizes_yield: false,
            max_vertices: self.max_points,
        };
        let mut tell = |added: usize, _: &mut dyn FnMut() -> f64| {
            if let Some(progress) = self.progress {
                progress(added);
            }
            Ok(())
        };
        refine_telling(task, watch, &mut tell)
    }

    fn mesh(&self, domain: &Constrained, refined: Refined) -> Result<Mesh> {
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
        let part = watched(&self.options, |watch| Part::of(&all, &kept, watch))?;
        let mut walls = with_room(part.of.len())?;
        let sides = part.of.iter().map(|&t| refined.sides[t as usize]);
        walls.extend(sides.map(|sides| sides.map(|line| line >= 0)));
        Ok(Mesh {
            added: added.len(),
            tiling: Tiling::of(
                Cow::Owned(points),
                part.arrays,
                Vec::new(),
                self.options.workers(),
            ),
            walls,
            complete: !refined.exhausted,
        })
    }
}

impl fmt::Debug for MeshBuilder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MeshBuilder")
            .field("options", &self.options)
            .field("min_angle", &self.min_angle)
            .field("max_area", &self.max_area)
            .field("max_points", &self.max_points)
            .field("progress", &self.progress.is_some())
            .finish()
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
