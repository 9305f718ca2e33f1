//! The walk through exported arrays to the triangle that contains a point.
//!
//! The remembering visibility walk (O. Devillers, S. Pion and M. Teillaud, "Walking in a
//! triangulation", 2002) crosses an edge that has the point on its other side. It terminates on
//! Delaunay triangulations; on others it may cycle, so it has a budget, and then the straight walk
//! takes over, which visits each triangle on a line once.

use delone_predicates::{Point2, Sign, orient2d};

use super::locator::Located;
use super::star::Place;
use super::straight::{End, Trace};
use super::tiling::{next, prev};
use crate::base::arrays::{Side, Triangles};
use crate::base::error::Result;

/// Steps of the visibility walk before the straight walk takes over: several times what a walk
/// across a whole mesh of uniform points needs, which is a multiple of the square root; here of a
/// power of two above it, which is found faster.
fn budget(triangles: usize) -> usize {
    64 + (8 << ((triangles | 1).ilog2() / 2 + 1))
}

/// On which side of the edge opposite each corner of a triangle `q` is: positive is inside. As a call
/// it would take a tenth of the time of a short walk.
#[inline(always)]
pub fn sides_of([a, b, c]: [Point2; 3], q: Point2) -> [Sign; 3] {
    [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)]
}

/// Walks from triangle `from` to `q`.
#[inline]
pub fn walk(given: &Triangles, from: usize, q: Point2) -> Result<Located> {
    match visibility(given, from, q, budget(given.simplices.len())) {
        Some(found) => Ok(found),
        None => straight(given, from, q),
    }
}

/// The visibility walk, unless it needs more than `budget` steps.
#[inline]
pub fn visibility(given: &Triangles, from: usize, q: Point2, budget: usize) -> Option<Located> {
    let corners = given.corners(from);
    let sides = sides_of(corners, q);
    let Some(corner) = sides.iter().position(|&s| s == Sign::Negative) else {
        return Some(Located::Inside(Place::of(from, sides)));
    };
    // The walk leaves `at` across the edge from u to v.
    let simplex = from;
    let mut at = Side { simplex, corner };
    let (mut u, mut v) = (corners[next(corner)], corners[prev(corner)]);
    for _ in 0..budget {
        let Some(side) = given.beyond(at) else {
            return Some(Located::Outside(Some(at)));
        };
        let w = given.at(side);
        touch(given, side);
        let (left, right) = (orient2d(u, w, q), orient2d(w, v, q));
        let turns_left = left == Sign::Negative;
        if !turns_left && right != Sign::Negative {
            let simplex = side.simplex;
            // Not by writing to memory, which could not be read as a whole at once.
            let (l, r) = (next(side.corner), prev(side.corner));
            let (on_l, on_r) = (left == Sign::Zero, right == Sign::Zero);
            let on = std::array::from_fn(|k| (on_l && k == l) || (on_r && k == r));
            return Some(Located::Inside(Place { simplex, on }));
        }
        // Selections instead of branches, which would be unpredictable.
        at.corner = if turns_left {
            next(side.corner)
        } else {
            prev(side.corner)
        };
        (u, v) = (select(turns_left, u, w), select(turns_left, w, v));
        at.simplex = side.simplex;
    }
    None
}

/// Loads the vertices of the two triangles that may be next, so that distant memory arrives while
/// the signs are computed: a tenth of the time if the points are unsorted. If an edge has different
/// rows on its sides, other points may be loaded; nothing depends on it.
#[inline]
fn touch(given: &Triangles, side: Side) {
    let sum = |s: &[i32; 3]| s[0].wrapping_add(s[1]).wrapping_add(s[2]);
    let here = &given.simplices[side.simplex];
    for k in [next(side.corner), prev(side.corner)] {
        let beyond = given.neighbors[side.simplex][k];
        if let Some(there) = given.simplices.get(beyond as usize) {
            let shared = sum(here).wrapping_sub(here[k]);
            let far = sum(there).wrapping_sub(shared);
            if let Some(p) = given.points.get(far as usize) {
                std::hint::black_box(p[0]);
            }
        }
    }
}

#[inline]
fn select(first: bool, a: Point2, b: Point2) -> Point2 {
    [0, 1].map(|k| if first { a[k] } else { b[k] })
}

/// The straight walk from the first corner of a triangle.
#[cold]
#[inline(never)]
pub fn straight(given: &Triangles, from: usize, q: Point2) -> Result<Located> {
    let (simplex, corner) = (from, 0);
    let end = Trace::from_corner(given, Side { simplex, corner }, q).run(|_| ())?;
    Ok(match end {
        End::Reached(t) => Located::Inside(Place::of(t, sides_of(given.corners(t), q))),
        End::Left(side) => Located::Outside(Some(side)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A center, two rings of points around it, the outer one rotated by a phase, and triangles
    /// (after L. De Floriani et al., 1991).
    fn pinwheel(phase: f64) -> (Vec<Point2>, Vec<[i32; 3]>, Vec<[i32; 3]>) {
        let turn = |r: f64, i: i32, phase: f64| {
            let angle = (f64::from(i) + phase) * std::f64::consts::TAU / 6.0;
            [r * angle.cos(), r * angle.sin()]
        };
        let mut points: Vec<Point2> = (0..6).map(|i| turn(1.0, i, 0.0)).collect();
        points.extend((0..6).map(|i| turn(4.0, i, phase)));
        points.push([0.0, 0.0]);
        let (mut simplices, mut neighbors) = (Vec::new(), Vec::new());
        for i in 0..6 {
            let (j, h) = ((i + 1) % 6, (i + 5) % 6);
            simplices.extend([[12, i, j], [i, i + 6, j], [j, i + 6, j + 6]]);
            neighbors.extend([
                [3 * i + 1, 3 * j, 3 * h],
                [3 * i + 2, 3 * i, 3 * h + 2],
                [-1, 3 * j + 1, 3 * i + 1],
            ]);
        }
        (points, simplices, neighbors)
    }

    #[test]
    fn the_straight_walk_ends_where_the_visibility_walk_cycles() {
        let (points, simplices, neighbors) = pinwheel(1.2);
        let given = Triangles {
            points: &points,
            simplices: &simplices,
            neighbors: &neighbors,
        };
        let (simplex, on) = (0, [false; 3]);
        let (q, expected) = ([0.1, 0.03], Ok(Located::Inside(Place { simplex, on })));
        let mut circles = 0;
        for from in 0..simplices.len() {
            circles += usize::from(visibility(&given, from, q, 1000).is_none());
            assert_eq!(walk(&given, from, q), expected);
            assert_eq!(straight(&given, from, q), expected);
        }
        assert!(circles > 0);
    }
}
