//! Circumspheres of tetrahedra in plain floating point, with a proven error bound.
//!
//! # The bound
//!
//! Let u = 2^-53, let B, C, D be three corners relative to the fourth, p, rounded once, and L = |B|
//! |C| |D|. The center, relative to p, is c = N / (2 det) with N = |B|^2 (C x D) + |C|^2 (D x B) +
//! |D|^2 (B x C) and det = B . (C x D).
//!
//! *det.* Each of its six monomials goes through three differences, two products and three sums or
//! differences: 8 roundings. The sum of the magnitudes of the monomials is the permanent of the
//! matrix of magnitudes, at most 3!/3^(3/2) L < 1.16 L. So det errs by at most 9.3 u L, to first
//! order.
//!
//! *N.* Each component of C x D has monomials of at most |C| |D| in total (Cauchy), so those of a
//! component of N sum to at most (|B| + |C| + |D|) L. They go through at most 14 roundings: six
//! differences, three in the squared length, two in the cross product, the product of both, two
//! sums. The corners are on the sphere, so each length is at most 2 r, and each component errs by
//! at most 14 * 6 u r L = 84 u r L; all three, as a vector, by 146 u r L.
//!
//! *c.* Hence c errs by at most (146 u r L + 2 * 9.3 u r L) / (2 |det|) plus a rounding, less than 83 u r L / |det|.
//! A sphere is kept where det^2 > 2^-52 L^2, that is L / |det| < 2^26: then c errs by less than 83 * 2^-27 r < 2^-20 r.
//! (Terms of second order are 2^-20 of that; the computed L^2 errs by 20 u.)
//!
//! *Position.* The absolute center is p + c, rounded: an error of at most u |p + c| in each
//! coordinate. It is kept if |p + c|^2 < 2^60 r^2: less than 2^-22 r. The sum of both errors, E, is
//! less than 2^-19.5 r.
//!
//! *Power.* For a query q at distance d from the computed center, the power d^2 - r^2, with r the
//! distance of p from the same center, errs by at most 2 (d + r) E + 2 E^2 < 2^-18 (d r + r^2) <
//! 2^-17 (d^2 + r^2), and by a few u (d^2 + r^2) for its own roundings. [`SLACK`] = 2^-16 covers
//! it.
//!
//! *Range.* All coordinates are below 2^[`RANGE`] in magnitude, so each length is below 2^42, and
//! L^2 is above 2^-600, so each length is above 2^-384 and r above 2^-385. An underflow adds at
//! most 2^-1074, times at most three lengths: less than 2^-940, which is negligible compared with u
//! L r > 2^-53 2^-300 2^-385. If a sphere is certain, r < 2^27 2^42, and its fourth power is in
//! range.

use delone_predicates::Point3;

/// Relative uncertainty of a power, see the head of the file.
pub const SLACK: f64 = 1.0 / 65536.0;

/// Spheres are used only for coordinates below 2^RANGE.
pub const RANGE: i32 = 40;

/// A center and the squared radius. NaN, which fails every comparison, if nothing is certain.
pub type Sphere = [f64; 4];

/// The sphere of ghosts and of tetrahedra that are too flat.
pub const UNKNOWN: Sphere = [f64::NAN; 4];

/// A corner relative to the point at the origin.
#[derive(Clone, Copy)]
pub struct Ray {
    /// The difference.
    pub d: Point3,
    /// Its squared length.
    pub lift: f64,
}

impl Ray {
    /// `q` relative to `p`.
    #[inline(always)]
    pub fn new(q: Point3, p: Point3) -> Self {
        let d = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        Self {
            d,
            lift: d[0] * d[0] + d[1] * d[1] + d[2] * d[2],
        }
    }
}

/// The sphere through `p` and three corners relative to it; `doubt` is added to its squared radius.
#[inline(always)]
pub fn sphere(p: Point3, b: Ray, c: Ray, d: Ray, doubt: f64) -> Sphere {
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
    [cx, cy, cz, if certain { square + doubt } else { f64::NAN }]
}

/// The power of `q`: negative inside.
#[inline(always)]
pub fn power([x, y, z, square]: Sphere, q: Point3) -> f64 {
    let (dx, dy, dz) = (q[0] - x, q[1] - y, q[2] - z);
    dx * dx + dy * dy + dz * dz - square
}

/// The squared distance from the center beyond which a point is certainly outside.
#[inline]
pub fn reach(square: f64) -> f64 {
    // d^2 (1 - s) > r^2 (1 + s), with room to spare, for s = SLACK.
    square * (1.0 + 4.0 * SLACK)
}

/// Spheres computed side by side.
pub const LANES: usize = 8;

/// The corners of a star relative to its center.
pub struct Rays {
    all: [[f64; 4]; 64],
}

impl Default for Rays {
    fn default() -> Self {
        Self {
            all: [[0.0; 4]; 64],
        }
    }
}

impl Rays {
    /// Stores ray i.
    #[inline(always)]
    pub fn set(&mut self, i: usize, ray: Ray) {
        let [x, y, z] = ray.d;
        self.all[i] = [x, y, z, ray.lift];
    }
}

/// One coordinate by facet; rows at multiples of 4 KiB would conflict in the cache.
type Row = [f64; 136];

/// The corners of facets of a star, coordinate by coordinate. All are gathered before the first are
/// used: a load of data that was stored in pieces waits until it is in the cache.
pub struct Facets {
    corners: [[Row; 4]; 3],
}

impl Default for Facets {
    fn default() -> Self {
        Self {
            corners: [[[0.0; 136]; 4]; 3],
        }
    }
}

impl Facets {
    /// Stores the rays of facets.
    #[inline(always)]
    pub fn gather(&mut self, rays: &Rays, places: &[[u8; 3]]) {
        for (i, places) in places.iter().enumerate() {
            let i = i & 127;
            for (corner, &place) in self.corners.iter_mut().zip(places) {
                let [x, y, z, lift] = rays.all[usize::from(place) & 63];
                corner[0][i] = x;
                corner[1][i] = y;
                corner[2][i] = z;
                corner[3][i] = lift;
            }
        }
    }
}

/// Spheres computed side by side, and the powers of one point.
pub struct Lanes {
    /// Coordinate by coordinate; the squared radius is last.
    pub sphere: [[f64; LANES]; 4],
    /// Powers.
    pub power: [f64; LANES],
}

/// The spheres through `p` and the [`LANES`] facets from `from` on, and the powers of `aim`.
#[inline(always)]
pub fn spheres(p: Point3, facets: &Facets, from: usize, doubt: f64, aim: Point3) -> Lanes {
    let mut out = Lanes {
        sphere: [[0.0; LANES]; 4],
        power: [0.0; LANES],
    };
    let from = from & (127 & !(LANES - 1));
    let [b, c, d] = &facets.corners;
    let (b, c, d) = (lanes(b, from), lanes(c, from), lanes(d, from));
    for lane in 0..LANES {
        let ray = |[x, y, z, lift]: &[&[f64; LANES]; 4]| Ray {
            d: [x[lane], y[lane], z[lane]],
            lift: lift[lane],
        };
        let (b, c, d) = (ray(&b), ray(&c), ray(&d));
        let s = sphere(p, b, c, d, doubt);
        for (to, from) in out.sphere.iter_mut().zip(s) {
            to[lane] = from;
        }
        out.power[lane] = power(s, aim);
    }
    out
}

/// The coordinates of [`LANES`] rays from `from` on.
#[inline(always)]
fn lanes(rows: &[Row; 4], from: usize) -> [&[f64; LANES]; 4] {
    [
        part(&rows[0], from),
        part(&rows[1], from),
        part(&rows[2], from),
        part(&rows[3], from),
    ]
}

#[inline(always)]
fn part(row: &Row, from: usize) -> &[f64; LANES] {
    row[from..].first_chunk().unwrap_or(&[0.0; LANES])
}
