//! Which tetrahedra are to be refined, and why.

use delone_predicates::Point3;

pub type Vector = [f64; 3];

/// The edges of a tetrahedron.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// Spheres are smaller than computed by this share: points on them are outside.
pub const ROUNDING: f64 = 1e-9;

/// The difference of two points.
#[inline(always)]
pub fn minus(a: Point3, b: Point3) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The inner product.
#[inline(always)]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[inline(always)]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A point, and a multiple of a vector beyond it.
#[inline(always)]
pub fn plus(a: Point3, s: f64, v: Vector) -> Point3 {
    [a[0] + s * v[0], a[1] + s * v[1], a[2] + s * v[2]]
}

/// The distance of two points.
#[inline]
pub fn distance(a: Point3, b: Point3) -> f64 {
    let d = minus(a, b);
    dot(d, d).sqrt()
}

/// The measures of a tetrahedron.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    pub longest: f64,
    pub shortest: f64,
    /// The edge of the regular tetrahedron with its volume.
    pub mean: f64,
    /// The radius of its circumsphere, and where the center is.
    pub radius: f64,
    pub center: Point3,
}

/// Edges longer than this many sizes are too long.
const LONG: f64 = 2.0;

impl Shape {
    pub fn of([a, b, c, d]: [Point3; 4]) -> Self {
        let (p, q, r) = (minus(b, a), minus(c, a), minus(d, a));
        let edges = [p, q, r, minus(c, b), minus(d, b), minus(d, c)].map(|e| dot(e, e));
        let (least, most) = edges
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(l, m), &e| (l.min(e), m.max(e)));
        let normal = cross(p, q);
        // Six times the volume; a regular one with edges e has e^3 / sqrt(2).
        let volume = dot(normal, r).abs();
        // The center from a: (|r|^2 p x q + |p|^2 q x r + |q|^2 r x p) / (2 volume).
        let (qr, rp) = (cross(q, r), cross(r, p));
        let sum = [0, 1, 2]
            .map(|i| (edges[2] * normal[i] + edges[0] * qr[i] + edges[1] * rp[i]) / (2.0 * volume));
        Self {
            longest: most.sqrt(),
            shortest: least.sqrt(),
            mean: (volume * std::f64::consts::SQRT_2).cbrt(),
            radius: dot(sum, sum).sqrt(),
            center: plus(a, 1.0, sum),
        }
    }

    /// By which factor it is too large: more than 1 if it is.
    pub fn excess(&self, size: f64) -> f64 {
        (self.mean / size).max(self.longest / (LONG * size))
    }

    pub fn is_larger_than(&self, size: f64) -> bool {
        self.excess(size) > 1.0
    }
}

/// The circumcenter of a triangle and the square of its radius.
pub fn circumcircle([a, b, c]: [Point3; 3]) -> (Point3, f64) {
    let (p, q) = (minus(b, a), minus(c, a));
    let normal = cross(p, q);
    let (pp, qq) = (dot(p, p), dot(q, q));
    // (|p|^2 q - |q|^2 p) x (p x q) / (2 |p x q|^2), from a.
    let mixed = [0, 1, 2].map(|i| pp * q[i] - qq * p[i]);
    let turned = cross(mixed, normal);
    let over = 1.0 / (2.0 * dot(normal, normal));
    let from = turned.map(|x| x * over);
    (plus(a, 1.0, from), dot(from, from))
}

/// The edge of the equilateral triangle with the area of a triangle, and its longest edge.
pub fn triangle([a, b, c]: [Point3; 3]) -> (f64, f64) {
    let (p, q, r) = (minus(b, a), minus(c, a), minus(c, b));
    let normal = cross(p, q);
    let twice = dot(normal, normal).sqrt();
    let longest = dot(p, p).max(dot(q, q)).max(dot(r, r));
    // Twice the area of an equilateral triangle with edges e: e^2 sqrt(3) / 2.
    ((twice * 2.0 / 3.0_f64.sqrt()).sqrt(), longest.sqrt())
}

/// The smallest height of a triangle; 0 if it has no area.
pub fn lowest([a, b, c]: [Point3; 3]) -> f64 {
    let normal = cross(minus(b, a), minus(c, a));
    let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
    if longest > 0.0 {
        dot(normal, normal).sqrt() / longest
    } else {
        0.0
    }
}

/// By which factor a triangle is too large.
pub fn excess_of_triangle(corners: [Point3; 3], size: f64) -> f64 {
    let (mean, longest) = triangle(corners);
    (mean / size).max(longest / (LONG * size))
}
