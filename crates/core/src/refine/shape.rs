//! The shape of triangles in plain floating point: which are bad, where a vertex mends them, and which
//! subsegments a vertex encroaches upon.

use delone_predicates::Point2;
use num_bigint::BigInt;

use crate::wide::{lowest, scaled};

/// Squares of cosines that differ by a smaller part are compared exactly: four roundings each.
const UNSURE: f64 = 1e-14;

/// The bounds.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// The squared cosine of the smallest angle that is allowed.
    cos2: f64,
    /// Distance of an off-centre from the shortest edge, in lengths of that edge.
    off: f64,
    /// The squared cosine of the angle at which a lens is seen from its rim.
    lens: f64,
}

/// Why a triangle is bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// Its smallest angle.
    Angle,
    /// Its area.
    Size,
}

/// A triangle as seen from its shortest edge.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// The corner opposite the shortest edge, where the smallest angle is.
    pub apex: usize,
    /// The squared length of the shortest edge.
    pub shortest: f64,
    /// Twice the area.
    pub area2: f64,
    skinny: bool,
}

fn minus(a: Point2, b: Point2) -> Point2 {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point2, b: Point2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point2, b: Point2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The smallest angle of a triangle in degrees.
pub fn angle([a, b, c]: [Point2; 3]) -> f64 {
    let edges = [minus(c, b), minus(a, c), minus(b, a)];
    let at = |k: usize| -dot(edges[(k + 1) % 3], edges[(k + 2) % 3]);
    let largest = at(0).max(at(1)).max(at(2));
    cross(edges[0], edges[1]).atan2(largest).to_degrees()
}

impl Shape {
    /// Bounds for the smallest angle `degrees`, below 60; with `circles` lenses are circles.
    pub fn new(degrees: f64, circles: bool) -> Self {
        let angle = degrees.to_radians();
        // Where the squared cosine is a simple fraction, it is that one and not its neighbour.
        let cos2 = match degrees {
            30.0 => 0.75,
            45.0 => 0.5,
            _ => angle.cos() * angle.cos(),
        };
        // The triangle of the shortest edge and the off-centre has this angle there; a little more,
        // so that roundings do not make it bad again.
        let off = 0.5 / (angle / 2.0).tan() * 0.95;
        Self {
            cos2,
            lens: if circles {
                0.0
            } else {
                (2.0 * cos2 - 1.0).powi(2)
            },
            off: if degrees > 0.0 { off } else { f64::INFINITY },
        }
    }

    /// Looks at a triangle.
    pub fn see(&self, corners: [Point2; 3]) -> Seen {
        let [a, b, c] = corners;
        let edges = [minus(c, b), minus(a, c), minus(b, a)];
        let lengths = edges.map(|e| dot(e, e));
        let apex = match lengths {
            [x, y, z] if x <= y && x <= z => 0,
            [_, y, z] if y <= z => 1,
            _ => 2,
        };
        let [l, m] = [(apex + 1) % 3, (apex + 2) % 3];
        // The two edges at the apex run away from it and back to it.
        let cosine = -dot(edges[l], edges[m]);
        let (square, bound) = (cosine * cosine, self.cos2 * lengths[l] * lengths[m]);
        let skinny = if (square - bound).abs() > UNSURE * bound {
            square > bound
        } else {
            self.is_skinny([corners[apex], corners[l], corners[m]])
        };
        Seen {
            apex,
            shortest: lengths[apex],
            area2: cross(edges[0], edges[1]),
            skinny: cosine > 0.0 && skinny,
        }
    }

    /// Whether the angle at `a` is too small, exactly.
    #[cold]
    fn is_skinny(&self, [a, b, c]: [Point2; 3]) -> bool {
        let low = lowest(&[a, b, c], &[]);
        let [a, b, c] = [a, b, c].map(|p| p.map(|x| scaled(x, low)));
        let [u, v] = [b, c].map(|p| [&p[0] - &a[0], &p[1] - &a[1]]);
        let dot = |u: &[BigInt; 2], v: &[BigInt; 2]| &u[0] * &v[0] + &u[1] * &v[1];
        let of_bound = lowest(&[[self.cos2, 1.0]], &[]);
        let [bound, one] = [self.cos2, 1.0].map(|x| scaled(x, of_bound));
        let cosine = dot(&u, &v);
        &cosine * &cosine * one > dot(&u, &u) * dot(&v, &v) * bound
    }

    /// Why a triangle of at most twice the area `cap2` is bad, if it is.
    pub fn fault(&self, seen: &Seen, cap2: f64) -> Option<Reason> {
        if seen.skinny {
            Some(Reason::Angle)
        } else if seen.area2 > cap2 {
            Some(Reason::Size)
        } else {
            None
        }
    }

    /// Where a vertex mends a triangle: its circumcentre, or for an angle a point nearer to the
    /// shortest edge on the way there.
    pub fn cure(&self, corners: [Point2; 3], seen: &Seen, reason: Reason) -> Point2 {
        let [p, q, r] = [1, 2, 0].map(|k| corners[(seen.apex + k) % 3]);
        // The shortest edge is p q, and p is the origin.
        let (u, v) = (minus(q, p), minus(r, p));
        let (uu, vv) = (dot(u, u), dot(v, v));
        let d = 0.5 / cross(u, v);
        let centre = [(v[1] * uu - u[1] * vv) * d, (u[0] * vv - v[0] * uu) * d];
        if reason == Reason::Size {
            return [p[0] + centre[0], p[1] + centre[1]];
        }
        let middle = [0.5 * u[0], 0.5 * u[1]];
        // The normal of the edge on the triangle's side, as long as the edge.
        let off = [middle[0] - self.off * u[1], middle[1] + self.off * u[0]];
        let (near, far) = (minus(off, middle), minus(centre, middle));
        let nearer = dot(near, near) < dot(far, far);
        let [x, y] = if nearer { off } else { centre };
        [p[0] + x, p[1] + y]
    }

    /// Whether `r` lies in the diametral lens of the subsegment `p q` (L. P. Chew, "Guaranteed-quality
    /// mesh generation for curved surfaces", 1993): it sees it at an angle of 180 degrees less twice
    /// the bound or more.
    pub fn in_lens(&self, p: Point2, q: Point2, r: Point2) -> bool {
        let (u, v) = (minus(p, r), minus(q, r));
        let cosine = dot(u, v);
        cosine < 0.0 && cosine * cosine >= self.lens * dot(u, u) * dot(v, v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_off_centre_makes_a_triangle_that_is_just_good() {
        for degrees in [20.0, 30.0, 34.0] {
            let shape = Shape::new(degrees, false);
            let thin = [[0.0, 0.0], [1.0, 0.0], [0.5, 9.0]];
            let seen = shape.see(thin);
            assert_eq!(seen.apex, 2);
            assert_eq!(shape.fault(&seen, 100.0), Some(Reason::Angle));
            let x = shape.cure(thin, &seen, Reason::Angle);
            let made = [[0.0, 0.0], [1.0, 0.0], x];
            assert_eq!(shape.fault(&shape.see(made), 100.0), None);
            let higher = [[0.0, 0.0], [1.0, 0.0], [x[0], 1.06 * x[1]]];
            assert_eq!(shape.fault(&shape.see(higher), 100.0), Some(Reason::Angle));
        }
    }

    #[test]
    fn a_lens_is_thinner_than_the_circle() {
        let shape = Shape::new(30.0, false);
        let lens = |y| shape.in_lens([-1.0, 0.0], [1.0, 0.0], [0.0, y]);
        assert!(lens(0.57) && !lens(0.58));
        assert!(!shape.in_lens([-1.0, 0.0], [1.0, 0.0], [3.0, 0.0]));
        let shape = Shape::new(30.0, true);
        let circle = |y| shape.in_lens([-1.0, 0.0], [1.0, 0.0], [0.0, y]);
        assert!(circle(0.99) && !circle(1.01));
    }
}
