//! Signs of determinants: exact, canonical, and in plain floating point.

use delone_predicates::{incircle, incircle_canonical, orient2d};
use wasm_bindgen::prelude::*;

use crate::answer::pairs;

/// For each three points, the orientation; `naive` computes in plain floating point.
#[wasm_bindgen]
pub fn orientations(coordinates: &[f64], naive: bool) -> Vec<i8> {
    let each = |&[a, b, c]: &[[f64; 2]; 3]| {
        if naive {
            sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        } else {
            orient2d(a, b, c) as i8
        }
    };
    pairs(coordinates).as_chunks().0.iter().map(each).collect()
}

/// For each four points, the sign of the in-circle determinant.
#[wasm_bindgen]
pub fn incircles(coordinates: &[f64], naive: bool) -> Vec<i8> {
    let each = |&[a, b, c, d]: &[[f64; 2]; 4]| {
        if naive {
            sign(plain_incircle([a, b, c], d))
        } else {
            incircle(a, b, c, d) as i8
        }
    };
    pairs(coordinates).as_chunks().0.iter().map(each).collect()
}

/// For each four points, the sign with ties broken as in triangulations.
#[wasm_bindgen]
pub fn incircles_canonical(coordinates: &[f64]) -> Vec<i8> {
    let each = |&[a, b, c, d]: &[[f64; 2]; 4]| incircle_canonical(a, b, c, d) as i8;
    pairs(coordinates).as_chunks().0.iter().map(each).collect()
}

fn plain_incircle(corners: [[f64; 2]; 3], d: [f64; 2]) -> f64 {
    let [a, b, c] = corners.map(|p| [p[0] - d[0], p[1] - d[1]]);
    let lift = |p: [f64; 2]| p[0] * p[0] + p[1] * p[1];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    lift(a) * cross(b, c) + lift(b) * cross(c, a) + lift(c) * cross(a, b)
}

/// The sign of a result, 0 for NaN.
fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}
