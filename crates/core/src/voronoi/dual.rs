//! The dual of a 2-D triangulation: vertices, then ridges, then regions.

use delone_predicates::{Point2, incircle};

use super::given::Given;
use super::regions::{Regions, Walk};
use super::ridges::{OWNED, Ridges, ridges};
use super::vertices::{centers, masks, number};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::measure::circle::Corners;
use crate::regular::power_sign;

/// The dual of the triangles, edges and points of a triangulation.
#[derive(Debug)]
pub struct Diagram {
    /// The vertices in range, in the order of their first triangles.
    pub vertices: Vec<Point2>,
    /// The vertex of each triangle, or -1.
    pub triangle_vertex: Vec<i32>,
    /// Edges of cells.
    pub ridges: Ridges,
    /// Cells.
    pub regions: Regions,
}

/// The diagram of a triangulation.
pub fn diagram(given: Given<2, 3>, workers: usize, watch: &Watch) -> Result<Diagram> {
    let (mut vertices, beyond) = centers::<Corners, 2, 3>(given, workers, watch)?;
    watch.check()?;
    let owned = |t, shared| owned(given, t, shared) << OWNED;
    let masks = masks(
        given,
        &vertices,
        workers,
        watch,
        |t, u| tied(given, t, u),
        owned,
    )?;
    watch.check()?;
    let (triangle_vertex, far) =
        number::<Corners, 2, 3>(given, &masks, &mut vertices, &beyond, watch)?;
    watch.check()?;
    let (ridges, first_ridge) = ridges(given, &masks, &triangle_vertex, &far, workers, watch)?;
    watch.check()?;
    let walk = Walk {
        given,
        masks: &masks,
        vertex: &triangle_vertex,
        first_ridge: &first_ridge,
    };
    let regions = walk.regions(&ridges.sites, workers, watch)?;
    let mut triangle_vertex = triangle_vertex;
    if !far.is_empty() {
        triangle_vertex.iter_mut().for_each(|v| *v = (*v).max(-1));
    }
    Ok(Diagram {
        vertices,
        triangle_vertex,
        ridges,
        regions,
    })
}

/// The edges of a triangle whose ridges are numbered with it: those that have one, on the later
/// side.
fn owned(given: Given<2, 3>, t: usize, shared: u8) -> u8 {
    let mine = |k: usize| shared >> k & 1 == 0 && given.neighbors[t][k] < t as i32;
    (0..3).map(|k| u8::from(mine(k)) << k).sum()
}

/// Whether triangle `t` and its neighbor `other` have the same center, exactly.
#[cold]
#[inline(never)]
fn tied(given: Given<2, 3>, t: usize, other: usize) -> Result<bool> {
    let apex = given.simplices[other][given.back(t, other)?];
    let [a, b, c] = given.simplices[t];
    let points = [a, b, c, apex].map(|v| given.point(v));
    let sign = if given.weights.is_empty() {
        let [a, b, c, d] = points;
        incircle(a, b, c, d)
    } else {
        power_sign(points, [a, b, c, apex].map(|v| given.weight(v)))
    };
    Ok(sign.is_zero())
}
