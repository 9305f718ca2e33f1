//! Areas and circumcenters of spherical triangles.

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;
use delone_predicates::sphere::{Unit, leveled};
use num_bigint::BigInt;

use super::directions::units;
use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::parallel;
use crate::base::vector::dot;
pub(super) use crate::base::vector::{cross, minus};
use crate::base::watch::Watch;
use crate::base::wide::{determinant, lowest, ratio, root, scaled};

/// Triangles, or ridges, that are measured together.
const SHARE: usize = 1 << 10;
/// A determinant of pairs has an error of at most 2^-98 times the lengths of two differences; one
/// that is not 2^50 times as large as that is computed by integers.
const UNSURE: f64 = 1.0 / (1_u64 << 48) as f64;

/// The solid angles of triangles: 4 pi for the whole sphere.
pub fn areas(
    vectors: &[Point3],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    mapped(vectors, simplices, area, workers, watch)
}

/// The circumcenters of triangles: unit vectors, rounded, equally far from the corners and on their
/// side of the sphere.
pub fn circumcenters(
    vectors: &[Point3],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Point3>> {
    mapped(vectors, simplices, circumcenter, workers, watch)
}

/// The values of a function of the vectors of a few corners and of their directions.
pub(super) fn mapped<T: Copy + Default + Send, const N: usize>(
    vectors: &[Point3],
    simplices: &[[i32; N]],
    measure: fn([Point3; N], &[Unit; N]) -> T,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<T>> {
    // Each direction is a corner of about six triangles, or of twelve ridges with their sites.
    let (heads, tails) = units(vectors, workers, watch)?;
    let mut values = filled(simplices.len(), T::default())?;
    let tasks = simplices.chunks(SHARE).zip(values.chunks_mut(SHARE));
    parallel::map_watched(workers, tasks.collect(), watch, |(simplices, values)| {
        for (value, corners) in values.iter_mut().zip(simplices) {
            let rows = corners.map(|v| v as usize);
            let directions = rows.map(|v| Unit {
                hi: heads[v],
                lo: tails[v],
            });
            *value = measure(rows.map(|v| vectors[v]), &directions);
        }
        Ok(())
    })?;
    Ok(values)
}

/// The coordinates of a direction.
pub(super) fn pairs(unit: &Unit) -> [Pair; 3] {
    [0, 1, 2].map(|k| Pair {
        hi: unit.hi[k],
        lo: unit.lo[k],
    })
}

/// The sum of the absolute coordinates.
pub(super) fn size(p: [Pair; 3]) -> f64 {
    p.iter().map(|x| x.hi.abs()).sum()
}

/// A. Van Oosterom and J. Strackee, "The solid angle of a plane triangle" (1983): the tangent of
/// half of it is [a, b, c] / (1 + a b + b c + c a). The determinant is correct to nearly all bits,
/// even for slivers. The sum need not be, as long as one of the two is large, because its error
/// counts in proportion to the determinant. Both are small if two corners are nearly opposite.
fn area(corners: [Point3; 3], directions: &[Unit; 3]) -> f64 {
    let units = directions.each_ref().map(pairs);
    let [a, b, c] = units;
    let (p, q) = (minus(a, c), minus(b, c));
    let normal = cross(p, q);
    let det = (normal[0] * c[0] + normal[1] * c[1] + normal[2] * c[2]).hi;
    // The error of 2^-98 (|P| + |Q|), see `delone_predicates::sphere`, and 2^50 times that.
    let det = if det.abs() > UNSURE * (size(p) * size(q) + (size(p) + size(q)) * UNSURE) {
        det
    } else {
        exact_determinant(corners)
    };
    let [a, b, c] = directions.each_ref().map(|unit| unit.hi);
    let sum = 1.0 + dot(a, b) + dot(b, c) + dot(c, a);
    // An error of 2^-50 in the sum causes less than 2^-47 in the angle if the sum is above 1/8.
    if sum.abs() > 0.125 {
        return 2.0 * det.atan2(sum);
    }
    let sum = sum_of_products(units);
    // The error of pairs is below 2^-95.
    if sum.abs().max(det.abs()) > 1.0 / (1_u64 << 40) as f64 {
        return 2.0 * det.atan2(sum);
    }
    exact_area(corners)
}

/// 1 + a b + b c + c a in pairs.
fn sum_of_products([a, b, c]: [[Pair; 3]; 3]) -> f64 {
    let one = Pair { hi: 1.0, lo: 0.0 };
    let product = |p: [Pair; 3], q: [Pair; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    (one + product(a, b) + product(b, c) + product(c, a)).hi
}

/// The solid angle by integers, and roots with 256 bits after the point.
#[cold]
fn exact_area(corners: [Point3; 3]) -> f64 {
    const BITS: u32 = 256;
    let [a, b, c] = integers(corners);
    let product =
        |p: &[BigInt; 3], q: &[BigInt; 3]| -> BigInt { p.iter().zip(q).map(|(x, y)| x * y).sum() };
    // Lengths in units of 2^-256; `root` has 64 of these bits.
    let length = |p: &[BigInt; 3]| root(&(product(p, p) << (2 * (BITS - 64))));
    let [k, l, m] = [&a, &b, &c].map(length);
    let whole: BigInt = (&k * &l * &m) >> (2 * BITS);
    let sum = whole + product(&a, &b) * &m + product(&b, &c) * &k + product(&c, &a) * &l;
    let det = determinant([&a, &b, &c]) << BITS;
    // Both are divided by the larger one, so neither quotient is out of range.
    let most = det.magnitude().max(sum.magnitude()).clone().into();
    let share = |x: &BigInt| ratio(x, &most, 0).unwrap_or_default();
    2.0 * share(&det).atan2(share(&sum))
}

/// Each vector as integers, in a unit of its own.
fn integers(corners: [Point3; 3]) -> [[BigInt; 3]; 3] {
    corners.map(|v| {
        let v = leveled(v);
        let low = lowest(&[v], &[]);
        v.map(|x| scaled(x, low))
    })
}

/// The determinant of three directions, by integers and one root.
#[cold]
fn exact_determinant(corners: [Point3; 3]) -> f64 {
    let rows = integers(corners);
    let [a, b, c] = rows.each_ref();
    let squares = rows.iter().map(|v| v.iter().map(|x| x * x).sum::<BigInt>());
    let lengths = root(&squares.product());
    ratio(&(determinant([a, b, c]) << 64_u32), &lengths, 0).unwrap_or_default()
}

fn circumcenter(_: [Point3; 3], directions: &[Unit; 3]) -> Point3 {
    let [a, b, c] = directions.each_ref().map(pairs);
    let n = cross(minus(a, c), minus(b, c)).map(|x| x.hi);
    // Differences may be tiny, and their products may underflow when squared.
    let n = leveled(n);
    let length = dot(n, n).sqrt();
    n.map(|x| x / length + 0.0)
}
