//! The visibility walk through exported arrays to the simplex that contains a point.

use delone_predicates::Sign;

use super::simplex;
use crate::base::arrays::{Given, Side};
use crate::locate::{Located, Place};

/// Steps before a walk gives up, times the number of simplices along an axis. A visibility walk
/// ends in a Delaunay triangulation; in other arrays it may not.
const BUDGET: usize = 1 << 8;

/// Walks from simplex `from` to `q`, each time across the facet opposite the least barycentric
/// coordinate; ends outside without a facet if the budget is exhausted.
#[inline(always)]
pub fn walk<const D: usize, const N: usize, const P: usize>(
    given: &Given<D, N>,
    from: usize,
    q: &[f64; D],
) -> Located<N> {
    let along = (given.simplices.len() | 1).ilog2() as usize / D + 1;
    let mut simplex = from;
    for _ in 0..BUDGET << along {
        let corners = given.corners(simplex);
        let (l, bound) = simplex::rough::<D, N, P>(&corners, q);
        let mut corner = 0;
        for k in 1..N {
            if l[k] < l[corner] {
                corner = k;
            }
        }
        // Comparisons that NaN fails.
        if l[corner] > bound {
            let on = [Sign::Positive; N];
            return Located::Inside(Place::of(simplex, on));
        }
        let certain = l[corner] < -bound;
        if !certain {
            let signs = simplex::sides::<D, N, P>(&corners, q);
            match signs.iter().position(|&side| side == Sign::Negative) {
                None => return Located::Inside(Place::of(simplex, signs)),
                Some(k) => corner = k,
            }
        }
        let at = Side { simplex, corner };
        match given.beyond(at) {
            None => return Located::Outside(Some(at)),
            Some(side) => simplex = side.simplex,
        }
    }
    Located::Outside(None)
}
