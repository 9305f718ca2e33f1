//! Double-double arithmetic for areas: quotients, roots, unit vectors, and products of complex
//! numbers.
//!
//! # The area as one product
//!
//! With w = (x + i y) / (1 + z), half the area of the triangle of a pole, p and q is the argument
//! of 1 + conj(w_p) w_q. So a sum of such areas is twice the argument of one product: roots and one
//! arc tangent are the only functions, and the product loses nothing where triangles cancel. A
//! factor errs by some 2^-100 of its size, so the area of k factors errs by k 2^-99 steradians and
//! a unit in its last place (H. Eriksson, "On the measure of solid angles", Mathematics Magazine
//! 63, 1990).

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;

/// A vector of pairs.
pub type Pair3 = [Pair; 3];

/// Zero.
pub const ZERO: Pair = Pair { hi: 0.0, lo: 0.0 };
/// One.
pub const ONE: Pair = Pair { hi: 1.0, lo: 0.0 };

/// The double as a pair.
#[inline]
pub fn pair(x: f64) -> Pair {
    Pair::from_double(x)
}

/// The number with the other sign.
#[inline]
pub fn negated(a: Pair) -> Pair {
    Pair {
        hi: -a.hi,
        lo: -a.lo,
    }
}

/// A pair times a power of two.
#[inline]
fn times(a: Pair, power: f64) -> Pair {
    Pair {
        hi: a.hi * power,
        lo: a.lo * power,
    }
}

/// A pair times two to the power of an exponent, which may be out of range.
pub fn scaled(mut a: Pair, exponent: i64) -> Pair {
    const STEP: i64 = 1000;
    let mut left = exponent.clamp(-4 * STEP, 4 * STEP);
    while left != 0 {
        let step = left.clamp(-STEP, STEP);
        a = times(a, f64::from_bits(((1023 + step) as u64) << 52));
        left -= step;
    }
    a
}

/// The quotient, by three steps of long division: to 2^-100 of itself.
#[inline]
pub fn quotient(a: Pair, b: Pair) -> Pair {
    let first = a.hi / b.hi;
    let rest = a - b * pair(first);
    let second = rest.hi / b.hi;
    let rest = rest - b * pair(second);
    pair(first) + pair(second) + pair(rest.hi / b.hi)
}

/// The square root, by one step of Newton's method: to 2^-101 of itself; 0 below zero.
#[inline]
pub fn root(a: Pair) -> Pair {
    if a.hi <= 0.0 {
        return ZERO;
    }
    let r = a.hi.sqrt();
    let rest = a - Pair::product(r, r);
    pair(r) + pair(rest.hi / (2.0 * r))
}

/// The cross product.
#[inline]
pub fn cross(a: &Pair3, b: &Pair3) -> Pair3 {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The cross product of doubles. For entries below 2 it errs by less than 2^-101 per coordinate:
/// two exact products below 4, and a difference that errs by 4 u^2 of their sum, where u = 2^-53.
#[inline]
pub fn cross_of(a: Point3, b: Point3) -> Pair3 {
    let minor = |i: usize, j: usize| Pair::product(a[i], b[j]) - Pair::product(a[j], b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The dot product.
#[inline]
pub fn dot(a: &Pair3, b: &Pair3) -> Pair {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The heads of a vector.
#[inline]
pub fn heads(a: &Pair3) -> Point3 {
    a.map(|x| x.hi)
}

/// The vector, of which only the direction counts, large enough that squares do not vanish: normals of
/// sides as short as 1e-300 are as small.
#[inline]
pub fn raised(v: &Pair3) -> Pair3 {
    const LIFT: f64 = f64::from_bits((1023 + 500) << 52);
    let top = v.iter().fold(0.0, |top: f64, x| top.max(x.hi.abs()));
    if top >= 1e-100 || top == 0.0 {
        return *v;
    }
    let once = v.map(|x| times(x, LIFT));
    if top >= 1e-250 {
        once
    } else {
        once.map(|x| times(x, LIFT))
    }
}

/// The vector times the power of two that brings its largest coordinate to 1 <= |x| < 2, so that
/// squares are in range. It must not be zero.
#[inline]
pub fn leveled(v: &Pair3) -> Pair3 {
    let top = v.iter().fold(0.0, |top: f64, x| top.max(x.hi.abs()));
    let exponent = ((top.to_bits() >> 52) & 0x7ff) as i64 - 1023;
    let up = f64::from_bits(((1023 - exponent).clamp(1, 2046) as u64) << 52);
    v.map(|x| times(x, up))
}

/// The vector divided by its length; zero stays zero.
#[inline]
pub fn unit(v: &Pair3) -> Pair3 {
    if v.iter().all(|x| x.hi == 0.0) {
        return [ZERO; 3];
    }
    let v = leveled(v);
    let inverse = quotient(ONE, root(dot(&v, &v)));
    v.map(|x| x * inverse)
}

/// One of six rotations that bring an axis of coordinates to the pole; exact.
#[inline]
pub fn chart(axis: usize, p: &Pair3) -> Pair3 {
    let [x, y, z] = *p;
    match axis {
        0 => [x, y, z],
        1 => [x, negated(y), negated(z)],
        2 => [y, z, x],
        3 => [z, y, negated(x)],
        4 => [z, x, y],
        _ => [x, z, negated(y)],
    }
}

/// Parts of cells are above this height in the chart of their sum: a row that crosses the equator
/// reaches at most 60.3 degrees beyond it (`bands`), to -0.87, and a cell within the hemisphere around
/// a vector reaches -sqrt(2/3) in the chart of that.
pub const LOWEST: f64 = -0.9;

/// The chart whose pole is the axis nearest to a vector.
pub fn chart_of(c: Point3) -> usize {
    let mut top = 0;
    for k in 1..3 {
        if c[k].abs() > c[top].abs() {
            top = k;
        }
    }
    [[2, 3], [4, 5], [0, 1]][top][usize::from(c[top] < 0.0)]
}

/// Where the area of a side is measured from: its start, or its end if the start is below
/// [`LOWEST`], near the opposite of the pole, where factors lose digits and then vanish.
///
/// A side that has a place at or above `LOWEST` has an end there: its height is a sine, which below
/// zero has no maximum but at its ends. And a start below `LOWEST` is in no part that is above, so
/// no part begins there.
#[inline]
pub fn base(axis: usize, start: &Pair3, end: &Pair3) -> Spot {
    let from = spot(axis, start);
    if from[2].hi < 1.0 + LOWEST {
        spot(axis, end)
    } else {
        from
    }
}

/// A place in a chart: x and y, and its height above the opposite of the pole, for a vector of any
/// length. Of a unit vector that is 1 + z.
pub type Spot = [Pair; 3];

/// The place of a unit vector.
#[inline]
pub fn spot(axis: usize, p: &Pair3) -> Spot {
    spot_of(axis, p, ONE)
}

/// The place of a vector with a length.
#[inline]
pub fn spot_of(axis: usize, p: &Pair3, length: Pair) -> Spot {
    let [x, y, z] = chart(axis, p);
    [x, y, length + z]
}

/// The place of a vector that is not zero, without dividing by its length.
#[inline]
pub fn toward(axis: usize, v: &Pair3) -> Spot {
    let v = leveled(v);
    spot_of(axis, &v, root(dot(&v, &v)))
}

/// The factor of the triangle of the pole and two places of its chart.
#[inline]
pub fn factor(p: &Spot, q: &Spot) -> (Pair, Pair) {
    let re = p[2] * q[2] + p[0] * q[0] + p[1] * q[1];
    let im = p[0] * q[1] - p[1] * q[0];
    (re, im)
}

/// A product of complex numbers, of which only the argument counts, and a sum of small areas.
#[derive(Clone, Copy)]
pub struct Turn {
    re: Pair,
    im: Pair,
    /// The areas between parallels and their chords.
    pub extra: f64,
}

impl Turn {
    /// The empty product.
    pub fn new() -> Self {
        Self {
            re: ONE,
            im: ZERO,
            extra: 0.0,
        }
    }

    /// Adds a triangle, or subtracts it.
    #[inline]
    pub fn mul(&mut self, (re, im): (Pair, Pair), minus: bool) {
        const FAR: f64 = (1_u128 << 100) as f64;
        let im = if minus { negated(im) } else { im };
        let (x, y) = (self.re * re - self.im * im, self.re * im + self.im * re);
        let top = x.hi.abs().max(y.hi.abs());
        let power = if top > FAR {
            1.0 / FAR
        } else if top < 1.0 / FAR {
            FAR
        } else {
            1.0
        };
        (self.re, self.im) = (times(x, power), times(y, power));
    }

    /// Adds the area to the left of a ring.
    pub fn around(&mut self, axis: usize, ring: &[(Point3, Pair3)]) {
        let first = spot(axis, &ring[0].1);
        let mut last = first;
        for (_, unit) in &ring[1..] {
            let next = spot(axis, unit);
            self.mul(factor(&last, &next), false);
            last = next;
        }
        self.mul(factor(&last, &first), false);
    }

    /// The sum, from -2 pi to 2 pi.
    pub fn area(&self) -> f64 {
        2.0 * self.im.hi.atan2(self.re.hi) + self.extra
    }
}

/// The area between a parallel and its chord, over the angle `w`, where `s` is the sine of the
/// latitude and `k` the square of its cosine: 2 s k times the integral from 0 to w / 2 of sin^2 v /
/// (1 - k sin^2 v).
///
/// All terms of the integrand are positive. (The closed form 2 atan(s tan(w / 2)) - s w loses all
/// digits near a pole.) Up to 0.02 the series to w^9, whose next term is below 2^-60 of the sum;
/// beyond, Gauss with twelve points in pieces of at most 0.5.
pub fn sliver(s: f64, k: f64, w: f64) -> f64 {
    const X: [f64; 6] = [
        0.125_233_408_511_468_9,
        0.367_831_498_998_180_2,
        0.587_317_954_286_617_5,
        0.769_902_674_194_304_7,
        0.904_117_256_370_474_9,
        0.981_560_634_246_719_3,
    ];
    const W: [f64; 6] = [
        0.249_147_045_813_402_8,
        0.233_492_536_538_354_8,
        0.203_167_426_723_065_9,
        0.160_078_328_543_346_2,
        0.106_939_325_995_318_4,
        0.047_175_336_386_511_8,
    ];
    let u = w / 2.0;
    if u.abs() < 0.02 {
        let u2 = u * u;
        let third = 2.0 / 45.0 - 2.0 * k / 3.0 + k * k;
        let fourth = -1.0 / 315.0 + k / 5.0 - k * k + k * k * k;
        let series =
            1.0 / 3.0 + u2 * ((k - 1.0 / 3.0) / 5.0 + u2 * (third / 7.0 + u2 * fourth / 9.0));
        return 2.0 * s * k * u * u2 * series;
    }
    let pieces = (u.abs() / 0.5).ceil();
    let h = u / pieces;
    let mut sum = 0.0;
    for piece in 0..pieces as usize {
        for (x, weight) in X.iter().zip(W) {
            for x in [-x, *x] {
                let v = (h * (piece as f64 + 0.5 + x / 2.0)).sin();
                sum += weight * v * v / (1.0 - k * v * v);
            }
        }
    }
    s * k * sum * h
}
