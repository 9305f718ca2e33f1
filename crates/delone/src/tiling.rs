//! Triangles or tetrahedra with their neighbors, and the queries that all of them answer.

use std::borrow::Cow;
use std::sync::OnceLock;

use delone_core::arrays::{Arrays, Given};
use delone_core::memory::with_room;
use delone_core::watch::Watch;
use delone_core::{locate, locate3, measure};

use crate::options::NEVER;
use crate::{Error, Location, Point2, Point3, Result};

/// Simplices that fill a domain: triangles in 2-D, tetrahedra in 3-D, with their neighbors.
///
/// [`Triangulation`](crate::Triangulation), [`Triangulation3`](crate::Triangulation3),
/// [`Constrained`](crate::Constrained) and [`Mesh`](crate::Mesh) dereference to it, so its methods are
/// theirs. `D` is the dimension and `N` = `D` + 1 the number of corners of a simplex. Vertices are
/// rows of [`points`](Self::points), simplices are numbered from 0. Triangles are counter-clockwise;
/// tetrahedra have a positive determinant [`orient3d`](crate::predicates::orient3d).
#[derive(Debug)]
pub struct Tiling<'a, const D: usize, const N: usize> {
    pub(crate) points: Cow<'a, [[f64; D]]>,
    pub(crate) arrays: Arrays<N>,
    pub(crate) duplicates: Vec<[u32; 2]>,
    threads: usize,
    kept: Kept,
}

/// What queries share, made by the first of them; of the two, the one of the dimension is used.
#[derive(Debug, Default)]
struct Kept {
    plane: OnceLock<locate::Kept>,
    space: OnceLock<locate3::Kept>,
}

impl<'a, const D: usize, const N: usize> Tiling<'a, D, N> {
    pub(crate) fn of(
        points: Cow<'a, [[f64; D]]>,
        arrays: Arrays<N>,
        duplicates: Vec<[u32; 2]>,
        threads: usize,
    ) -> Self {
        Self {
            points,
            arrays,
            duplicates,
            threads,
            kept: Kept::default(),
        }
    }

    pub(crate) fn given(&self) -> Given<'_, D, N> {
        Given {
            points: &self.points,
            simplices: &self.arrays.simplices,
            neighbors: &self.arrays.neighbors,
        }
    }

    /// The points: the rows of the input, then the points that were added.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// For each simplex, the simplex across the facet opposite each corner; `None` on the boundary.
    pub fn neighbors(&self) -> impl ExactSizeIterator<Item = [Option<usize>; N]> + '_ {
        let rows = self.arrays.neighbors.iter();
        rows.map(|row| row.map(|t| usize::try_from(t).ok()))
    }

    /// Rows that repeat a point, each with the first row of that point, which is the vertex.
    ///
    /// ```
    /// let t = delone::Triangulation::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])?;
    /// assert_eq!(t.duplicates().collect::<Vec<_>>(), [(3, 1)]);
    /// # Ok::<(), delone::Error>(())
    /// ```
    pub fn duplicates(&self) -> impl ExactSizeIterator<Item = (usize, usize)> + '_ {
        let rows = self.duplicates.iter();
        rows.map(|&[row, first]| (row as usize, first as usize))
    }

    /// The arrays themselves, without a copy: the corners of each simplex, and its neighbors, -1 on
    /// the boundary. For buffers and files that take integers of 32 bits.
    pub fn into_arrays(self) -> (Vec<[i32; N]>, Vec<[i32; N]>) {
        (self.arrays.simplices, self.arrays.neighbors)
    }

    fn simplices(&self) -> impl ExactSizeIterator<Item = [usize; N]> + '_ {
        let rows = self.arrays.simplices.iter();
        rows.map(|row| row.map(|v| v as usize))
    }

    /// The facets of the boundary; `facet` tells the corners of the one opposite a corner.
    fn outer(&self, facet: impl Fn(usize) -> [usize; D]) -> Result<Vec<[usize; D]>> {
        let rows = || self.arrays.simplices.iter().zip(&self.arrays.neighbors);
        let count = rows().map(|(_, n)| n.iter().filter(|t| **t < 0).count());
        let mut found = with_room(count.sum())?;
        for (corners, neighbors) in rows() {
            let open = (0..N).filter(|&k| neighbors[k] < 0);
            found.extend(open.map(|k| facet(k).map(|corner| corners[corner] as usize)));
        }
        Ok(found)
    }
}

/// Refuses queries that are not finite.
fn finite<const D: usize>(queries: &[[f64; D]]) -> Result<()> {
    let bad = |q: &[f64; D]| q.iter().any(|x| !x.is_finite());
    let mut rows = (0..queries.len()).filter(|&row| bad(&queries[row]));
    let few: Vec<usize> = rows.by_ref().take(10).collect();
    if few.is_empty() {
        return Ok(());
    }
    Err(Error::NonFinite {
        count: few.len() + rows.count(),
        rows: few,
    })
}

fn vertex(v: i32) -> Result<usize> {
    usize::try_from(v).map_err(|_| Error::Internal("a query has no nearest simplex".into()))
}

fn one<T>(found: Vec<T>) -> Result<T> {
    let none = || Error::Internal("a query has no answer".into());
    found.into_iter().next().ok_or_else(none)
}

/// Calls `work` with queries of triangles as the core takes them.
fn batch2<T>(
    tiling: &Tiling<2, 3>,
    queries: &[Point2],
    work: impl FnOnce(&locate::Batch) -> delone_core::error::Result<T>,
) -> Result<T> {
    finite(queries)?;
    let given = tiling.given();
    let kept = locate_kept(&tiling.kept.plane, || locate::Kept::of(&given, NEVER))?;
    Ok(work(&locate::Batch {
        locator: locate::Locator::new(given, kept, NEVER),
        queries,
        workers: tiling.threads,
        watch: NEVER,
    })?)
}

/// The same of tetrahedra.
fn batch3<T>(
    tiling: &Tiling<3, 4>,
    queries: &[Point3],
    work: impl FnOnce(&locate3::Batch) -> delone_core::error::Result<T>,
) -> Result<T> {
    finite(queries)?;
    let given = tiling.given();
    let kept = locate_kept(&tiling.kept.space, || locate3::Kept::of(&given, NEVER))?;
    Ok(work(&locate3::Batch {
        locator: locate3::Locator::new(given, kept, NEVER),
        queries,
        workers: tiling.threads,
        watch: NEVER,
    })?)
}

/// What is kept, or is made now; if two threads make it, one of two equal values.
fn locate_kept<K>(
    cell: &OnceLock<K>,
    make: impl FnOnce() -> delone_core::error::Result<K>,
) -> Result<&K> {
    if let Some(kept) = cell.get() {
        return Ok(kept);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}

impl Tiling<'_, 2, 3> {
    /// The three vertices of each triangle, counter-clockwise.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [usize; 3]> + '_ {
        self.simplices()
    }

    /// Each edge once, the smaller vertex first, in ascending order.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn edges(&self) -> Result<Vec<[usize; 2]>> {
        let Given {
            points,
            simplices,
            neighbors,
        } = self.given();
        let edges = measure::edges2(simplices, neighbors, points.len(), self.threads, NEVER)?;
        Ok(edges.iter().map(|e| e.map(|v| v as usize)).collect())
    }

    /// The edges of the boundary, each with its triangle on the left.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn boundary(&self) -> Result<Vec<[usize; 2]>> {
        self.outer(|k| [(k + 1) % 3, (k + 2) % 3])
    }

    /// The area of each triangle, with a relative error below 1e-14.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn areas(&self) -> Result<Vec<f64>> {
        let given = self.given();
        let areas = measure::areas(given.points, given.simplices, self.threads, NEVER)?;
        Ok(areas)
    }

    /// The smallest angle of each triangle in degrees.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn min_angles(&self) -> Result<Vec<f64>> {
        let given = self.given();
        let [smallest, ..] =
            measure::qualities2(given.points, given.simplices, self.threads, NEVER)?;
        Ok(smallest)
    }

    /// Where a point lies; see [`Location`]. Exact: no tolerance decides. The first call prepares a
    /// search tree in linear time; then one call takes about the time of a short walk.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if a coordinate is NaN or infinite, and [`Error::Memory`].
    pub fn locate(&self, query: Point2) -> Result<Location<2, 3>> {
        one(self.locate_all(&[query])?)
    }

    /// The same for many points, with threads and faster than one by one.
    ///
    /// # Errors
    /// As for [`locate`](Self::locate).
    pub fn locate_all(&self, queries: &[Point2]) -> Result<Vec<Location<2, 3>>> {
        let found = batch2(self, queries, locate::coordinates)?;
        let weights = found.weights.as_chunks().0;
        let edges = found.edge.as_chunks::<2>().0;
        let mut all = with_room(queries.len())?;
        for (row, &t) in found.triangle.iter().enumerate() {
            all.push(if t >= 0 {
                Location::Inside {
                    simplex: t as usize,
                    weights: weights[row],
                }
            } else {
                let [a, b] = edges[row];
                Location::Outside {
                    simplex: vertex(found.beside[row])?,
                    facet: [vertex(a)?, vertex(b)?],
                    weights: [1.0 - found.along[row], found.along[row]],
                }
            });
        }
        Ok(all)
    }

    pub(crate) fn nearest2(&self, query: Point2) -> Result<usize> {
        vertex(one(batch2(self, &[query], locate::nearest)?)?)
    }
}

impl Tiling<'_, 3, 4> {
    /// The four vertices of each tetrahedron, positively oriented.
    pub fn tetrahedra(&self) -> impl ExactSizeIterator<Item = [usize; 4]> + '_ {
        self.simplices()
    }

    /// Each edge once, the smaller vertex first, in ascending order.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn edges(&self) -> Result<Vec<[usize; 2]>> {
        let given = self.given();
        let (n, workers) = (given.points.len(), self.threads);
        let edges = measure::edges3(given.simplices, n, workers, NEVER)?;
        Ok(edges.iter().map(|e| e.map(|v| v as usize)).collect())
    }

    /// The faces of the boundary, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn boundary(&self) -> Result<Vec<[usize; 3]>> {
        self.outer(|k| locate3::FACES[k])
    }

    /// The volume of each tetrahedron, with a relative error below 1e-14.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn volumes(&self) -> Result<Vec<f64>> {
        let given = self.given();
        let volumes = measure::volumes(given.points, given.simplices, self.threads, NEVER)?;
        Ok(volumes)
    }

    /// Where a point lies; see [`Location`]. Exact: no tolerance decides. The first call prepares a
    /// search tree in linear time; then one call takes about the time of a short walk.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if a coordinate is NaN or infinite, and [`Error::Memory`].
    pub fn locate(&self, query: Point3) -> Result<Location<3, 4>> {
        one(self.locate_all(&[query])?)
    }

    /// The same for many points, with threads and faster than one by one.
    ///
    /// # Errors
    /// As for [`locate`](Self::locate).
    pub fn locate_all(&self, queries: &[Point3]) -> Result<Vec<Location<3, 4>>> {
        let found = batch3(self, queries, locate3::coordinates)?;
        let weights = found.weights.as_chunks().0;
        let faces = found.face.as_chunks::<3>().0;
        let shares = found.shares.as_chunks().0;
        let mut all = with_room(queries.len())?;
        for (row, &t) in found.simplex.iter().enumerate() {
            all.push(if t >= 0 {
                Location::Inside {
                    simplex: t as usize,
                    weights: weights[row],
                }
            } else {
                let [a, b, c] = faces[row];
                Location::Outside {
                    simplex: vertex(found.beside[row])?,
                    facet: [vertex(a)?, vertex(b)?, vertex(c)?],
                    weights: shares[row],
                }
            });
        }
        Ok(all)
    }

    pub(crate) fn nearest3(&self, query: Point3) -> Result<usize> {
        vertex(one(batch3(self, &[query], locate3::nearest)?)?)
    }
}

/// The watch for a call: the core borrows it.
pub(crate) fn watched<T>(
    options: &crate::Options<'_>,
    work: impl FnOnce(&Watch) -> delone_core::error::Result<T>,
) -> Result<T> {
    Ok(work(&options.watch())?)
}
