//! 2-D regular triangulations of weighted points, exact and canonical, and periodic triangulations.
//!
//! A regular triangulation is the lower hull of sites lifted to |p|^2 - w; periodic triangulations
//! are built by the same insertion. `records`, `heaviest` and `blocks` also serve 3-D.

mod blocks;
mod classes;
mod heaviest;
mod insertion;
mod periodic;
mod power;
mod records;
pub mod space;
mod validate;
mod validate_periodic;

use delone_predicates::Point2;

use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::points;
use crate::base::watch::Watch;
use crate::order::arrange;

pub use blocks::{Found, in_blocks};
pub use classes::{Periodic, periodic};
pub use heaviest::{Heaviest, heaviest};
pub use insertion::Sites;
pub use periodic::Images;
pub use power::{Weighted, power_sign};
pub use records::{GHOST, NONE, Records};
pub use validate::{Checked, checked, validate};
pub use validate_periodic::{PeriodicFindings, Wrapped, validate_periodic};

/// The regular triangulation of weighted points.
#[derive(Debug)]
pub struct Regular {
    /// Triangles of rows; none if all points are collinear.
    pub triangles: Arrays<3>,
    /// If all points are collinear, the rows that are not hidden, in order along the line.
    pub chain: Vec<u32>,
    /// For each row the row that represents it: the first of the heaviest rows with the same
    /// coordinates.
    pub stands_for: Vec<i32>,
}

/// Triangulates finite points with finite weights, one for each; the same for any number of workers.
pub fn regular(
    points: &[Point2],
    weights: &[f64],
    workers: usize,
    watch: &Watch,
) -> Result<Regular> {
    points::scan(points)?;
    let arranged = arrange(points, workers, watch)?;
    let Heaviest {
        rows,
        weights,
        stands_for,
    } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    let sites = Weighted {
        points: &arranged.points,
        weights: &weights,
    };
    let found = in_blocks(sites, &arranged.starts, workers, watch, |sites| {
        insertion::insert_all(&sites, sites.points.len(), watch)
    })?;
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
