//! The dual of a 3-D triangulation: vertices, then ridges, then regions.

use delone_predicates::{Point3, insphere};

use super::regions::{Regions, regions};
use super::ridges::{Ridges, ridges};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::measure::sphere::Corners;
use crate::regular::space::power_sign;
use crate::voronoi::Given;
use crate::voronoi::vertices::{centers, masks, number};

/// The dual of the tetrahedra, edges and points of a triangulation.
#[derive(Debug)]
pub struct Diagram {
    /// The vertices in range, in the order of their first tetrahedra.
    pub vertices: Vec<Point3>,
    /// The vertex of each tetrahedron, or -1.
    pub simplex_vertex: Vec<i32>,
    /// Faces of cells.
    pub ridges: Ridges,
    /// Cells.
    pub regions: Regions,
}

/// The diagram of a triangulation.
pub fn diagram(given: Given<3, 4>, workers: usize, watch: &Watch) -> Result<Diagram> {
    let (mut vertices, beyond) = centers::<Corners, 3, 4>(given, workers, watch)?;
    watch.check()?;
    let shared = masks(
        given,
        &vertices,
        workers,
        watch,
        |t, u| tied(given, t, u),
        |_, _| 0,
    )?;
    watch.check()?;
    let (mut simplex_vertex, far) =
        number::<Corners, 3, 4>(given, &shared, &mut vertices, &beyond, watch)?;
    watch.check()?;
    let ridges = ridges(given, &simplex_vertex, far, workers, watch)?;
    watch.check()?;
    let regions = regions(given, &simplex_vertex, &ridges, workers, watch)?;
    simplex_vertex.iter_mut().for_each(|v| *v = (*v).max(-1));
    Ok(Diagram {
        vertices,
        simplex_vertex,
        ridges,
        regions,
    })
}

/// Whether tetrahedron `t` and its neighbor `other` have the same center, exactly.
#[cold]
#[inline(never)]
fn tied(given: Given<3, 4>, t: usize, other: usize) -> Result<bool> {
    let apex = given.simplices[other][given.back(t, other)?];
    let [a, b, c, d] = given.simplices[t];
    let sites = [a, b, c, d, apex];
    let points = sites.map(|v| given.point(v));
    let sign = if given.weights.is_empty() {
        let [a, b, c, d, e] = points;
        insphere(a, b, c, d, e)
    } else {
        power_sign(points, sites.map(|v| given.weight(v)))
    };
    Ok(sign.is_zero())
}
