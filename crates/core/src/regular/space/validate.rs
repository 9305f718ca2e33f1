//! Is this the 3-D regular triangulation of weighted points? See `regular::validate`, which explains
//! why the checks suffice.

use delone_predicates::{Sign, orient3d};

use super::power::{power_canonical, power_sign};
use crate::base::arrays::{OUTWARD, Tetrahedra};
use crate::base::error::Result;
use crate::base::points;
use crate::base::proof::{Expected, Verdict};
use crate::base::watch::Watch;
use crate::delaunay::space::validate::{Findings3, examine};
use crate::order::space::arrange;
use crate::regular::{Checked, Heaviest, heaviest, others, unused};

/// Checks everything that makes `given` the canonical regular triangulation of its points with
/// finite weights, as many.
pub fn validate(given: Tetrahedra, weights: &[f64], watch: &Watch) -> Result<Checked<Findings3>> {
    points::scan(given.points)?;
    let arranged = arrange(given.points, watch)?;
    let Heaviest {
        rows, stands_for, ..
    } = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    let expected = Expected {
        rows: &rows,
        others: &others(&stands_for),
        may_hide: true,
    };
    let at = |v: u32| given.points[v as usize];
    let weight = |v: u32| weights[v as usize];
    let judge = |sites: [i32; 5]| {
        let sites = sites.map(|v| v as u32);
        match power_sign(sites.map(at), sites.map(weight)) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if power_canonical(sites.map(at), sites.map(weight)) == Sign::Positive => {
                Verdict::Tie
            }
            _ => Verdict::Right,
        }
    };
    let (mut faults, left) = examine(given, expected, judge, watch)?;
    let mut hidden = Vec::new();
    if faults == Findings3::default() {
        let beyond = |corners: [u32; 4], k: usize, p: u32| {
            let [a, b, c] = OUTWARD[k].map(|i| at(corners[i]));
            orient3d(a, b, c, at(p)) == Sign::Positive
        };
        let below = |[a, b, c, d]: [u32; 4], p: u32| {
            let sites = [a, b, c, d, p];
            power_canonical(sites.map(at), sites.map(weight)) == Sign::Positive
        };
        (hidden, faults.missing) = unused(given, &left, beyond, below, watch)?;
    }
    Ok(Checked {
        faults,
        hidden,
        stands_for,
    })
}
