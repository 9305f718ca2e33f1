//! Exact validation of a 3-D regular triangulation; see `regular::validate`, which
//! explains why the checks suffice.

use delone_predicates::{Sign, orient3d};

use super::power::{power_canonical, power_sign};
use crate::base::arrays::{OUTWARD, Tetrahedra};
use crate::base::error::Result;
use crate::base::points;
use crate::base::proof::Verdict;
use crate::base::watch::Watch;
use crate::order::space::arrange;
use crate::regular::{Checked, checked, heaviest};

/// Checks everything that makes `given` the canonical regular triangulation of its points, with one
/// finite weight for each.
pub fn validate(given: Tetrahedra, weights: &[f64], watch: &Watch) -> Result<Checked<3>> {
    points::scan(given.points)?;
    let arranged = arrange(given.points, watch)?;
    let at = |v: u32| given.points[v as usize];
    let weight = |v: u32| weights[v as usize];
    let is_below =
        |sites: [u32; 5]| power_canonical(sites.map(at), sites.map(weight)) == Sign::Positive;
    let judge = |t: usize, _, apex: i32| {
        let [a, b, c, d] = given.simplices[t];
        let sites = [a, b, c, d, apex].map(|v| v as u32);
        match power_sign(sites.map(at), sites.map(weight)) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if is_below(sites) => Verdict::Tie,
            _ => Verdict::Right,
        }
    };
    let beyond = |corners: [u32; 4], k: usize, p: u32| {
        let [a, b, c] = OUTWARD[k].map(|i| at(corners[i]));
        orient3d(a, b, c, at(p)) == Sign::Positive
    };
    let below = |[a, b, c, d]: [u32; 4], p: u32| is_below([a, b, c, d, p]);
    let own = heaviest(weights, &arranged.rows, &arranged.duplicates)?;
    checked(given, own, judge, (beyond, below), watch)
}
