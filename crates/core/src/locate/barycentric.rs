//! Barycentric coordinates of a point in a triangle, accurate at large offsets and in thin
//! triangles.
//!
//! They are exact at corners, and zero opposite the edges that contain the point (A. F. Möbius,
//! 1827).

use delone_predicates::Point2;
use num_bigint::BigInt;

use super::cross::{certain, plain};
use super::range::seen_from;
use super::star::Place;
use super::tiling::{next, prev};
use crate::base::arrays::Triangles;
use crate::base::wide::{lowest, ratio, scaled};

/// Areas below this may have lost digits to underflow.
const LEAST: f64 = 1e-250;

/// The weights of the corners of the triangle at `place` for `q`: nonnegative, with sum 1.
#[inline]
pub fn barycentric(given: &Triangles, place: &Place, q: Point2) -> [f64; 3] {
    let corners = given.corners(place.simplex);
    weights(corners, place.on, q)
}

/// The same for given corners; `on` tells on which edges `q` is exactly.
#[inline]
pub fn weights(corners: [Point2; 3], on: [bool; 3], q: Point2) -> [f64; 3] {
    // No arithmetic at a corner: at a tiny edge of a huge triangle it would vanish.
    match on {
        [false, true, true] => return [1.0, 0.0, 0.0],
        [true, false, true] => return [0.0, 1.0, 0.0],
        [true, true, false] => return [0.0, 0.0, 1.0],
        _ => {}
    }
    let (relative, unit) = seen_from(q, corners);
    let mut areas = [0.0; 3];
    for k in 0..3 {
        areas[k] = plain(relative[next(k)], relative[prev(k)]).unwrap_or(f64::NAN); // not accurate
    }
    let sum = areas[0] + areas[1] + areas[2];
    if sum.is_nan() || sum <= LEAST || on != [false; 3] || areas.iter().any(|&a| a < 0.0) {
        return with_care(corners, relative, unit, on, q);
    }
    areas.map(|a| a / sum)
}

#[inline(never)]
fn with_care(
    corners: [Point2; 3],
    relative: [Point2; 3],
    unit: f64,
    on: [bool; 3],
    q: Point2,
) -> [f64; 3] {
    if on != [false; 3] {
        return along_edge(corners, on, q);
    }
    let mut areas = [0.0; 3];
    for (k, area) in areas.iter_mut().enumerate() {
        let (i, j) = (next(k), prev(k));
        *area = match plain(relative[i], relative[j]) {
            Some(area) if area > LEAST => area,
            _ if unit == 1.0 => match certain(q, corners[i], corners[j]) {
                Some(area) => area.max(0.0),
                None => return exact(corners, on, q),
            },
            _ => return exact(corners, on, q),
        };
    }
    let sum = areas[0] + areas[1] + areas[2];
    areas.map(|a| a / sum)
}

/// The weights from areas in integers, if doubles are uncertain.
#[cold]
fn exact(corners: [Point2; 3], on: [bool; 3], q: Point2) -> [f64; 3] {
    let low = lowest(&[corners[0], corners[1], corners[2], q], &[]);
    let relative = corners.map(|p| [0, 1].map(|k| scaled(p[k], low) - scaled(q[k], low)));
    let areas: [BigInt; 3] = std::array::from_fn(|k| {
        let (a, b) = (&relative[next(k)], &relative[prev(k)]);
        (&a[0] * &b[1] - &a[1] * &b[0]).max(BigInt::ZERO)
    });
    let sum = &areas[0] + &areas[1] + &areas[2];
    if sum == BigInt::ZERO {
        return along_edge(corners, on, q);
    }
    areas.map(|area| ratio(&area, &sum, 0).unwrap_or(0.0))
}

/// The weights on the edge that contains the point; in a degenerate triangle, on the longest edge.
#[cold]
fn along_edge(corners: [Point2; 3], on: [bool; 3], q: Point2) -> [f64; 3] {
    let k = (0..3)
        .find(|&i| on[i])
        .unwrap_or_else(|| opposite_longest(corners, q));
    let [du, dv] = distances(corners[next(k)], corners[prev(k)], q);
    let mut weights = [0.0; 3];
    weights[next(k)] = if du + dv > 0.0 { dv / (du + dv) } else { 1.0 };
    weights[prev(k)] = 1.0 - weights[next(k)];
    weights
}

fn opposite_longest(corners: [Point2; 3], q: Point2) -> usize {
    let (relative, _) = seen_from(q, corners);
    let length = |k: usize| {
        let (u, v) = (relative[next(k)], relative[prev(k)]);
        (v[0] - u[0]).hypot(v[1] - u[1])
    };
    let longer = |k: usize, i: usize| if length(i) > length(k) { i } else { k };
    longer(longer(0, 1), 2)
}

/// The distances of `q` from two points with which it is collinear, up to a common factor: along the
/// axis on which these are further apart. The other axis may be larger by all powers of two that
/// there are, and a common unit would make these distances zero.
fn distances(u: Point2, v: Point2, q: Point2) -> [f64; 2] {
    let apart = [0, 1].map(|axis| (u[axis] - v[axis]).abs());
    let axis = usize::from(apart[1] > apart[0]);
    // Differences of small numbers are exact, those of large ones must not overflow.
    let unit = if apart[axis] < 1e300 { 1.0 } else { 0.125 };
    [u, v].map(|end| (q[axis] * unit - end[axis] * unit).abs())
}
