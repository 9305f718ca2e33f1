//! The sign of x0 sqrt n0 + x1 sqrt n1 + x2 sqrt n2 + x3 sqrt n3 for integers, by squaring.
//!
//! 1. Terms with equal n_i are added: this ends most ties of symmetric sets.
//! 2. Let T_i = x_i^2 n_i and s_i the sign of x_i, so that the sum is that of s_i sqrt T_i. The sign l
//!    of the first two is s_0 or s_1 if these agree, else it follows from T_0 and T_1; r likewise is the
//!    sign of minus the last two. If l and r differ, or both are zero, that is all.
//! 3. Otherwise both sides are squared: the answer is l times the sign of D + R, where
//!    D = T_0 + T_1 - T_2 - T_3, R = s_0 s_1 sqrt A - s_2 s_3 sqrt B, A = 4 T_0 T_1 and B = 4 T_2 T_3.
//! 4. The sign of R follows from A and B. If those of D and R do not contradict each other, that is
//!    all. Else compare D^2 with R^2 = A + B + 2 m sqrt(A B), where m is the product of the signs in
//!    R: with E = D^2 - A - B, compare E with 2 m sqrt(A B), by signs and then E^2 with 4 A B.
//!
//! In each step the sides have the same sign when they are squared, so that equality is exact and no
//! bound on how small a sum may be is needed.
//!
//! # Widths
//!
//! Let coordinates be below 2^b, b = 64 L - 3. By Hadamard minors are below 3^(3/2) 2^3b, with two or
//! three terms added below 3 times that: 2^(3b + 4); squared lengths are below 2^(2b + 2). So
//! T < 2^(8b + 10), D^2, A, B < 2^(16b + 26), E < 2^(16b + 28), E^2, 4 A B < 2^(32b + 56). (If three terms
//! were added, at most two are left, and step 2 ends it; but the widths suffice.) As 8b + 10 <= 512 L - 14,
//! 16b + 28 <= 1024 L - 20 and 32b + 56 <= 2048 L - 40, the integers of 8 L, 16 L and 32 L limbs hold them.

use crate::integer::Integer;
use crate::sign::Sign;

/// The sign of the sum of `factors[i]` times the root of `squares[i]`, which are positive.
pub fn sign<
    const L2: usize,
    const L3: usize,
    const L6: usize,
    const L8: usize,
    const L16: usize,
    const L32: usize,
>(
    factors: [Integer<L3>; 4],
    squares: [Integer<L2>; 4],
) -> Sign {
    let terms = merged(factors, squares);
    let signs = terms.each_ref().map(|(x, _)| x.sign());
    let has = |sign: Sign| signs.contains(&sign);
    if !has(Sign::Positive) || !has(Sign::Negative) {
        return if has(Sign::Positive) {
            Sign::Positive
        } else if has(Sign::Negative) {
            Sign::Negative
        } else {
            Sign::Zero
        };
    }
    let t = terms.map(|(x, n)| x.times::<L3, L6>(&x).times::<L2, L8>(&n));
    let pair = |i: usize, j: usize| sum_of_two(signs[i], signs[j], || t[i].minus(&t[j]).sign());
    let (left, right) = (pair(0, 1), -pair(2, 3));
    if left != right {
        return if left > right {
            Sign::Positive
        } else {
            Sign::Negative
        };
    }
    if left.is_zero() {
        return Sign::Zero;
    }
    let d = t[0].plus(&t[1]).minus(&t[2].plus(&t[3]));
    let product = |i: usize, j: usize| {
        let twice = |x: &Integer<L8>| x.plus(x);
        twice(&t[i]).times::<L8, L16>(&twice(&t[j]))
    };
    let (a, b) = (product(0, 1), product(2, 3));
    left * with_roots::<L8, L16, L32>(&d, signs[0] * signs[1], &a, -(signs[2] * signs[3]), &b)
}

/// The terms, where those with equal squares are added and zeros are last.
fn merged<const L2: usize, const L3: usize>(
    mut factors: [Integer<L3>; 4],
    squares: [Integer<L2>; 4],
) -> [(Integer<L3>, Integer<L2>); 4] {
    for i in 0..4 {
        for j in i + 1..4 {
            if squares[i].minus(&squares[j]).sign().is_zero() {
                factors[i] = factors[i].plus(&factors[j]);
                factors[j] = factors[j].minus(&factors[j]);
            }
        }
    }
    let mut terms: [_; 4] = std::array::from_fn(|i| (factors[i], squares[i]));
    terms.sort_by_key(|(x, _)| x.sign().is_zero());
    terms
}

/// The sign of s sqrt x + t sqrt y from that of x - y.
fn sum_of_two(s: Sign, t: Sign, difference: impl FnOnce() -> Sign) -> Sign {
    if s * t == Sign::Negative {
        s * difference()
    } else if s.is_zero() {
        t
    } else {
        s
    }
}

/// The sign of d + s sqrt a + t sqrt b, for a, b >= 0.
fn with_roots<const L8: usize, const L16: usize, const L32: usize>(
    d: &Integer<L8>,
    s: Sign,
    a: &Integer<L16>,
    t: Sign,
    b: &Integer<L16>,
) -> Sign {
    let (s, t) = (s * a.sign(), t * b.sign());
    let (head, roots) = (d.sign(), sum_of_two(s, t, || a.minus(b).sign()));
    if head * roots != Sign::Negative {
        return if head.is_zero() { roots } else { head };
    }
    // The head is larger than the roots if and only if e - 2 s t sqrt(a b) > 0.
    let e = d.times::<L8, L16>(d).minus(&a.plus(b));
    let (side, k) = (e.sign(), -(s * t));
    let larger = sum_of_two(side, k, || {
        let twice = |x: &Integer<L16>| x.plus(x);
        let square = e.times::<L16, L32>(&e);
        square.minus(&twice(a).times::<L16, L32>(&twice(b))).sign()
    });
    head * larger
}
