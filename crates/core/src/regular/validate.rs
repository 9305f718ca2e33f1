//! Exact validation of a 2-D regular triangulation: lists the simplices and points that are wrong.
//!
//! Why these checks suffice: triangles that tile the convex hull of their vertices, and are locally
//! regular at each inner edge, are the lower hull of the lifted vertices (see
//! `delaunay::plane::validate`). With ties broken, the lower hull is strictly convex, so no vertex
//! should be hidden. A point that is not a vertex is rightly left out if and only if its lift is
//! not below the triangle that contains it, with ties broken in the same way.
//!
//! Points are located by walks that cross an edge with the point strictly beyond it. In a regular
//! triangulation no such walk returns to a triangle (H. Edelsbrunner, "An acyclicity theorem for
//! cell complexes in d dimensions", 1990). So hidden points are judged only if all else is right.

use delone_predicates::Sign;

use super::heaviest::{Heaviest, heaviest};
use super::insertion::Sites;
use super::power::Weighted;
use crate::base::arrays::{Given, Triangles};
use crate::base::error::{Error, Result};
use crate::base::points;
use crate::base::proof::{Expected, Findings, Tiling, Verdict, examine};
use crate::base::watch::{Pace, Watch};
use crate::order::arrange;

/// Steps of walks between two checks for interruption.
const STEPS: usize = 1 << 14;

/// The faults of a triangulation with weights, and for each row the row that represents it: the
/// first of the heaviest rows with its coordinates.
pub type Checked<const D: usize> = (Findings<D>, Vec<i32>);

/// Checks everything that makes `given` the canonical regular triangulation of its points, with one
/// finite weight for each.
pub fn validate(given: Triangles, weights: &[f64], watch: &Watch) -> Result<Checked<2>> {
    points::scan(given.points)?;
    let arranged = arrange(given.points, 1, watch)?;
    let sites = Weighted {
        points: given.points,
        weights,
    };
    let judge = |t: usize, k: usize, q: i32| {
        let [u, v] = given.facet(t, k);
        sites.verdict([given.simplices[t][k], u, v, q].map(|v| v as u32))
    };
    let beyond = |corners: [u32; 3], k: usize, p: u32| {
        let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        sites.turn([u, v, p]) == Sign::Negative
    };
    let below = |[a, b, c]: [u32; 3], p: u32| sites.is_below([a, b, c, p]);
    let own = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    checked(given, own, judge, (beyond, below), watch)
}

/// The checks for both dimensions, given the heaviest rows. `beyond` tells whether a row is
/// strictly beyond the facet opposite a corner, `below` whether its lift is below a simplex, with
/// ties broken.
pub fn checked<'a, const D: usize, const N: usize>(
    given: Given<'a, D, N>,
    own: Heaviest,
    judge: impl Fn(usize, usize, i32) -> Verdict,
    (beyond, below): (
        impl Fn([u32; N], usize, u32) -> bool,
        impl Fn([u32; N], u32) -> bool,
    ),
    watch: &Watch,
) -> Result<Checked<D>>
where
    Given<'a, D, N>: Tiling<D, N>,
{
    let expected = Expected {
        rows: &own.rows,
        others: &others(&own.stands_for),
        may_hide: true,
    };
    let (mut faults, left) = examine(given, expected, judge, watch)?;
    if faults == Findings::default() {
        (faults.hidden, faults.missing) = unused(given, &left, beyond, below, watch)?;
    }
    Ok((faults, own.stands_for))
}

/// `[row, row that represents it]` for each row that another one represents.
pub fn others(stands_for: &[i32]) -> Vec<[u32; 2]> {
    let all = (0_u32..).zip(stands_for);
    all.filter(|&(row, &standing)| row as i32 != standing)
        .map(|(row, &standing)| [row, standing as u32])
        .collect()
}

/// Of the rows that no simplex uses, those below the simplices that contain them, and those outside
/// all simplices, both ascending; `beyond` and `below` are as in [`checked`].
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

/// The simplex that contains a place, by a walk from simplex `from`; `None` outside.
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
