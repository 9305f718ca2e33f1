//! Exact validation of a 2-D regular triangulation: lists the simplices and points that are wrong.
//!
//! Why these checks suffice: triangles that tile the convex hull of their vertices, and are locally
//! regular at each inner edge, are the lower hull of the lifted vertices (see `delaunay::plane::validate`).
//! With ties broken the lower hull is strictly convex, so that no vertex should be hidden. A point that
//! is not a vertex changes nothing exactly if its lift does not lie below the triangle that contains it,
//! with ties broken in the same way.
//!
//! Points are located by walks that cross an edge with the point strictly beyond it. In a regular
//! triangulation no such walk returns to a triangle (H. Edelsbrunner, "An acyclicity theorem for cell
//! complexes in d dimensions", 1990). So hidden points are judged only if everything else is right.

use delone_predicates::Sign;

use super::heaviest::{Heaviest, heaviest};
use super::insertion::Sites;
use super::power::Weighted;
use crate::base::arrays::{Given, Triangles};
use crate::base::error::{Error, Result};
use crate::base::points;
use crate::base::proof::Expected;
use crate::base::watch::{Pace, Watch};
use crate::delaunay::plane::validate::{Findings, examine};
use crate::order::arrange;

/// Steps of walks between two checks for interruption.
const STEPS: usize = 1 << 14;

/// What is wrong with a regular triangulation.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Checked<F> {
    /// Faults as without weights; those in `missing` lie outside all simplices.
    pub faults: F,
    /// Rows that are not vertices though their lifts lie below the simplices that hold them. They, and
    /// those that are missing, are looked for only where there is no other fault.
    pub hidden: Vec<u32>,
    /// For each row the row that represents it: the heaviest with its coordinates, the first of
    /// these.
    pub stands_for: Vec<i32>,
}

/// Checks everything that makes `given` the canonical regular triangulation of its points with
/// finite weights, as many.
pub fn validate(given: Triangles, weights: &[f64], watch: &Watch) -> Result<Checked<Findings>> {
    points::scan(given.points)?;
    let arranged = arrange(given.points, 1, watch)?;
    let Heaviest {
        rows, stands_for, ..
    } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    let sites = Weighted {
        points: given.points,
        weights,
    };
    let expected = Expected {
        rows: &rows,
        others: &others(&stands_for),
        may_hide: true,
    };
    let judge = |sites4: [i32; 4]| sites.verdict(sites4.map(|v| v as u32));
    let (mut faults, left) = examine(given, expected, judge, watch)?;
    let mut hidden = Vec::new();
    if faults == Findings::default() {
        let beyond = |corners: [u32; 3], k: usize, p: u32| {
            let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            sites.turn([u, v, p]) == Sign::Negative
        };
        let below = |[a, b, c]: [u32; 3], p: u32| sites.is_below([a, b, c, p]);
        (hidden, faults.missing) = unused(given, &left, beyond, below, watch)?;
    }
    Ok(Checked {
        faults,
        hidden,
        stands_for,
    })
}

/// `[row, row that represents it]` for each row that another one represents.
pub fn others(stands_for: &[i32]) -> Vec<[u32; 2]> {
    let all = (0_u32..).zip(stands_for);
    all.filter(|&(row, &standing)| row as i32 != standing)
        .map(|(row, &standing)| [row, standing as u32])
        .collect()
}

/// Parts rows that no simplex uses: first those below the simplices that hold them, then those outside
/// all simplices, both ascending. `beyond` tells whether a row is strictly beyond the facet opposite a
/// corner, `below` whether its lift is below a simplex, ties broken.
pub fn unused<const D: usize, const N: usize>(
    given: Given<D, N>,
    rows: &[u32],
    beyond: impl Fn([u32; N], usize, u32) -> bool,
    below: impl Fn([u32; N], u32) -> bool,
    watch: &Watch,
) -> Result<(Vec<u32>, Vec<u32>)> {
    let mut pace = Pace::new(watch, STEPS);
    let (mut hidden, mut outside) = (Vec::new(), Vec::new());
    let mut last = 0;
    for &p in rows {
        match holder(given, last, |corners, k| beyond(corners, k, p), &mut pace)? {
            Some(t) => {
                last = t;
                if below(given.simplices[t].map(|v| v as u32), p) {
                    hidden.push(p);
                }
            }
            None => outside.push(p),
        }
    }
    hidden.sort_unstable();
    outside.sort_unstable();
    Ok((hidden, outside))
}

/// The simplex that holds a place, by a walk from simplex `from`; none outside.
fn holder<const D: usize, const N: usize>(
    given: Given<D, N>,
    from: usize,
    is_beyond: impl Fn([u32; N], usize) -> bool,
    pace: &mut Pace,
) -> Result<Option<usize>> {
    let (mut t, mut came) = (from, -1);
    for _ in 0..given.simplices.len() {
        pace.spend(1)?;
        let corners = given.simplices[t].map(|v| v as u32);
        let around = given.neighbors[t];
        let step = (0..N).find(|&k| (came < 0 || around[k] != came) && is_beyond(corners, k));
        let Some(k) = step else { return Ok(Some(t)) };
        if around[k] < 0 {
            return Ok(None);
        }
        (t, came) = (around[k] as usize, t as i32);
    }
    if given.simplices.is_empty() {
        return Ok(None);
    }
    Err(Error::Internal("a walk comes back to a simplex".into()))
}
