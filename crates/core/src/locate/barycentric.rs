//! Barycentric coordinates (A. F. Möbius, 1827) of a point in a triangle: accurate beside large
//! offsets and in thin triangles, exact at corners, and zero opposite the edges that hold the point.

use delone_predicates::Point2;

use super::cross::{accurate, plain};
use super::range::seen_from;
use super::star::Place;
use super::tiling::{next, prev};
use crate::delaunay2::validate::Given;

/// The weights of the corners of the triangle at `place` for `q`: not negative, of sum 1.
#[inline]
pub fn barycentric(given: &Given, place: &Place, q: Point2) -> [f64; 3] {
    let corners = given.corners(place.triangle);
    weights(corners, place.on, q)
}

/// The same for corners by themselves; `on` tells on which edges `q` is exactly.
#[inline]
pub fn weights(corners: [Point2; 3], on: [bool; 3], q: Point2) -> [f64; 3] {
    // At a corner no arithmetic is asked: beside a tiny edge of a huge triangle it would vanish.
    match on {
        [false, true, true] => return [1.0, 0.0, 0.0],
        [true, false, true] => return [0.0, 1.0, 0.0],
        [true, true, false] => return [0.0, 0.0, 1.0],
        _ => {}
    }
    let (seen, unit) = seen_from(q, corners);
    let mut areas = [0.0; 3];
    for k in 0..3 {
        areas[k] = plain(seen[next(k)], seen[prev(k)]).unwrap_or(f64::NAN); // not accurate
    }
    let sum = areas[0] + areas[1] + areas[2];
    if sum.is_nan() || sum <= 0.0 || on != [false; 3] || areas.iter().any(|&a| a < 0.0) {
        return with_care(corners, seen, unit, on, q);
    }
    areas.map(|a| a / sum)
}

#[inline(never)]
fn with_care(
    corners: [Point2; 3],
    seen: [Point2; 3],
    unit: f64,
    on: [bool; 3],
    q: Point2,
) -> [f64; 3] {
    let mut areas = [0.0; 3];
    for k in 0..3 {
        if on[k] {
            continue;
        }
        let (i, j) = (next(k), prev(k));
        let area = plain(seen[i], seen[j]).unwrap_or_else(|| {
            if unit == 1.0 {
                accurate(q, corners[i], corners[j])
            } else {
                accurate([0.0; 2], seen[i], seen[j])
            }
        });
        areas[k] = area.max(0.0);
    }
    let sum = areas[0] + areas[1] + areas[2];
    if sum > 0.0 {
        return areas.map(|a| a / sum);
    }
    along_edge(corners, on, q)
}

/// The weights on the edge that has the point, or in a triangle that no arithmetic of doubles tells
/// from its longest edge.
#[cold]
fn along_edge(corners: [Point2; 3], on: [bool; 3], q: Point2) -> [f64; 3] {
    let (mut seen, _) = seen_from(q, corners);
    let length = |k: usize| {
        let (u, v) = (seen[next(k)], seen[prev(k)]);
        (v[0] - u[0]).hypot(v[1] - u[1])
    };
    let mut k = 0;
    for i in 1..3 {
        if length(i) > length(k) {
            k = i;
        }
    }
    // The edge may be so short beside the triangle that it needs a unit of its own.
    if let Some(edge) = (0..3).find(|&i| on[i]) {
        k = edge;
        let (ends, _) = seen_from(q, [corners[next(k)], corners[prev(k)]]);
        [seen[next(k)], seen[prev(k)]] = ends;
    }
    let [du, dv] = [next(k), prev(k)].map(|i| seen[i][0].hypot(seen[i][1]));
    let mut weights = [0.0; 3];
    weights[next(k)] = if du + dv > 0.0 { dv / (du + dv) } else { 1.0 };
    weights[prev(k)] = 1.0 - weights[next(k)];
    weights
}
