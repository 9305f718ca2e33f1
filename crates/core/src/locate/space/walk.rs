//! The walk through exported arrays to the tetrahedron that contains a point.
//!
//! The remembering visibility walk (O. Devillers, S. Pion and M. Teillaud, "Walking in a
//! triangulation", 2002) crosses a face that has the point on its other side. On Delaunay
//! triangulations the power of the point with respect to the circumspheres decreases at each step,
//! so it terminates; on others it may cycle, so it has a budget, and then a tree of boxes is used.

use delone_predicates::{Point3, Sign, orient3d};

use super::{Located, Place};
use crate::base::arrays::{Side, Tetrahedra};

/// Steps before the walk gives up: several times what a walk across a whole mesh of uniform points
/// needs, which is a multiple of the cube root; here of a power of two above it, which is found
/// faster.
fn budget(simplices: usize) -> usize {
    256 + (16 << ((simplices | 1).ilog2() / 3 + 1))
}

/// On which side of the face opposite each corner of a tetrahedron `q` is: positive is inside.
#[inline]
pub fn sides_of([a, b, c, d]: [Point3; 4], q: Point3) -> [Sign; 4] {
    [
        orient3d(q, b, c, d),
        orient3d(a, q, c, d),
        orient3d(a, b, q, d),
        orient3d(a, b, c, q),
    ]
}

/// Walks from tetrahedron `from` to `q`; ends outside without a face if the budget is exhausted.
#[inline]
pub fn walk(given: &Tetrahedra, from: usize, q: Point3) -> Located {
    let sides = sides_of(given.corners(from), q);
    let Some(corner) = sides.iter().position(|&s| s == Sign::Negative) else {
        return Located::Inside(Place::of(from, sides));
    };
    let simplex = from;
    let mut at = Side { simplex, corner };
    'walk: for _ in 0..budget(given.simplices.len()) {
        let Some(side) = given.beyond(at) else {
            return Located::Outside(Some(at));
        };
        let corners = given.corners(side.simplex);
        // The point is on the inner side of the face through which the walk came.
        let mut signs = [Sign::Positive; 4];
        for k in 1..4 {
            let corner = (side.corner + k) % 4;
            let mut with = corners;
            with[corner] = q;
            let [a, b, c, d] = with;
            signs[corner] = orient3d(a, b, c, d);
            if signs[corner] == Sign::Negative {
                at = Side { corner, ..side };
                continue 'walk;
            }
        }
        return Located::Inside(Place::of(side.simplex, signs));
    }
    Located::Outside(None)
}
