//! Which of two directions is nearer to a third one.
//!
//! The sign of (a q) / |a| - (b q) / |b| for dot products. The filter takes (a - b) q for directions: with
//! u, h as in `orient`, a monomial has 2 u + u from its entries and passes a product and at most two
//! sums, 6 u, where 8 u leaves room; h in each of three entries meets |q|, in all 1.74 h, where 2^-98
//! does. Else integers: if the dot products x, y differ in sign that is all, else the squares x^2 |b|^2
//! and y^2 |a|^2 decide.

use crate::Point3;
use crate::integer::{FULL, Integer, capacity};
use crate::range::bit_span;
use crate::sign::Sign;

use super::orient::difference;
use super::unit::Unit;

/// Bound relative to the permanent, 8 u.
const BOUND: f64 = 4.0 * f64::EPSILON;
/// Absolute bound, 2^-98.
const ABSOLUTE: f64 = 1.0 / (1_u128 << 98) as f64;

/// Positive if the direction of `a` is nearer to that of `q` than that of `b`, zero if they are equally
/// near. Exact for all finite doubles; lengths do not count.
///
/// ```
/// use delone_predicates::{Sign, sphere::nearer};
/// let q = [1.0, 1.0, 0.0];
/// assert_eq!(nearer(q, [9.0, 0.0, 0.0], [0.0, 0.5, 0.0]), Sign::Zero);
/// assert_eq!(nearer(q, [1.0, 0.0, 0.0], [0.0, 0.5, 1e-300]), Sign::Positive);
/// ```
#[must_use]
pub fn nearer(q: Point3, a: Point3, b: Point3) -> Sign {
    nearer_of([q, a, b], [q, a, b].map(Unit::of).each_ref())
}

/// The same, with the directions given, too.
#[inline]
#[must_use]
pub fn nearer_of(vectors: [Point3; 3], units: [&Unit; 3]) -> Sign {
    let (sum, bound) = by_differences(units);
    if sum.abs() > bound {
        Sign::of(sum)
    } else {
        nearer_exact(vectors)
    }
}

/// The difference of the products and the bound of its error.
#[inline]
pub fn by_differences([q, a, b]: [&Unit; 3]) -> (f64, f64) {
    let d = difference(a, b);
    let terms = [0, 1, 2].map(|k| d[k] * q.hi[k]);
    let sum = terms[0] + terms[1] + terms[2];
    let permanent = terms[0].abs() + terms[1].abs() + terms[2].abs();
    (sum, BOUND * permanent + ABSOLUTE)
}

#[cold]
#[inline(never)]
fn nearer_exact(vectors: [Point3; 3]) -> Sign {
    let (mut lows, mut width) = ([0; 3], 0);
    for (low, v) in lows.iter_mut().zip(vectors) {
        match bit_span(&[v]) {
            None => return Sign::Zero,
            Some((lowest, wide)) => {
                *low = lowest;
                width = width.max(wide);
            }
        }
    }
    if width <= capacity(1) {
        integer::<1, 2, 4, 6>(vectors, lows)
    } else if width <= capacity(2) {
        integer::<2, 4, 8, 12>(vectors, lows)
    } else if width <= capacity(5) {
        integer::<5, 10, 20, 30>(vectors, lows)
    } else {
        integer::<FULL, 66, 132, 198>(vectors, lows)
    }
}

/// The same with coordinates of `L` limbs: below 2^(64 L - 3), so that the products of six are below
/// 2^(384 L - 13).
fn integer<const L: usize, const L2: usize, const L4: usize, const L6: usize>(
    vectors: [Point3; 3],
    lows: [i32; 3],
) -> Sign {
    let v: [[Integer<L>; 3]; 3] =
        std::array::from_fn(|i| vectors[i].map(|x| Integer::from_double(x, lows[i])));
    let dot = |i: usize, j: usize| -> Integer<L2> {
        let term = |k: usize| v[i][k].times::<L, L2>(&v[j][k]);
        term(0).plus(&term(1)).plus(&term(2))
    };
    let (x, y) = (dot(0, 1), dot(0, 2));
    let (s, t) = (x.sign(), y.sign());
    if s != t || s.is_zero() {
        return Sign::from(s.cmp(&t));
    }
    let term = |x: &Integer<L2>, n: Integer<L2>| x.times::<L2, L4>(x).times::<L2, L6>(&n);
    s * term(&x, dot(2, 2)).minus(&term(&y, dot(1, 1))).sign()
}
