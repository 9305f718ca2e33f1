//! Barycentric coordinates of a point in a tetrahedron, accurate at large offsets and in slivers.
//!
//! They are exact at corners, and zero opposite the faces that contain the point.
//!
//! Each weight is a volume over the sum of all four. A volume that cancels in plain floating point
//! is computed in double-double arithmetic (T. J. Dekker, "A floating-point technique for extending
//! the available precision", 1971), and in integers if that does not suffice. Weights do not change
//! when an axis is scaled, so each axis gets its own unit, in which nothing overflows or
//! underflows.

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use super::Place;
use crate::base::arrays::Tetrahedra;
use crate::base::wide::{ratio, scaled};

/// Ratio of the magnitude of the products to the volume above which plain floating point does not
/// suffice: about 1e-14 is left. The same for double-double arithmetic, which leaves about 2^-50 of
/// 2^-50.
const THIN: f64 = 16.0;
const THINNEST: f64 = (1u64 << 48) as f64;
/// Differences within these bounds are not scaled: their third powers are doubles, and their
/// products lose nothing to underflow.
const SAFE: std::ops::Range<f64> = 1e-80..1e80;

/// The weights of the corners of the tetrahedron at `place` for `q`: nonnegative, with sum 1.
pub fn barycentric(given: &Tetrahedra, place: &Place, q: Point3) -> [f64; 4] {
    if let Some(corner) = place.site() {
        let mut weights = [0.0; 4];
        weights[corner] = 1.0;
        return weights;
    }
    let corners = given.corners(place.simplex);
    weights(corners, place.on, q)
}

/// The same for given corners; `on` tells on which faces `q` is exactly.
fn weights(corners: [Point3; 4], on: [bool; 4], q: Point3) -> [f64; 4] {
    let seen = corners.map(|p| [0, 1, 2].map(|k| p[k] - q[k]));
    let least = |least: f64, x: &f64| if *x == 0.0 { least } else { least.min(x.abs()) };
    let most = |most: f64, x: &f64| most.max(x.abs());
    let flat = seen.as_flattened();
    let range = flat.iter().fold(f64::MAX, least)..flat.iter().fold(0.0, most);
    if !SAFE.contains(&range.start) || !SAFE.contains(&range.end) {
        return exactly(corners, on, q);
    }
    let mut volumes = [0.0; 4];
    for k in (0..4).filter(|&k| !on[k]) {
        let others = without(&seen, k);
        let Some(volume) = plain(others).or_else(|| paired(without(&corners, k), q)) else {
            return exactly(corners, on, q);
        };
        // The volumes from a face to the point are positive up to the sign of the permutation.
        volumes[k] = if k % 2 == 0 { volume } else { -volume };
    }
    let sum: f64 = volumes.iter().sum();
    if volumes.iter().any(|&v| v < 0.0) || sum.is_nan() || sum <= 0.0 {
        return exactly(corners, on, q);
    }
    volumes.map(|v| v / sum)
}

/// The other three.
fn without<T: Copy>(corners: &[T; 4], k: usize) -> [T; 3] {
    [0, 1, 2].map(|i| corners[i + usize::from(i >= k)])
}

/// The determinant of three vectors; `None` if it is too small compared with its products.
fn plain([a, b, c]: [Point3; 3]) -> Option<f64> {
    let products = [
        (a[0], b[1] * c[2], b[2] * c[1]),
        (a[1], b[2] * c[0], b[0] * c[2]),
        (a[2], b[0] * c[1], b[1] * c[0]),
    ];
    let volume: f64 = products.iter().map(|(x, p, m)| x * (p - m)).sum();
    let size: f64 = products
        .iter()
        .map(|(x, p, m)| x.abs() * (p.abs() + m.abs()))
        .sum();
    (volume.abs() * THIN >= size).then_some(volume)
}

/// The same for three points relative to `q`, in double-double arithmetic.
#[cold]
fn paired(corners: [Point3; 3], q: Point3) -> Option<f64> {
    let [a, b, c] = corners.map(|p| [0, 1, 2].map(|k| Pair::difference(p[k], q[k])));
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    let volume = a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1);
    let size = |i: usize, j: usize| (b[i].hi * c[j].hi).abs() + (b[j].hi * c[i].hi).abs();
    let size = a[0].hi.abs() * size(1, 2) + a[1].hi.abs() * size(2, 0) + a[2].hi.abs() * size(0, 1);
    let volume = volume.hi + volume.lo;
    (volume.abs() * THINNEST >= size).then_some(volume)
}

/// The weights, each rounded once.
#[cold]
#[inline(never)]
fn exactly(corners: [Point3; 4], on: [bool; 4], q: Point3) -> [f64; 4] {
    let low = crate::base::wide::lowest(&[corners.as_slice(), &[q]].concat(), &[]);
    let integer = |p: Point3| p.map(|x| scaled(x, low));
    let q = integer(q);
    let seen = corners.map(|p| {
        let p = integer(p);
        [0, 1, 2].map(|k| &p[k] - &q[k])
    });
    let volumes: [BigInt; 4] = std::array::from_fn(|k| {
        let [a, b, c] = [0, 1, 2].map(|i| &seen[i + usize::from(i >= k)]);
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        let volume = &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
        if k % 2 == 0 { volume } else { -volume }
    });
    let sum: BigInt = volumes.iter().sum();
    std::array::from_fn(|k| {
        if on[k] {
            0.0
        } else {
            ratio(&volumes[k], &sum, 0).unwrap_or(0.0)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Point3; 4] = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [0.0, 0.0, 4.0],
    ];

    #[test]
    fn weights_are_those_of_the_definition_at_every_scale() {
        for scale in [1.0, 1e-300, 1e300, 5e-324] {
            let corners = CORNERS.map(|p| p.map(|x| x * scale));
            let q = [scale, scale, 0.0];
            assert_eq!(
                weights(corners, [false, false, false, true], q),
                [0.5, 0.25, 0.25, 0.0]
            );
        }
        let wide = CORNERS.map(|p| [p[0], p[1] * 1e-200, p[2] * 1e-200]);
        let q = [1.0, 1e-200, 1e-200];
        for (w, e) in weights(wide, [false; 4], q).into_iter().zip([0.25; 4]) {
            assert!((w - e).abs() < 1e-15);
        }
    }

    #[test]
    fn slivers_far_away_have_accurate_weights() {
        let at = [4e6, 5e5, 1e3];
        let unit = 2f64.powi(-30);
        let corners = [
            at,
            [at[0] + 8.0, at[1], at[2]],
            [at[0], at[1] + 8.0, at[2]],
            [at[0] + 8.0, at[1] + 8.0, at[2] + 4.0 * unit],
        ];
        let q = [at[0] + 4.0, at[1] + 4.0, at[2] + unit];
        let found = weights(corners, [false; 4], q);
        let expected = [0.25; 4];
        assert_eq!(found, expected);
    }
}
