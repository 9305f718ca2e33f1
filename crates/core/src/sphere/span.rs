//! Lengths of ridges on the sphere, and the areas between them and their sites.
//!
//! Let a b be the edge of a ridge, c and d the corners to its left and right, p = b - a, q = c - a,
//! r = d - a, n = p x q and m = r x p the outward normals of the two facets, and D = -[p, q, r] >=
//! 0. As n x m = D p, the ridge has the length atan2(D |p|, n m). The triangle from a to the ends n
//! / |n| and m / |m| has the determinant D |p|^2 / (2 |n| |m|), as a p = -|p|^2 / 2; with the
//! formula of Van Oosterom and Strackee (1983) the tangent of half of its area is
//!
//! D |p|^2 / 2 : |n| |m| + (a n) |m| + (a m) |n| + n m.
//!
//! Each factor comes from differences of directions, and none cancels, so that slivers and cells
//! beyond a hemisphere keep nearly all bits. Only the denominator does where n and m are nearly
//! opposite, as those of the cells around sites that are close to each other; there it is computed
//! by integers. The triangle from b is its mirror image.

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;
use delone_predicates::sphere::{Unit, leveled};
use num_bigint::BigInt;

use super::measure::{cross, mapped, minus, pairs, size};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::base::wide::{angle, determinant, lowest, ratio, root, scaled};

/// A determinant of pairs has an error of at most 2^-98 times products of lengths; one that is not
/// 2^40 times as large as that is computed by integers.
const UNSURE: f64 = 1.0 / (1_u64 << 58) as f64;
/// Digits of square roots in integers.
const DIGITS: u32 = 512;
/// A denominator below this fraction of its terms has lost too many digits.
const LOST: f64 = 1.0 / (1_u64 << 40) as f64;
/// Digits after the point of directions in integers. They differ by 2^-107 or more, as pairs of
/// doubles do, and what is left of the denominator is the sixth power of that.
const PLACES: u32 = 1792;

/// For each ridge, by its edge and the corners to its left and right: its length, and the area of
/// the triangle between it and either of its sites.
pub fn spans(
    vectors: &[Point3],
    around: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; 2]>> {
    mapped(vectors, around, span, workers, watch)
}

fn dot(p: &[Pair; 3], q: &[Pair; 3]) -> Pair {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

/// The length of a vector.
fn norm(p: &[Pair; 3]) -> Pair {
    let square = dot(p, p);
    if square.hi <= 0.0 {
        return Pair::from_double(0.0);
    }
    let root = Pair::from_double(square.hi.sqrt());
    // One step of Newton's method.
    let rest = (square - root.square()).hi / (2.0 * root.hi);
    root + Pair::from_double(rest)
}

/// The length and area of one ridge, from the vectors of its four corners and their directions.
fn span(corners: [Point3; 4], directions: &[Unit; 4]) -> [f64; 2] {
    let [a, b, c, d] = directions.each_ref().map(pairs);
    let [p, q, r] = [minus(b, a), minus(c, a), minus(d, a)];
    // A common factor of n and m, which may be tiny: p becomes about 1.
    let top = p.iter().fold(0.0, |top: f64, x| top.max(x.hi.abs()));
    if top == 0.0 {
        return [0.0; 2];
    }
    let up = Pair::from_double(leveled([top, 0.0, 0.0])[0] / top);
    let p = p.map(|x| x * up);
    let (n, m) = (cross(p, q), cross(r, p));
    let det = -dot(&m, &q).hi;
    let (s, t, w) = (size(p), size(q), size(r));
    let det = if det.abs() > UNSURE * (s * t + t * w + w * s) {
        det
    } else {
        -exact_determinant(corners) * up.hi
    };
    let det = det.max(0.0);
    let (long, wide, both) = (norm(&n), norm(&m), dot(&n, &m));
    let across = dot(&p, &p).hi;
    let cosine = long * wide + dot(&a, &n) * wide + dot(&a, &m) * long + both;
    let sine = det * across / (2.0 * up.hi);
    let half = if cosine.hi.abs() < LOST * (long * wide).hi {
        exact_half_area(corners)
    } else {
        sine.atan2(cosine.hi)
    };
    [(det * across.sqrt()).atan2(both.hi), 2.0 * half]
}

/// The determinant of the differences of the last three of four directions from the first, by
/// integers and roots.
#[cold]
fn exact_determinant(corners: [Point3; 4]) -> f64 {
    let rows = corners.map(|v| {
        let v = leveled(v);
        let low = lowest(&[v], &[]);
        v.map(|x| scaled(x, low))
    });
    let squares = rows
        .each_ref()
        .map(|v| v.iter().map(|x| x * x).sum::<BigInt>());
    let roots = squares.each_ref().map(|n| (n << (2 * DIGITS)).sqrt());
    let [a, b, c, d] = rows.each_ref();
    let sum = &roots[0] * determinant([b, c, d]) - &roots[1] * determinant([a, c, d])
        + &roots[2] * determinant([a, b, d])
        - &roots[3] * determinant([a, b, c]);
    let lengths = root(&squares.iter().product()) << DIGITS;
    ratio(&(sum << 64_u32), &lengths, 0).unwrap_or_default()
}

/// Half the area of the triangle between a site and its ridge, by integers.
#[cold]
fn exact_half_area(corners: [Point3; 4]) -> f64 {
    let [a, b, c, d] = corners.map(|v| {
        let v = leveled(v);
        let low = lowest(&[v], &[]);
        let whole = v.map(|x| scaled(x, low));
        let square: BigInt = whole.iter().map(|x| x * x).sum();
        let length = (square << (2 * PLACES)).sqrt();
        whole.map(|x| (x << (2 * PLACES)) / &length)
    });
    let minus = |x: &[BigInt; 3], y: &[BigInt; 3]| [0, 1, 2].map(|k| &x[k] - &y[k]);
    let times = |x: &BigInt, y: &BigInt| (x * y) >> PLACES;
    let dot = |x: &[BigInt; 3], y: &[BigInt; 3]| -> BigInt {
        let sum: BigInt = (0..3).map(|k| &x[k] * &y[k]).sum();
        sum >> PLACES
    };
    let cross = |x: &[BigInt; 3], y: &[BigInt; 3]| {
        [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            (&x[i] * &y[j] - &x[j] * &y[i]) >> PLACES
        })
    };
    let [p, q, r] = [minus(&b, &a), minus(&c, &a), minus(&d, &a)];
    let (n, m) = (cross(&p, &q), cross(&r, &p));
    let [long, wide] = [&n, &m].map(|x| (dot(x, x) << PLACES).sqrt());
    let det = -dot(&m, &q);
    let sine = times(&det, &dot(&p, &p)) >> 1_u32;
    let cosine =
        times(&long, &wide) + times(&dot(&a, &n), &wide) + times(&dot(&a, &m), &long) + dot(&n, &m);
    // The corners to both sides are not on one circle with the site, so the sine is positive.
    angle(&sine, &cosine)
}
