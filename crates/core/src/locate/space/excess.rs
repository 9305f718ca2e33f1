//! The nearest of many triangles in 3-D, exactly, for any boundary and any distance: see
//! `locate::excess` for how distances are compared.

use delone_predicates::Point3;
use num_bigint::BigInt;

use super::foot::{Foot, Triangle};
use crate::base::points::Extent;
use crate::base::wide::lowest;
use crate::locate::{Boxes, Excess};

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
    use crate::base::watch::Watch;

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
