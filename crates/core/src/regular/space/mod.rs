//! 3-D regular triangulations: the lower hull of sites lifted to |p|^2 - w, exact and canonical.

mod insertion;
mod power;
mod validate;

use delone_predicates::{Point3, orient3d};

use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::points;
use crate::base::watch::Watch;
use crate::order::space_blocks::arrange_blocks;
use crate::regular::{Heaviest, Weighted, heaviest, in_blocks};

pub use power::{power_canonical, power_sign};
pub use validate::validate;

/// The regular triangulation of weighted points in 3-D.
#[derive(Debug)]
pub struct Regular {
    /// Tetrahedra of rows.
    pub tetrahedra: Arrays<4>,
    /// For each row the row that represents it: the first of the heaviest rows with the same
    /// coordinates.
    pub stands_for: Vec<i32>,
}

/// From this many points on, there are at least two blocks. With fewer points, many would be near
/// the borders of blocks, and triangulated twice.
const TWO: usize = 1 << 16;

/// The most points that a block should hold.
const BLOCK: usize = 1 << 18;

/// Triangulates finite points with finite weights, one for each, that are not all coplanar; the
/// same for any number of workers.
pub fn regular(
    points: &[Point3],
    weights: &[f64],
    workers: usize,
    watch: &Watch,
) -> Result<Regular> {
    points::scan(points)?;
    let fewest = 1 + usize::from(points.len() >= TWO);
    let blocks = points.len().div_ceil(BLOCK).max(fewest).next_power_of_two();
    let (arranged, starts) = arrange_blocks(points, blocks, workers, watch)?;
    if spanning(&arranged.points).is_none() {
        return Err(points::degenerate_in_space(
            &arranged.points,
            &arranged.rows,
        ));
    };
    let Heaviest {
        rows,
        weights,
        stands_for,
    } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    let sites = Weighted {
        points: &arranged.points,
        weights: &weights,
    };
    let found = in_blocks(sites, &starts, workers, watch, |sites| {
        match spanning(sites.points) {
            Some(first) => insertion::insert_all(sites, first, watch).map(Ok),
            // A flat block has no tetrahedra, and all its sites may be vertices of others.
            None => Ok(Err((0..sites.points.len() as u32).collect())),
        }
    })?;
    let mut tetrahedra =
        found.map_err(|_| Error::Internal("the sites between blocks are in one plane".into()))?;
    for corners in &mut tetrahedra.simplices {
        *corners = corners.map(|v| rows[v as usize] as i32);
    }
    Ok(Regular {
        tetrahedra,
        stands_for,
    })
}

/// The first four affinely independent points of distinct ones.
fn spanning(points: &[Point3]) -> Option<[u32; 4]> {
    let (&a, &b) = (points.first()?, points.get(1)?);
    let i = (2..points.len()).find(|&i| !points::collinear(a, b, points[i]))?;
    let j = (2..points.len()).find(|&j| !orient3d(a, b, points[i], points[j]).is_zero())?;
    Some([0, 1, i as u32, j as u32])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::arrays::Given;
    use crate::base::random::uniform;
    use crate::base::watch::IDLE;

    #[test]
    fn blocks_are_joined_alike_by_any_number_of_workers() {
        let mut next = uniform(5);
        let points: Vec<Point3> = (0..TWO + 500).map(|_| [(); 3].map(|()| next())).collect();
        let weights: Vec<f64> = points.iter().map(|_| 2e-4 * next()).collect();
        let one = regular(&points, &weights, 1, &IDLE).unwrap();
        let three = regular(&points, &weights, 3, &IDLE).unwrap();
        assert_eq!(one.tetrahedra.simplices, three.tetrahedra.simplices);
        assert_eq!(one.tetrahedra.neighbors, three.tetrahedra.neighbors);
        assert_eq!(one.stands_for, three.stands_for);
        let given = Given {
            points: &points,
            simplices: &one.tetrahedra.simplices,
            neighbors: &one.tetrahedra.neighbors,
        };
        let report = validate(given, &weights, &IDLE).unwrap();
        assert_eq!(report.0, Default::default());
    }
}
