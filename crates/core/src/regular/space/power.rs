//! The predicate of weighted sites in 3-D: whether a lifted site is below the hyperplane of four.
//!
//! A site p of weight w is lifted to the height |p|^2 - w; the regular triangulation is the lower
//! hull of the lifted sites. With A = a - e and alpha = |A|^2 - w(a) + w(e), and likewise for b, c
//! and d, e lies below the hyperplane of a, b, c and d (positively oriented) if alpha [B, C, D] -
//! beta [A, C, D] + gamma [A, B, D] - delta [A, B, C] is positive.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53 and P the sum of the magnitudes of the monomials. Each goes through 15 roundings,
//! as in the in-sphere test, and one more for the sum with the difference of weights: 18 u P leaves
//! room. The filter is used only if all magnitudes are between 2^-200 and 2^200 or zero,
//! so that nothing overflows or underflows. Arbitrary-precision integers decide what it cannot.
//!
//! # Ties
//!
//! The height of each site is lowered by an infinitesimal, infinitely larger for a
//! lexicographically smaller site: the sign of a tie is that of the first site, in this order,
//! whose cofactor, the orientation of the other four, is not zero.

use delone_predicates::{Point3, Sign, lexicographic, orient3d};
use num_bigint::BigInt;

use crate::base::wide::{determinant, lowest, scaled, sign};

const BOUND: f64 = 18.0 * f64::EPSILON / 2.0;
/// 2^-200 and 2^200.
const RANGE: (f64, f64) = (
    f64::from_bits((1023 - 200) << 52),
    f64::from_bits((1023 + 200) << 52),
);

/// Whether the fifth site is below the hyperplane of the other four, lifted to |p|^2 - w: positive
/// if it is, for positively oriented corners.
pub fn power_sign(points: [Point3; 5], weights: [f64; 5]) -> Sign {
    filter(points, weights).unwrap_or_else(|| exact(points, weights))
}

/// Like [`power_sign`], with ties broken by coordinates; zero only if all five sites are coplanar.
pub fn power_canonical(points: [Point3; 5], weights: [f64; 5]) -> Sign {
    match power_sign(points, weights) {
        Sign::Zero => tie(points),
        sign => sign,
    }
}

#[inline]
fn filter([a, b, c, d, e]: [Point3; 5], w: [f64; 5]) -> Option<Sign> {
    let [a, b, c, d] = [a, b, c, d].map(|p| [p[0] - e[0], p[1] - e[1], p[2] - e[2]]);
    let extra = [w[4] - w[0], w[4] - w[1], w[4] - w[2], w[4] - w[3]];
    let inside = |x: &f64| *x == 0.0 || (x.abs() > RANGE.0 && x.abs() < RANGE.1);
    let all = [a, b, c, d];
    if !all.as_flattened().iter().chain(&extra).all(inside) {
        return None;
    }
    let length = |p: Point3| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    let products = |p: Point3, q: Point3| (p[0] * q[1], p[1] * q[0]);
    let minor = |(x, y): (f64, f64)| x - y;
    let size = |(x, y): (f64, f64)| x.abs() + y.abs();
    let (ab, bc, cd) = (products(a, b), products(b, c), products(c, d));
    let (da, ac, bd) = (products(d, a), products(a, c), products(b, d));
    let bcd = b[2] * minor(cd) - c[2] * minor(bd) + d[2] * minor(bc);
    let acd = c[2] * minor(da) + d[2] * minor(ac) + a[2] * minor(cd);
    let abd = d[2] * minor(ab) + a[2] * minor(bd) + b[2] * minor(da);
    let abc = a[2] * minor(bc) - b[2] * minor(ac) + c[2] * minor(ab);
    let lengths = [a, b, c, d].map(length);
    let heights = [0, 1, 2, 3].map(|i| lengths[i] + extra[i]);
    let det = (heights[0] * bcd - heights[1] * acd) + (heights[2] * abd - heights[3] * abc);
    let sizes = [0, 1, 2, 3].map(|i| lengths[i] + extra[i].abs());
    let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].abs());
    let permanent = sizes[0] * (bz * size(cd) + cz * size(bd) + dz * size(bc))
        + sizes[1] * (cz * size(da) + dz * size(ac) + az * size(cd))
        + sizes[2] * (dz * size(ab) + az * size(bd) + bz * size(da))
        + sizes[3] * (az * size(bc) + bz * size(ac) + cz * size(ab));
    (det.abs() > BOUND * permanent).then(|| Sign::of(det))
}

#[cold]
#[inline(never)]
fn exact(points: [Point3; 5], weights: [f64; 5]) -> Sign {
    let low = lowest(&points, &weights);
    let at = points.map(|p| p.map(|x| scaled(x, low)));
    let scaled_weights = weights.map(|w| scaled(w, 2 * low));
    let seen: [[BigInt; 3]; 4] = std::array::from_fn(|i| [0, 1, 2].map(|k| &at[i][k] - &at[4][k]));
    let height = |i: usize| {
        let [x, y, z] = &seen[i];
        x * x + y * y + z * z + &scaled_weights[4] - &scaled_weights[i]
    };
    let det = |i: usize, j: usize, k: usize| determinant([&seen[i], &seen[j], &seen[k]]);
    let positive = height(0) * det(1, 2, 3) + height(2) * det(0, 1, 3);
    sign(&(positive - height(1) * det(0, 2, 3) - height(3) * det(0, 1, 2)))
}

/// The sign of a tie of five sites whose lifts are on one hyperplane.
#[cold]
fn tie(mut points: [Point3; 5]) -> Sign {
    let mut odd = false;
    for i in 1..5 {
        for j in (1..=i).rev() {
            if lexicographic(points[j], points[j - 1]).is_lt() {
                points.swap(j - 1, j);
                odd = !odd;
            }
        }
    }
    for k in 0..5 {
        let mut others = [[0.0; 3]; 4];
        for (slot, i) in others.iter_mut().zip((0..5).filter(|&i| i != k)) {
            *slot = points[i];
        }
        let [a, b, c, d] = others;
        let turn = orient3d(a, b, c, d);
        if turn != Sign::Zero {
            // The last site is lowered into the sphere; each swap of rows flips the sign.
            return turn.flip_if((k % 2 == 1) != odd);
        }
    }
    Sign::Zero
}

#[cfg(test)]
mod tests {
    use super::*;
    use delone_predicates::{insphere, insphere_canonical};

    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 3_u64;
        move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn equal_weights_change_nothing() {
        let mut next = numbers();
        for i in 0..4000 {
            // Few distinct coordinates, so that there are many ties.
            let steps = if i % 2 == 0 { 3.0 } else { 1e6 };
            let p = [(); 5].map(|()| [(); 3].map(|()| (next() * steps).floor()));
            let [a, b, c, d, e] = p;
            assert_eq!(power_sign(p, [2.5; 5]), insphere(a, b, c, d, e));
            let distinct = (0..5).all(|i| (0..i).all(|j| p[i] != p[j]));
            if distinct && orient3d(a, b, c, d) != Sign::Zero {
                let found = power_canonical(p, [0.0; 5]);
                assert_eq!(found, insphere_canonical(a, b, c, d, e), "{p:?}");
            }
        }
    }

    #[test]
    fn the_filter_agrees_with_integers() {
        let mut next = numbers();
        let mut sure = 0;
        for _ in 0..2000 {
            let points = [(); 5].map(|()| [(); 3].map(|()| next()));
            let weights = [(); 5].map(|()| 0.2 * next());
            if let Some(sign) = filter(points, weights) {
                sure += 1;
                assert_eq!(sign, exact(points, weights));
            }
        }
        assert!(sure > 1900);
    }
}
