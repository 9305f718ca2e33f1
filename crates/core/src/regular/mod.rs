//! Regular triangulations: the lower hull of sites lifted to |p|^2 - w, exact and canonical; and
//! Delaunay triangulations of periodic sets, which are built by the same insertion.

mod insertion;
mod periodic;
mod power;

use delone_predicates::Point2;

use crate::arrays::Arrays;
use crate::error::Result;
use crate::memory::{filled, with_room};
use crate::order::arrange;
use crate::points;
use crate::watch::Watch;

pub use insertion::Sites;
pub use periodic::{Copies, Images, periodic};
pub use power::power_sign;

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
    let mut heaviest = arranged.rows.clone();
    let mut place = filled(points.len(), 0_u32)?;
    for (i, &row) in (0_u32..).zip(&arranged.rows) {
        place[row as usize] = i;
    }
    for &[row, first] in &arranged.duplicates {
        let best = &mut heaviest[place[first as usize] as usize];
        if weights[row as usize] > weights[*best as usize] {
            *best = row;
        }
    }
    let mut stands_for = with_room(points.len())?;
    stands_for.extend(0..points.len() as i32);
    for &[row, first] in &arranged.duplicates {
        stands_for[row as usize] = heaviest[place[first as usize] as usize] as i32;
    }
    for (&row, &best) in arranged.rows.iter().zip(&heaviest) {
        stands_for[row as usize] = best as i32;
    }
    let mut own = with_room(heaviest.len())?;
    own.extend(heaviest.iter().map(|&row| weights[row as usize]));
    let sites = power::Weighted {
        points: &arranged.points,
        weights: &own,
    };
    let rows = |v: i32| heaviest[v as usize] as i32;
    let found = insertion::insert_all(&sites, arranged.rows.len(), watch)?;
    let (mut triangles, chain) = match found {
        Ok(triangles) => (triangles, Vec::new()),
        Err(chain) => (
            Arrays::default(),
            chain.iter().map(|&v| heaviest[v as usize]).collect(),
        ),
    };
    for corners in &mut triangles.simplices {
        *corners = corners.map(rows);
    }
    Ok(Regular {
        triangles,
        chain,
        stands_for,
    })
}
