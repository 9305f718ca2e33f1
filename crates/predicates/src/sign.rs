//! The answer of a predicate.

use std::cmp::Ordering;
use std::ops::{Mul, Neg};

/// The sign of a determinant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    /// Below zero: right turn, clockwise, outside.
    Negative = -1,
    /// Exactly zero: the points are degenerate.
    Zero = 0,
    /// Above zero: left turn, counterclockwise, inside.
    Positive = 1,
}

impl Sign {
    /// The sign of a double; [`Sign::Zero`] for NaN.
    #[inline]
    #[must_use]
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// This sign, negated if `flip` is true.
    #[inline]
    #[must_use]
    pub fn flip_if(self, flip: bool) -> Self {
        if flip { -self } else { self }
    }

    /// Whether this is [`Sign::Zero`].
    #[inline]
    #[must_use]
    pub fn is_zero(self) -> bool {
        self == Self::Zero
    }
}

impl Neg for Sign {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        match self {
            Self::Negative => -other,
            Self::Zero => Self::Zero,
            Self::Positive => other,
        }
    }
}

impl From<Ordering> for Sign {
    #[inline]
    fn from(ordering: Ordering) -> Self {
        match ordering {
            Ordering::Less => Self::Negative,
            Ordering::Equal => Self::Zero,
            Ordering::Greater => Self::Positive,
        }
    }
}

impl From<i128> for Sign {
    #[inline]
    fn from(value: i128) -> Self {
        value.cmp(&0).into()
    }
}

impl From<Sign> for i8 {
    #[inline]
    fn from(sign: Sign) -> Self {
        sign as Self
    }
}
