//! 3-D regular triangulations: the lower hull of sites lifted to |p|^2 - w, exact and canonical.

mod insertion;
mod power;
mod validate;

use delone_predicates::{Point3, orient3d};

use crate::arrays::Arrays;
use crate::error::Result;
use crate::order::space::arrange;
use crate::points;
use crate::regular::{Heaviest, Weighted, heaviest};
use crate::watch::Watch;

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

/// Triangulates finite points with finite weights, one for each, that are not all coplanar.
pub fn regular(points: &[Point3], weights: &[f64], watch: &Watch) -> Result<Regular> {
    points::scan(points)?;
    let arranged = arrange(points, watch)?;
    let Some(first) = spanning(&arranged.points) else {
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
    let mut tetrahedra = insertion::insert_all(sites, first, watch)?;
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
