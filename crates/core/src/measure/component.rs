//! A coordinate of a center from double-double numbers, if its rounding is certain; for 2-D and
//! 3-D.

use delone_predicates::arithmetic::Pair;

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;
/// More than underflow can change in the last sums of pairs: 2^-1000.
const FLOOR: f64 = f64::from_bits((1023 - 1000) << 52);

/// `origin` + n / (2 half), if its whole error interval rounds to one double.
///
/// `p` and `size` are the sums of the magnitudes of the monomials of `n` and `half`. The errors of
/// these, doubled, are at most `most` u^2 of them; the quotient errs by 32 u^2 of itself, the sum
/// by 4 u^2 of both parts: doubled, with room for the rounding of the bound.
pub fn component(origin: f64, n: Pair, p: f64, half: Pair, size: f64, most: f64) -> Option<f64> {
    let q = quotient(n, half) * Pair::difference(0.5, 0.0);
    let sum = Pair::difference(origin, 0.0) + q;
    let error = most * U * U * ((p + q.hi.abs() * size) / half.hi.abs())
        + 128.0 * U * U * (q.hi.abs() + origin.abs())
        + FLOOR;
    let (low, high) = (sum.hi + (sum.lo - error), sum.hi + (sum.lo + error));
    (low == high).then_some(low)
}

/// `n / d` to about 100 bits.
fn quotient(n: Pair, d: Pair) -> Pair {
    let as_pair = |x: f64| Pair::difference(x, 0.0);
    let first = n.hi / d.hi;
    let rest = n - d * as_pair(first);
    let second = rest.hi / d.hi;
    let rest = rest - d * as_pair(second);
    (as_pair(first) + as_pair(second)) + as_pair(rest.hi / d.hi)
}
