//! Comparisons of Fortune's sweep: a vertical line moves to the right and stops at points and at
//! the right ends of circles. S. Fortune, "A sweepline algorithm for Voronoi diagrams",
//! Algorithmica 2 (1987).
//!
//! # Which of two parabolas is in front
//!
//! The circle that touches the vertical line through q in q and passes through a has the radius
//! |a - q|^2 / (2 (qx - ax)). So the parabola of b is in front of that of a, at the height of q,
//! where |a - q|^2 (qx - bx) - |b - q|^2 (qx - ax) > 0: degree 3.
//!
//! # Right ends of circles
//!
//! With u = a - b, v = c - b, w = c - a, the circle through a, b, c ends at
//! bx + (n + sqrt l) / (2 d), d = u x v, n = |u|^2 vy - |v|^2 uy, l = |u|^2 |v|^2 |w|^2. With
//! x = b1x - b2x and d > 0, two ends compare as A + sqrt P - sqrt Q compares with zero, where
//! A = 2 d1 d2 x + n1 d2 - n2 d1, P = d2^2 l1, Q = d1^2 l2. If A and P - Q do not have opposite
//! signs, the sign of either that is not zero answers. If A > 0 > P - Q, both sides of
//! A + sqrt P <> sqrt Q may be squared, and then both sides of 2 A sqrt P <> U = Q - P - A^2 where
//! U > 0; the case A < 0 < P - Q is this one with the circles exchanged. The degree is 20 at most,
//! and 10 where A = 0, as between the equal circles of a column of a grid.
//!
//! # The bound of the estimate
//!
//! Let e = 2^-53. Rounded differences err by a factor 1 + e, |u|^2 by 4 e, |u| by 3 e, their
//! product sqrt l by 11 e, a term of n by 6 e and n by 7 e M in all, M = |u|^2 |vy| + |v|^2 |uy|;
//! the numerator N = n + sqrt l then by less than f = 14 e (M + sqrt l) with room for what is of
//! second order. d errs by less than g = 8 e (|ux vy| + |uy vx|), which is twice what is needed. If
//! g < d / 4, N / 2d errs by at most 2/3 (f + |N| g / d) / d; the third that is left holds the
//! roundings of the division and of the bound. Adding bx errs by e of the sum.
//!
//! Where n < 0 the two parts of N cancel, which is bad for great circles that end near their
//! points. Since l - n^2 = m^2, m = |u|^2 vx - |v|^2 ux, which is the center's ordinate times 2 d,
//! then N = m^2 / t, t = sqrt l - n. m errs by less than h = 8 e (|u|^2 |vx| + |v|^2 |ux|), t by
//! less than f, and if f < t / 4, then N by less than 4/3 ((2 |m| + h) h + N f) / t; 2 is taken for
//! 4/3, and 14 e N holds the roundings.
//!
//! Squared lengths between 2^-300 and 2^300 exclude overflow, and what underflow adds to N vanishes
//! before f; to d it adds 2^-1073 at most, which g gets. m^2 / t may be far below all doubles and
//! yet count, as d may be small, too: so `FLOOR` is added after that division, and g / d, which
//! exceeds 2^-51, is taken first; `UNDERFLOW` is what N / 2d and the bound itself may lose. Other
//! triples are scaled by a power of two to coordinates below 1, off by at most 2^-1074 each, the largest of which has its last bit at
//! 2^-53 or is a multiple of 2^-52. The triple is not collinear, so two points differ in that
//! coordinate, by 2^-54 at least, and two of the lengths exceed 2^-56. Then squared lengths from
//! 2^-1000 on suffice: sqrt l exceeds 2^-612, and what underflow adds vanishes as before. In m it
//! matters only where the larger of the two terms is subnormal; m^2 then errs by less than `FLOOR`,
//! as it does where it underflows itself.

use std::ops::RangeInclusive;

use crate::Point2;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{exponent_field, lattice, power_of_two};
use crate::sign::Sign;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// Relative bound of [`front`]: each of two positive terms passes 6 roundings, their difference one
/// that changes no sign; the rest is for terms of second order and for the bound.
const BOUND_FRONT: f64 = 8.0 * U;
/// Bound f of the estimate.
const BOUND_NUMERATOR: f64 = 14.0 * U;
/// Bound of n and m alone.
const BOUND_WEIGHTED: f64 = 8.0 * U;
/// Bound g of the estimate.
const BOUND_CROSS: f64 = 8.0 * U;
/// Above any error of underflow.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// Eight roundings of subnormal numbers.
const UNDERFLOW: f64 = f64::from_bits(4);
/// Squared lengths for which the estimate is bounded: 2^-300 to 2^300.
const LENGTHS: RangeInclusive<f64> = {
    let top = power_of_two(300);
    1.0 / top..=top
};
/// [`LENGTHS`] of scaled triples.
const LENGTHS_SCALED: RangeInclusive<f64> = power_of_two(-1000)..=8.0;
/// Most bits of differences for a 128-bit [`front`]: below 4 * 2^3b.
const BITS_FRONT: u32 = 41;
/// Most bits of differences within a triple for which P and Q stay below 2^117.
const BITS_TRIPLE: u32 = 11;
/// With it, most bits of 4 d1 d2 x, so that A stays below 2^62.
const BITS_SHIFT: u32 = 60;

/// Which of the parabolas of `a` and `b` is in front at the height of `q`, when the sweep line has
/// reached `q`: positive for that of `b`, zero if both pass through one point there.
///
/// Neither `a` nor `b` may lie right of `q`.
#[inline]
#[must_use]
pub fn front(a: Point2, b: Point2, q: Point2) -> Sign {
    let [(ax, ay), (bx, by)] = [a, b].map(|p| (q[0] - p[0], q[1] - p[1]));
    let (far, near) = ((ax * ax + ay * ay) * bx, (bx * bx + by * by) * ax);
    let det = far - near;
    if det.abs() > BOUND_FRONT * (far + near) + FLOOR * (1.0 + ax + bx) {
        Sign::of(det)
    } else {
        front_exact(a, b, q)
    }
}

#[cold]
#[inline(never)]
fn front_exact(a: Point2, b: Point2, q: Point2) -> Sign {
    let found = lattice([q[0], q[1], q[0], q[1]], [a[0], a[1], b[0], b[1]]);
    if let Some(found) = found {
        let v = found.values;
        if found.bits <= BITS_FRONT {
            let [ax, ay, bx, by] = v.map(i128::from);
            return Sign::from((ax * ax + ay * ay) * bx - (bx * bx + by * by) * ax);
        }
        let [ax, ay, bx, by] = v.map(Integer::new);
        return front_sign::<1, 2, 3>(&[ax, ay], &[bx, by], false);
    }
    let points = [a, b, q];
    by_width(
        &points,
        |low| front_from_points::<2, 4, 6>(&points, low),
        |low| front_from_points::<5, 10, 15>(&points, low),
        |low| front_from_points::<12, 24, 36>(&points, low),
        |low| front_from_points::<FULL, { 2 * FULL }, { 3 * FULL }>(&points, low),
    )
}

fn front_from_points<const D: usize, const D2: usize, const D3: usize>(
    points: &[Point2; 3],
    low: i32,
) -> Sign {
    let [a, b] = differences::<D, 2, 3, 2>(points, low);
    front_sign::<D, D2, D3>(&a, &b, true)
}

/// The sign of |a|^2 bx - |b|^2 ax, for a and b relative to q, or q relative to them.
fn front_sign<const D: usize, const D2: usize, const D3: usize>(
    a: &[Integer<D>; 2],
    b: &[Integer<D>; 2],
    reversed: bool,
) -> Sign {
    let far: Integer<D3> = length::<D, D2>(a).times(&b[0]);
    let near = length::<D, D2>(b).times(&a[0]);
    far.minus(&near).sign().flip_if(reversed)
}

/// The right end of the circle through three points, rounded, with an error bound.
#[derive(Clone, Copy, Debug)]
pub struct CircleEnd {
    /// The approximate abscissa.
    pub value: f64,
    /// The error bound; infinite if nothing is known.
    pub error: f64,
}

impl CircleEnd {
    /// The end of the circle through three points, which turn right.
    #[inline]
    #[must_use]
    pub fn of(triple: [Point2; 3]) -> Self {
        let end = Self::within(&LENGTHS, triple);
        if end.error < f64::INFINITY {
            end
        } else {
            Self::scaled(triple)
        }
    }

    /// The end, if the squared lengths are `allowed`.
    #[inline]
    fn within(allowed: &RangeInclusive<f64>, [a, b, c]: [Point2; 3]) -> Self {
        let minus = |p: Point2, q: Point2| [p[0] - q[0], p[1] - q[1]];
        let (u, v, w) = (minus(a, b), minus(c, b), minus(c, a));
        let lengths = [u, v, w].map(|p| p[0] * p[0] + p[1] * p[1]);
        let [uu, vv, _] = lengths;
        let (left, right) = (u[0] * v[1], u[1] * v[0]);
        let d = left - right;
        let g = BOUND_CROSS * (left.abs() + right.abs()) + FLOOR;
        let root = lengths.iter().map(|l| l.sqrt()).product::<f64>();
        let (n, n_size) = weighted(uu, v[1], vv, u[1]);
        let mut numerator = n + root;
        let mut f = BOUND_NUMERATOR * (n_size + root);
        let mut sound = true;
        if n < 0.0 {
            let (m, m_size) = weighted(uu, v[0], vv, u[0]);
            let (t, h) = (root - n, BOUND_WEIGHTED * m_size);
            sound = f < 0.25 * t;
            numerator = m * m / t;
            let square = (2.0 * m.abs() + h) * h + numerator * f;
            f = (2.0 * square + FLOOR) / t + BOUND_NUMERATOR * numerator + FLOOR;
        }
        let value = b[0] + 0.5 * numerator / d;
        let error = (f + numerator.abs() * (g / d)) / d + (2.0 * U * value.abs() + UNDERFLOW);
        let known = sound && g < 0.25 * d && lengths.iter().all(|l| allowed.contains(l));
        Self::bounded(value, if known { error } else { f64::INFINITY })
    }

    /// Values that are not finite are unknown.
    #[inline]
    fn bounded(value: f64, error: f64) -> Self {
        let error = if value.is_finite() && error.is_finite() {
            error
        } else {
            f64::INFINITY
        };
        Self { value, error }
    }

    /// The end, computed with coordinates scaled below 1.
    #[cold]
    #[inline(never)]
    fn scaled(triple: [Point2; 3]) -> Self {
        let fields = triple.as_flattened().iter().map(|&x| exponent_field(x));
        // From 0 to 2046 for finite numbers; the largest goes to 1022, that of 1/2.
        let shift = 1022 - fields.fold(0, i32::max).min(2046);
        let [first, second] = [shift / 2, shift - shift / 2];
        let there = triple.map(|p| p.map(|x| x * power_of_two(first) * power_of_two(second)));
        let end = Self::within(&LENGTHS_SCALED, there);
        let back = |x: f64| x * power_of_two(-first) * power_of_two(-second);
        // Scaling back may underflow slightly, too.
        Self::bounded(back(end.value), back(end.error) + UNDERFLOW)
    }

    /// The sign of this end minus another, if the bounds prove it.
    #[inline]
    #[must_use]
    pub fn minus(&self, other: &Self) -> Option<Sign> {
        let difference = self.value - other.value;
        (difference.abs() > self.error + other.error).then(|| Sign::of(difference))
    }

    /// The sign of this end minus `x`, if the bound proves it.
    #[inline]
    #[must_use]
    pub fn minus_abscissa(&self, x: f64) -> Option<Sign> {
        let difference = self.value - x;
        (difference.abs() > self.error).then(|| Sign::of(difference))
    }
}

/// `p x - q y` and the sum of the magnitudes of its terms, for nonnegative `p` and `q`.
#[inline]
fn weighted(p: f64, x: f64, q: f64, y: f64) -> (f64, f64) {
    let (left, right) = (p * x, q * y);
    (left - right, left.abs() + right.abs())
}

/// The sign of the right end of the circle through `s` minus that of the circle through `t`; exact.
/// Both triples turn right.
#[cold]
#[inline(never)]
#[must_use]
pub fn circle_ends(s: [Point2; 3], t: [Point2; 3]) -> Sign {
    if mirrored(s, t) {
        return Sign::Zero;
    }
    lattice_ends(s, t).unwrap_or_else(|| integer_ends(s, t))
}

/// Whether the circles are equal up to their height, found without big numbers: the middle points
/// have equal abscissas, and the others are placed alike relative to them, or mirrored vertically.
/// Differences that are not exact prove nothing.
fn mirrored(s: [Point2; 3], t: [Point2; 3]) -> bool {
    if s[1][0] != t[1][0] {
        return false;
    }
    let seen = |[a, b, c]: [Point2; 3]| [a, c].map(|p| [p[0] - b[0], p[1] - b[1]]);
    let exact = |[a, b, c]: [Point2; 3]| {
        [a, c].iter().all(|p| {
            (0..2).all(|k| {
                let (difference, error) = crate::expansion::two_difference(p[k], b[k]);
                error == 0.0 && difference.is_finite()
            })
        })
    };
    let (s_seen, t_seen) = (seen(s), seen(t));
    let flipped = [t_seen[1], t_seen[0]].map(|[x, y]| [x, -y]);
    (s_seen == t_seen || s_seen == flipped) && exact(s) && exact(t)
}

/// Like [`circle_ends`], if the differences lie on a lattice of 64-bit integers.
pub fn lattice_ends(s: [Point2; 3], t: [Point2; 3]) -> Option<Sign> {
    let [[a, b, c], [e, f, g]] = [s, t];
    let found = lattice(
        [
            a[0], a[1], c[0], c[1], c[0], c[1], e[0], e[1], g[0], g[1], g[0], g[1], b[0],
        ],
        [
            b[0], b[1], b[0], b[1], a[0], a[1], f[0], f[1], f[0], f[1], e[0], e[1], f[0],
        ],
    )?;
    let v = found.values;
    let width = |v: &[i64]| v.iter().fold(0, |all, x| all | x.unsigned_abs());
    let bits = |v: &[i64]| u64::BITS - width(v).leading_zeros();
    let (triple, shift) = (bits(&v[..12]), bits(&v[12..]));
    if triple <= BITS_TRIPLE && 4 * triple + 3 + shift <= BITS_SHIFT {
        return Some(narrow_ends(v.map(i128::from)));
    }
    let v = v.map(Integer::new);
    let triple = |k: usize| [[v[k], v[k + 1]], [v[k + 2], v[k + 3]], [v[k + 4], v[k + 5]]];
    Some(wide_ends::<1, 2, 3, 4, 5, 6, 10, 20>(
        triple(0),
        triple(6),
        v[12],
    ))
}

/// The sign for u, v, w of both triples and x, of few bits: see [`BITS_TRIPLE`].
fn narrow_ends(all: [i128; 13]) -> Sign {
    let circle = |v: &[i128]| {
        let length = |k: usize| v[k] * v[k] + v[k + 1] * v[k + 1];
        let [uu, vv, ww] = [0, 2, 4].map(length);
        (
            v[0] * v[3] - v[1] * v[2],
            uu * v[3] - vv * v[1],
            uu * vv * ww,
        )
    };
    let (d1, n1, l1) = circle(&all[..6]);
    let (d2, n2, l2) = circle(&all[6..12]);
    let a = 2 * d1 * d2 * all[12] + n1 * d2 - n2 * d1;
    let (p, q) = (d2 * d2 * l1, d1 * d1 * l2);
    let (by_a, by_root) = (Sign::from(a), Sign::from(p - q));
    if by_a * by_root != Sign::Negative {
        return either(by_a, by_root);
    }
    let (p, q) = if by_a == Sign::Positive {
        (p, q)
    } else {
        (q, p)
    };
    let u = q - p - a * a;
    if u <= 0 {
        return by_a;
    }
    let left: Integer<4> = Integer::<2>::from(4 * a * a).times(&Integer::<2>::from(p));
    let right = Integer::<2>::from(u).times(&Integer::<2>::from(u));
    by_a * left.minus(&right).sign()
}

/// Of two signs that are not opposite, the one that is not zero.
fn either(a: Sign, b: Sign) -> Sign {
    if a.is_zero() { b } else { a }
}

/// Like [`circle_ends`], by integers that hold every double.
#[cold]
#[inline(never)]
pub fn integer_ends(s: [Point2; 3], t: [Point2; 3]) -> Sign {
    const F: usize = FULL;
    let points = [s[0], s[2], t[0], t[1], t[2], s[1]];
    by_width(
        &points,
        |low| from_points::<2, 4, 6, 8, 10, 12, 20, 40>(&points, low),
        |low| from_points::<5, 10, 15, 20, 25, 30, 50, 100>(&points, low),
        |low| from_points::<12, 24, 36, 48, 60, 72, 120, 240>(&points, low),
        |low| {
            from_points::<
                F,
                { 2 * F },
                { 3 * F },
                { 4 * F },
                { 5 * F },
                { 6 * F },
                { 10 * F },
                { 20 * F },
            >(&points, low)
        },
    )
}

/// The points as a, c, e, f, g, b of `[a, b, c]` and `[e, f, g]`.
fn from_points<
    const D: usize,
    const D2: usize,
    const D3: usize,
    const D4: usize,
    const D5: usize,
    const D6: usize,
    const D10: usize,
    const D20: usize,
>(
    points: &[Point2; 6],
    low: i32,
) -> Sign {
    let [a, c, e, f, g] = differences::<D, 2, 6, 5>(points, low);
    let minus = |p: &[Integer<D>; 2], q: &[Integer<D>; 2]| [p[0].minus(&q[0]), p[1].minus(&q[1])];
    let x = f[0].minus(&f[0]).minus(&f[0]);
    let second = [minus(&e, &f), minus(&g, &f), minus(&g, &e)];
    wide_ends::<D, D2, D3, D4, D5, D6, D10, D20>([a, c, minus(&c, &a)], second, x)
}

/// The squared length.
fn length<const D: usize, const D2: usize>(p: &[Integer<D>; 2]) -> Integer<D2> {
    p[0].times::<D, D2>(&p[0]).plus(&p[1].times(&p[1]))
}

/// Twice the number.
fn twice<const N: usize>(x: &Integer<N>) -> Integer<N> {
    x.plus(x)
}

/// The numbers d, n and l of a circle.
struct Circle<const D2: usize, const D3: usize, const D6: usize> {
    d: Integer<D2>,
    n: Integer<D3>,
    l: Integer<D6>,
}

/// Of differences u, v, w below W / 4, W = 2^64D: d < W^2 / 8, n < W^3 / 16, l < W^6 / 512.
fn circle<const D: usize, const D2: usize, const D3: usize, const D4: usize, const D6: usize>(
    [u, v, w]: &[[Integer<D>; 2]; 3],
) -> Circle<D2, D3, D6> {
    let [uu, vv, ww] = [u, v, w].map(length::<D, D2>);
    Circle {
        d: u[0].times::<D, D2>(&v[1]).minus(&u[1].times(&v[0])),
        n: uu.times::<D, D3>(&v[1]).minus(&vv.times(&u[1])),
        l: uu.times::<D2, D4>(&vv).times(&ww),
    }
}

/// The sign of A + sqrt P - sqrt Q for u, v, w of both triples and x.
///
/// A < 3 W^5 / 128, P and Q < W^10 / 2^15, U < W^10 / 2^10, and 4 A^2 P < W^20 / 2^22: all have
/// room.
fn wide_ends<
    const D: usize,
    const D2: usize,
    const D3: usize,
    const D4: usize,
    const D5: usize,
    const D6: usize,
    const D10: usize,
    const D20: usize,
>(
    first: [[Integer<D>; 2]; 3],
    second: [[Integer<D>; 2]; 3],
    x: Integer<D>,
) -> Sign {
    let s: Circle<D2, D3, D6> = circle::<D, D2, D3, D4, D6>(&first);
    let t: Circle<D2, D3, D6> = circle::<D, D2, D3, D4, D6>(&second);
    let crosses: Integer<D4> = s.d.times(&t.d);
    let a: Integer<D5> = twice(&crosses.times(&x))
        .plus(&s.n.times(&t.d))
        .minus(&t.n.times(&s.d));
    let p: Integer<D10> = t.d.times::<D2, D4>(&t.d).times(&s.l);
    let q: Integer<D10> = s.d.times::<D2, D4>(&s.d).times(&t.l);
    let (by_a, by_root) = (a.sign(), p.minus(&q).sign());
    if by_a * by_root != Sign::Negative {
        return either(by_a, by_root);
    }
    let (p, q) = if by_a == Sign::Positive {
        (p, q)
    } else {
        (q, p)
    };
    let square: Integer<D10> = a.times(&a);
    let u = q.minus(&p).minus(&square);
    if u.sign() != Sign::Positive {
        return by_a;
    }
    let left: Integer<D20> = twice(&twice(&square)).times(&p);
    by_a * left.minus(&u.times(&u)).sign()
}

/// The sign of the right end of the circle through `[a, b, c]`, which turn right, minus `x`; exact.
///
/// With B = b - (x, by) it is that of A + sqrt l, A = 2 d Bx + n.
#[cold]
#[inline(never)]
#[must_use]
pub fn circle_end_abscissa([a, b, c]: [Point2; 3], x: f64) -> Sign {
    let found = lattice(
        [a[0], a[1], c[0], c[1], c[0], c[1], b[0]],
        [b[0], b[1], b[0], b[1], a[0], a[1], x],
    );
    if let Some(found) = found {
        let [ux, uy, vx, vy, wx, wy, x] = found.values.map(Integer::new);
        return end_sign::<1, 2, 3, 4, 6>([[ux, uy], [vx, vy], [wx, wy]], &x);
    }
    const F: usize = FULL;
    let points = [a, c, [x, b[1]], b];
    by_width(
        &points,
        |low| end_from_points::<2, 4, 6, 8, 12>(&points, low),
        |low| end_from_points::<5, 10, 15, 20, 30>(&points, low),
        |low| end_from_points::<12, 24, 36, 48, 72>(&points, low),
        |low| end_from_points::<F, { 2 * F }, { 3 * F }, { 4 * F }, { 6 * F }>(&points, low),
    )
}

fn end_from_points<
    const D: usize,
    const D2: usize,
    const D3: usize,
    const D4: usize,
    const D6: usize,
>(
    points: &[Point2; 4],
    low: i32,
) -> Sign {
    let [u, v, line] = differences::<D, 2, 4, 3>(points, low);
    let w = [v[0].minus(&u[0]), v[1].minus(&u[1])];
    let x = line[1].minus(&line[0]);
    end_sign::<D, D2, D3, D4, D6>([u, v, w], &x)
}

/// A < 2 W^2/8 W/4 + W^3/16 = W^3 / 8.
fn end_sign<const D: usize, const D2: usize, const D3: usize, const D4: usize, const D6: usize>(
    triple: [[Integer<D>; 2]; 3],
    x: &Integer<D>,
) -> Sign {
    let s: Circle<D2, D3, D6> = circle::<D, D2, D3, D4, D6>(&triple);
    let a = twice(&s.d.times::<D, D3>(x)).plus(&s.n);
    if a.sign() == Sign::Negative {
        s.l.minus(&a.times(&a)).sign()
    } else {
        either(a.sign(), s.l.sign())
    }
}
