//! The nearest of many triangles in 3-D, exactly, for any boundary and any distance.
//!
//! Let r be the point of a box around all triangles that is nearest to the query q, which takes
//! only comparisons to find. The squared distance of a point p exceeds that of r by the sum, over
//! the axes, of |p - r| (|p - r| + 2 |q - r|): on an axis where q is outside the range of the box,
//! the box lies on the other side of r. No term is negative, so that sum keeps its digits even if
//! both distances round to the same double, and has an error bound of its own. What that bound
//! leaves undecided is compared in integers.

use std::array::from_fn;

use delone_predicates::Point3;
use num_bigint::BigInt;

use super::foot::{Foot, Triangle};
use crate::locate::Boxes;
use crate::points::Extent;
use crate::wide::lowest;

/// Error bound of a coordinate of the nearest point of a triangle, relative to the largest
/// coordinate of its corners: weights of three corners, each with a few roundings.
const PLACE: f64 = 16.0 * f64::EPSILON;
/// Relative error bound of a sum of such products.
const SUM: f64 = 16.0 * f64::EPSILON;
/// Larger than the sum of all underflow errors.
const NOTHING: f64 = 1e-290;
/// Above this, differences of coordinates may overflow.
const LARGE: f64 = 1e300;

/// For points in a box, by how much their squared distance exceeds that of its nearest point, in a
/// unit of its own.
#[derive(Debug)]
pub struct Excess {
    /// The nearest point of the box, and twice the vector from there to the query, in units.
    origin: Point3,
    reach: Point3,
    /// Factors of coordinates, first one that keeps differences in range.
    halved: f64,
    unit: f64,
    /// The factor from coordinates in this unit to those of the reach.
    across: f64,
}

impl Excess {
    /// For points in `extent` and query `q`.
    pub fn over(extent: &Extent<3>, q: Point3) -> Self {
        let Extent { min, max } = extent;
        let origin: Point3 = from_fn(|k| q[k].clamp(min[k], max[k]));
        let is_large = |p: &Point3| p.iter().any(|x| x.abs() > LARGE);
        let halved = if is_large(min) || is_large(max) {
            0.25
        } else {
            1.0
        };
        let away = if is_large(&q) { 0.25 } else { halved };
        let side = (0..3).fold(0.0_f64, |m, k| m.max(max[k] * halved - min[k] * halved));
        let way: Point3 = from_fn(|k| (q[k] * away - origin[k] * away).abs());
        let unit = unit_of(side);
        // `away` is at most `halved`, so nothing overflows here.
        let far = unit_of(way.iter().fold(side * (away / halved), |m, x| m.max(*x)));
        Self {
            origin,
            reach: way.map(|x| x * far * 2.0),
            halved,
            unit,
            across: (away / halved) * (far / unit),
        }
    }

    /// The difference of a coordinate from that of the nearest point of the box.
    fn beyond(&self, k: usize, x: f64) -> f64 {
        (x * self.halved - self.origin[k] * self.halved) * self.unit
    }

    /// A lower bound of the excess in a box.
    pub fn least(&self, extent: &Extent<3>) -> f64 {
        let sum: f64 = (0..3)
            .map(|k| {
                let gap = self
                    .beyond(k, extent.min[k])
                    .max(-self.beyond(k, extent.max[k]));
                let gap = gap.max(0.0);
                gap * (gap * self.across + self.reach[k])
            })
            .sum();
        sum * (1.0 - SUM) - NOTHING
    }

    /// Lower and upper bounds of the excess of the point with given corner weights.
    fn bounds(&self, corners: &[Point3; 3], shares: [f64; 3]) -> [f64; 2] {
        let (mut sum, mut lost) = (0.0, 0.0);
        for k in 0..3 {
            let (mut at, mut most) = (0.0, 0.0_f64);
            for (corner, share) in corners.iter().zip(shares) {
                if share > 0.0 {
                    let way = self.beyond(k, corner[k]);
                    at += share * way;
                    most = most.max(way.abs());
                }
            }
            let (at, off) = (f64::abs(at), PLACE * most);
            sum += at * (at * self.across + self.reach[k]);
            lost += off * ((2.0 * at + off) * self.across + self.reach[k]);
        }
        let lost = 2.0 * lost + SUM * sum + NOTHING;
        [sum - lost, sum + lost]
    }
}

/// A power of two that scales a number to near 1; less so at the ends of the range.
fn unit_of(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52 & 0x7ff) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1000, 1000)) as u64) << 52)
}

/// A triangle that may be the nearest one.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    /// The vertices of the face, edge or corner with the nearest point, ascending: if two triangles
    /// share it, their distances are equal.
    feature: [i32; 3],
    item: usize,
    foot: Foot,
    least: f64,
}

/// The triangle nearest to `q`, the first of several, and the weights of its corners in the nearest
/// point; the search starts at `hint`. All triangles lie in `extent`; `face` gives their vertices.
pub fn nearest(
    boxes: &Boxes<3>,
    extent: &Extent<3>,
    q: Point3,
    hint: Option<usize>,
    face: impl Fn(usize) -> ([i32; 3], [Point3; 3]),
) -> Option<(usize, [f64; 3])> {
    let excess = Excess::over(extent, q);
    let mut found: Vec<Candidate> = Vec::new();
    let mut within = f64::INFINITY;
    // Collect the triangles whose excess may be the least, by rounded bounds.
    boxes.search(
        hint,
        |extent| excess.least(extent),
        |item| {
            let (vertices, corners) = face(item);
            if excess.least(&Extent::of(corners)) > within {
                return within;
            }
            let triangle = Triangle::new(corners, q);
            let foot = triangle.foot();
            let [least, most] = excess.bounds(&corners, triangle.shares(foot));
            if least <= within {
                let feature = feature(vertices, foot);
                found.push(Candidate {
                    feature,
                    item,
                    foot,
                    least,
                });
                within = within.min(most);
            }
            within
        },
    );
    // One candidate for each face, edge or corner; integers decide between the rest.
    found.retain(|candidate| candidate.least <= within);
    found.sort_unstable_by_key(|candidate| (candidate.feature, candidate.item));
    found.dedup_by_key(|candidate| candidate.feature);
    let triangle = |candidate: &Candidate| Triangle::new(face(candidate.item).1, q);
    let best = match found[..] {
        [] => return None,
        [only] => only,
        _ => exactly(found, q, triangle)?,
    };
    Some((best.item, triangle(&best).shares(best.foot)))
}

/// The vertices of the face, edge or corner with the nearest point, ascending.
fn feature([a, b, c]: [i32; 3], foot: Foot) -> [i32; 3] {
    let mut found = match foot {
        Foot::Face => [a, b, c],
        Foot::Edge(k) => [[-1, a, b], [-1, b, c], [-1, c, a]][k],
        Foot::Corner(k) => [-1, -1, [a, b, c][k]],
    };
    found.sort_unstable();
    found
}

/// The nearest of the candidates, the first of several, by exact comparison.
#[cold]
#[inline(never)]
fn exactly(
    mut found: Vec<Candidate>,
    q: Point3,
    triangle: impl Fn(&Candidate) -> Triangle,
) -> Option<Candidate> {
    found.sort_unstable_by_key(|candidate| candidate.item);
    let mut points = vec![q];
    points.extend(
        found
            .iter()
            .flat_map(|candidate| triangle(candidate).corners()),
    );
    let low = lowest(&points, &[]);
    let mut best: Option<(Candidate, BigInt, BigInt)> = None;
    for candidate in found {
        let (above, below) = triangle(&candidate).square(candidate.foot, low);
        let nearer = best
            .as_ref()
            .is_none_or(|(_, least, unit)| &above * unit < least * &below);
        if nearer {
            best = Some((candidate, above, below));
        }
    }
    best.map(|(candidate, ..)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::watch::Watch;

    /// A unit grid on both sides of a slab, two triangles per square.
    fn walls() -> Vec<[Point3; 3]> {
        let mut found = Vec::new();
        for x in [0.0, 1.0] {
            for i in 0..6 {
                for j in 0..6 {
                    let at = |a: i32, b: i32| [x, f64::from(i + a), f64::from(j + b)];
                    found.push([at(0, 0), at(1, 0), at(1, 1)]);
                    found.push([at(0, 0), at(1, 1), at(0, 1)]);
                }
            }
        }
        found
    }

    fn found(size: f64, q: Point3) -> (usize, [f64; 3]) {
        let walls: Vec<_> = walls()
            .iter()
            .map(|face| face.map(|p| p.map(|x| x * size)))
            .collect();
        let extent = Extent::of(walls.iter().flatten().copied());
        let boxes = Boxes::over(walls.len(), |i| Extent::of(walls[i]), &Watch::idle()).unwrap();
        // No two triangles share vertex numbers, so all ties are left to integers.
        let face = |i: usize| ([0, 1, 2].map(|k| (3 * i + k) as i32), walls[i]);
        nearest(&boxes, &extent, q, None, face).unwrap()
    }

    #[test]
    fn walls_that_round_to_one_distance() {
        for (size, far) in [(1.0, 1e18), (5e-324, 1.0), (1.0, 1e300), (1e307, 1.7e308)] {
            let beside = |x: f64| [x, 3.75 * size, 2.25 * size];
            let near = found(size, beside(-far));
            assert!(near.0 < 72, "{size} {far}: {near:?}");
            assert!(found(size, beside(far)).0 >= 72);
        }
        assert_eq!(found(1.0, [-1e300, 3.75, 2.25]), (40, [0.25, 0.5, 0.25]));
    }

    #[test]
    fn the_first_of_several_is_returned() {
        // In the middle of the slab, below a vertex of six triangles of each wall.
        assert_eq!(found(1.0, [0.5, 1.0, 1.0]).0, 0);
        assert!(found(1.0, [0.5 + f64::EPSILON, 1.0, 1.0]).0 >= 72);
    }
}
