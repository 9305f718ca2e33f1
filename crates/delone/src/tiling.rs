//! Triangles or tetrahedra with their neighbors, and the queries that all of them answer.

use std::borrow::Cow;
use std::time::Duration;

use delone_core::arrays::Arrays;
use delone_core::memory::with_room;

use crate::checks::{finite, has_length, in_range};
use crate::dimension::{Kept, Kernel, Made, Scene};
use crate::options::NEVER;
use crate::{Dimension, Error, Location, Options, Result};

/// Simplices that fill a domain: triangles in 2-D, tetrahedra in 3-D, with their neighbors.
///
/// [`Triangulation`](crate::Triangulation), [`Constrained`](crate::Constrained) and
/// [`Mesh`](crate::Mesh) dereference to it, so its methods are theirs. `D` is the dimension and
/// `N` = `D` + 1 the number of corners of a simplex. Vertices are rows of [`points`](Self::points),
/// simplices are numbered from 0. Triangles are counter-clockwise; tetrahedra have a positive
/// determinant [`orient3d`](crate::predicates::orient3d).
#[derive(Debug)]
pub struct Tiling<'a, const D: usize = 2, const N: usize = 3> {
    pub(crate) points: Cow<'a, [[f64; D]]>,
    pub(crate) simplices: Cow<'a, [[i32; N]]>,
    pub(crate) neighbors: Cow<'a, [[i32; N]]>,
    pub(crate) duplicates: Vec<[u32; 2]>,
    stages: Vec<(&'static str, Duration)>,
    /// How many of the points were added.
    added: usize,
    threads: usize,
    kept: Kept,
}

impl<'a, const D: usize, const N: usize> Tiling<'a, D, N> {
    /// Of `made`, with the last `added` of the points.
    pub(crate) fn of(
        points: Cow<'a, [[f64; D]]>,
        made: Made<N>,
        added: usize,
        options: &Options,
    ) -> Self {
        Self {
            points,
            simplices: Cow::Owned(made.arrays.simplices),
            neighbors: Cow::Owned(made.arrays.neighbors),
            duplicates: made.duplicates,
            stages: made.stages,
            added,
            threads: options.workers(),
            kept: Kept::default(),
        }
    }

    /// The same points with other simplices.
    pub(crate) fn with(self, arrays: Arrays<N>) -> Self {
        Self {
            simplices: Cow::Owned(arrays.simplices),
            neighbors: Cow::Owned(arrays.neighbors),
            kept: Kept::default(),
            ..self
        }
    }

    /// Simplices from elsewhere, borrowed: as rows of points, positively oriented, and for each of
    /// them the simplex across the facet opposite each corner, -1 on the boundary.
    ///
    /// It is checked that points are finite and numbers in range; the rest is up to the caller. If
    /// simplices overlap or do not name each other, queries have wrong answers or end with
    /// [`Error::Internal`].
    ///
    /// ```
    /// use delone::Tiling;
    ///
    /// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    /// let halves = Tiling::from_arrays(&square, &[[0, 1, 2], [2, 3, 0]], &[[-1, 1, -1], [-1, 0, -1]])?;
    /// assert_eq!(halves.locate(&[[0.2, 0.8]])?[0].simplex(), Some(1));
    /// # Ok::<(), delone::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::Shape`].
    pub fn from_arrays(
        points: &'a [[f64; D]],
        simplices: &'a [[i32; N]],
        neighbors: &'a [[i32; N]],
    ) -> Result<Self> {
        finite(points)?;
        has_length(neighbors, simplices.len(), "neighbors")?;
        in_range(simplices, 0, points.len(), "simplices")?;
        in_range(neighbors, -1, simplices.len(), "neighbors")?;
        Ok(Self {
            points: points.into(),
            simplices: simplices.into(),
            neighbors: neighbors.into(),
            duplicates: Vec::new(),
            stages: Vec::new(),
            added: 0,
            threads: Options::new().workers(),
            kept: Kept::default(),
        })
    }

    /// The arrays themselves: the corners of each simplex, and its neighbors, -1 on the boundary.
    /// They are copied only if they were borrowed.
    pub fn into_arrays(self) -> (Vec<[i32; N]>, Vec<[i32; N]>) {
        (self.simplices.into_owned(), self.neighbors.into_owned())
    }

    /// The points: the rows of the input, then the points that were added.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// The points that were added, where segments cross or by refinement: the last of the points.
    pub fn added(&self) -> &[[f64; D]] {
        &self.points[self.points.len() - self.added..]
    }

    /// The vertices of each simplex.
    pub fn simplices(&self) -> impl ExactSizeIterator<Item = [usize; N]> + '_ {
        self.simplices.iter().map(|row| row.map(|v| v as usize))
    }

    /// For each simplex, the simplex across the facet opposite each corner; `None` on the boundary.
    pub fn neighbors(&self) -> impl ExactSizeIterator<Item = [Option<usize>; N]> + '_ {
        let rows = self.neighbors.iter();
        rows.map(|row| row.map(|t| usize::try_from(t).ok()))
    }

    /// Rows that repeat a point, each with the first row of that point, which is the vertex.
    ///
    /// ```
    /// let t = delone::Triangulation::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])?;
    /// assert_eq!(t.duplicates(), [[3, 1]]);
    /// # Ok::<(), delone::Error>(())
    /// ```
    pub fn duplicates(&self) -> &[[u32; 2]] {
        &self.duplicates
    }

    /// The stages of the computation with the time that each took.
    pub fn stages(&self) -> &[(&'static str, Duration)] {
        &self.stages
    }
}

impl<const D: usize, const N: usize> Tiling<'_, D, N>
where
    [f64; D]: Dimension<N>,
{
    pub(crate) fn scene(&self) -> Scene<'_, [f64; D], N> {
        Scene {
            points: &self.points,
            simplices: &self.simplices,
            neighbors: &self.neighbors,
            kept: &self.kept,
            workers: self.threads,
        }
    }

    /// Each edge once, the smaller vertex first, in ascending order.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn edges(&self) -> Result<Vec<[usize; 2]>> {
        let edges = <[f64; D]>::edges(self.scene(), NEVER)?;
        Ok(edges.iter().map(|e| e.map(|v| v as usize)).collect())
    }

    /// The facets of the boundary. An edge has its triangle on the left; a face is counter-clockwise
    /// seen from outside.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn boundary(&self) -> Result<Vec<[usize; D]>> {
        let rows = || self.simplices.iter().zip(self.neighbors.iter());
        let count = rows().map(|(_, n)| n.iter().filter(|t| **t < 0).count());
        let mut found = with_room(count.sum())?;
        for (corners, neighbors) in rows() {
            let open = (0..N).filter(|&k| neighbors[k] < 0);
            let facet = |k: usize| <[f64; D]>::FACETS[k];
            found.extend(open.map(|k| std::array::from_fn(|i| corners[facet(k)[i]] as usize)));
        }
        Ok(found)
    }

    /// The area of each triangle or the volume of each tetrahedron, with a relative error below
    /// 1e-14.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn sizes(&self) -> Result<Vec<f64>> {
        Ok(<[f64; D]>::sizes(self.scene(), NEVER)?)
    }

    /// Where points lie; see [`Location`]. Exact: no tolerance decides. The first call prepares a
    /// search tree in linear time; then each query takes about the time of a short walk. Many queries
    /// in one call use threads and are faster than one by one.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if a coordinate is NaN or infinite, and [`Error::Memory`].
    pub fn locate(&self, queries: &[[f64; D]]) -> Result<Vec<Location<D, N>>> {
        finite(queries)?;
        let found = <[f64; D]>::locate(self.scene(), queries, NEVER)?;
        let weights = found.weights.as_chunks().0;
        let facets = found.facet.as_chunks::<D>().0;
        let shares = found.shares.as_chunks().0;
        let mut all = with_room(queries.len())?;
        for (row, &t) in found.simplex.iter().enumerate() {
            all.push(if t >= 0 {
                Location::Inside {
                    simplex: t as usize,
                    weights: weights[row],
                }
            } else {
                let beside = number(found.beside[row])?;
                Location::Outside {
                    simplex: beside,
                    facet: facets[row].map(|v| v as usize),
                    weights: shares[row],
                }
            });
        }
        Ok(all)
    }
}

impl Tiling<'_> {
    /// The smallest angle of each triangle in degrees.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn min_angles(&self) -> Result<Vec<f64>> {
        let [smallest, ..] =
            delone_core::measure::qualities2(&self.points, &self.simplices, self.threads, NEVER)?;
        Ok(smallest)
    }
}

/// A number that the core has found, which is -1 if there is none.
pub(crate) fn number(v: i32) -> Result<usize> {
    usize::try_from(v).map_err(|_| Error::Internal("a query has no nearest simplex".into()))
}
