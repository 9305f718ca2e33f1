//! Integers of a fixed number of 64-bit limbs, on the stack.
//!
//! Two's complement, least limb first. Sizes are chosen so that nothing wraps: let coordinates have
//! at most 64 D - 3 bits. Then, writing W for 2^64D,
//!
//! | what | bound | limbs |
//! |---|---|---|
//! | difference | W / 4 | D |
//! | 2 x 2 minor, 2 W^2 / 16 | W^2 / 8 | 2 D |
//! | squared length, 3 W^2 / 16 | W^2 / 4 | 2 D |
//! | 3 x 3 minor, 3 W/4 W^2/8 | W^3 / 8 | 3 D |
//! | in-circle, 3 W^2/8 W^2/8 | W^4 / 16 | 4 D |
//! | in-sphere, 4 W^2/4 W^3/8 | W^5 / 8 | 5 D |
//!
//! and each must stay below half of 2 to the power of its bits. The same table with D = 1 serves
//! lattice differences of up to 62 bits.

use crate::range::{bit_span, decode_odd};
use crate::sign::Sign;

/// A signed integer of `N` limbs.
#[derive(Clone, Copy, Debug)]
pub struct Integer<const N: usize>([u64; N]);

/// The widest coordinate, in bits, for which differences have `limbs` limbs.
pub const fn capacity(limbs: usize) -> u32 {
    64 * limbs as u32 - 3
}

/// Limbs of a difference for any two finite doubles: 2098 bits and the three of [`capacity`].
pub const FULL: usize = 33;

impl Integer<1> {
    /// The integer of one limb.
    #[inline]
    pub fn new(value: i64) -> Self {
        Self([value as u64])
    }
}

impl From<i128> for Integer<2> {
    #[inline]
    fn from(value: i128) -> Self {
        Self([value as u64, (value >> 64) as u64])
    }
}

impl<const N: usize> Integer<N> {
    /// `x / 2^low`, where x is a multiple of 2^low that fits.
    pub fn from_double(x: f64, low: i32) -> Self {
        let mut limbs = [0; N];
        let (magnitude, exponent) = decode_odd(x);
        if magnitude == 0 {
            return Self(limbs);
        }
        let shift = (exponent - low) as usize;
        let (limb, bit) = (shift / 64, shift % 64);
        let placed = u128::from(magnitude) << bit;
        limbs[limb] = placed as u64;
        if limb + 1 < N {
            limbs[limb + 1] = (placed >> 64) as u64;
        }
        if x < 0.0 {
            Self([0; N]).minus(&Self(limbs))
        } else {
            Self(limbs)
        }
    }

    /// The sum.
    #[inline]
    pub fn plus(&self, other: &Self) -> Self {
        let mut limbs = self.0;
        let mut carry = false;
        for (limb, &add) in limbs.iter_mut().zip(&other.0) {
            let (sum, over) = limb.overflowing_add(add);
            let (sum, again) = sum.overflowing_add(u64::from(carry));
            (*limb, carry) = (sum, over | again);
        }
        Self(limbs)
    }

    /// The difference.
    #[inline]
    pub fn minus(&self, other: &Self) -> Self {
        let mut limbs = self.0;
        subtract(&mut limbs, &other.0);
        Self(limbs)
    }

    /// The number with the other sign.
    #[inline]
    pub fn negated(&self) -> Self {
        Self([0; N]).minus(self)
    }

    /// The product; it has as many limbs as both factors together.
    ///
    /// The product of the limbs as unsigned numbers is too large by 2^64A times b where a is
    /// negative, and by 2^64B times a where b is.
    #[inline]
    pub fn times<const B: usize, const P: usize>(&self, other: &Integer<B>) -> Integer<P> {
        const { assert!(N + B == P, "a product has the limbs of its factors") }
        let mut product = [0; P];
        for (i, &a) in self.0.iter().enumerate() {
            // Wide integers are mostly zeros; for short ones the branch would cost more.
            if N > 8 && a == 0 {
                continue;
            }
            let mut carry = 0;
            for (j, &b) in other.0.iter().enumerate() {
                let sum = u128::from(a) * u128::from(b) + u128::from(product[i + j]) + carry;
                product[i + j] = sum as u64;
                carry = sum >> 64;
            }
            product[i + B] = carry as u64;
        }
        if self.is_negative() {
            subtract(&mut product[N..], &other.0);
        }
        if other.is_negative() {
            subtract(&mut product[B..], &self.0);
        }
        Integer(product)
    }

    #[inline]
    fn is_negative(&self) -> bool {
        (self.0[N - 1] as i64) < 0
    }

    /// The sign.
    #[inline]
    pub fn sign(&self) -> Sign {
        if self.is_negative() {
            Sign::Negative
        } else if self.0.iter().all(|&limb| limb == 0) {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }
}

/// `limbs -= other`, for equally many limbs, modulo 2 to the power of their bits.
#[inline]
fn subtract(limbs: &mut [u64], other: &[u64]) {
    let mut borrow = false;
    for (limb, &sub) in limbs.iter_mut().zip(other) {
        let (difference, under) = limb.overflowing_sub(sub);
        let (difference, again) = difference.overflowing_sub(u64::from(borrow));
        (*limb, borrow) = (difference, under | again);
    }
}

/// The first N - 1 points relative to the last, in units of 2^low.
pub fn differences<const L: usize, const D: usize, const N: usize, const M: usize>(
    points: &[[f64; D]; N],
    low: i32,
) -> [[Integer<L>; D]; M] {
    const { assert!(M + 1 == N, "one point is the origin") }
    let at = |i: usize, k: usize| Integer::from_double(points[i][k], low);
    let origin: [Integer<L>; D] = std::array::from_fn(|k| at(M, k));
    std::array::from_fn(|i| std::array::from_fn(|k| at(i, k).minus(&origin[k])))
}

/// Calls the evaluation of the smallest size class that holds `points`: of `small`, `medium`,
/// `large` and `full`, which have differences of 2, 5, 12 and [`FULL`] limbs. Each takes the
/// exponent of the unit.
pub fn by_width<const D: usize, const N: usize>(
    points: &[[f64; D]; N],
    small: impl Fn(i32) -> Sign,
    medium: impl Fn(i32) -> Sign,
    large: impl Fn(i32) -> Sign,
    full: impl Fn(i32) -> Sign,
) -> Sign {
    match bit_span(points) {
        None => Sign::Zero,
        Some((low, width)) if width <= capacity(2) => small(low),
        Some((low, width)) if width <= capacity(5) => medium(low),
        Some((low, width)) if width <= capacity(12) => large(low),
        Some((low, _)) => full(low),
    }
}
