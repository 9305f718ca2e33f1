//! Voronoi diagrams in 2-D.

use delone_core::voronoi::{self as core, Diagram, Given};

use crate::cells::Cells;
use crate::tiling::watched;
use crate::{Error, Options, Point2, Result, Triangulation};

/// The Voronoi diagram of points in 2-D: the cell of a point is what is nearer to it than to any
/// other point.
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
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Voronoi<'t> {
    triangulation: &'t Triangulation<'t>,
    diagram: Diagram,
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

impl<'t> Voronoi<'t> {
    /// The diagram of the points of a triangulation, in linear time.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(triangulation: &'t Triangulation<'t>) -> Result<Self> {
        Self::with_options(triangulation, Options::new())
    }

    /// The same with options.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::Interrupted`].
    pub fn with_options(
        triangulation: &'t Triangulation<'t>,
        options: Options<'t>,
    ) -> Result<Self> {
        let arrays = triangulation.given();
        let given = Given {
            points: arrays.points,
            weights: &[],
            simplices: arrays.simplices,
            neighbors: arrays.neighbors,
        };
        let diagram = watched(&options, |watch| {
            core::diagram(given, options.workers(), watch)
        })?;
        Ok(Self {
            triangulation,
            diagram,
            options,
        })
    }

    /// The vertices: the centers of circumcircles, rounded. Triangles with one circumcircle share a
    /// vertex, which an exact test decides.
    pub fn vertices(&self) -> &[Point2] {
        &self.diagram.vertices
    }

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
        let Diagram {
            vertices,
            ridges,
            regions,
            ..
        } = &self.diagram;
        let cells = core::Cells {
            points: self.triangulation.points(),
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
        watched(&self.options, |watch| {
            let polygons = core::clip(cells, min, max, workers, watch)?;
            let (starts, points) = (&polygons.starts, &polygons.points);
            let measures = core::measures(starts, points, workers, watch)?;
            Cells::of(&regions.of_point, polygons, measures)
        })
    }
}
