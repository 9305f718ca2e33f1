//! Where to insert a vertex that improves a bad triangle, in plain floating point.
//!
//! Three rules keep the number of vertices small. For a small angle, the off-center is used: the
//! point on the way from the shortest edge to the circumcenter whose triangle with that edge is
//! just good enough (A. Üngör, "Off-centers", LATIN 2004). If a size is requested, the vertex is no
//! farther from the edge than the size, so that a front of triangles advances that are almost
//! equilateral and almost as large as allowed (S. Rebay, "Efficient unstructured mesh generation by
//! means of Delaunay triangulation and Bowyer-Watson algorithm", Journal of Computational Physics
//! 106, 1993). And if two neighbors are skinny because their short edges follow each other, one
//! vertex that sees both edges at the bound improves both: edge lengths double from layer to layer.

use delone_predicates::Point2;

use super::shape::{Seen, cross, dot, minus};

/// Targets stay within the bounds by this factor, so that neither rounding nor a slight distortion
/// makes the triangle bad again. Values closer to 1 give fewer vertices, until refinement no longer
/// terminates.
const OFF: f64 = 0.95;
const PAIR: f64 = 0.97;

/// The area of a triangle in a front, as a fraction of its limit. Triangles between fronts are
/// larger, so with a larger fraction they would exceed the limit too often and be split.
const SHARE: f64 = 0.9;

/// The squared edge of an equilateral triangle, in units of twice its area.
const EDGE2: f64 = 1.154_700_538_379_251_7;

/// The squared height of an equilateral triangle, in units of its squared edge.
const HEIGHT2: f64 = 0.75;

/// The angle bound, in the form needed here.
#[derive(Debug, Clone, Copy)]
pub struct Places {
    sin: f64,
    cos: f64,
    /// Distance of an off-center from the shortest edge, in lengths of that edge.
    off: f64,
}

/// Two edges that meet: the common vertex, and the other ends. The region to be meshed is
/// counterclockwise from the first to the last.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    pub middle: Point2,
    pub first: Point2,
    pub last: Point2,
}

impl Places {
    /// For the smallest angle `degrees`, below 60.
    pub fn new(degrees: f64) -> Self {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // The distance from which an edge of length 1 appears at the angle of the bound.
        let off = 0.5 * (1.0 + cos) / sin * OFF;
        Self { sin, cos, off }
    }

    /// The squared length of edges that a front aims for under an area limit.
    pub fn longest2(cap2: f64) -> f64 {
        EDGE2 * SHARE * cap2
    }

    /// The circumcenter of a triangle.
    pub fn center(corners: [Point2; 3], seen: &Seen) -> Point2 {
        let [p, _, c] = from_shortest(corners, seen);
        [p[0] + c[0], p[1] + c[1]]
    }

    /// The position for a triangle that should have at most twice the area `cap2`.
    pub fn improve(&self, corners: [Point2; 3], seen: &Seen, cap2: f64) -> Point2 {
        let [p, u, center] = from_shortest(corners, seen);
        // The height above the shortest edge, in lengths of it.
        let wanted = (Self::longest2(cap2) / seen.shortest - 0.25).max(HEIGHT2);
        let height = self.off.min(wanted.sqrt());
        let middle = [0.5 * u[0], 0.5 * u[1]];
        let off = [middle[0] - height * u[1], middle[1] + height * u[0]];
        let (near, far) = (minus(off, middle), minus(center, middle));
        let nearer = dot(near, near) < dot(far, far);
        let [x, y] = if nearer { off } else { center };
        [p[0] + x, p[1] + y]
    }

    /// The farthest position that sees both edges of a bend at the bound, and its squared distance
    /// from the middle vertex; `None` if another angle would be too small, or the distance exceeds
    /// the size.
    pub fn above(&self, bend: Bend, cap2: f64) -> Option<(Point2, f64)> {
        let [u, v] = [bend.first, bend.last].map(|end| minus(end, bend.middle));
        let [a, b] = [dot(u, u).sqrt(), dot(v, v).sqrt()];
        // theta is the angle of the bend, up to a full turn; phi is its part before the position.
        // The edge of length a is seen at the bound from the distance a sin(bound + phi) / sin
        // bound, the other one from b sin(bound + theta - phi) / sin bound, and these must be
        // equal.
        let (sin_theta, cos_theta) = (cross(u, v) / (a * b), dot(u, v) / (a * b));
        let sin_both = self.sin * cos_theta + self.cos * sin_theta;
        let cos_both = self.cos * cos_theta - self.sin * sin_theta;
        let (y, x) = (b * sin_both - a * self.sin, a * self.cos + b * cos_both);
        let length = x.hypot(y).copysign(y);
        let (sin_phi, cos_phi) = (y / length, x / length);
        let sin_rest = sin_theta * cos_phi - cos_theta * sin_phi;
        let cos_rest = cos_theta * cos_phi + sin_theta * sin_phi;
        // The angles at the middle vertex and at the two other ends.
        let straight = 1.0 - 2.0 * self.cos * self.cos;
        let fits = |cos: f64| cos <= self.cos && cos >= straight;
        if !(sin_rest > 0.0 && fits(cos_phi) && fits(cos_rest)) {
            return None;
        }
        let far = PAIR * (cos_phi + self.cos * sin_phi / self.sin);
        let distance2 = far * far * a * a;
        if distance2 > Self::longest2(cap2) {
            return None;
        }
        let x = bend.middle[0] + far * (cos_phi * u[0] - sin_phi * u[1]);
        let y = bend.middle[1] + far * (sin_phi * u[0] + cos_phi * u[1]);
        Some(([x, y], distance2))
    }
}

/// One end of the shortest edge; from there, the other end and the circumcenter.
fn from_shortest(corners: [Point2; 3], seen: &Seen) -> [Point2; 3] {
    let [p, q, r] = [1, 2, 0].map(|k| corners[(seen.apex + k) % 3]);
    let (u, v) = (minus(q, p), minus(r, p));
    let (uu, vv) = (dot(u, u), dot(v, v));
    let d = 0.5 / cross(u, v);
    [
        p,
        u,
        [(v[1] * uu - u[1] * vv) * d, (u[0] * vv - v[0] * uu) * d],
    ]
}

#[cfg(test)]
mod tests {
    use super::super::shape::{Reason, Shape, angle};
    use super::*;

    #[test]
    fn an_off_center_makes_a_triangle_that_is_just_good() {
        for degrees in [20.0, 30.0, 34.0] {
            let shape = Shape::new(degrees, false);
            let thin = [[0.0, 0.0], [1.0, 0.0], [0.5, 9.0]];
            let seen = shape.see(thin);
            assert_eq!(seen.apex, 2);
            assert_eq!(shape.fault(&seen, 100.0), Some(Reason::Angle));
            let x = Places::new(degrees).improve(thin, &seen, f64::INFINITY);
            let made = [[0.0, 0.0], [1.0, 0.0], x];
            assert_eq!(shape.fault(&shape.see(made), 100.0), None);
            let higher = [[0.0, 0.0], [1.0, 0.0], [x[0], 1.06 * x[1]]];
            assert_eq!(shape.fault(&shape.see(higher), 100.0), Some(Reason::Angle));
        }
    }

    #[test]
    fn a_size_is_reached_from_its_edge() {
        let large = [[0.0, 0.0], [1.0, 0.0], [0.5, 9.0]];
        let seen = Shape::new(20.0, false).see(large);
        let places = Places::new(20.0);
        // Twice the area of an equilateral triangle with this edge, slightly more than the share.
        let [x, y] = places.improve(large, &seen, 0.75_f64.sqrt() / SHARE);
        assert!((x - 0.5).abs() < 1e-12 && (y - 0.75_f64.sqrt()).abs() < 1e-12);
        let [_, higher] = places.improve(large, &seen, 2.0);
        assert!(higher > y);
        // Never so close that edges keep getting shorter.
        let [_, least] = places.improve(large, &seen, 1e-9);
        assert!((least - 0.75_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn one_vertex_improves_two_edges() {
        for (degrees, [first, last]) in [
            (30.0, [[1.0, 0.0], [-1.0, 0.0]]),
            (30.0, [[1.0, 0.1], [-0.9, 0.5]]),
            (30.0, [[1.0, -0.2], [-0.8, -0.1]]),
            (20.0, [[1.0, 0.0], [-0.5, 1.0]]),
        ] {
            let bend = Bend {
                middle: [0.0, 0.0],
                first,
                last,
            };
            let places = Places::new(degrees);
            let (x, distance2) = places.above(bend, f64::INFINITY).unwrap();
            assert!((dot(x, x) - distance2).abs() < 1e-12);
            for triangle in [[[0.0, 0.0], first, x], [last, [0.0, 0.0], x]] {
                assert!(angle(triangle) > degrees);
                let [p, q] = [triangle[0], triangle[1]];
                let seen = cross(minus(p, x), minus(q, x)).atan2(dot(minus(p, x), minus(q, x)));
                assert!(seen.to_degrees() < 1.1 * degrees, "{seen}");
            }
            assert!(places.above(bend, 0.1).is_none());
        }
        let sharp = Bend {
            middle: [0.0, 0.0],
            first: [1.0, 0.0],
            last: [1.0, 1.0],
        };
        assert!(Places::new(30.0).above(sharp, f64::INFINITY).is_none());
        let reflex = Bend {
            middle: [0.0, 0.0],
            first: [0.0, -1.0],
            last: [-0.2, -1.0],
        };
        assert!(Places::new(30.0).above(reflex, f64::INFINITY).is_none());
    }
}
