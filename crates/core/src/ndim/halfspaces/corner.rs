//! The corner of a facet and the plane of its dual points: rounded once, or in rare cases twice.
//!
//! As in the proof of `ndim::fine`, x is refined with residuals in pairs of doubles, which err by
//! (12 D + 32) u^2 times the sum of their magnitudes (tails of products are sums: twice as long). If B
//! is an approximate inverse of the normals A, with |I - A B| <= defect, and r is the residual of x, then
//! the residual of x + B r is at most 2 defect |r|, including the rounding errors of B r. A coordinate
//! that is not known to much more than 53 bits, for example because it is zero, is computed in integers.

use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use super::sites::{SAFE, Sites, leveled};
use super::wrap::{Facet, Hull};
use crate::base::wide::ratio;
use crate::ndim::filter::{Inverse, LEAST_RESIDUAL, Matrix, ROUNDED, U, dot, invert_small};

/// A coordinate is rounded if its relative error is below this.
const CLOSE: f64 = 1e-19;

/// A point, infinite if there is none, and the plane of a facet: unit normal and offset.
pub type Corner<const D: usize, const V: usize> = ([f64; D], [f64; V]);

/// The corner of a facet. `None` if its vectors are not independent.
pub fn corner<const D: usize, const V: usize, const P: usize>(
    hull: &mut Hull<'_, D, V, P>,
    c: u32,
) -> Option<Corner<D, V>> {
    let is_bounded = hull.side(c, hull.sites.len()) < 0;
    if is_bounded
        && let Facet { vertices, .. } = hull.facets[c as usize]
        && let Some(x) = refined::<D, V, P>(&hull.sites, &vertices)
    {
        let p = &hull.sites.point;
        let step: [f64; D] = std::array::from_fn(|k| (x[k] - Pair::from_double(p[k])).hi);
        return Some((x.map(|x| x.hi), equation(step, 1.0)));
    }
    let normal = hull.normal(c)?.wide();
    let point = std::array::from_fn(|k| {
        let known = is_bounded
            .then(|| ratio(&normal[k], &normal[D], 0))
            .flatten();
        known.unwrap_or(f64::INFINITY)
    });
    let (step, end) = hull.sites.step(&normal);
    let most = step
        .iter()
        .map(|x| BigInt::from(x.magnitude().clone()))
        .max()?;
    let share = |x: &BigInt| ratio(x, &most, 0).unwrap_or(f64::MAX);
    let shares: [f64; D] = std::array::from_fn(|k| share(&step[k]));
    Some((point, equation(shares, share(&end))))
}

/// The plane of the dual points of a corner that is `step / end` from the interior point.
fn equation<const D: usize, const V: usize>(step: [f64; D], end: f64) -> [f64; V] {
    let most = step.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let size = step
        .iter()
        .map(|x| (x / most) * (x / most))
        .sum::<f64>()
        .sqrt();
    std::array::from_fn(|k| match step.get(k) {
        Some(x) => x / most / size,
        None => 0.0 - end / most / size,
    })
}

/// The point on D boundaries, if floating point finds it accurately enough.
fn refined<const D: usize, const V: usize, const P: usize>(
    sites: &Sites<'_, D, V, P>,
    vertices: &[u32; D],
) -> Option<[Pair; D]> {
    let mut a: Matrix<D, P> = [[0.0; P]; D];
    let mut b = [0.0; D];
    for i in 0..D {
        let mut v = sites.row(vertices[i]);
        let end = std::mem::replace(&mut v[D], 0.0);
        let (scale, normal) = leveled(&v);
        let (first, second) = super::sites::factors(-scale);
        a[i][..D].copy_from_slice(&normal[..D]);
        b[i] = end * first * second;
    }
    let is_safe = |x: &f64| *x == 0.0 || SAFE.contains(&x.abs());
    if !a
        .as_flattened()
        .iter()
        .chain(&b)
        .chain(&sites.point)
        .all(is_safe)
    {
        return None;
    }
    let inverse = invert_small(&a);
    if !inverse.norm.is_finite() {
        return None;
    }
    let size = ROUNDED * a.iter().map(|row| dot(row, row)).sum::<f64>().sqrt();
    // The first step is the solution itself, from the interior point.
    let mut x = sites.point.map(Pair::from_double);
    let r: [f64; D] = std::array::from_fn(|i| (0..D).fold(-b[i], |s, k| s - a[i][k] * x[k].hi));
    improve(&mut x, &inverse, &r);
    for _ in 0..3 {
        let (mut r, mut squares, mut roundings) = ([0.0; D], 0.0, 0.0);
        for i in 0..D {
            let (mut sum, mut magnitude) = (Pair::from_double(-b[i]), b[i].abs());
            for k in 0..D {
                let product = Pair::product(a[i][k], x[k].hi);
                let lo = product.lo + a[i][k] * x[k].lo;
                magnitude += product.hi.abs();
                sum = sum - Pair { lo, ..product };
            }
            r[i] = sum.hi;
            squares += sum.hi * sum.hi;
            roundings += magnitude;
        }
        improve(&mut x, &inverse, &r);
        let length = x.iter().map(|x| x.hi * x.hi).sum::<f64>().sqrt();
        let rounding = (12 * D + 32) as f64 * U * U * roundings + 16.0 * U * U * size * length;
        let residual = 2.0 * inverse.defect * squares.sqrt() + rounding + LEAST_RESIDUAL;
        let error = 2.0 * ROUNDED * inverse.norm * residual;
        if x.iter().all(|x| error <= CLOSE * x.hi.abs()) {
            return Some(x);
        }
    }
    None
}

/// Adds B r.
#[inline(always)]
fn improve<const D: usize, const P: usize>(
    x: &mut [Pair; D],
    inverse: &Inverse<D, P>,
    r: &[f64; D],
) {
    for k in 0..D {
        let change = (0..D).map(|i| inverse.b[k][i] * r[i]).sum();
        x[k] = x[k] + Pair::from_double(change);
    }
}
