//! Voronoi diagrams in 3-D.

use delone_core::memory::filled;
use delone_core::voronoi::Given;
use delone_core::voronoi3::{self as core, Cells, Diagram};

use crate::tiling::watched;
use crate::voronoi::{Corner, Ridge};
use crate::{Options, Point3, Result, Triangulation3};

/// The Voronoi diagram of points in 3-D: the cell of a point is what is nearer to it than to any
/// other point.
///
/// ```
/// use delone::{Triangulation3, Voronoi3};
///
/// let axis = [-1.0, 0.0, 1.0];
/// let plane = |z| axis.map(|y| axis.map(|x| [x, y, z])).concat();
/// let grid = axis.map(plane).concat();
/// let t = Triangulation3::new(&grid)?;
/// let volumes = Voronoi3::new(&t)?.volumes()?;
/// assert!((volumes[13] - 1.0).abs() < 1e-14);
/// assert_eq!(volumes[0], f64::INFINITY);
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug)]
pub struct Voronoi3<'t> {
    triangulation: &'t Triangulation3<'t>,
    diagram: Diagram,
    options: Options<'t>,
}

impl<'t> Voronoi3<'t> {
    /// The diagram of the points of a triangulation, in linear time.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory).
    pub fn new(triangulation: &'t Triangulation3<'t>) -> Result<Self> {
        Self::with_options(triangulation, Options::new())
    }

    /// The same with options.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory), [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn with_options(
        triangulation: &'t Triangulation3<'t>,
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

    /// The vertices: the centers of circumspheres, rounded. Tetrahedra with one circumsphere share a
    /// vertex, which an exact test decides.
    pub fn vertices(&self) -> &[Point3] {
        &self.diagram.vertices
    }

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
        let Diagram {
            vertices,
            ridges,
            regions,
            ..
        } = &self.diagram;
        let cells = Cells {
            points: self.triangulation.points(),
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
        let found = watched(&self.options, |watch| core::measures(cells, workers, watch))?;
        let mut volumes = filled(regions.of_point.len(), 0.0)?;
        for (&site, volume) in regions.site.iter().zip(found.volumes) {
            volumes[site as usize] = volume;
        }
        Ok(volumes)
    }
}
