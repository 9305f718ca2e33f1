//! Edges of open Gabriel graphs that are not in the triangulation: diameters of empty balls with
//! more points on their surface, such as the second diagonal of a square.
//!
//! b is such a neighbor of a if it lies in the Voronoi cell of a, enlarged to twice its size (see
//! `regions`), and is not a Delaunay neighbor. A tree of boxes is searched; a box beyond one side of
//! the enlarged cell is skipped.

use delone_predicates::proximity::angle;
use delone_predicates::{Sign, incircle, insphere};

use super::edges::{SHARE, Skeleton, joined, sorted};
use super::tree::Tree;
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};

/// Vertices that are searched from between two checks for interruption.
const LOT: usize = 1 << 8;

/// Simplices and their neighbors.
type Tiling<'a, const N: usize> = (&'a [[i32; N]], &'a [[i32; N]]);

/// Coordinates of a dimension with a test for equal circumspheres.
pub trait Cospherical<const D: usize, const N: usize> {
    /// Whether the sphere through the corners of a simplex passes through `p`.
    fn is_on(corners: [[f64; D]; N], p: [f64; D]) -> bool;
}

impl Cospherical<2, 3> for [f64; 2] {
    fn is_on([a, b, c]: [Self; 3], p: Self) -> bool {
        incircle(a, b, c, p).is_zero()
    }
}

impl Cospherical<3, 4> for [f64; 3] {
    fn is_on([a, b, c, d]: [Self; 4], p: Self) -> bool {
        insphere(a, b, c, d, p).is_zero()
    }
}

/// The edges with an empty open diametral ball that are not in the skeleton. With simplices and
/// neighbors, only corners of adjacent simplices on one sphere are searched from: where a diameter
/// leaves the first simplex, another one continues the same cell of the Voronoi dual.
pub fn antipodes<const D: usize, const N: usize>(
    skeleton: &Skeleton<D>,
    tree: &Tree<D>,
    simplices: Option<Tiling<N>>,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>>
where
    [f64; D]: Cospherical<D, N>,
{
    let starts = match simplices {
        Some((simplices, neighbors)) => tied(skeleton, simplices, neighbors, workers, watch)?,
        None => filled(skeleton.points.len(), true)?,
    };
    let shares = (0..tree.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let mut found = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for place in first..tree.len().min(first + SHARE) {
            let row = tree.rows[place] as i32;
            if starts[row as usize] {
                pace.spend(1)?;
                from(skeleton, tree, row, &mut found)?;
            }
        }
        Ok(found)
    })?;
    sorted(&joined(&parts)?, skeleton.points.len(), watch)
}

/// Which rows are corners of two adjacent simplices with one sphere.
fn tied<const D: usize, const N: usize>(
    skeleton: &Skeleton<D>,
    simplices: &[[i32; N]],
    neighbors: &[[i32; N]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<bool>>
where
    [f64; D]: Cospherical<D, N>,
{
    let shares = (0..simplices.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let mut found: Vec<[i32; N]> = Vec::new();
        for t in first..simplices.len().min(first + SHARE) {
            let corners = simplices[t].map(|v| skeleton.at(v));
            for &other in neighbors[t].iter().filter(|&&other| other < t as i32) {
                let Ok(other) = usize::try_from(other) else {
                    continue;
                };
                let apex = simplices[other].iter().find(|v| !simplices[t].contains(v));
                if apex.is_some_and(|&v| <[f64; D]>::is_on(corners, skeleton.at(v))) {
                    push(&mut found, simplices[t])?;
                    push(&mut found, simplices[other])?;
                }
            }
        }
        Ok(found)
    })?;
    let mut marked = filled(skeleton.points.len(), false)?;
    for &row in parts.iter().flatten().flatten() {
        marked[row as usize] = true;
    }
    Ok(marked)
}

/// The edges from one row to larger ones.
fn from<const D: usize>(
    skeleton: &Skeleton<D>,
    tree: &Tree<D>,
    row: i32,
    found: &mut Vec<[i32; 2]>,
) -> Result<()> {
    let (a, around) = (skeleton.at(row), skeleton.around(row));
    let mut far = Vec::new();
    let enter =
        |extent: &Extent<D>, _, _| !around.iter().any(|&v| is_beyond(a, skeleton.at(v), extent));
    tree.boxes
        .each(&mut Vec::with_capacity(64), enter, |place| {
            let (other, b) = (tree.rows[place] as i32, tree.points[place]);
            let open = |&v: &i32| angle(a, skeleton.at(v), b) != Sign::Negative;
            if other > row && !around.contains(&other) && around.iter().all(open) {
                far.push([row, other]);
            }
            true
        });
    for edge in far {
        push(found, edge)?;
    }
    Ok(())
}

/// Whether a box is certainly beyond the plane through `c` that is perpendicular to `a c`.
#[inline]
fn is_beyond<const D: usize>(a: [f64; D], c: [f64; D], extent: &Extent<D>) -> bool {
    let (mut sum, mut size) = (0.0, 0.0);
    for k in 0..D {
        let along = c[k] - a[k];
        let low = if along > 0.0 {
            extent.min[k]
        } else {
            extent.max[k]
        };
        let term = (low - c[k]) * along;
        sum += term;
        size += term.abs();
    }
    // The terms err by less than 1e-15 of themselves; NaN and infinity fail the comparison.
    sum > 1e-14 * size + f64::MIN_POSITIVE
}
