//! One simplex given by the coordinates of its corners: signs and numbers of points in it.
//!
//! The stages are those of `decide`: rounded with a proven bound, in pairs of doubles with the same
//! proof, integers. The filters of `filter` take coordinates below 1; here they take differences
//! within [`SAFE`]. All bounds are relative but for the floors, which exceed what underflows there.

use delone_predicates::Sign;
use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use super::filter::{Inverse, LEAST_RESIDUAL, Matrix, ROUNDED, U, barycentric, dot, invert};
use super::fine::{Fine, differences};
use super::frame::Frame;
use super::residues::{FEW_BITS, is_zero};
use super::sites::Sites;
use crate::base::wide::{ratio, scaled};

/// Differences that the filters take, if they are not zero.
const SAFE: std::ops::Range<f64> = 1e-100..1e100;

/// The error of weights, next to the smallest of them, above which integers are used.
const CLOSE: f64 = 1e-15;

/// Coordinates padded with zeros.
#[inline(always)]
pub fn padded<const D: usize, const P: usize>(p: &[f64; D]) -> [f64; P] {
    std::array::from_fn(|k| if k < D { p[k] } else { 0.0 })
}

/// The rounded differences of corners from the first one, and those of a point; whether the filters
/// take them.
#[inline(always)]
fn seen<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> (Matrix<D, P>, [f64; P], bool) {
    let o = &corners[0];
    let (mut a, mut d) = ([[0.0; P]; D], [0.0; P]);
    let (mut least, mut most) = (f64::MAX, 0.0f64);
    for k in 0..D {
        d[k] = q[k] - o[k];
        for i in 0..D {
            a[i][k] = corners[i + 1][k] - o[k];
        }
    }
    for x in a.as_flattened().iter().chain(&d) {
        let size = x.abs();
        most = most.max(size);
        least = if size == 0.0 { least } else { least.min(size) };
    }
    (a, d, least > SAFE.start && most < SAFE.end)
}

/// Rounded barycentric coordinates of a point, the bound of their errors, infinite if unknown, and
/// the inverse of the differences of the corners.
#[inline(always)]
pub fn rough<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> ([f64; V], f64, Matrix<D, P>) {
    let (a, d, safe) = seen::<D, V, P>(corners, q);
    if !safe {
        return ([f64::NAN; V], f64::INFINITY, [[0.0; P]; D]);
    }
    let inverse = invert(&a);
    let (l, bound) = barycentric(&inverse, &d);
    (l, bound, inverse.b)
}

/// Whether a point whose coordinates are off by at most `slack` is outside for certain.
pub fn is_outside<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
    slack: f64,
) -> bool {
    let (a, d, safe) = seen::<D, V, P>(corners, q);
    if !safe {
        return false;
    }
    let inverse = invert(&a);
    let (l, bound) = barycentric::<D, V, P>(&inverse, &d);
    // The coordinates other than the first change by at most |A^-1| times the way, the first by D times.
    let way = ROUNDED * D as f64 * (D as f64).sqrt() * inverse.norm * slack;
    l.iter().any(|x| *x < -(bound + way))
}

/// On which side of the facet opposite each corner a point is: positive is inside, for corners in any
/// order. Nothing is inside a flat simplex.
#[inline(always)]
pub fn sides<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> [Sign; V] {
    let (l, bound, _) = rough::<D, V, P>(corners, q);
    if l.iter().all(|x| x.abs() > bound) {
        return l.map(sign_of);
    }
    uncertain::<D, V, P>(corners, q)
}

#[cold]
#[inline(never)]
fn uncertain<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> [Sign; V] {
    let (l, bound) = refined::<D, V, P>(corners, q).unwrap_or(([f64::NAN; V], f64::INFINITY));
    if l.iter().all(|x| x.abs() > bound) {
        return l.map(sign_of);
    }
    let Some(mut exact) = Exact::of(corners, q) else {
        return [Sign::Negative; V];
    };
    std::array::from_fn(|i| {
        if l[i].abs() > bound {
            sign_of(l[i])
        } else {
            exact.side::<V>(i, bound)
        }
    })
}

fn sign_of(x: f64) -> Sign {
    if x < 0.0 {
        Sign::Negative
    } else {
        Sign::Positive
    }
}

/// Barycentric coordinates from solutions in pairs of doubles, and the bound of their errors.
fn refined<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    q: &[f64; D],
) -> Option<([f64; V], f64)> {
    let (rounded, _, safe) = seen::<D, V, P>(corners, q);
    if !safe {
        return None;
    }
    let corners = corners.each_ref().map(padded::<D, P>);
    let inverse = invert(&rounded);
    let (found, bound) = fine_barycentric(&corners.each_ref(), &padded(q), &inverse);
    bound.is_finite().then_some((found, bound))
}

/// The same from an approximate inverse of the differences, for coordinates that the filters take; the
/// bound is infinite if it is unknown.
pub fn fine_barycentric<const D: usize, const V: usize, const P: usize>(
    corners: &[&[f64; P]; V],
    q: &[f64; P],
    inverse: &Inverse<D, P>,
) -> ([f64; V], f64) {
    let a: [[Pair; D]; D] = std::array::from_fn(|i| differences(corners[i + 1], corners[0]));
    let d: [Pair; D] = differences(q, corners[0]);
    let (l, error) = solved(&a, &d, inverse);
    let mut rest = Pair::from_double(1.0);
    let mut size = 1.0;
    for x in l {
        rest = rest - x;
        size += x.hi.abs();
    }
    let bound = ROUNDED * (D as f64 * error + (4 * D + 8) as f64 * U * U * size);
    let found = std::array::from_fn(|i| if i == 0 { rest.hi } else { l[i - 1].hi });
    let finite = bound.is_finite();
    (found, if finite { bound } else { f64::INFINITY })
}

/// The solution l of l A = d, refined, and a bound of its error, by the proof of `filter`: at most
/// |A^-1| times the residual. That is a sum of D + 1 terms, of which D pass through a product and D
/// sums: (4 D + 9) u^2 times the sum of their magnitudes.
fn solved<const D: usize, const P: usize>(
    a: &[[Pair; D]; D],
    d: &[Pair; D],
    inverse: &Inverse<D, P>,
) -> ([Pair; D], f64) {
    let mut l = [Pair::from_double(0.0); D];
    let mut error = f64::INFINITY;
    // The first step is the solution itself; the last pass measures only.
    for step in 0..5 {
        let (mut residual, mut squares) = ([0.0; D], 0.0);
        for k in 0..D {
            let (mut sum, mut size) = (d[k], d[k].hi.abs());
            for i in 0..D {
                let product = l[i] * a[i][k];
                size += product.hi.abs();
                sum = sum - product;
            }
            residual[k] = sum.hi;
            let rounding = (8 * D + 16) as f64 * U * U * size;
            let bound = ROUNDED * sum.hi.abs() + rounding + LEAST_RESIDUAL;
            squares += bound * bound;
        }
        error = ROUNDED * inverse.norm * squares.sqrt();
        if step < 4 {
            for i in 0..D {
                let change = (0..D).map(|k| residual[k] * inverse.b[k][i]).sum();
                l[i] = l[i] + Pair::from_double(change);
            }
        }
    }
    (l, error)
}

/// The weights of the corners at a point that is in the closed simplex: none negative, zero opposite
/// the facets on which it is, the others with a relative error below 1e-14.
pub fn weights<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    on: [bool; V],
    q: &[f64; D],
) -> [f64; V] {
    if let Some((l, bound)) = refined::<D, V, P>(corners, q) {
        let known = |i: usize| on[i] || (l[i] > 0.0 && bound <= CLOSE * l[i]);
        if (0..V).all(known) {
            return std::array::from_fn(|i| if on[i] { 0.0 } else { l[i] });
        }
    }
    let Some(mut exact) = Exact::of(corners, q) else {
        return [f64::NAN; V];
    };
    std::array::from_fn(|i| if on[i] { 0.0 } else { exact.weight::<V>(i) })
}

/// The corners of a simplex, and a point, as integers.
struct Exact<const D: usize> {
    sites: Sites<D, 8>,
    frame: Option<Frame>,
}

impl<const D: usize> Exact<D> {
    fn of<const V: usize>(corners: &[[f64; D]; V], q: &[f64; D]) -> Option<Self> {
        let sites = Sites::new(corners.iter().chain([q]).copied().collect()).ok()?;
        Some(Self { sites, frame: None })
    }

    fn frame<const V: usize>(&mut self) -> Option<&Frame> {
        if self.frame.is_none() {
            let corners: [u32; V] = std::array::from_fn(|i| i as u32);
            self.frame = Frame::new(&self.sites, &corners);
        }
        self.frame.as_ref()
    }

    /// The sign of a barycentric coordinate that is below `2 bound`.
    fn side<const V: usize>(&mut self, i: usize, bound: f64) -> Sign {
        // The determinant with the point in place of the corner, in units.
        if self.sites.filtered && self.sites.bits > FEW_BITS && bound.is_finite() {
            let mut rows: [u32; V] = std::array::from_fn(|i| i as u32);
            let log = self.sites.log_determinant(&rows) + (2.0 * bound).log2();
            rows[i] = V as u32;
            let points = self.sites.integers(rows.into_iter());
            let bits = log.ceil() as i64 + 1 - D as i64 * self.sites.unit;
            if is_zero(&points, false, bits).is_some() {
                return Sign::Zero;
            }
        }
        let point = V as u32;
        if self.frame::<V>().is_none() {
            return Sign::Negative;
        }
        match &self.frame {
            Some(frame) => match frame.coordinate(&self.sites, 0, i, point) {
                0 => Sign::Zero,
                side => sign_of(f64::from(side)),
            },
            None => Sign::Negative,
        }
    }

    fn weight<const V: usize>(&mut self, i: usize) -> f64 {
        if self.frame::<V>().is_none() {
            return f64::NAN;
        }
        let Some(frame) = &self.frame else {
            return f64::NAN;
        };
        let share = frame.share(&self.sites, 0, i, V as u32);
        ratio(&share, &frame.determinant(), 0).unwrap_or(0.0)
    }
}

/// A determinant, `mantissa * 2^exponent`, with a bound of its relative error.
struct Determinant {
    mantissa: f64,
    exponent: i64,
    error: f64,
}

/// The determinant of the differences of corners from the first one, by elimination in pairs.
///
/// A step m - f r, where f is a quotient of magnitude at most 1 (but for roundings) that errs by less
/// than 64 u^2, is an exact one for a matrix whose entry differs by less than 100 u^2 M, where M is
/// the largest magnitude of all entries met. So the product of the pivots is the determinant of a
/// matrix that differs from A by at most e = 100 D^2 u^2 M in its norm, and det A by at most
/// (1 + |A^-1| e)^D - 1 of it: 2 D |A^-1| e if that is below 1.
fn determinant<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
) -> Option<Determinant> {
    let (rounded, _, safe) = seen::<D, V, P>(corners, &corners[0]);
    if !safe {
        return None;
    }
    let o = padded::<D, P>(&corners[0]);
    let mut m: [[Pair; D]; D] = std::array::from_fn(|i| differences(&padded(&corners[i + 1]), &o));
    let mut most = rounded
        .as_flattened()
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    let (mut value, mut exponent) = (Pair::from_double(1.0), 0);
    for k in 0..D {
        let mut pivot = k;
        for i in k + 1..D {
            if m[i][k].hi.abs() > m[pivot][k].hi.abs() {
                pivot = i;
            }
        }
        if pivot != k {
            m.swap(k, pivot);
            value = Pair::from_double(0.0) - value;
        }
        let of_pivot = m[k];
        for row in m.iter_mut().skip(k + 1) {
            let f = quotient(row[k], of_pivot[k]);
            for j in k + 1..D {
                row[j] = row[j] - f * of_pivot[j];
                most = most.max(row[j].hi.abs());
            }
        }
        // The product, with its exponent apart.
        value = value * of_pivot[k];
        let power = exponent_of(value.hi);
        let (down, up) = (power_of_two(-power / 2), power_of_two(-power + power / 2));
        value = value * Pair::from_double(down) * Pair::from_double(up);
        exponent += i64::from(power);
    }
    let norm = invert(&rounded).norm;
    let e = (100 * D * D) as f64 * U * U * most + LEAST_RESIDUAL;
    let error = ROUNDED * 2.0 * D as f64 * norm * e + (10 * D) as f64 * U * U + U;
    // Comparisons that NaN fails.
    (error < 0.5 && value.hi != 0.0).then_some(Determinant {
        mantissa: value.hi,
        exponent,
        error,
    })
}

fn quotient(a: Pair, b: Pair) -> Pair {
    let first = a.hi / b.hi;
    let rest = a - Pair::from_double(first) * b;
    Pair::from_double(first) + Pair::from_double(rest.hi / b.hi)
}

/// The exponent of a double; 0 for zero and what is not finite.
fn exponent_of(x: f64) -> i32 {
    match (x.to_bits() >> 52 & 0x7ff) as i32 {
        0 | 0x7ff => 0,
        biased => biased - 1023,
    }
}

/// 2^exponent, for exponents from -1022 to 1023.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// The orientation of corners: the sign of the determinant of their differences from the first one.
pub fn orientation<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
) -> Sign {
    if let Some(found) = determinant::<D, V, P>(corners) {
        return sign_of(found.mantissa);
    }
    match Exact::of(corners, &corners[0]) {
        Some(mut exact) => match exact.frame::<V>() {
            Some(frame) if frame.positive => Sign::Positive,
            Some(_) => Sign::Negative,
            None => Sign::Zero,
        },
        None => Sign::Zero,
    }
}

/// The volume of a simplex, with a relative error below 1e-14 within the range of doubles.
pub fn volume<const D: usize, const V: usize, const P: usize>(corners: &[[f64; D]; V]) -> f64 {
    let factorial: u32 = (1..=D as u32).product();
    if let Some(found) = determinant::<D, V, P>(corners).filter(|found| found.error < 1e-15) {
        let value = found.mantissa.abs() / f64::from(factorial);
        // In steps, as a power may be out of range; what is beyond it is 0 or infinite either way.
        let mut left = found.exponent.clamp(-4000, 4000) as i32;
        let mut value = value;
        while left != 0 {
            let step = left.clamp(-1000, 1000);
            value *= power_of_two(step);
            left -= step;
        }
        return value;
    }
    let Some(mut exact) = Exact::of(corners, &corners[0]) else {
        return f64::NAN;
    };
    let Some(frame) = exact.frame::<V>() else {
        return 0.0;
    };
    let determinant = frame.determinant();
    let (_, low) = exact.sites.coordinate(0, 0);
    ratio(&determinant, &BigInt::from(factorial), D as i64 * low).unwrap_or(f64::INFINITY)
}

/// The center of the sphere through the corners, each coordinate within 4 units in the last place;
/// infinite if out of range.
pub fn circumcenter<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
) -> [f64; D] {
    let (_, _, safe) = seen::<D, V, P>(corners, &corners[0]);
    let fine = safe.then(|| {
        let rows = corners.map(|p| padded::<D, P>(&p));
        let refs: [&[f64; P]; V] = std::array::from_fn(|i| &rows[i]);
        Fine::<D>::new(&refs)
    });
    let mut exact = None;
    std::array::from_fn(|k| {
        if let Some(fine) = &fine {
            let half = Pair::from_double(0.5) * fine.center(k);
            let at = Pair::from_double(corners[0][k]) + half;
            let rounding = 8.0 * U * U * (corners[0][k].abs() + half.hi.abs());
            if 0.5 * fine.error() + rounding <= 2.0 * U * at.hi.abs() {
                return at.hi;
            }
        }
        let exact: &mut Option<Exact<D>> = &mut exact;
        if exact.is_none() {
            *exact = Exact::of(corners, &corners[0]);
        }
        let Some(exact) = exact else {
            return f64::NAN;
        };
        let (first, low) = exact.sites.coordinate(0, k);
        let Some(frame) = exact.frame::<V>() else {
            return f64::NAN;
        };
        let twice: BigInt = frame.determinant() * 2;
        let at: BigInt = scaled(first, low) * &twice + frame.lifted(k);
        let far = if at < BigInt::ZERO {
            f64::NEG_INFINITY
        } else {
            f64::INFINITY
        };
        ratio(&at, &twice, low).unwrap_or(far)
    })
}

/// The affine map to barycentric coordinates: the inverse of the matrix whose columns are the vectors
/// from the last corner to the others, each row with an error below 1e-13 of its length; and below it
/// that corner.
pub fn transform<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
) -> [[f64; D]; V] {
    // The last corner is the origin.
    let from_last: [[f64; D]; V] = std::array::from_fn(|i| corners[(i + D) % V]);
    let mut found = [[0.0; D]; V];
    found[D] = corners[D];
    if refined_rows::<D, V, P>(&from_last, &mut found) {
        return found;
    }
    let frame = Exact::of(&from_last, &corners[D]).and_then(|mut exact| {
        let (_, low) = exact.sites.coordinate(0, 0);
        exact.frame::<V>().map(|_| ())?;
        exact.frame.map(|frame| (frame, low))
    });
    let Some((frame, low)) = frame else {
        return [[f64::NAN; D]; V];
    };
    let determinant = frame.determinant();
    for (i, row) in found.iter_mut().enumerate().take(D) {
        for (k, entry) in row.iter_mut().enumerate() {
            let adjoint = frame.adjoint(k, i);
            let far = if adjoint < BigInt::ZERO {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
            *entry = ratio(&adjoint, &determinant, -low).unwrap_or(far);
        }
    }
    found
}

/// The rows of `transform` in pairs; whether they are accurate enough.
fn refined_rows<const D: usize, const V: usize, const P: usize>(
    corners: &[[f64; D]; V],
    found: &mut [[f64; D]; V],
) -> bool {
    let (rounded, _, safe) = seen::<D, V, P>(corners, &corners[0]);
    if !safe {
        return false;
    }
    let o = padded::<D, P>(&corners[0]);
    let a: [[Pair; D]; D] = std::array::from_fn(|i| differences(&padded(&corners[i + 1]), &o));
    let inverse = invert(&rounded);
    let mut error = 0.0f64;
    for k in 0..D {
        let unit: [Pair; D] = std::array::from_fn(|j| Pair::from_double(f64::from(j == k)));
        let (row, bound) = solved(&a, &unit, &inverse);
        error = error.max(bound);
        for i in 0..D {
            found[i][k] = row[i].hi;
        }
    }
    // A comparison that NaN fails.
    found[..D].iter().all(|row| {
        let length = dot(&padded::<D, P>(row), &padded::<D, P>(row)).sqrt();
        error * (D as f64) < 1e-14 * length
    })
}
