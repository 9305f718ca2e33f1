//! Delaunay triangulations of points, in 2-D and in 3-D.

use std::borrow::Cow;
use std::ops::Deref;

use delone_core::delaunay2::{self, Method};
use delone_core::delaunay3;

use crate::tiling::{Tiling, watched};
use crate::{Options, Point2, Point3, Result};

/// The Delaunay triangulation of points in 2-D: its triangles fill the convex hull, and no
/// circumcircle contains another point.
///
/// Its methods are those of [`Tiling`].
///
/// ```
/// use delone::Triangulation;
///
/// // Four points on a circle: the diagonal starts at the lexicographically smallest one.
/// let t = Triangulation::new(&[[1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [0.0, 0.0]])?;
/// assert!(t.edges()?.contains(&[0, 3]));
/// assert_eq!(t.boundary()?.len(), 4);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Triangulation<'a>(Tiling<'a, 2, 3>);

impl<'a> Triangulation<'a> {
    /// Triangulates points, in O(n log n) time and with memory linear in n.
    ///
    /// # Errors
    /// [`Error::NonFinite`](crate::Error::NonFinite), [`TooFew`](crate::Error::TooFew),
    /// [`Collinear`](crate::Error::Collinear), [`TooLarge`](crate::Error::TooLarge) above 2^28 points,
    /// [`Memory`](crate::Error::Memory).
    pub fn new(points: impl Into<Cow<'a, [Point2]>>) -> Result<Self> {
        Self::with_options(points, Options::new())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As for [`new`](Self::new), and [`Interrupted`](crate::Error::Interrupted).
    pub fn with_options(
        points: impl Into<Cow<'a, [Point2]>>,
        options: Options<'_>,
    ) -> Result<Self> {
        let (points, workers) = (points.into(), options.workers());
        let made = watched(&options, |watch| {
            delaunay2::triangulate(&points, Method::Auto, workers, watch)
        })?;
        Ok(Self(Tiling::of(
            points,
            made.arrays,
            made.duplicates,
            workers,
        )))
    }

    /// The vertex nearest to a point; of several, the one with the smallest row. Exact.
    ///
    /// # Errors
    /// [`Error::NonFinite`](crate::Error::NonFinite) if a coordinate is NaN or infinite.
    pub fn nearest(&self, query: Point2) -> Result<usize> {
        self.0.nearest2(query)
    }
}

impl<'a> Deref for Triangulation<'a> {
    type Target = Tiling<'a, 2, 3>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a> From<Triangulation<'a>> for Tiling<'a, 2, 3> {
    fn from(triangulation: Triangulation<'a>) -> Self {
        triangulation.0
    }
}

/// The Delaunay triangulation of points in 3-D: its tetrahedra fill the convex hull, and no
/// circumsphere contains another point.
///
/// Its methods are those of [`Tiling`].
///
/// ```
/// use delone::Triangulation3;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let t = Triangulation3::new(&corners)?;
/// assert_eq!(t.tetrahedra().len(), 1);
/// assert!((t.volumes()?[0] - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Triangulation3<'a>(Tiling<'a, 3, 4>);

impl<'a> Triangulation3<'a> {
    /// Triangulates points. The result has up to O(n²) tetrahedra; for points that are spread evenly
    /// it has about 6.8 n.
    ///
    /// # Errors
    /// [`Error::NonFinite`](crate::Error::NonFinite), [`TooFew`](crate::Error::TooFew),
    /// [`Collinear`](crate::Error::Collinear), [`Coplanar`](crate::Error::Coplanar),
    /// [`TooLarge`](crate::Error::TooLarge) above 2^27 points or 2^30 tetrahedra,
    /// [`Memory`](crate::Error::Memory).
    pub fn new(points: impl Into<Cow<'a, [Point3]>>) -> Result<Self> {
        Self::with_options(points, Options::new())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As for [`new`](Self::new), and [`Interrupted`](crate::Error::Interrupted).
    pub fn with_options(
        points: impl Into<Cow<'a, [Point3]>>,
        options: Options<'_>,
    ) -> Result<Self> {
        let (points, workers) = (points.into(), options.workers());
        let made = watched(&options, |watch| {
            delaunay3::triangulate(&points, workers, watch)
        })?;
        Ok(Self(Tiling::of(
            points,
            made.arrays,
            made.duplicates,
            workers,
        )))
    }

    /// The vertex nearest to a point; of several, the one with the smallest row. Exact.
    ///
    /// # Errors
    /// [`Error::NonFinite`](crate::Error::NonFinite) if a coordinate is NaN or infinite.
    pub fn nearest(&self, query: Point3) -> Result<usize> {
        self.0.nearest3(query)
    }
}

impl<'a> Deref for Triangulation3<'a> {
    type Target = Tiling<'a, 3, 4>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a> From<Triangulation3<'a>> for Tiling<'a, 3, 4> {
    fn from(triangulation: Triangulation3<'a>) -> Self {
        triangulation.0
    }
}
