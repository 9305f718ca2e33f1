//! Constrained Delaunay triangulations: of points and segments, and of the inside of polygons.

use std::borrow::Cow;
use std::collections::HashSet;
use std::ops::Deref;

use delone_core::arrays::{Arrays, Given};
use delone_core::constrained::{self as core, Subsegments};
use delone_core::delaunay2::Method;
use delone_core::error::Result as CoreResult;
use delone_core::memory::with_room;
use delone_core::points::LIMIT2;
use delone_core::watch::Watch;
use delone_predicates::orient2d;

use crate::areas::{Hull, Part};
use crate::tiling::{Tiling, watched};
use crate::{Error, Options, Point2, Result};

/// The points that may be added unless the caller sets another limit.
const MOST_ADDED: usize = 4_000_000;

/// A constrained Delaunay triangulation: every segment is an edge or a chain of edges, and all other
/// edges are Delaunay as far as segments do not block the view.
///
/// Its methods are those of [`Tiling`], too.
///
/// ```
/// use delone::Constrained;
///
/// let points = [[0.0, 0.0], [2.0, -1.0], [4.0, 0.0], [2.0, 1.0]];
/// // The Delaunay diagonal is the short one, from row 1 to row 3.
/// let c = Constrained::new(&points, &[[0, 2]])?;
/// assert!(c.edges()?.contains(&[0, 2]));
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Constrained<'a> {
    tiling: Tiling<'a, 2, 3>,
    added: usize,
    walls: Vec<[bool; 3]>,
    subsegments: Subsegments,
    /// All triangles of the hull, if some are not kept.
    whole: Option<Whole>,
}

/// All triangles of the hull, and those of them that are kept.
#[derive(Debug)]
pub(crate) struct Whole {
    pub arrays: Arrays<3>,
    pub walls: Vec<[bool; 3]>,
    pub kept: Vec<bool>,
}

/// An edge, or one of the edges in a chain, that a segment has become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Subsegment<'c> {
    /// Its vertices, in the direction of the first segment that covers it.
    pub ends: [usize; 2],
    sources: &'c [i32],
}

impl<'c> Subsegment<'c> {
    /// The rows of the segments that cover it, ascending; several if segments overlap.
    pub fn sources(&self) -> impl ExactSizeIterator<Item = usize> + 'c {
        self.sources.iter().map(|&row| row as usize)
    }
}

impl<'a> Constrained<'a> {
    /// Triangulates the convex hull of points with segments, which are pairs of rows. Segments may
    /// share ends, overlap and pass through points.
    ///
    /// # Errors
    /// Those of [`Triangulation::new`](crate::Triangulation::new), [`Error::NoSuchPoint`], and
    /// [`Error::Crossing`] if segments cross; see [`ConstrainedBuilder::split_crossings`].
    pub fn new(points: impl Into<Cow<'a, [Point2]>>, segments: &[[usize; 2]]) -> Result<Self> {
        Self::builder().build(points, segments)
    }

    /// Triangulates the inside of polygons, given as closed rings without the repeated last point:
    /// whatever the rings wind around an odd number of times, so that a ring in another is a hole.
    /// Rings that cross get a vertex there.
    ///
    /// ```
    /// use delone::Constrained;
    ///
    /// let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
    /// let c = Constrained::polygon(&[square(0.0, 3.0), square(1.0, 2.0)])?;
    /// assert_eq!(c.areas()?.iter().sum::<f64>(), 8.0);
    /// assert_eq!(c.boundary()?.len(), 8);
    /// # Ok::<(), delone::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Constrained::new`], but crossings are none; [`Error::EmptyDomain`] if there is no
    /// inside.
    pub fn polygon(rings: &[impl AsRef<[Point2]>]) -> Result<Constrained<'static>> {
        Self::builder().split_crossings(true).build_polygon(rings)
    }

    /// Options for segments and holes.
    pub fn builder<'o>() -> ConstrainedBuilder<'o> {
        ConstrainedBuilder {
            options: Options::new(),
            split: false,
            conforming: false,
            enclosed: false,
            max_points: MOST_ADDED,
            holes: Vec::new(),
        }
    }

    /// The number of points that were added, for crossings and for
    /// [`conforming`](ConstrainedBuilder::conforming): the last rows of [`points`](Tiling::points).
    pub fn added(&self) -> usize {
        self.added
    }

    /// For each triangle, whether the edge opposite each corner is part of a segment.
    pub fn is_constrained(&self) -> impl ExactSizeIterator<Item = [bool; 3]> + '_ {
        self.walls.iter().copied()
    }

    /// The edges that segments have become, each once, in the order of the segments and along them.
    /// Those outside of the domain are included.
    pub fn subsegments(&self) -> impl ExactSizeIterator<Item = Subsegment<'_>> + '_ {
        let Subsegments {
            ends,
            start,
            source,
            ..
        } = &self.subsegments;
        let rows = ends.iter().zip(start.windows(2));
        rows.map(|(ends, range)| Subsegment {
            ends: ends.map(|v| v as usize),
            sources: &source[range[0] as usize..range[1] as usize],
        })
    }

    /// All triangles of the hull, which of their edges are segments, and the triangles that are
    /// kept; `None` if all are.
    pub(crate) fn whole(&self) -> (Given<'_, 2, 3>, &[[bool; 3]], Option<&[bool]>) {
        let given = self.tiling.given();
        match &self.whole {
            None => (given, &self.walls, None),
            Some(whole) => {
                let hull = Given {
                    simplices: &whole.arrays.simplices,
                    neighbors: &whole.arrays.neighbors,
                    ..given
                };
                (hull, &whole.walls, Some(&whole.kept))
            }
        }
    }

    pub(crate) fn subsegment_ends(&self) -> &[[i32; 2]] {
        &self.subsegments.ends
    }
}

impl<'a> Deref for Constrained<'a> {
    type Target = Tiling<'a, 2, 3>;

    fn deref(&self) -> &Self::Target {
        &self.tiling
    }
}

impl<'a> From<Constrained<'a>> for Tiling<'a, 2, 3> {
    fn from(constrained: Constrained<'a>) -> Self {
        constrained.tiling
    }
}

/// Options of a constrained triangulation; made by [`Constrained::builder`].
///
/// ```
/// use delone::Constrained;
///
/// let points = [[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0]];
/// let c = Constrained::builder().split_crossings(true).build(&points, &[[0, 1], [2, 3]])?;
/// assert_eq!(c.points()[4], [1.0, 1.0]);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct ConstrainedBuilder<'o> {
    options: Options<'o>,
    split: bool,
    conforming: bool,
    enclosed: bool,
    max_points: usize,
    holes: Vec<Point2>,
}

impl<'o> ConstrainedBuilder<'o> {
    /// Sets threads and interruption.
    #[must_use]
    pub fn options(mut self, options: Options<'o>) -> Self {
        self.options = options;
        self
    }

    /// Whether segments that cross get a vertex there, with rounded coordinates. Otherwise they are
    /// an error, which is the default.
    #[must_use]
    pub fn split_crossings(mut self, split: bool) -> Self {
        self.split = split;
        self
    }

    /// Whether vertices are added on segments until the diametral circle of each subsegment is
    /// empty, so that all triangles are Delaunay.
    #[must_use]
    pub fn conforming(mut self, conforming: bool) -> Self {
        self.conforming = conforming;
        self
    }

    /// Whether only the triangles that segments enclose are kept, not all of the convex hull.
    #[must_use]
    pub fn enclosed_only(mut self, enclosed: bool) -> Self {
        self.enclosed = enclosed;
        self
    }

    /// One point in each hole: the triangles around it are removed, up to the segments.
    #[must_use]
    pub fn holes(mut self, seeds: &[Point2]) -> Self {
        self.holes = seeds.to_vec();
        self
    }

    /// The most points that may be added, by default 4,000,000.
    #[must_use]
    pub fn max_points(mut self, most: usize) -> Self {
        self.max_points = most;
        self
    }

    /// Triangulates points and segments.
    ///
    /// # Errors
    /// Those of [`Constrained::new`], and [`Error::Budget`], [`Error::Seed`], [`Error::EmptyDomain`],
    /// [`Error::Interrupted`].
    pub fn build<'a>(
        &self,
        points: impl Into<Cow<'a, [Point2]>>,
        segments: &[[usize; 2]],
    ) -> Result<Constrained<'a>> {
        let points = points.into();
        let pairs = pairs(segments, points.len())?;
        self.made(points, &pairs, false)
    }

    /// Triangulates the inside of polygons; see [`Constrained::polygon`].
    ///
    /// # Errors
    /// Those of [`build`](Self::build).
    pub fn build_polygon(&self, rings: &[impl AsRef<[Point2]>]) -> Result<Constrained<'static>> {
        let count = rings.iter().map(|ring| ring.as_ref().len()).sum();
        if count > LIMIT2 {
            let limit = LIMIT2;
            return Err(delone_core::error::Error::TooMany {
                found: count,
                limit,
            }
            .into());
        }
        let mut points = with_room(count)?;
        let mut pairs = with_room(count)?;
        for ring in rings.iter().map(AsRef::as_ref) {
            let first = points.len() as u32;
            let end = first + ring.len() as u32;
            let next = |row| if row + 1 < end { row + 1 } else { first };
            pairs.extend((first..end).map(|row| [row, next(row)]));
            points.extend_from_slice(ring);
        }
        self.made(Cow::Owned(points), &pairs, true)
    }

    fn made<'a>(
        &self,
        points: Cow<'a, [Point2]>,
        pairs: &[[u32; 2]],
        rings: bool,
    ) -> Result<Constrained<'a>> {
        let workers = self.options.workers();
        let options = core::Options {
            split: self.split,
            conforming: self.conforming,
            max_vertices: self.max_points,
            method: Method::Auto,
            workers,
        };
        let made = watched(&self.options, |watch| {
            core::constrain(&points, pairs, options, watch)
        })?;
        let added = made.added.len();
        let points = if added == 0 {
            points
        } else {
            let mut all = with_room(points.len() + added)?;
            all.extend_from_slice(&points);
            all.extend_from_slice(&made.added);
            Cow::Owned(all)
        };
        let hull = Constrained {
            tiling: Tiling::of(points, made.arrays, made.duplicates, workers),
            added,
            walls: made.constrained,
            subsegments: made.subsegments,
            whole: None,
        };
        if !rings && !self.enclosed && self.holes.is_empty() {
            return Ok(hull);
        }
        let seeds = seeds(&hull, &self.holes)?;
        self.reduced(hull, &seeds, rings)
    }

    /// The triangles of the domain.
    fn reduced<'a>(
        &self,
        hull: Constrained<'a>,
        seeds: &[usize],
        rings: bool,
    ) -> Result<Constrained<'a>> {
        let Constrained {
            tiling,
            added,
            walls,
            subsegments,
            ..
        } = hull;
        let Tiling {
            points,
            arrays,
            duplicates,
            ..
        } = tiling;
        let reduce = |watch: &Watch| -> CoreResult<_> {
            let all = Hull {
                arrays: &arrays,
                walls: &walls,
            };
            let mut kept = all.kept(self.enclosed && !rings, seeds, watch)?;
            if rings {
                let odd = all.odd(&subsegments, watch)?;
                kept.iter_mut()
                    .zip(odd)
                    .for_each(|(kept, odd)| *kept &= odd);
            }
            Ok((Part::of(&arrays, &kept, watch)?, kept))
        };
        let (part, kept) = watched(&self.options, reduce)?;
        if part.of.is_empty() {
            return Err(Error::EmptyDomain);
        }
        let mut sides = with_room(part.of.len())?;
        sides.extend(part.of.iter().map(|&t| walls[t as usize]));
        Ok(Constrained {
            tiling: Tiling::of(points, part.arrays, duplicates, self.options.workers()),
            added,
            walls: sides,
            subsegments,
            whole: Some(Whole {
                arrays,
                walls,
                kept,
            }),
        })
    }
}

/// Segments as the core takes them.
fn pairs(segments: &[[usize; 2]], points: usize) -> Result<Vec<[u32; 2]>> {
    let mut found = with_room(segments.len())?;
    for (segment, ends) in segments.iter().enumerate() {
        if let Some(&row) = ends.iter().find(|row| **row >= points) {
            return Err(Error::NoSuchPoint {
                segment,
                row,
                points,
            });
        }
        // More points than fit are refused by the core, which counts them.
        found.push(ends.map(|row| row as u32));
    }
    Ok(found)
}

/// The triangles that hold the seeds of holes, none of which may be on a segment.
fn seeds(hull: &Constrained, holes: &[Point2]) -> Result<Vec<usize>> {
    let given = hull.tiling.given();
    let mut found = with_room(holes.len())?;
    let mut ends: HashSet<i32> = HashSet::new();
    for (hole, place) in hull.locate_all(holes)?.into_iter().enumerate() {
        let q = holes[hole];
        let Some(t) = place.simplex() else {
            return Err(Error::Seed { hole });
        };
        let corners = given.corners(t);
        let on = |k: usize| orient2d(corners[(k + 1) % 3], corners[(k + 2) % 3], q).is_zero();
        let mut bad = (0..3).any(|k| hull.walls[t][k] && on(k));
        // At a vertex it may be on a segment that is no edge of this triangle.
        if let Some(k) = corners.iter().position(|p| *p == q) {
            if ends.is_empty() {
                ends.extend(hull.subsegments.ends.as_flattened());
            }
            bad |= ends.contains(&given.simplices[t][k]);
        }
        if bad {
            return Err(Error::Seed { hole });
        }
        found.push(t);
    }
    Ok(found)
}
