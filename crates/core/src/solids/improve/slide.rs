//! Vertices of walls that move: those inside flat facets move in their planes, and those inside straight
//! edges move along these.
//!
//! # Why the surface stays
//!
//! An edge continues a facet if it has two walls, which are in one plane on opposite sides of it; at the front
//! of a crack they are on the same side. A vertex slides if all edges of walls at it continue facets (it is
//! inside one), or if all but two do, and these are collinear (it is inside an edge). Coplanarity, sides and
//! collinearity are exact, and the new position is exactly in all of these planes, and on the line. All tetrahedra at the
//! vertex stay positive, on both sides of the walls. A wall `v a b` with the opposite corner `c` keeps its
//! orientation in its plane then: `c` does not move, so the sign of the tetrahedron is that of the wall.
//! So the walls cover the same part of their plane as before, once.

use delone_predicates::{Point2, Point3, Sign, lexicographic, orient2d, orient3d};

use super::measure::{Vector, cross, dot, minus, plus};
use super::store::{FACES, Store};

/// Positions off an axis are rounded to this share of the largest coordinate, so that sums and simple
/// multiples of them are doubles.
const GRID: f64 = 1.0 / (1_u64 << 30) as f64;

/// Where a vertex may move.
#[derive(Debug, Clone)]
pub struct Slide {
    /// Corners of a wall in each plane that contains the vertex.
    planes: Vec<[Point3; 3]>,
    /// The ends of the edges along which it moves, if it is inside an edge.
    line: Option<[Point3; 2]>,
}

/// Whether a point is exactly in the plane of three others.
fn is_on_plane([a, b, c]: [Point3; 3], x: Point3) -> bool {
    orient3d(a, b, c, x) == Sign::Zero
}

/// Whether two triangles at the edge from `a` to `b` are in one plane, on opposite sides of it.
pub fn continues([a, b]: [Point3; 2], [c, d]: [Point3; 2]) -> bool {
    // In a plane of two axes in which the first triangle is not flat.
    let sides = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
        let flat = |p: Point3| -> Point2 { [p[i], p[j]] };
        [c, d].map(|x| orient2d(flat(a), flat(b), flat(x)))
    });
    let beside = |[one, two]: [Sign; 2]| one != Sign::Zero && two != Sign::Zero && one != two;
    let seen = sides.into_iter().find(|[one, _]| *one != Sign::Zero);
    orient3d(a, b, c, d) == Sign::Zero && seen.is_some_and(beside)
}

/// Whether three points are exactly collinear.
fn are_collinear(a: Point3, b: Point3, c: Point3) -> bool {
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
        let flat = |p: Point3| -> Point2 { [p[i], p[j]] };
        orient2d(flat(a), flat(b), flat(c)) == Sign::Zero
    })
}

/// Collects the other two vertices of each wall at a vertex with the tetrahedra `star`, once.
fn walls(store: &Store, v: u32, star: &[u32]) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    for &t in star {
        let corners = store.corners[t as usize];
        for k in (0..4).filter(|&k| corners[k] != v && store.beyond(t, k).is_none()) {
            let mut others = FACES[k].map(|i| corners[i]).into_iter().filter(|&u| u != v);
            if let (Some(a), Some(b)) = (others.next(), others.next()) {
                found.push([a.min(b), a.max(b)]);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

impl Slide {
    /// Where a vertex on walls may move, given all tetrahedra at it; `None` if it may not.
    pub fn of(store: &Store, v: u32, star: &[u32]) -> Option<Self> {
        let at = |u: u32| store.points[u as usize];
        let here = at(v);
        let walls = walls(store, v, star);
        // The planes, each with the corners of its first wall.
        let mut planes: Vec<[Point3; 3]> = Vec::new();
        for [a, b] in walls.iter().map(|wall| wall.map(at)) {
            if !planes
                .iter()
                .any(|&p| is_on_plane(p, a) && is_on_plane(p, b))
            {
                planes.push([here, a, b]);
            }
        }
        // The edges at which facets end.
        let mut neighbors: Vec<u32> = walls.iter().flatten().copied().collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        let mut ends = neighbors.into_iter().filter(|&u| {
            let mut others = walls.iter().filter(|wall| wall.contains(&u));
            let beyond = |wall: &[u32; 2]| at(wall[usize::from(wall[0] == u)]);
            match (others.next(), others.next(), others.next()) {
                (Some(one), Some(two), None) => {
                    !continues([here, at(u)], [beyond(one), beyond(two)])
                }
                _ => true,
            }
        });
        match (ends.next(), ends.next(), ends.next()) {
            (None, ..) if planes.len() == 1 => Some(Self { planes, line: None }),
            (Some(a), Some(b), None) => {
                let line = [at(a), at(b)];
                let between = lexicographic(line[0], here) == lexicographic(here, line[1]);
                (between && are_collinear(line[0], here, line[1])).then_some(Self {
                    planes,
                    line: Some(line),
                })
            }
            _ => None,
        }
    }

    /// The part of a vector along which the vertex may move.
    pub fn along(&self, v: Vector) -> Vector {
        let zero = [0.0; 3];
        if let Some([a, b]) = self.line {
            let d = minus(b, a);
            return plus(zero, dot(v, d) / dot(d, d), d);
        }
        let [a, b, c] = self.planes[0];
        let n = cross(minus(b, a), minus(c, a));
        plus(v, -dot(v, n) / dot(n, n), n)
    }

    /// The position nearest to `x`, up to rounding, that is exactly in all planes and on the line;
    /// `None` if none is found.
    pub fn nearest(&self, x: Point3) -> Option<Point3> {
        let place = match self.line {
            Some(line) => on_line(line, x),
            None => on_plane(self.planes[0], x),
        };
        let on = |p: &[Point3; 3]| is_on_plane(*p, place);
        let there = self.planes.iter().all(on);
        let straight = |[a, b]: [Point3; 2]| are_collinear(a, place, b);
        (there && self.line.is_none_or(straight)).then_some(place)
    }
}

/// The axes along which all of these points have the same coordinate.
fn shared(points: &[Point3]) -> [bool; 3] {
    [0, 1, 2].map(|k| points.iter().all(|p| p[k] == points[0][k]))
}

/// A number rounded to a multiple of a power of two near `unit`.
fn rounded(x: f64, unit: f64) -> f64 {
    let power = 2_f64.powi(unit.log2().floor() as i32);
    (x / power).round() * power
}

/// The rounding unit for points of this size.
fn unit(points: &[Point3]) -> f64 {
    let all = points.as_flattened();
    GRID * all.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()))
}

/// A position near `x` in a plane: exactly if it is parallel to two axes, and often otherwise if
/// the plane has simple coordinates.
fn on_plane(plane: [Point3; 3], x: Point3) -> Point3 {
    let [a, b, c] = plane;
    let same = shared(&plane);
    if same.contains(&true) {
        return [0, 1, 2].map(|k| if same[k] { a[k] } else { x[k] });
    }
    // Two coordinates are rounded so that the third, along the longest component of the normal, may be a
    // double.
    let n = cross(minus(b, a), minus(c, a));
    let m = (1..3).fold(0, |m, k| if n[k].abs() > n[m].abs() { k } else { m });
    let (i, j) = ((m + 1) % 3, (m + 2) % 3);
    let unit = unit(&plane);
    let mut place = x;
    (place[i], place[j]) = (rounded(x[i], unit), rounded(x[j], unit));
    place[m] = a[m] - (n[i] * (place[i] - a[i]) + n[j] * (place[j] - a[j])) / n[m];
    place
}

/// A position near `x` on a line: exactly if it is parallel to an axis, and often otherwise if the
/// line has simple coordinates.
fn on_line([a, b]: [Point3; 2], x: Point3) -> Point3 {
    let same = shared(&[a, b]);
    if same.into_iter().filter(|&k| k).count() == 2 {
        return [0, 1, 2].map(|k| if same[k] { a[k] } else { x[k] });
    }
    let d = minus(b, a);
    // A fraction of few bits.
    let s = rounded(dot(minus(x, a), d) / dot(d, d), 1.0 / 4096.0);
    plus(a, s, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tetrahedra of a fan around a vertex on the plane z = 0, below the apex (0, 0, 1).
    fn fan(rim: &[Point3]) -> Store {
        let mut points = vec![[0.0; 3], [0.0, 0.0, 1.0]];
        points.extend(rim);
        let n = rim.len() as u32;
        let corners = (0..n).map(|i| [1, 0, 2 + (i + 1) % n, 2 + i]).collect();
        let rows: Vec<u32> = (0..points.len() as u32).collect();
        Store::new(points, corners, vec![0; rim.len()], &rows).unwrap()
    }

    fn slide(store: &Store) -> Option<Slide> {
        let all: Vec<u32> = (0..store.places()).collect();
        Slide::of(store, 0, &all)
    }

    const SQUARE: [Point3; 4] = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
    ];

    #[test]
    fn a_vertex_inside_a_facet_moves_in_its_plane() {
        let slide = slide(&fan(&SQUARE)).unwrap();
        assert!(slide.line.is_none());
        assert_eq!(slide.nearest([0.1, 0.2, 0.3]), Some([0.1, 0.2, 0.0]));
        assert_eq!(slide.along([1.0, 2.0, 3.0]), [1.0, 2.0, 0.0]);
    }

    #[test]
    fn a_vertex_inside_an_edge_moves_along_it() {
        let mut bent = SQUARE;
        (bent[1][2], bent[3][2]) = (-0.5, -0.25);
        let slide = slide(&fan(&bent)).unwrap();
        assert!(slide.line.is_some());
        assert_eq!(slide.nearest([0.1, 0.2, 0.3]), Some([0.1, 0.0, 0.0]));
        assert_eq!(slide.along([1.0, 2.0, 3.0]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn walls_on_one_side_of_an_edge_do_not_continue_each_other() {
        let edge = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let [c, d] = [[1.0, 0.0, 0.5], [-2.0, 0.0, 0.1]];
        assert!(continues(edge, [c, d]));
        assert!(!continues(edge, [c, [3.0, 0.0, -1.0]]));
        assert!(!continues(edge, [c, [-2.0, 1e-300, 0.1]]));
        assert!(!continues(edge, [c, [0.0, 0.0, 5.0]]));
    }

    #[test]
    fn a_vertex_at_a_corner_stays() {
        for k in 0..4 {
            let mut bent = SQUARE;
            (bent[k][2], bent[(k + 1) % 4][2]) = (-1e-300, -3e-300);
            assert!(slide(&fan(&bent)).is_none(), "{k}");
        }
        // Two edges that are not collinear: a notch in the rim of a facet.
        let mut bent = SQUARE;
        (bent[0][1], bent[1][2], bent[3][2]) = (1e-9, -0.5, -0.25);
        assert!(slide(&fan(&bent)).is_none());
    }

    #[test]
    fn positions_in_skew_planes_are_exact_or_none() {
        let plane = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let of = |plane: [Point3; 3]| Slide {
            planes: vec![plane],
            line: None,
        };
        let place = of(plane).nearest([0.3, 0.4, 0.2]).unwrap();
        assert_eq!(place.iter().sum::<f64>(), 1.0);
        assert!((place[0] - 0.4).abs() < 1e-6, "{place:?}");
        // No doubles near the plane x + 3 y + 7.1 z = c.
        let odd = [[0.1, 0.2, 0.3], [1.1, -0.7, 0.55], [0.3, 1.9, -0.4]];
        assert!(of(odd).nearest([0.5, 0.5, 0.2]).is_none());
        let line = Slide {
            planes: vec![plane],
            line: Some([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]),
        };
        let place = line.nearest([0.3, 0.6, 0.2]).unwrap();
        assert_eq!((place[0] + place[1], place[2]), (1.0, 0.0));
    }
}
