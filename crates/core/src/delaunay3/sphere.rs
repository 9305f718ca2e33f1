//! The circumsphere of a tetrahedron in plain floating point, with a proven certainty.
//!
//! # The bound
//!
//! Let u = 2^-53, let B, C, D be three corners as seen from the fourth, p, rounded once, and L = |B| |C|
//! |D|. The centre, seen from p, is c = N / (2 det) with N = |B|^2 (C x D) + |C|^2 (D x B) + |D|^2
//! (B x C) and det = B . (C x D).
//!
//! *det.* Each of its six monomials passes three differences, two products and three sums or
//! differences: 8 roundings. The sum of the magnitudes of the monomials is the permanent of the matrix of
//! magnitudes, at most 3!/3^(3/2) L < 1.16 L. So det errs by at most 9.3 u L, to first order.
//!
//! *N.* Each component of C x D has monomials of at most |C| |D| in all (Cauchy), so those of a
//! component of N sum to at most (|B| + |C| + |D|) L. They pass at most: six differences, three roundings
//! in the squared length, two in the cross product, the product of both, two sums: 14. The corners
//! are on the sphere, so each length is at most 2 r, and each component errs by at most 14 * 6 u r L = 84
//! u r L; all three, as a vector, by 146 u r L.
//!
//! *c.* Hence c errs by at most (146 u r L + 2 * 9.3 u r L) / (2 |det|) plus a rounding, less than 83 u r L / |det|.
//! A sphere is kept where det^2 > 2^-52 L^2, that is L / |det| < 2^26: then c errs by less than 83 * 2^-27 r < 2^-20 r.
//! (Terms of second order are 2^-20 of that; the computed L^2 errs by 20 u.)
//!
//! *Position.* The absolute centre is p + c, rounded: an error of at most u |p + c| in each coordinate. It is
//! kept where |p + c|^2 < 2^60 r^2: less than 2^-22 r. The error of both, E, is less than 2^-19.5 r.
//!
//! *Power.* For a query q at distance d from the centre so found, the power d^2 - r^2, with r the distance of
//! p from the same centre, errs by at most 2 (d + r) E + 2 E^2 < 2^-18 (d r + r^2) < 2^-17 (d^2 + r^2), and by
//! some u (d^2 + r^2) for its own roundings. [`SLACK`] = 2^-16 covers it.
//!
//! *Range.* All coordinates are below 2^[`RANGE`] in magnitude, L^2 above 2^-600, so that each length is
//! above 2^-350 and no underflow exceeds 2^-1074 times 2^300, which is nothing beside u L r.

use delone_predicates::Point3;

/// Relative certainty of a power, see the head of the file.
pub const SLACK: f64 = 1.0 / 65536.0;

/// Coordinates below 2^RANGE may be asked of spheres.
pub const RANGE: i32 = 20;

/// A centre, and the square of the radius. NaN, which fails every comparison, where nothing is certain.
pub type Sphere = [f64; 4];

/// The sphere of ghosts and of tetrahedra that are too flat.
pub const UNKNOWN: Sphere = [f64::NAN; 4];

/// A corner as seen from the point at the origin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ray {
    /// The difference.
    pub d: Point3,
    /// Its squared length.
    pub lift: f64,
}

impl Ray {
    /// `q` as seen from `p`.
    #[inline]
    pub fn new(q: Point3, p: Point3) -> Self {
        let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        Self {
            d,
            lift: d[0] * d[0] + d[1] * d[1] + d[2] * d[2],
        }
    }
}

/// The sphere through `p` and three corners seen from it.
#[inline]
pub fn sphere(p: Point3, b: Ray, c: Ray, d: Ray) -> Sphere {
    const FLAT: f64 = f64::EPSILON; // 2^-52
    const SMALL: f64 = 1e-180; // above 2^-600
    const FAR: f64 = (1u64 << 60) as f64;
    let cross = |p: Point3, q: Point3| {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    };
    let (cd, db, bc) = (cross(c.d, d.d), cross(d.d, b.d), cross(b.d, c.d));
    let det = b.d[0] * cd[0] + b.d[1] * cd[1] + b.d[2] * cd[2];
    let half = 0.5 / det;
    let center = |k: usize| (b.lift * cd[k] + c.lift * db[k] + d.lift * bc[k]) * half;
    let [x, y, z] = [center(0), center(1), center(2)];
    let square = x * x + y * y + z * z;
    let volume = b.lift * c.lift * d.lift;
    let [cx, cy, cz] = [p[0] + x, p[1] + y, p[2] + z];
    let certain = (det * det > FLAT * volume)
        & (volume > SMALL)
        & (cx * cx + cy * cy + cz * cz < FAR * square);
    [cx, cy, cz, if certain { square } else { f64::NAN }]
}

/// The power of `q`: negative inside; `None` where it is not certain.
#[inline]
pub fn inside([x, y, z, square]: Sphere, q: Point3) -> Option<bool> {
    let (dx, dy, dz) = (q[0] - x, q[1] - y, q[2] - z);
    let distance = dx * dx + dy * dy + dz * dz;
    let power = distance - square;
    (power.abs() > SLACK * (distance + square)).then_some(power < 0.0)
}
