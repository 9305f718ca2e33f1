//! Voronoi diagrams, in 2-D and in 3-D.

use delone_core::memory::filled;
use delone_core::{voronoi as plane, voronoi3 as space};

use crate::arrays::{Diagram2, Diagram3};
use crate::cells::Cells;
use crate::dimension::Kernel;
use crate::{Dimension, Error, Options, Point2, Result, Triangulation};

/// The Voronoi diagram of points: the cell of a point is what is nearer to it than to any other
/// point.
///
/// ```
/// use delone::{Triangulation, Voronoi};
///
/// let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0]];
/// let t = Triangulation::new(&points)?;
/// let voronoi = Voronoi::new(&t)?;
/// assert_eq!(voronoi.vertices(), [[1.0, 1.0]]);
/// let cells = voronoi.clip([0.0, 0.0], [2.0, 2.0])?;
/// assert_eq!((cells.area(0), cells.polygon(3).len()), (1.0, 4));
///
/// let axis = [-1.0, 0.0, 1.0];
/// let plane = |z| axis.map(|y| axis.map(|x| [x, y, z])).concat();
/// let grid = axis.map(plane).concat();
/// let t = Triangulation::new(&grid)?;
/// let volumes = Voronoi::new(&t)?.volumes()?;
/// assert!((volumes[13] - 1.0).abs() < 1e-14);
/// assert_eq!(volumes[0], f64::INFINITY);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Voronoi<'t, const D: usize = 2, const N: usize = 3>
where
    [f64; D]: Dimension<N>,
{
    points: &'t [[f64; D]],
    diagram: <[f64; D] as Kernel<N>>::Diagram,
    options: Options<'t>,
}

/// An edge or face between two cells: `C` is its corners, [`Corner`]s in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Ridge<C> {
    /// The points whose cells it separates.
    pub sites: [usize; 2],
    /// Its corners: two in 2-D, in 3-D those of a polygon.
    pub corners: C,
}

/// An end of an edge, or a corner of a face, of a Voronoi diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Corner<const D: usize> {
    /// A vertex of the diagram.
    Vertex(usize),
    /// Unbounded in this direction, a vector of length 1.
    Ray([f64; D]),
}

impl<const D: usize> Corner<D> {
    /// The corner of a code: a vertex, or `!i` for ray `i`.
    pub(crate) fn of(code: i32, rays: &[[f64; D]]) -> Self {
        match usize::try_from(code) {
            Ok(vertex) => Self::Vertex(vertex),
            Err(_) => Self::Ray(rays[!code as usize]),
        }
    }
}

impl<'t, const D: usize, const N: usize> Voronoi<'t, D, N>
where
    [f64; D]: Dimension<N>,
{
    /// The diagram of the points of a triangulation, in linear time.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(triangulation: &'t Triangulation<'_, D, N>) -> Result<Self> {
        Self::of(triangulation, Options::new())
    }

    pub(crate) fn of(
        triangulation: &'t Triangulation<'_, D, N>,
        options: Options<'t>,
    ) -> Result<Self> {
        let mut scene = triangulation.scene();
        scene.workers = options.workers();
        Ok(Self {
            points: scene.points,
            diagram: options.watched(|watch| <[f64; D]>::voronoi(scene, watch))?,
            options,
        })
    }

    /// The vertices: the centers of circumcircles or circumspheres, rounded. Simplices with one
    /// center share a vertex, which an exact test decides.
    pub fn vertices(&self) -> &[[f64; D]] {
        <[f64; D]>::vertices(&self.diagram)
    }
}

impl Voronoi<'_> {
    /// The edges of the cells. The first site is on the left of the way from the first corner to the
    /// second; if one of the corners is a ray, it is the first.
    pub fn ridges(&self) -> impl ExactSizeIterator<Item = Ridge<[Corner<2>; 2]>> + '_ {
        let ridges = &self.diagram.ridges;
        let rows = ridges.sites.iter().zip(&ridges.ends);
        rows.map(|(sites, ends)| Ridge {
            sites: sites.map(|v| v as usize),
            corners: ends.map(|code| Corner::of(code, &ridges.rays)),
        })
    }

    /// The cells cut to a box, which may be smaller or larger than the convex hull.
    ///
    /// # Errors
    /// [`Error::Option`] if the box is not finite or has no area; [`Error::Memory`],
    /// [`Error::Interrupted`].
    pub fn clip(&self, min: Point2, max: Point2) -> Result<Cells> {
        let valid = |k: usize| min[k].is_finite() && max[k].is_finite() && min[k] < max[k];
        if !(valid(0) && valid(1)) {
            let text = format!("the box from {min:?} to {max:?} has no finite positive area");
            return Err(Error::Option(text));
        }
        let Diagram2 {
            vertices,
            ridges,
            regions,
            ..
        } = &self.diagram;
        let cells = plane::Cells {
            points: self.points,
            weights: &[],
            vertices,
            sites: &ridges.sites,
            ends: &ridges.ends,
            rays: &ridges.rays,
            beyond: &ridges.beyond,
            site: &regions.site,
            starts: &regions.starts,
            entry_vertices: &regions.vertices,
            entry_ridges: &regions.ridges,
        };
        let workers = self.options.workers();
        self.options.watched(|watch| {
            let polygons = plane::clip(cells, min, max, workers, watch)?;
            let (starts, points) = (&polygons.starts, &polygons.points);
            let measures = plane::measures(starts, points, workers, watch)?;
            Cells::of(&regions.of_point, polygons, measures)
        })
    }
}

impl Voronoi<'_, 3, 4> {
    /// The faces of the cells: convex polygons. An unbounded one begins and ends with a ray.
    pub fn ridges(&self) -> impl ExactSizeIterator<Item = Ridge<Vec<Corner<3>>>> + '_ {
        let ridges = &self.diagram.ridges;
        let rows = ridges.sites.iter().zip(ridges.starts.windows(2));
        rows.map(|(sites, range)| {
            let entries = &ridges.entries[range[0] as usize..range[1] as usize];
            let corner = |&code: &i32| Corner::of(code, &ridges.rays);
            Ridge {
                sites: sites.map(|v| v as usize),
                corners: entries.iter().map(corner).collect(),
            }
        })
    }

    /// The volume of the cell of each point: infinite if the cell is unbounded, 0 for rows that
    /// repeat a point.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory), [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn volumes(&self) -> Result<Vec<f64>> {
        let Diagram3 {
            vertices,
            ridges,
            regions,
            ..
        } = &self.diagram;
        let cells = space::Cells {
            points: self.points,
            weights: &[],
            vertices,
            sites: &ridges.sites,
            starts: &ridges.starts,
            entries: &ridges.entries,
            site: &regions.site,
            ridge_starts: &regions.ridge_starts,
            ridges: &regions.ridges,
        };
        let workers = self.options.workers();
        let found = self
            .options
            .watched(|watch| space::measures(cells, workers, watch))?;
        let mut volumes = filled(regions.of_point.len(), 0.0)?;
        for (&site, volume) in regions.site.iter().zip(found.volumes) {
            volumes[site as usize] = volume;
        }
        Ok(volumes)
    }
}

impl From<Voronoi<'_>> for Diagram2 {
    fn from(voronoi: Voronoi<'_>) -> Self {
        voronoi.diagram
    }
}

impl From<Voronoi<'_, 3, 4>> for Diagram3 {
    fn from(voronoi: Voronoi<'_, 3, 4>) -> Self {
        voronoi.diagram
    }
}
