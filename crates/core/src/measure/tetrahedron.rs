//! Quality of tetrahedra: dihedral angles, volume, radius and edge ratios.
//!
//! Let N be the face vectors (twice their areas, inward) and D six times the volume. The dihedral
//! angle at an edge of length l, between the faces k and m, has the cotangent -N_k . N_m / (D l),
//! so angles near 0 and 180 degrees are as accurate as others. The inradius is D / sum |N|, the
//! circumradius |S| / (2 D) with S = sum |v_i|^2 N_i over the vectors v_i from the last corner.

use num_bigint::BigInt;

use super::batch::{columns, each};
use super::corners::{
    Corners, Integers, Measure, Number, Vectors, cross, determinant3, dot, in_units,
};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::base::wide::{across, angle, ratio, root};

/// The two faces at each edge, by their opposite corners, which are not on the edge; the edges are
/// 01, 02, 03, 12, 13 and 23.
const BESIDE: [[usize; 2]; 6] = [[2, 3], [1, 3], [1, 2], [0, 3], [0, 2], [0, 1]];

/// For each tetrahedron the smallest and the largest dihedral angle in degrees, the volume, three
/// times the inradius over the circumradius, and the longest over the shortest edge.
pub fn qualities3(
    points: &[[f64; 3]],
    simplices: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<[Vec<f64>; 5]> {
    let quality = |corners| Corners::new(corners).measure(&Quality);
    columns(points, simplices, workers, watch, quality)
}

/// The dihedral angles of tetrahedra in degrees, at the edges 01, 02, 03, 12, 13 and 23.
pub fn dihedral_angles(
    points: &[[f64; 3]],
    simplices: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; 6]>> {
    let angles = |corners| Corners::new(corners).measure(&Angles);
    each(points, simplices, workers, watch, angles)
}

/// The inward face vectors, the edge vectors, the sum S, and D.
struct Parts {
    faces: [[f64; 3]; 4],
    lengths: [f64; 6],
    center: [f64; 3],
    size: f64,
}

impl Parts {
    #[inline]
    fn of<T: Number>(vectors: &Vectors<T, 3>) -> Self {
        let [a, b, c] = vectors.to;
        let [p, q, r] = [cross(c, b), cross(a, c), cross(b, a)];
        let rest = [0, 1, 2].map(|k| (p[k] + q[k] + r[k]).negated());
        let minus = |v: [T; 3], w: [T; 3]| [v[0] - w[0], v[1] - w[1], v[2] - w[2]];
        let edges = [minus(a, b), minus(a, c), a, minus(b, c), b, c];
        let [aa, bb, cc] = [dot(a, a), dot(b, b), dot(c, c)];
        let center = [0, 1, 2].map(|k| aa * p[k] + bb * q[k] + cc * r[k]);
        let values = |v: [T; 3]| v.map(T::value);
        Self {
            faces: [p, q, r, rest].map(values),
            lengths: edges.map(|v| length(values(v))),
            center: values(center),
            size: dot(a, p).value(),
        }
    }

    /// The cosines of dihedral angles times the lengths of both face vectors.
    #[inline]
    fn cosines(&self) -> [f64; 6] {
        BESIDE.map(|[k, m]| -dot(self.faces[k], self.faces[m]))
    }
}

#[inline]
fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}

struct Quality;

impl Measure<3> for Quality {
    type Out = [f64; 5];

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 3]; 3]) -> T {
        determinant3(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 3>) -> [f64; 5] {
        let parts = Parts::of(vectors);
        // The larger the cotangent, the smaller the angle: two arc tangents suffice.
        let cosines = parts.cosines();
        let cotangent = |i: usize| cosines[i] / parts.lengths[i];
        let (mut low, mut high) = (0, 0);
        for i in 1..6 {
            if cotangent(i) < cotangent(low) {
                low = i;
            }
            if cotangent(i) > cotangent(high) {
                high = i;
            }
        }
        let degrees = |i: usize| {
            (parts.size * parts.lengths[i])
                .atan2(cosines[i])
                .to_degrees()
        };
        let surface: f64 = parts.faces.iter().map(|&face| length(face)).sum();
        let size = parts.size;
        let (short, long) = parts
            .lengths
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(s, l), &x| (s.min(x), l.max(x)));
        [
            degrees(high),
            degrees(low),
            in_units(size / 6.0, 3 * vectors.exponent),
            (6.0 * size * (size / (surface * length(parts.center)))).min(1.0),
            long / short,
        ]
    }

    fn exact(&self, vectors: &Integers<3>) -> [f64; 5] {
        let of = Exact::of(vectors);
        let angles = of.angles();
        let (least, most) = angles
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(s, l), &x| (s.min(x), l.max(x)));
        let surface: BigInt = of.faces.iter().map(|face| root(&square(face))).sum();
        let around = surface * root(&square(&of.center));
        // Two roots, each scaled by 2^64.
        let squares = (&of.size * &of.size * 6) << 128_u32;
        let mut lengths = of.lengths;
        lengths.sort();
        [
            least,
            most,
            ratio(&of.size, &BigInt::from(6), 3 * vectors.low).unwrap_or(f64::INFINITY),
            ratio(&squares, &around, 0).unwrap_or(1.0).min(1.0),
            ratio(&lengths[5], &lengths[0], 0).unwrap_or(f64::INFINITY),
        ]
    }
}

struct Angles;

impl Measure<3> for Angles {
    type Out = [f64; 6];

    #[inline]
    fn determinant<T: Number>(vectors: &[[T; 3]; 3]) -> T {
        determinant3(vectors)
    }

    #[inline]
    fn of<T: Number>(&self, vectors: &Vectors<T, 3>) -> [f64; 6] {
        let parts = Parts::of(vectors);
        let cosines = parts.cosines();
        std::array::from_fn(|i| {
            (parts.size * parts.lengths[i])
                .atan2(cosines[i])
                .to_degrees()
        })
    }

    fn exact(&self, vectors: &Integers<3>) -> [f64; 6] {
        Exact::of(vectors).angles()
    }
}

/// The same as `Parts`, in integers; lengths are scaled by 2^64 and rounded down.
struct Exact {
    faces: [[BigInt; 3]; 4],
    lengths: [BigInt; 6],
    center: [BigInt; 3],
    size: BigInt,
}

impl Exact {
    fn of(vectors: &Integers<3>) -> Self {
        let [a, b, c] = &vectors.to;
        let [p, q, r] = [across(c, b), across(a, c), across(b, a)];
        let rest = [0, 1, 2].map(|k| -(&p[k] + &q[k] + &r[k]));
        let minus =
            |v: &[BigInt; 3], w: &[BigInt; 3]| [&v[0] - &w[0], &v[1] - &w[1], &v[2] - &w[2]];
        let (ab, ac, bc) = (minus(a, b), minus(a, c), minus(b, c));
        let lengths = [&ab, &ac, a, &bc, b, c].map(|v| root(&square(v)));
        let squares = [a, b, c].map(square);
        let center =
            [0, 1, 2].map(|k| &squares[0] * &p[k] + &squares[1] * &q[k] + &squares[2] * &r[k]);
        let size = inner(a, &p);
        Self {
            faces: [p, q, r, rest],
            lengths,
            center,
            size,
        }
    }

    /// The dihedral angles in degrees.
    fn angles(&self) -> [f64; 6] {
        std::array::from_fn(|i| {
            let [k, m] = BESIDE[i];
            let sine = &self.size * &self.lengths[i];
            let cosine = -inner(&self.faces[k], &self.faces[m]) << 64_u32;
            angle(&sine, &cosine).to_degrees()
        })
    }
}

fn inner(p: &[BigInt; 3], q: &[BigInt; 3]) -> BigInt {
    p.iter().zip(q).map(|(x, y)| x * y).sum()
}

fn square(p: &[BigInt; 3]) -> BigInt {
    inner(p, p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stages_agree_where_all_are_accurate() {
        let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corners = Corners::new(corner);
        let plain = corners.measure(&Quality);
        assert_eq!(plain[1], 90.0);
        assert_eq!(plain[2], 1.0 / 6.0);
        assert!((plain[0] - 2_f64.sqrt().atan().to_degrees()).abs() < 1e-13);
        let exact = Quality.exact(&corners.integers());
        let pairs = Quality.of(&corners.pairs().unwrap());
        for (p, q) in plain.iter().chain(&pairs).zip(exact.iter().chain(&exact)) {
            assert!(
                (p - q).abs() <= 8.0 * f64::EPSILON * q.abs(),
                "{plain:?} {exact:?}"
            );
        }
        let angles = Angles.exact(&corners.integers());
        assert_eq!(angles.map(f64::round), [90.0, 90.0, 90.0, 55.0, 55.0, 55.0]);
        assert_eq!(
            corners.measure(&Angles).map(f64::round),
            angles.map(f64::round)
        );
    }
}
