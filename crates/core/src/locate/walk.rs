//! The walk through exported arrays to the triangle that contains a point.
//!
//! The remembering visibility walk (O. Devillers, S. Pion and M. Teillaud, "Walking in a
//! triangulation", 2002) crosses an edge that has the point on its other side. It terminates on
//! Delaunay triangulations; on others it may cycle, so it has a budget, and then the straight walk
//! takes over, which visits each triangle on a line once.

use delone_predicates::{Point2, Sign, orient2d};

use super::straight::{End, Trace};
use super::tiling::{Side, next, prev};
use crate::arrays::Triangles;
use crate::error::Result;

/// The end of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// In a triangle whose closed area contains the point, which is on the edges opposite these
    /// corners.
    Inside(usize, [bool; 3]),
    /// At a boundary edge that has the point strictly outside.
    Beyond(Side),
}

/// Steps of the visibility walk before the straight walk takes over: several times what a walk
/// across a whole mesh of uniform points needs.
fn budget(triangles: usize) -> usize {
    64 + 8 * triangles.isqrt()
}

/// Walks from triangle `from` to `q`.
#[inline]
pub fn walk(given: &Triangles, from: usize, q: Point2) -> Result<Found> {
    match visibility(given, from, q, budget(given.simplices.len())) {
        Some(found) => Ok(found),
        None => straight(given, from, q),
    }
}

/// On which side of the directed edge from `a` to `b` the point is.
#[inline]
fn side_of(a: Point2, b: Point2, q: Point2) -> Sign {
    orient2d(a, b, q)
}

/// The visibility walk, unless it needs more than `budget` steps.
#[inline]
pub fn visibility(given: &Triangles, from: usize, q: Point2, budget: usize) -> Option<Found> {
    let [a, b, c] = given.corners(from);
    let signs = [side_of(b, c, q), side_of(c, a, q), side_of(a, b, q)];
    let Some(k) = signs.iter().position(|&s| s == Sign::Negative) else {
        return Some(Found::Inside(from, signs.map(|s| s == Sign::Zero)));
    };
    // The walk leaves `at` across the edge from u to v.
    let mut at = Side {
        triangle: from,
        corner: k,
    };
    let corners = [a, b, c];
    let (mut u, mut v) = (corners[next(k)], corners[prev(k)]);
    for _ in 0..budget {
        let Some(side) = given.beyond(at) else {
            return Some(Found::Beyond(at));
        };
        let w = given.point(given.vertex(side));
        touch(given, side);
        let (left, right) = (side_of(u, w, q), side_of(w, v, q));
        let turns_left = left == Sign::Negative;
        if !turns_left && right != Sign::Negative {
            let mut on = [false; 3];
            on[next(side.corner)] = left == Sign::Zero;
            on[prev(side.corner)] = right == Sign::Zero;
            return Some(Found::Inside(side.triangle, on));
        }
        // Selections instead of branches, which would be unpredictable.
        at.corner = if turns_left {
            next(side.corner)
        } else {
            prev(side.corner)
        };
        (u, v) = (select(turns_left, u, w), select(turns_left, w, v));
        at.triangle = side.triangle;
    }
    None
}

/// Loads the vertices of the two triangles that may be next, so that distant memory arrives while
/// the signs are computed: a tenth of the time if the points are unsorted. If an edge has different
/// rows on its sides, other points may be loaded; nothing depends on it.
#[inline]
fn touch(given: &Triangles, side: Side) {
    let sum = |s: &[i32; 3]| s[0].wrapping_add(s[1]).wrapping_add(s[2]);
    let here = &given.simplices[side.triangle];
    for k in [next(side.corner), prev(side.corner)] {
        let beyond = given.neighbors[side.triangle][k];
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
pub fn straight(given: &Triangles, from: usize, q: Point2) -> Result<Found> {
    let mut trace = Trace::from_corner(
        given,
        Side {
            triangle: from,
            corner: 0,
        },
        q,
    );
    let end = trace.run(|_| ())?;
    Ok(match end {
        End::Reached(t) => {
            let [a, b, c] = given.corners(t);
            let on = [side_of(b, c, q), side_of(c, a, q), side_of(a, b, q)];
            Found::Inside(t, on.map(|s| s == Sign::Zero))
        }
        End::Left(side) => Found::Beyond(side),
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
        let (q, expected) = ([0.1, 0.03], Ok(Found::Inside(0, [false; 3])));
        let mut circles = 0;
        for from in 0..simplices.len() {
            circles += usize::from(visibility(&given, from, q, 1000).is_none());
            assert_eq!(walk(&given, from, q), expected);
            assert_eq!(straight(&given, from, q), expected);
        }
        assert!(circles > 0);
    }
}
