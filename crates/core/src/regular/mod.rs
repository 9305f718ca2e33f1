//! 2-D regular triangulations, the lower hull of sites lifted to |p|^2 - w, exact and canonical;
//! periodic triangulations, built by the same insertion. `records` and `heaviest` serve space as well.

mod heaviest;
mod insertion;
mod periodic;
mod power;
mod records;

use delone_predicates::Point2;

use crate::arrays::Arrays;
use crate::error::Result;
use crate::order::arrange;
use crate::points;
use crate::watch::Watch;

pub use heaviest::{Heaviest, heaviest};
pub use insertion::Sites;
pub use periodic::{Copies, Images, periodic};
pub use power::{Weighted, power_sign};
pub use records::{GHOST, NONE, Records};

/// The regular triangulation of weighted points.
#[derive(Debug)]
pub struct Regular {
    /// Triangles of rows; none where all points are in line.
    pub triangles: Arrays<3>,
    /// Where all points are in line, the rows that are not hidden, in their order.
    pub chain: Vec<u32>,
    /// For each row the row that stands for it: the heaviest with its coordinates, the first of these.
    pub stands_for: Vec<i32>,
}

/// Triangulates finite points with finite weights, as many.
pub fn regular(points: &[Point2], weights: &[f64], watch: &Watch) -> Result<Regular> {
    points::scan(points)?;
    let arranged = arrange(points, 1, watch)?;
    let Heaviest {
        rows,
        weights,
        stands_for,
    } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    let sites = Weighted {
        points: &arranged.points,
        weights: &weights,
    };
    let found = insertion::insert_all(&sites, arranged.rows.len(), watch)?;
    let (mut triangles, chain) = match found {
        Ok(triangles) => (triangles, Vec::new()),
        Err(chain) => (
            Arrays::default(),
            chain.iter().map(|&v| rows[v as usize]).collect(),
        ),
    };
    for corners in &mut triangles.simplices {
        *corners = corners.map(|v| rows[v as usize] as i32);
    }
    Ok(Regular {
        triangles,
        chain,
        stands_for,
    })
}
