//! Delaunay triangulations of points, in 2-D and in 3-D.

use std::borrow::Cow;
use std::ops::Deref;

use crate::checks::finite;
use crate::dimension::Kernel;
use crate::options::NEVER;
use crate::tiling::number;
use crate::{Dimension, Options, Result, Tiling};

/// The Delaunay triangulation of points: its simplices fill the convex hull, and no circumcircle or
/// circumsphere contains another point. The points tell whether it is in 2-D or in 3-D.
///
/// Its methods are those of [`Tiling`], too.
///
/// ```
/// use delone::{Triangulation, Triangulation3};
///
/// // Four points on a circle: the diagonal starts at the lexicographically smallest one.
/// let t = Triangulation::new(&[[1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [0.0, 0.0]])?;
/// assert!(t.edges()?.contains(&[0, 3]));
/// assert_eq!(t.boundary()?.len(), 4);
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let t: Triangulation3 = Triangulation::new(&corners)?;
/// assert_eq!(t.simplices().len(), 1);
/// assert!((t.sizes()?[0] - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Triangulation<'a, const D: usize = 2, const N: usize = 3>(Tiling<'a, D, N>);

/// A Delaunay triangulation in 3-D.
pub type Triangulation3<'a> = Triangulation<'a, 3, 4>;

impl<'a, const D: usize, const N: usize> Triangulation<'a, D, N>
where
    [f64; D]: Dimension<N>,
{
    /// Triangulates points. In 2-D it takes O(n log n) time and memory linear in n. In 3-D there are
    /// up to O(n²) tetrahedra; for points that are spread evenly there are about 6.8 n.
    ///
    /// # Errors
    /// [`NonFinite`](crate::Error::NonFinite), [`TooFew`](crate::Error::TooFew),
    /// [`Collinear`](crate::Error::Collinear), [`Coplanar`](crate::Error::Coplanar),
    /// [`TooLarge`](crate::Error::TooLarge) above 2^28 points in 2-D, 2^27 points or 2^30 tetrahedra
    /// in 3-D, [`Memory`](crate::Error::Memory).
    pub fn new(points: impl Into<Cow<'a, [[f64; D]]>>) -> Result<Self> {
        Options::new().triangulate(points)
    }

    pub(crate) fn made(points: Cow<'a, [[f64; D]]>, options: &Options) -> Result<Self> {
        let made = options.watched(|watch| <[f64; D]>::triangulate(&points, options, watch))?;
        Ok(Self(Tiling::of(points, made, 0, options)))
    }

    /// Takes a tiling that is a Delaunay triangulation, such as one from arrays that were stored.
    /// This is not checked; if it is not one, nearest vertices and Voronoi cells are wrong.
    pub fn trusted(tiling: Tiling<'a, D, N>) -> Self {
        Self(tiling)
    }

    /// The vertex nearest to each query; of several, the one with the smallest row. Exact.
    ///
    /// # Errors
    /// [`NonFinite`](crate::Error::NonFinite) if a coordinate is NaN or infinite, and
    /// [`Memory`](crate::Error::Memory).
    pub fn nearest(&self, queries: &[[f64; D]]) -> Result<Vec<usize>> {
        finite(queries)?;
        let found = <[f64; D]>::nearest(self.scene(), queries, NEVER)?;
        found.into_iter().map(number).collect()
    }
}

impl<'a, const D: usize, const N: usize> Deref for Triangulation<'a, D, N> {
    type Target = Tiling<'a, D, N>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a, const D: usize, const N: usize> From<Triangulation<'a, D, N>> for Tiling<'a, D, N> {
    fn from(triangulation: Triangulation<'a, D, N>) -> Self {
        triangulation.0
    }
}
