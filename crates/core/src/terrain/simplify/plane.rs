//! The plane of a triangle, and bounds on the vertical distance of points from it.
//!
//! With differences from a corner, w is twice the area, and the plane rises by a / w in x and by b / w
//! in y. A point is n / w away, n = w dz - (a dx + b dy).
//!
//! If coordinates and heights are multiples of powers of two, and numbers are small, as on rasters, then
//! no operation up to n rounds: a bound on the bits shows it, and the quotient is rounded upward.
//!
//! Otherwise n is computed with an error. Of the terms in w dz, each has at most 7 rounded operations on
//! its way, those in a dx and b dy at most 8, so that the error is below 9 u (W |dz| + A |dx| + B |dy|)
//! with u = 2^-53, where W, A and B have sums of absolute values in place of differences; in the triangle
//! dx and dy are at most those of its corners. 16 u covers this with the rounding of the bound itself.
//! Likewise w has an error below 5 u W, and 8 u is used. Underflow adds far less than [`TINY`] as long as
//! differences are below 2^250; beyond, and where w may be 0, bounds are infinite, which is right, too.

use delone_predicates::{Point2, arithmetic, lexicographic};

/// Relative errors of n, of w, and of the operations after both.
const OF_N: f64 = 1.0 / (1_u64 << 49) as f64;
const OF_W: f64 = 1.0 / (1_u64 << 50) as f64;
const AFTER: f64 = 1.0 + OF_W;
/// 2^-800.
const TINY: f64 = f64::from_bits((1023 - 800) << 52);
/// Bits of a double, and the exponents within which nothing underflows or overflows.
const BITS: i32 = 53;
const RANGE: i32 = 900;

/// With fewer points than this, a maximum and a search take longer than comparisons.
const SHORT: usize = 8;

/// A point with its height.
pub type Raised = [f64; 3];

/// No point.
pub const NONE: u32 = u32::MAX;

/// The position of a point.
#[inline]
pub fn below([x, y, _]: Raised) -> Point2 {
    [x, y]
}

/// The lowest bit of numbers, and their extremes.
#[derive(Debug, Clone, Copy)]
struct Span {
    low: i32,
    min: f64,
    max: f64,
}

impl Span {
    const EMPTY: Self = Self {
        low: i32::MAX,
        min: f64::INFINITY,
        max: f64::NEG_INFINITY,
    };

    fn add(&mut self, x: f64) {
        let (magnitude, exponent) = arithmetic::decode_odd(x);
        if magnitude != 0 {
            self.low = self.low.min(exponent);
        }
        self.min = self.min.min(x);
        self.max = self.max.max(x);
    }

    /// The lowest bit, and how many bits a difference of two numbers has at most.
    fn bits(&self) -> (i32, i32) {
        let extent = self.max - self.min;
        if self.low == i32::MAX || extent <= 0.0 {
            return (0, 1);
        }
        let (magnitude, exponent) = arithmetic::decode_odd(extent);
        let high = exponent + 64 - magnitude.leading_zeros() as i32;
        (self.low, high - self.low)
    }
}

/// Whether distances from planes through some of the points are computed without rounding, given all x, y
/// and heights.
pub fn is_exact(
    x: impl Iterator<Item = f64>,
    y: impl Iterator<Item = f64>,
    z: impl Iterator<Item = f64>,
) -> bool {
    let (mut across, mut up) = ([Span::EMPTY; 2], Span::EMPTY);
    x.for_each(|x| across[0].add(x));
    y.for_each(|y| across[1].add(y));
    z.for_each(|z| up.add(z));
    let low = across[0].low.min(across[1].low);
    let [kx, ky] = across.map(|axis| Span { low, ..axis }.bits().1);
    let (k, (rise, m)) = (kx.max(ky), up.bits());
    if low == i32::MAX || k > BITS || m > BITS {
        return false;
    }
    let (least, width) = (2 * low + rise, 2 * k + m + 3);
    width <= BITS && least.min(2 * low) > -RANGE && least + width < RANGE
}

/// The plane of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    origin: Raised,
    /// The smallest bound on w, its value, and the slopes times w.
    least: f64,
    w: f64,
    a: f64,
    b: f64,
    /// The error of n: a constant, and a factor of |dz|; both 0 without rounding.
    constant: f64,
    factor: f64,
    level: bool,
    exact: bool,
}

impl Plane {
    /// The plane of a counterclockwise triangle. The corners may be given from any of them on.
    pub fn of(mut corners: [Raised; 3], exact: bool) -> Self {
        let smaller = |p: Raised, q: Raised| lexicographic(below(p), below(q)).is_lt();
        while smaller(corners[1], corners[0]) || smaller(corners[2], corners[0]) {
            corners.rotate_left(1);
        }
        let [o, p, q] = corners;
        let [[px, py, pz], [qx, qy, qz]] = [p, q].map(|p| [p[0] - o[0], p[1] - o[1], p[2] - o[2]]);
        let w = px * qy - py * qx;
        let a = pz * qy - qz * py;
        let b = px * qz - qx * pz;
        let mut plane = Self {
            origin: o,
            least: w,
            w,
            a,
            b,
            constant: 0.0,
            factor: 0.0,
            level: pz == 0.0 && qz == 0.0,
            exact,
        };
        if !exact {
            let sum = |r: f64, s: f64| r.abs() + s.abs();
            let all = sum(px * qy, py * qx);
            let along = px.abs().max(qx.abs()) * sum(pz * qy, qz * py);
            let across = py.abs().max(qy.abs()) * sum(px * qz, qx * pz);
            plane.least = w - all * OF_W - TINY * TINY;
            plane.constant = (along + across) * OF_N + TINY;
            plane.factor = all * OF_N;
        }
        plane
    }

    /// At least |n| for a point in the triangle; NaN if numbers are too large.
    #[inline]
    pub fn offset(&self, [x, y, z]: Raised) -> f64 {
        let (dx, dy, dz) = (x - self.origin[0], y - self.origin[1], z - self.origin[2]);
        let n = (self.w * dz - (self.a * dx + self.b * dy)).abs();
        if self.exact {
            return n;
        }
        if self.level && dz == 0.0 {
            return 0.0;
        }
        n + (self.constant + self.factor * dz.abs())
    }

    /// The first of the points of a column whose offset is greatest, and this offset, if it is greater than
    /// `least`; heights that are NaN belong to no point.
    #[inline]
    pub fn worst_of(&self, x: f64, y: &[f64], z: &[f64], least: f64) -> Option<(usize, f64)> {
        if !self.exact {
            return first_greatest(y, z, least, |y, z| self.offset([x, y, z]));
        }
        // As in `offset`, without what is the same for all.
        let [ox, oy, oz] = self.origin;
        let (w, across, b) = (self.w, self.a * (x - ox), self.b);
        let offset = |y: f64, z: f64| (w * (z - oz) - (across + b * (y - oy))).abs();
        first_greatest(y, z, least, offset)
    }

    /// At least |n| / w, for a bound on |n|.
    #[inline]
    pub fn distance(&self, offset: f64) -> f64 {
        if offset == 0.0 {
            return 0.0;
        }
        if self.exact {
            let found = offset / self.w;
            let back = arithmetic::Pair::product(found, self.w);
            return if offset - back.hi > back.lo {
                found.next_up()
            } else {
                found
            };
        }
        let found = offset / self.least * AFTER;
        if self.least > 0.0 && !found.is_nan() {
            return found;
        }
        f64::INFINITY
    }
}

/// The first of the greatest offsets of points, and its number, if it is greater than `least`. Offsets that
/// are NaN do not count.
#[inline(always)]
fn first_greatest(
    y: &[f64],
    z: &[f64],
    least: f64,
    offset: impl Fn(f64, f64) -> f64,
) -> Option<(usize, f64)> {
    let mut most = least;
    // A few points are compared one by one.
    if z.len() < SHORT {
        let mut at = None;
        for (k, (&y, &z)) in y.iter().zip(z).enumerate() {
            let offset = offset(y, z);
            if offset > most {
                (at, most) = (Some(k), offset);
            }
        }
        return at.map(|k| (k, most));
    }
    for (&y, &z) in y.iter().zip(z) {
        let offset = offset(y, z);
        most = if offset > most { offset } else { most };
    }
    if most > least {
        // The greatest offset rarely grows, so the point is searched only then.
        let mut all = y.iter().zip(z);
        return all
            .position(|(&y, &z)| offset(y, z) == most)
            .map(|k| (k, most));
    }
    None
}
