//! How calls run, and what they compute.

use std::borrow::Cow;
use std::fmt;
use std::sync::OnceLock;
use std::thread::available_parallelism;

use delone_core::constrained::polygon;
use delone_core::watch::{IDLE, Watch};

use crate::arrays::{Domain, Filled, Refined, Rounds, Rule, Samples};
use crate::checks::{ascends, has_length};
use crate::mesh::within;
use crate::{Constrained, Dimension, Mesh, Method, Point2, Result, Triangulation, Voronoi};

/// The points that constrained triangulations and meshes may add unless the caller sets a limit.
const MOST_SPLIT: usize = 4_000_000;
const MOST_REFINED: usize = 5_000_000;

/// Called with the number of points added, and a function that finds the smallest angle so far.
pub(crate) type Progress<'o> = &'o (dyn Fn(usize, &mut dyn FnMut() -> f64) + Sync);

/// How a call runs and what it computes: settings, then the call. Each setting names the calls that
/// it concerns; the others ignore it.
///
/// ```
/// use delone::Options;
///
/// let points = [[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0]];
/// let options = Options::new().threads(2).split_crossings(true);
/// assert_eq!(options.triangulate(&points)?.simplices().len(), 2);
/// let constrained = options.constrain(&points, &[[0, 1], [2, 3]])?;
/// assert_eq!(constrained.added(), [[1.0, 1.0]]);
/// # Ok::<(), delone::Error>(())
/// ```
///
/// Any call can be stopped:
///
/// ```
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// use delone::{Error, Options};
///
/// let canceled = AtomicBool::new(true);
/// let stop = || canceled.load(Ordering::Relaxed);
/// let options = Options::new().interrupt(&stop);
/// let points: Vec<_> = (0..100_000_u32).map(|i| [f64::from(i), f64::from(i).sin()]).collect();
/// assert_eq!(options.triangulate(&points).err(), Some(Error::Interrupted));
/// ```
#[derive(Clone, Copy)]
pub struct Options<'o> {
    pub(crate) threads: usize,
    pub(crate) stop: Option<&'o (dyn Fn() -> bool + Sync)>,
    pub(crate) method: Method,
    pub(crate) split: bool,
    pub(crate) conforming: bool,
    pub(crate) enclosed: bool,
    pub(crate) holes: &'o [Point2],
    pub(crate) max_points: Option<usize>,
    pub(crate) min_angle: f64,
    pub(crate) max_area: f64,
    pub(crate) progress: Option<Progress<'o>>,
}

impl<'o> Options<'o> {
    /// The defaults: one thread for each processor, no interruption, and what each setting says.
    pub fn new() -> Self {
        Self {
            threads: 0,
            stop: None,
            method: Method::Auto,
            split: false,
            conforming: false,
            enclosed: false,
            holes: &[],
            max_points: None,
            min_angle: 30.0,
            max_area: f64::INFINITY,
            progress: None,
        }
    }

    /// The largest number of threads; 0 is one for each processor. It does not affect results.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// A function that is called every few thousand steps, by any of the threads. If it returns
    /// true, the call ends with [`Error::Interrupted`](crate::Error::Interrupted).
    #[must_use]
    pub fn interrupt(mut self, stop: &'o (dyn Fn() -> bool + Sync)) -> Self {
        self.stop = Some(stop);
        self
    }

    /// How points are triangulated in 2-D, by default [`Method::Auto`]. All methods give the same
    /// triangles.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// [`constrain`](Self::constrain): whether segments that cross get a vertex there, with rounded
    /// coordinates. Otherwise they are an error, which is the default.
    #[must_use]
    pub fn split_crossings(mut self, split: bool) -> Self {
        self.split = split;
        self
    }

    /// [`constrain`](Self::constrain), [`polygon`](Self::polygon): whether vertices are added on
    /// segments until the diametral circle of each subsegment is empty, so that all triangles are
    /// Delaunay.
    #[must_use]
    pub fn conforming(mut self, conforming: bool) -> Self {
        self.conforming = conforming;
        self
    }

    /// [`constrain`](Self::constrain): whether only the triangles that segments enclose are kept,
    /// not all of the convex hull.
    #[must_use]
    pub fn enclosed_only(mut self, enclosed: bool) -> Self {
        self.enclosed = enclosed;
        self
    }

    /// [`constrain`](Self::constrain), [`polygon`](Self::polygon): one point in each hole. The
    /// triangles around it are removed, up to the segments.
    #[must_use]
    pub fn holes(mut self, seeds: &'o [Point2]) -> Self {
        self.holes = seeds;
        self
    }

    /// The most points that may be added: by default 4,000,000 for constrained triangulations, which
    /// fail if they need more, and 5,000,000 for meshes, which then are what has been reached.
    #[must_use]
    pub fn max_points(mut self, most: usize) -> Self {
        self.max_points = Some(most);
        self
    }

    /// [`mesh`](Self::mesh), [`refine`](Self::refine): the smallest angle in degrees, up to rounding;
    /// at least 0 and below 60, by default 30. Refinement usually ends up to 33;
    /// above, `max_points` often ends the work.
    #[must_use]
    pub fn min_angle(mut self, degrees: f64) -> Self {
        self.min_angle = degrees;
        self
    }

    /// [`mesh`](Self::mesh): the largest area of a triangle, in the square of the unit of the points;
    /// by default without a limit.
    #[must_use]
    pub fn max_area(mut self, area: f64) -> Self {
        self.max_area = area;
        self
    }

    /// [`mesh`](Self::mesh), [`refine`](Self::refine): a function that is called now and then with
    /// the number of points that have been added, and a function that finds the smallest angle so
    /// far, in degrees.
    #[must_use]
    pub fn progress(mut self, tell: &'o (dyn Fn(usize, &mut dyn FnMut() -> f64) + Sync)) -> Self {
        self.progress = Some(tell);
        self
    }

    /// [`Triangulation::new`] with these options.
    ///
    /// # Errors
    /// Those of [`Triangulation::new`], and [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn triangulate<'a, const D: usize, const N: usize>(
        &self,
        points: impl Into<Cow<'a, [[f64; D]]>>,
    ) -> Result<Triangulation<'a, D, N>>
    where
        [f64; D]: Dimension<N>,
    {
        Triangulation::made(points.into(), self)
    }

    /// [`Constrained::new`] with these options. Segments are pairs of rows, of any integer type.
    ///
    /// # Errors
    /// Those of [`Constrained::new`], and [`Budget`](crate::Error::Budget),
    /// [`Seed`](crate::Error::Seed), [`EmptyDomain`](crate::Error::EmptyDomain),
    /// [`Interrupted`](crate::Error::Interrupted).
    pub fn constrain<'a, I: Copy + TryInto<usize>>(
        &self,
        points: impl Into<Cow<'a, [Point2]>>,
        segments: &[[I; 2]],
    ) -> Result<Constrained<'a>> {
        Constrained::of_segments(points.into(), segments, self)
    }

    /// [`Constrained::polygon`] with these options.
    ///
    /// # Errors
    /// Those of [`constrain`](Self::constrain), but crossings are none.
    pub fn polygon(&self, rings: &[impl AsRef<[Point2]>]) -> Result<Constrained<'static>> {
        Constrained::of_rings(rings, &self.split_crossings(true))
    }

    /// Only the triangles inside the rings `points[starts[i]..starts[i + 1]]`, without what
    /// [`polygon`](Self::polygon) finds besides: the fastest way to fill rings.
    ///
    /// ```
    /// use delone::{Options, arrays::Rule};
    ///
    /// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    /// let filled = Options::new().fill(&square, &[0, 4], Rule::NonZero)?;
    /// assert_eq!((filled.simplices.len(), filled.added.len()), (2, 0));
    /// # Ok::<(), delone::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`NonFinite`](crate::Error::NonFinite), [`Shape`](crate::Error::Shape),
    /// [`TooLarge`](crate::Error::TooLarge), [`Memory`](crate::Error::Memory),
    /// [`Interrupted`](crate::Error::Interrupted).
    pub fn fill(&self, points: &[Point2], starts: &[usize], rule: Rule) -> Result<Filled> {
        ascends(starts, points.len())?;
        self.watched(|watch| polygon(points, starts, rule, watch))
    }

    /// [`Mesh::new`] with these options.
    ///
    /// # Errors
    /// Those of [`Mesh::new`], [`Error::Option`](crate::Error::Option) if a number is out of range,
    /// [`Interrupted`](crate::Error::Interrupted).
    pub fn mesh(&self, domain: &Constrained) -> Result<Mesh> {
        Mesh::of(domain, self)
    }

    /// Refines triangles with labels and areas of their own: [`mesh`](Self::mesh) for several regions,
    /// or for what an earlier refinement has left.
    ///
    /// # Errors
    /// Those of [`mesh`](Self::mesh), and [`Error::Shape`](crate::Error::Shape).
    pub fn refine(&self, domain: Domain) -> Result<Refined> {
        within(self)?;
        domain.check()?;
        has_length(domain.areas, domain.simplices.len(), "areas")?;
        self.watched(|watch| domain.refined(self, watch))
    }

    /// [`refine`](Self::refine) in rounds, if the largest area of a triangle depends on its position:
    /// `areas` of the domain do not count.
    ///
    /// # Errors
    /// Those of [`refine`](Self::refine).
    pub fn rounds(&self, domain: Domain, samples: Samples) -> Result<Rounds> {
        within(self)?;
        domain.check()?;
        has_length(samples.areas, samples.positions.len(), "areas")?;
        self.watched(|watch| Rounds::new(domain.task(self), samples, watch))
    }

    /// [`Voronoi::new`] with these options.
    ///
    /// # Errors
    /// Those of [`Voronoi::new`], [`Interrupted`](crate::Error::Interrupted).
    pub fn voronoi<'t, const D: usize, const N: usize>(
        &self,
        triangulation: &'t Triangulation<'_, D, N>,
    ) -> Result<Voronoi<'t, D, N>>
    where
        [f64; D]: Dimension<N>,
        'o: 't,
    {
        Voronoi::of(triangulation, *self)
    }

    pub(crate) fn workers(&self) -> usize {
        match self.threads {
            0 => *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from)),
            threads => threads,
        }
    }

    pub(crate) fn most_split(&self) -> usize {
        self.max_points.unwrap_or(MOST_SPLIT)
    }

    pub(crate) fn most_refined(&self) -> usize {
        self.max_points.unwrap_or(MOST_REFINED)
    }

    /// Calls `work` with the watch of these options: the core borrows it.
    pub(crate) fn watched<T>(
        &self,
        work: impl FnOnce(&Watch) -> delone_core::error::Result<T>,
    ) -> Result<T> {
        Ok(match self.stop {
            Some(stop) => work(&Watch::new(stop))?,
            None => work(NEVER)?,
        })
    }
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("threads", &self.threads)
            .field("interrupt", &self.stop.is_some())
            .field("method", &self.method)
            .field("split_crossings", &self.split)
            .field("conforming", &self.conforming)
            .field("enclosed_only", &self.enclosed)
            .field("holes", &self.holes)
            .field("max_points", &self.max_points)
            .field("min_angle", &self.min_angle)
            .field("max_area", &self.max_area)
            .field("progress", &self.progress.is_some())
            .finish()
    }
}

/// The system reads files to count them, which takes longer than a small triangulation.
static PROCESSORS: OnceLock<usize> = OnceLock::new();

/// The watch of calls that are not interrupted.
pub(crate) static NEVER: &Watch<'static> = &IDLE;
