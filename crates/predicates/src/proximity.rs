//! Predicates of proximity graphs, in 2-D and 3-D: angles, lengths, and the regions of an edge that
//! must be empty.
//!
//! | predicate | sign of | degree |
//! |---|---|---|
//! | [`angle()`] | (a - p) . (b - p) | 2 |
//! | [`shorter()`] | \|d - c\|^2 - \|b - a\|^2 | 2 |
//! | [`lune()`] | B (p - a) . (b - a) - \|p - a\|^2 | 2, times B |
//! | [`arcs()`] | (B^2 - 1) C^2 - D^2, C and D cross and dot product at p | 4, times B^2 |
//! | [`spheres()`] | (\|c - a\| + \|d - b\|)^2 - \|b - a\|^2 | 4 |
//!
//! B is the parameter of a beta skeleton (D. G. Kirkpatrick and J. D. Radke, "A framework for
//! computational morphology", 1985), a double from 1 to 2.
//!
//! # The bounds of the filters
//!
//! Let u = 2^-53, and P an expression with magnitudes in place of terms. A monomial of a dot product
//! passes through two differences, a product and at most two sums: 5 roundings, and one more with
//! B. The last difference changes no sign. So 10 u times the computed P leaves room for the terms of
//! second order and the roundings of P. Squares of such sums err twice as much, and B^2 - 1, from
//! B - 1 (exact) times B + 1, by 2 u: 24 u P suffice. Each bound has a term for products that
//! underflow, by 2^-1075 each; where these are multiplied, it grows with the other factor. For
//! [`spheres()`], where roots are taken of squares, these must be far from underflow.

use crate::Point2;
use crate::integer::{FULL, Integer, by_width, differences};
use crate::range::{decode_odd, lattice};
use crate::sign::Sign;

/// Relative bound of the filters of degree 2, see the head of the file.
const BOUND: f64 = 10.0 * (f64::EPSILON / 2.0);
/// Relative bound of the filters of degree 4.
const BOUND_SQUARED: f64 = 24.0 * (f64::EPSILON / 2.0);
/// Absolute bound of the filters.
const FLOOR: f64 = f64::MIN_POSITIVE;
/// Squares above it have lost nothing to underflow.
const SAFE_SQUARE: f64 = 1e-280;
/// Most bits of lattice differences whose dot product, times 53 bits, has 128 bits.
const BITS_NARROW: u32 = 35;

/// `a - b`, rounded.
#[inline]
fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// The dot product, and the sum of the magnitudes of its terms.
#[inline]
fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> (f64, f64) {
    (0..D).fold((0.0, 0.0), |(sum, size), k| {
        let term = a[k] * b[k];
        (sum + term, size + term.abs())
    })
}

/// The squared length.
#[inline]
fn squared<const D: usize>(a: [f64; D]) -> f64 {
    dot(a, a).0
}

/// The differences of the points of each pair on a common lattice, and its bits; z is 0 in 2-D.
fn on_lattice<const D: usize, const N: usize, const M: usize>(
    pairs: [[[f64; D]; 2]; N],
) -> Option<([[i64; 3]; N], u32)> {
    const { assert!(M == 3 * N && D <= 3, "three coordinates for each pair") }
    let at = |end: usize| -> [f64; M] {
        std::array::from_fn(|i| pairs[i / 3][end].get(i % 3).copied().unwrap_or(0.0))
    };
    let found = lattice(at(0), at(1))?;
    let values = std::array::from_fn(|i| [0, 1, 2].map(|k| found.values[3 * i + k]));
    Some((values, found.bits))
}

/// The dot product of lattice differences.
fn dot_whole(a: [i64; 3], b: [i64; 3]) -> i128 {
    (0..3).map(|k| i128::from(a[k]) * i128::from(b[k])).sum()
}

/// The dot product of integers.
#[inline]
fn dot_wide<const D: usize, const L: usize, const L2: usize>(
    a: &[Integer<L>; D],
    b: &[Integer<L>; D],
) -> Integer<L2> {
    let first: Integer<L2> = a[0].times(&b[0]);
    (1..D).fold(first, |sum, k| sum.plus(&a[k].times(&b[k])))
}

/// `a - b` of integers.
#[inline]
fn minus_wide<const D: usize, const L: usize>(
    a: &[Integer<L>; D],
    b: &[Integer<L>; D],
) -> [Integer<L>; D] {
    std::array::from_fn(|k| a[k].minus(&b[k]))
}

/// `beta` as m / 2^s: m has 53 bits, s is at most 52.
fn fraction(beta: f64) -> (i64, u32) {
    let (magnitude, exponent) = decode_odd(beta);
    if exponent > 0 {
        return ((magnitude << exponent) as i64, 0);
    }
    (magnitude as i64, exponent.unsigned_abs())
}

/// The angle at `p` between `a` and `b`, in any dimension up to 3: [`Sign::Positive`] if it is
/// acute, [`Sign::Negative`] if `p` is inside the diametral ball of `a b`. Exact for all finite
/// doubles.
///
/// ```
/// use delone_predicates::{Sign, proximity::angle};
/// assert_eq!(angle([0.0; 3], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0]), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn angle<const D: usize>(a: [f64; D], p: [f64; D], b: [f64; D]) -> Sign {
    let (sum, size) = dot(minus(a, p), minus(b, p));
    if sum.abs() > BOUND * size + FLOOR {
        return Sign::of(sum);
    }
    angle_exact(a, p, b)
}

#[cold]
#[inline(never)]
fn angle_exact<const D: usize>(a: [f64; D], p: [f64; D], b: [f64; D]) -> Sign {
    if let Some(([u, v], _)) = on_lattice::<D, 2, 6>([[a, p], [b, p]]) {
        return Sign::from(dot_whole(u, v));
    }
    fn wide<const D: usize, const L: usize, const L2: usize>(
        points: &[[f64; D]; 3],
        low: i32,
    ) -> Sign {
        let [u, v] = differences::<L, D, 3, 2>(points, low);
        dot_wide::<D, L, L2>(&u, &v).sign()
    }
    let points = [a, b, p];
    by_width(
        &points,
        |low| wide::<D, 2, 4>(&points, low),
        |low| wide::<D, 5, 10>(&points, low),
        |low| wide::<D, 12, 24>(&points, low),
        |low| wide::<D, FULL, { 2 * FULL }>(&points, low),
    )
}

/// Whether `a b` is shorter than `c d`: [`Sign::Positive`] if it is, [`Sign::Zero`] if both have
/// the same length. Exact for all finite doubles.
///
/// ```
/// use delone_predicates::{Sign, proximity::shorter};
/// assert_eq!(shorter([0.0, 0.0], [3.0, 4.0], [7.0, 1.0], [7.0, 6.0]), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn shorter<const D: usize>(a: [f64; D], b: [f64; D], c: [f64; D], d: [f64; D]) -> Sign {
    let (ab, cd) = (squared(minus(b, a)), squared(minus(d, c)));
    let det = cd - ab;
    if det.abs() > BOUND * (ab + cd) + FLOOR {
        return Sign::of(det);
    }
    shorter_exact(a, b, c, d)
}

#[cold]
#[inline(never)]
fn shorter_exact<const D: usize>(a: [f64; D], b: [f64; D], c: [f64; D], d: [f64; D]) -> Sign {
    if let Some(([u, v], _)) = on_lattice::<D, 2, 6>([[b, a], [d, c]]) {
        return Sign::from(dot_whole(v, v) - dot_whole(u, u));
    }
    fn wide<const D: usize, const L: usize, const L2: usize>(
        points: &[[f64; D]; 4],
        low: i32,
    ) -> Sign {
        let [b, d, a] = differences::<L, D, 4, 3>(points, low);
        let u = minus_wide(&b, &a);
        let ab: Integer<L2> = dot_wide(&u, &u);
        dot_wide::<D, L, L2>(&d, &d).minus(&ab).sign()
    }
    let points = [b, d, a, c];
    by_width(
        &points,
        |low| wide::<D, 2, 4>(&points, low),
        |low| wide::<D, 5, 10>(&points, low),
        |low| wide::<D, 12, 24>(&points, low),
        |low| wide::<D, FULL, { 2 * FULL }>(&points, low),
    )
}

/// Whether `p` is inside the ball whose surface passes through `a`, with its center on the ray to
/// `b` and the radius `beta` |ab| / 2: [`Sign::Positive`] inside, [`Sign::Zero`] on the surface.
/// With the ball of `b` it is the lune of a beta skeleton. `beta` is from 1 to 2.
///
/// ```
/// use delone_predicates::{Sign, proximity::lune};
/// // The diametral ball, and the ball around b.
/// assert_eq!(lune([0.0, 0.0], [2.0, 0.0], [1.0, 1.0], 1.0), Sign::Zero);
/// assert_eq!(lune([0.0, 0.0], [2.0, 0.0], [2.0, 2.0], 2.0), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn lune<const D: usize>(a: [f64; D], b: [f64; D], p: [f64; D], beta: f64) -> Sign {
    let (u, w) = (minus(p, a), minus(b, a));
    let ((along, size), away) = (dot(u, w), squared(u));
    let det = beta * along - away;
    if det.abs() > BOUND * (beta * size + away) + FLOOR {
        return Sign::of(det);
    }
    lune_exact(a, b, p, beta)
}

#[cold]
#[inline(never)]
fn lune_exact<const D: usize>(a: [f64; D], b: [f64; D], p: [f64; D], beta: f64) -> Sign {
    let (m, s) = fraction(beta);
    if let Some(([u, w], bits)) = on_lattice::<D, 2, 6>([[p, a], [b, a]])
        && bits <= BITS_NARROW
    {
        return Sign::from(i128::from(m) * dot_whole(u, w) - (dot_whole(u, u) << s));
    }
    fn wide<const D: usize, const L: usize, const L2: usize, const L3: usize>(
        points: &[[f64; D]; 3],
        low: i32,
        (m, s): (i64, u32),
    ) -> Sign {
        let [u, w] = differences::<L, D, 3, 2>(points, low);
        let (along, away): (Integer<L2>, Integer<L2>) = (dot_wide(&u, &w), dot_wide(&u, &u));
        let along: Integer<L3> = along.times(&Integer::new(m));
        along.minus(&away.times(&Integer::new(1 << s))).sign()
    }
    let points = [p, b, a];
    by_width(
        &points,
        |low| wide::<D, 2, 4, 5>(&points, low, (m, s)),
        |low| wide::<D, 5, 10, 11>(&points, low, (m, s)),
        |low| wide::<D, 12, 24, 25>(&points, low, (m, s)),
        |low| wide::<D, FULL, { 2 * FULL }, { 2 * FULL + 1 }>(&points, low, (m, s)),
    )
}

/// Whether `p` is in the union of the two disks of radius `beta` |ab| / 2 whose circles pass
/// through `a` and `b`: [`Sign::Positive`] inside, [`Sign::Zero`] on its outline. `p` must differ
/// from both; `beta` is from 1 to 2.
///
/// Both circles see `a b` under the angle whose sine is 1 / `beta`; inside it is larger.
///
/// ```
/// use delone_predicates::{Sign, proximity::arcs};
/// assert_eq!(arcs([0.0, 0.0], [2.0, 0.0], [1.0, 1.0], 1.0), Sign::Zero);
/// assert_eq!(arcs([0.0, 0.0], [2.0, 0.0], [1.0, 1.0], 1.25), Sign::Positive);
/// assert_eq!(arcs([0.0, 0.0], [2.0, 0.0], [1.0, 2.0], 1.25), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn arcs(a: Point2, b: Point2, p: Point2, beta: f64) -> Sign {
    match angle(a, p, b) {
        Sign::Negative => return Sign::Positive,
        Sign::Zero if beta > 1.0 => return Sign::Positive,
        Sign::Zero => return Sign::Zero,
        Sign::Positive if beta <= 1.0 => return Sign::Negative,
        Sign::Positive => {}
    }
    let (u, v) = (minus(a, p), minus(b, p));
    let (along, size) = dot(u, v);
    let (across, width) = dot(u, [v[1], -v[0]]);
    let factor = (beta - 1.0) * (beta + 1.0);
    let det = factor * (across * across) - along * along;
    let bound = BOUND_SQUARED * (factor * (width * width) + size * size);
    if det.abs() > bound + FLOOR * (1.0 + width + size) {
        return Sign::of(det);
    }
    arcs_exact(a, b, p, beta)
}

#[cold]
#[inline(never)]
fn arcs_exact(a: Point2, b: Point2, p: Point2, beta: f64) -> Sign {
    /// The sign, for differences of `L` limbs.
    fn of<const L: usize, const L2: usize, const L4: usize, const L6: usize>(
        u: &[Integer<L>; 2],
        v: &[Integer<L>; 2],
        beta: f64,
    ) -> Sign {
        let (m, s) = fraction(beta);
        let one = 1_i128 << (2 * s);
        let along: Integer<L2> = dot_wide(u, v);
        let across: Integer<L2> = u[0].times::<L, L2>(&v[1]).minus(&u[1].times(&v[0]));
        let (along, across): (Integer<L4>, Integer<L4>) =
            (along.times(&along), across.times(&across));
        let factor = Integer::from(i128::from(m) * i128::from(m) - one);
        across
            .times::<2, L6>(&factor)
            .minus(&along.times(&Integer::from(one)))
            .sign()
    }
    if let Some(([u, v], _)) = on_lattice::<2, 2, 6>([[a, p], [b, p]]) {
        let whole = |w: [i64; 3]| [w[0], w[1]].map(Integer::new);
        return of::<1, 2, 4, 6>(&whole(u), &whole(v), beta);
    }
    fn wide<const L: usize, const L2: usize, const L4: usize, const L6: usize>(
        points: &[Point2; 3],
        low: i32,
        beta: f64,
    ) -> Sign {
        let [u, v] = differences::<L, 2, 3, 2>(points, low);
        of::<L, L2, L4, L6>(&u, &v, beta)
    }
    let points = [a, b, p];
    by_width(
        &points,
        |low| wide::<2, 4, 8, 10>(&points, low, beta),
        |low| wide::<5, 10, 20, 22>(&points, low, beta),
        |low| wide::<12, 24, 48, 50>(&points, low, beta),
        |low| wide::<FULL, { 2 * FULL }, { 4 * FULL }, { 4 * FULL + 2 }>(&points, low, beta),
    )
}

/// Whether the sphere around `a` through `c` and the sphere around `b` through `d` meet:
/// [`Sign::Positive`] if their balls overlap, [`Sign::Zero`] if they touch from outside,
/// [`Sign::Negative`] if they are apart. `c` differs from `a`, and `d` from `b`.
///
/// ```
/// use delone_predicates::{Sign, proximity::spheres};
/// assert_eq!(spheres([0.0, 0.0], [0.0, 2.0], [5.0, 0.0], [2.0, 0.0]), Sign::Zero);
/// ```
#[inline]
#[must_use]
pub fn spheres<const D: usize>(a: [f64; D], c: [f64; D], b: [f64; D], d: [f64; D]) -> Sign {
    let [ac, bd, ab] = [minus(c, a), minus(d, b), minus(b, a)].map(squared);
    let reach = ac.sqrt() + bd.sqrt();
    let det = reach * reach - ab;
    if det.abs() > BOUND_SQUARED * (reach * reach + ab) && ac.min(bd) > SAFE_SQUARE {
        return Sign::of(det);
    }
    spheres_exact(a, c, b, d)
}

#[cold]
#[inline(never)]
fn spheres_exact<const D: usize>(a: [f64; D], c: [f64; D], b: [f64; D], d: [f64; D]) -> Sign {
    /// The sign of (sqrt(ac) + sqrt(bd))^2 - ab.
    fn of<const L2: usize, const L4: usize>([ac, bd, ab]: [Integer<L2>; 3]) -> Sign {
        let rest = ab.minus(&ac).minus(&bd);
        if rest.sign() == Sign::Negative {
            return Sign::Positive;
        }
        let (ac, bd) = (ac.plus(&ac), bd.plus(&bd));
        let square: Integer<L4> = rest.times(&rest);
        ac.times(&bd).minus(&square).sign()
    }
    if let Some((vectors, _)) = on_lattice::<D, 3, 9>([[c, a], [d, b], [b, a]]) {
        return of::<2, 4>(vectors.map(|v| Integer::from(dot_whole(v, v))));
    }
    fn wide<const D: usize, const L: usize, const L2: usize, const L4: usize>(
        points: &[[f64; D]; 4],
        low: i32,
    ) -> Sign {
        let [c, d, b] = differences::<L, D, 4, 3>(points, low);
        let d = minus_wide(&d, &b);
        of::<L2, L4>([dot_wide(&c, &c), dot_wide(&d, &d), dot_wide(&b, &b)])
    }
    let points = [c, d, b, a];
    by_width(
        &points,
        |low| wide::<D, 2, 4, 8>(&points, low),
        |low| wide::<D, 5, 10, 20>(&points, low),
        |low| wide::<D, 12, 24, 48>(&points, low),
        |low| wide::<D, FULL, { 2 * FULL }, { 4 * FULL }>(&points, low),
    )
}
