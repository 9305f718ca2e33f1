//! Predicates of directions: the points of the unit sphere that vectors of any length point to.
//!
//! Rounded unit vectors are not on the sphere, so here a vector means its direction `v / |v|`, exactly.
//! For vectors a, b, c, d and the determinant [a, b, c],
//!
//! - [`orient`] is the sign of [a, b, c]: lengths do not count;
//! - [`incircle`] is the sign of |a| [b, c, d] - |b| [a, c, d] + |c| [a, b, d] - |d| [a, b, c], which is
//!   |a| |b| |c| |d| times the determinant of the differences of the directions of b, c, d from that of
//!   a: positive inside the circle;
//! - [`nearer`] is the sign of (a q) / |a| - (b q) / |b|;
//! - [`compare`] is an order of directions in which no root occurs, and [`incircle_canonical`] breaks
//!   ties by it.
//!
//! # Stages
//!
//! 1. *Pairs*: directions as unevaluated sums of two doubles ([`Unit`]), whose differences are right
//!    to 53 bits; the determinant in plain floating point.
//! 2. *Double-double*: the same in double-double arithmetic.
//! 3. *Integer*: each vector times its own power of two, and the sign of a sum of four square roots by
//!    squaring (see `roots`).
//!
//! Callers with many tests try the leading doubles of the directions first.

mod incircle;
mod nearer;
mod order;
mod orient;
mod roots;
mod unit;

pub use incircle::{incircle, incircle_canonical, incircle_exact, incircle_of, tie};
pub use nearer::{nearer, nearer_of};
pub use order::{compare, same};
pub use orient::{orient, orient_exact, orient_of};
pub use unit::{Unit, leveled};

/// Each stage by itself, for tests and measurements; not part of the stable interface.
#[doc(hidden)]
pub mod stages {
    pub use super::incircle::{by_double_double, by_pairs, double_double, pairs};
    pub use super::nearer::by_differences;
    pub use super::orient::{by_pairs as orient_by_pairs, pairs as orient_pairs};
}
