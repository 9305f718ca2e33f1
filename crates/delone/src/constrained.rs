//! Constrained Delaunay triangulations: of points and segments, and of the inside of polygons.

use std::borrow::Cow;
use std::collections::HashSet;
use std::mem::take;
use std::ops::Deref;

use delone_core::arrays::{Arrays, Given};
use delone_core::constrained::{self as core, Subsegments};
use delone_core::error::Result as CoreResult;
use delone_core::memory::with_room;
use delone_core::points::LIMIT2;
use delone_core::watch::Watch;
use delone_predicates::orient2d;

use crate::areas::{Hull, Part};
use crate::arrays::Segments;
use crate::dimension::Made;
use crate::{Error, Options, Point2, Result, Tiling};

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
    tiling: Tiling<'a>,
    walls: Vec<[bool; 3]>,
    segments: Segments,
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
    /// share ends, overlap and pass through points. [`Options::constrain`] removes what is outside,
    /// splits crossings, and more.
    ///
    /// # Errors
    /// Those of [`Triangulation::new`](crate::Triangulation::new), [`Error::NoSuchPoint`], and
    /// [`Error::Crossing`] if segments cross; see [`Options::split_crossings`].
    pub fn new(points: impl Into<Cow<'a, [Point2]>>, segments: &[[usize; 2]]) -> Result<Self> {
        Options::new().constrain(points, segments)
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
    /// assert_eq!(c.sizes()?.iter().sum::<f64>(), 8.0);
    /// assert_eq!(c.boundary()?.len(), 8);
    /// # Ok::<(), delone::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Constrained::new`], but crossings are none; [`Error::EmptyDomain`] if there is no
    /// inside.
    pub fn polygon(rings: &[impl AsRef<[Point2]>]) -> Result<Constrained<'static>> {
        Options::new().polygon(rings)
    }

    /// For each triangle, whether the edge opposite each corner is part of a segment.
    pub fn is_constrained(&self) -> &[[bool; 3]] {
        &self.walls
    }

    /// The edges that segments have become, each once, in the order of the segments and along them.
    /// Those outside of the domain are included.
    pub fn subsegments(&self) -> impl ExactSizeIterator<Item = Subsegment<'_>> + '_ {
        let Segments {
            ends,
            starts,
            sources,
            ..
        } = &self.segments;
        let rows = ends.iter().zip(starts.windows(2));
        rows.map(|(ends, range)| Subsegment {
            ends: ends.map(|v| v as usize),
            sources: &sources[range[0] as usize..range[1] as usize],
        })
    }

    /// The triangles, what [`is_constrained`](Self::is_constrained) says, and what segments have
    /// become, without a copy.
    pub fn into_parts(self) -> (Tiling<'a>, Vec<[bool; 3]>, Segments) {
        (self.tiling, self.walls, self.segments)
    }

    /// All triangles of the hull, which of their edges are segments, and the triangles that are
    /// kept; `None` if all are.
    pub(crate) fn whole(&self) -> (Given<'_, 2, 3>, &[[bool; 3]], Option<&[bool]>) {
        let given = given(&self.tiling);
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
        &self.segments.ends
    }

    pub(crate) fn of_segments<I: Copy + TryInto<usize>>(
        points: Cow<'a, [Point2]>,
        segments: &[[I; 2]],
        options: &Options,
    ) -> Result<Self> {
        let pairs = pairs(segments, points.len())?;
        let hull = Self::hull(points, &pairs, options)?;
        if !options.enclosed && options.holes.is_empty() {
            return Ok(hull);
        }
        hull.reduced(options, false)
    }

    pub(crate) fn of_rings(
        rings: &[impl AsRef<[Point2]>],
        options: &Options,
    ) -> Result<Constrained<'static>> {
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
        let hull = Constrained::hull(Cow::Owned(points), &pairs, options)?;
        hull.reduced(options, true)
    }

    /// All triangles of the hull.
    fn hull(points: Cow<'a, [Point2]>, pairs: &[[u32; 2]], options: &Options) -> Result<Self> {
        let given = core::Options {
            split: options.split,
            conforming: options.conforming,
            max_vertices: options.most_split(),
            method: options.method,
            workers: options.workers(),
        };
        let made = options.watched(|watch| core::constrain(&points, pairs, given, watch))?;
        let Subsegments {
            ends,
            start: starts,
            source: sources,
            forward,
        } = made.subsegments;
        let triangles = Made {
            arrays: made.arrays,
            duplicates: made.duplicates,
            stages: made.stages,
        };
        let added = made.added.len();
        let points = joined(points, &made.added)?;
        Ok(Self {
            tiling: Tiling::of(points, triangles, added, options),
            walls: made.constrained,
            segments: Segments {
                ends,
                starts,
                sources,
                forward,
                zero: made.zero,
                through: made.through,
                crossings: made.crossings,
            },
            whole: None,
        })
    }

    /// Without the holes, and without what is outside of all segments or rings.
    fn reduced(mut self, options: &Options, rings: bool) -> Result<Self> {
        let seeds = seeds(&self, options.holes)?;
        let arrays = Arrays {
            simplices: take(self.tiling.simplices.to_mut()),
            neighbors: take(self.tiling.neighbors.to_mut()),
        };
        let walls = self.walls;
        let reduce = |watch: &Watch| -> CoreResult<_> {
            let all = Hull {
                arrays: &arrays,
                walls: &walls,
            };
            let mut kept = all.kept(options.enclosed && !rings, &seeds, watch)?;
            if rings {
                let odd = all.odd(&self.segments, watch)?;
                kept.iter_mut()
                    .zip(odd)
                    .for_each(|(kept, odd)| *kept &= odd);
            }
            Ok((Part::of(&arrays, &kept, watch)?, kept))
        };
        let (part, kept) = options.watched(reduce)?;
        if part.of.is_empty() {
            return Err(Error::EmptyDomain);
        }
        let mut sides = with_room(part.of.len())?;
        sides.extend(part.of.iter().map(|&t| walls[t as usize]));
        Ok(Self {
            tiling: self.tiling.with(part.arrays),
            walls: sides,
            segments: self.segments,
            whole: Some(Whole {
                arrays,
                walls,
                kept,
            }),
        })
    }
}

impl<'a> Deref for Constrained<'a> {
    type Target = Tiling<'a>;

    fn deref(&self) -> &Self::Target {
        &self.tiling
    }
}

/// The arrays of a tiling as the core takes them.
fn given<'t>(tiling: &'t Tiling<'_>) -> Given<'t, 2, 3> {
    Given {
        points: &tiling.points,
        simplices: &tiling.simplices,
        neighbors: &tiling.neighbors,
    }
}

/// The points followed by those that were added.
fn joined<'a>(points: Cow<'a, [Point2]>, added: &[Point2]) -> Result<Cow<'a, [Point2]>> {
    if added.is_empty() {
        return Ok(points);
    }
    let mut all = with_room(points.len() + added.len())?;
    all.extend_from_slice(&points);
    all.extend_from_slice(added);
    Ok(Cow::Owned(all))
}

/// Segments as the core takes them.
fn pairs<I: Copy + TryInto<usize>>(segments: &[[I; 2]], points: usize) -> Result<Vec<[u32; 2]>> {
    let mut found = with_room(segments.len())?;
    for (segment, ends) in segments.iter().enumerate() {
        let ends = ends.map(|end| end.try_into().unwrap_or(usize::MAX));
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
    let given = given(&hull.tiling);
    let mut found = with_room(holes.len())?;
    let mut ends: HashSet<i32> = HashSet::new();
    for (hole, place) in hull.locate(holes)?.into_iter().enumerate() {
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
                ends.extend(hull.segments.ends.as_flattened());
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
