//! The visibility walk through exported arrays to the simplex that contains a point.
//!
//! Inverting the matrix of each simplex takes most of the time of a walk. So all steps but the first
//! and the last replace one corner in the inverse of the simplex before, as the simplex method does. Roundings
//! add up in that, so it only proposes a simplex: there the walk goes on with certain signs.

use delone_predicates::Sign;

use super::filter::Matrix;
use super::simplex;
use crate::base::arrays::{Given, Side};
use crate::locate::{Located, Place};

/// Steps before a walk gives up, times the number of simplices along an axis. A visibility walk
/// ends in a Delaunay triangulation; in other arrays it may not.
const BUDGET: usize = 1 << 8;

/// A barycentric coordinate below minus this is negative, whatever the roundings of many steps are.
const NEAR: f64 = 1e-6;

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
    for step in 0..BUDGET << along {
        let corners = given.corners(simplex);
        let (l, bound, inverse) = simplex::rough::<D, N, P>(&corners, q);
        let corner = least(&l);
        // Comparisons that NaN fails.
        if l[corner] > bound {
            let on = [Sign::Positive; N];
            return Located::Inside(Place::of(simplex, on));
        }
        let mut at = Side { simplex, corner };
        let certain = l[corner] < -bound;
        if !certain {
            let signs = simplex::sides::<D, N, P>(&corners, q);
            match signs.iter().position(|&side| side == Sign::Negative) {
                None => return Located::Inside(Place::of(simplex, signs)),
                Some(k) => at.corner = k,
            }
        } else if step == 0 {
            simplex = hurry(given, at, q, l, inverse, BUDGET << along);
            if simplex != from {
                continue;
            }
        }
        match given.beyond(at) {
            None => return Located::Outside(Some(at)),
            Some(side) => simplex = side.simplex,
        }
    }
    Located::Outside(None)
}

/// The number of the least coordinate.
#[inline(always)]
fn least<const N: usize>(l: &[f64; N]) -> usize {
    let mut corner = 0;
    for k in 1..N {
        if l[k] < l[corner] {
            corner = k;
        }
    }
    corner
}

/// Walks across a facet and on, as long as rounded coordinates `l` show the way, and returns the simplex
/// where it ends. The columns of `b` are the gradients of all coordinates except the first. At most
/// `budget` steps.
#[inline(always)]
pub fn hurry<const D: usize, const N: usize, const P: usize>(
    given: &Given<D, N>,
    mut at: Side,
    q: &[f64; D],
    mut l: [f64; N],
    mut b: Matrix<D, P>,
    budget: usize,
) -> usize {
    // The vertices that `l` and `b` belong to, in an order of their own, and the one to replace.
    let mut corners = given.simplices[at.simplex];
    let mut k = at.corner;
    for _ in 0..budget {
        let Some(beyond) = given.beyond(at) else {
            break;
        };
        let next = given.simplices[beyond.simplex];
        let new = next[beyond.corner];
        let w = given.point(new);
        // The coordinates of the new vertex, without the first.
        let mut of_new = [0.0; P];
        of_new[..D].copy_from_slice(&l[1..]);
        let (mut rest, mut gradient) = (1.0, [0.0; D]);
        for row in 0..D {
            let way = w[row] - q[row];
            for j in 0..P {
                of_new[j] += b[row][j] * way;
            }
        }
        for j in 0..D {
            rest -= of_new[j];
        }
        // That of the vertex it replaces is negative, and so is that of q: their quotient is that of q
        // for the new vertex.
        let f = 1.0 / if k == 0 { rest } else { of_new[k - 1] };
        for row in 0..D {
            let old: f64 = if k == 0 {
                -(0..D).map(|j| b[row][j]).sum::<f64>()
            } else {
                b[row][k - 1]
            };
            gradient[row] = old * f;
            for j in 0..P {
                b[row][j] -= of_new[j] * gradient[row];
            }
            if k > 0 {
                b[row][k - 1] = gradient[row];
            }
        }
        let share = l[k] * f;
        for i in 1..N {
            l[i] -= of_new[i - 1] * share;
        }
        l[k] = share;
        l[0] = 1.0;
        for i in 1..N {
            l[0] -= l[i];
        }
        corners[k] = new;
        at.simplex = beyond.simplex;
        k = least(&l);
        // A comparison that NaN fails.
        if l[k] < -NEAR {
            let corner: usize = (1..N).map(|j| j * usize::from(next[j] == corners[k])).sum();
            at.corner = corner.min(N - 1);
        } else {
            break;
        }
    }
    at.simplex
}
