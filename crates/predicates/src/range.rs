//! The limits set by the exponents of coordinates: the range of expansions, the lattice of
//! differences, integer widths.

use crate::expansion::two_difference;

/// Everything but the sign.
const ABS: u64 = u64::MAX >> 1;
/// The bits of the fraction.
const FRACTION: u64 = (1 << 52) - 1;
/// The exponent field of 1.0.
const BIAS: i32 = 1023;

/// Smallest binary exponent of a coordinate that expansions take. See [`is_safe`].
const WINDOW_LOW: i32 = -160;
/// Largest binary exponent of a coordinate that expansions take. See [`is_safe`].
const WINDOW_HIGH: i32 = 189;

/// The exponent field: 0 for subnormals, 2047 for NaN and infinities.
#[inline]
pub fn exponent_field(value: f64) -> i32 {
    ((value.to_bits() & ABS) >> 52) as i32
}

/// 2^exponent, for exponents from -1022 to 1023.
#[inline]
pub const fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((BIAS + exponent) as u64) << 52)
}

/// Whether expansions up to degree 5 neither overflow nor underflow on these coordinates.
///
/// Each is zero or 2^-160 <= |x| < 2^190. Then all are multiples of 2^-212, so are their sums and
/// differences, rounded or not (rounding takes a multiple of a power of two to a multiple of it),
/// and so everything of degree k, parts of products included, is a multiple of 2^-212k, which for
/// k <= 5 is at least 2^-1060 and representable: no operation underflows. Differences are below
/// 2^191, factors below 2^577 (so that splitting is safe), the permanent of degree 5, the largest,
/// below 72 * 2^955: nothing overflows.
#[inline]
pub fn is_safe<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> bool {
    points.as_flattened().iter().all(|&x| {
        let above = exponent_field(x) - (BIAS + WINDOW_LOW);
        x == 0.0 || (0..=WINDOW_HIGH - WINDOW_LOW).contains(&above)
    })
}

/// Points times one power of two.
pub struct Scaled<const D: usize, const N: usize> {
    /// The points; unless `exact`, each coordinate may have lost up to 2^-1074 (two roundings of
    /// 2^-1075), and all of it.
    pub points: [[f64; D]; N],
    /// Whether every coordinate has changed exactly by the factor, and expansions are safe.
    pub exact: bool,
}

/// The points times the power of two that moves the largest coordinate to the upper end of the
/// window. `None` if a coordinate is not finite.
pub fn scale_to_window<const D: usize, const N: usize>(
    points: &[[f64; D]; N],
) -> Option<Scaled<D, N>> {
    let coordinates = points.as_flattened();
    let top = coordinates.iter().map(|&x| exponent_field(x)).max()?;
    if top > 2 * BIAS {
        return None;
    }
    // The power lies between 2^-834 and 2^1212: two factors, as one may not be a double.
    let shift = WINDOW_HIGH - (top - BIAS);
    let (first, second) = (power_of_two(shift / 2), power_of_two(shift - shift / 2));
    let points = points.map(|p| p.map(|x| x * first * second));
    // A safe nonzero value is far from underflow, so it is exact.
    let vanished = |(&x, &y): (&f64, &f64)| x != 0.0 && y == 0.0;
    let exact = is_safe(&points) && !coordinates.iter().zip(points.as_flattened()).any(vanished);
    Some(Scaled { points, exact })
}

/// Differences as integers times one power of two.
pub struct Lattice<const N: usize> {
    /// The integers, without a common factor of two.
    pub values: [i64; N],
    /// Each is below 2^bits in magnitude; `bits` is at most 62.
    pub bits: u32,
}

impl<const N: usize> Lattice<N> {
    /// From integers below 2^bits.
    #[inline]
    fn reduced(values: [i64; N], bits: u32) -> Self {
        // Not all are zero: the largest was scaled to a fixed highest bit.
        let common = values.iter().fold(0, |all, v| all | v).trailing_zeros();
        Self {
            values: values.map(|v| v >> common),
            bits: bits - common,
        }
    }
}

/// The differences `minuends[i] - subtrahends[i]` on their common lattice, if the integers fit.
///
/// The differences are scaled so that the largest has a given number of bits. If then each converts
/// to an integer and back without change, all are known exactly; common factors of two are removed
/// last.
#[inline]
pub fn lattice<const N: usize>(minuends: [f64; N], subtrahends: [f64; N]) -> Option<Lattice<N>> {
    let differences: [(f64, f64); N] =
        std::array::from_fn(|i| two_difference(minuends[i], subtrahends[i]));
    let (heads, tails) = (differences.map(|d| d.0), differences.map(|d| d.1));
    // A comparison that NaN fails; NaN fails the conversion, too.
    let top = heads
        .iter()
        .fold(0.0, |top: f64, x| if x.abs() > top { x.abs() } else { top });
    let exponent = exponent_field(top) - BIAS;
    // The powers of two below must be normal; a difference that overflows goes here, too.
    if !(-900..=900).contains(&exponent) {
        let zero = top == 0.0 && heads.iter().all(|&x| x == 0.0);
        return zero.then_some(Lattice {
            values: [0; N],
            bits: 0,
        });
    }
    let whole = tails.iter().fold(true, |whole, &x| whole & (x == 0.0));
    if whole && let Some(found) = short(&heads, exponent) {
        return Some(found);
    }
    long(&heads, &tails, exponent)
}

/// Differences with an exact double, and at most 51 bits of lattice.
///
/// Adding 1.5 * 2^52 leaves the integer in the low bits of the fraction, rounded. Where scaling
/// underflows the integer is zero, and the way back finds that the value is not.
#[inline]
fn short<const N: usize>(heads: &[f64; N], exponent: i32) -> Option<Lattice<N>> {
    const SHIFTER: f64 = ((1_u64 << 52) + (1 << 51)) as f64;
    let (scale, back) = (power_of_two(50 - exponent), power_of_two(exponent - 50));
    let shifted = heads.map(|x| x * scale + SHIFTER);
    let differs = |(s, &x): (&f64, &f64)| (s - SHIFTER) * back != x;
    if shifted
        .iter()
        .zip(heads)
        .fold(false, |any, pair| any | differs(pair))
    {
        return None;
    }
    let values = shifted.map(|s| s.to_bits().wrapping_sub(SHIFTER.to_bits()) as i64);
    Some(Lattice::reduced(values, 51))
}

/// Any differences, at most 61 bits of lattice.
#[inline]
fn long<const N: usize>(heads: &[f64; N], tails: &[f64; N], exponent: i32) -> Option<Lattice<N>> {
    let (scale, back) = (power_of_two(60 - exponent), power_of_two(exponent - 60));
    let mut exact = true;
    let mut convert = |x: f64| {
        let integer = (x * scale) as i64;
        exact &= integer as f64 * back == x;
        integer
    };
    // A tail is at most half a unit in the last place of its head: sums reach 2^61 at most.
    let values = std::array::from_fn(|i| convert(heads[i]) + convert(tails[i]));
    exact.then(|| Lattice::reduced(values, 62))
}

/// Magnitude and exponent: |x| = magnitude * 2^exponent, for finite x.
#[inline]
fn decode(x: f64) -> (u64, i32) {
    let (field, fraction) = (exponent_field(x), x.to_bits() & FRACTION);
    if field == 0 {
        (fraction, -1074)
    } else {
        (fraction | (1 << 52), field - BIAS - 52)
    }
}

/// Magnitude and exponent as from `decode`, with an odd magnitude or zero.
#[inline]
pub fn decode_odd(x: f64) -> (u64, i32) {
    let (magnitude, exponent) = decode(x);
    let zeros = magnitude.trailing_zeros() & 63;
    (magnitude >> zeros, exponent + zeros as i32)
}

/// The lowest set bit of all coordinates (its exponent), and the width in bits from there to the
/// highest: at most 2098, and 0 if all are zero. `None` if a coordinate is not finite.
pub fn bit_span<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> Option<(i32, u32)> {
    let (mut low, mut high) = (i32::MAX, i32::MIN);
    for &x in points.as_flattened() {
        if !x.is_finite() {
            return None;
        }
        let (magnitude, exponent) = decode_odd(x);
        if magnitude != 0 {
            low = low.min(exponent);
            high = high.max(exponent + 64 - magnitude.leading_zeros() as i32);
        }
    }
    Some(if low == i32::MAX {
        (0, 0)
    } else {
        (low, (high - low) as u32)
    })
}
