//! Exact geometric predicates: the sign of the determinant, for every finite double.
//!
//! | predicate | answers | degree |
//! |---|---|---|
//! | [`orient2d()`] | on which side of the line `ab` does `c` lie? | 2 |
//! | [`angle()`] | is the angle at `p` between `a` and `b` acute? | 2 |
//! | [`nearer()`], [`nearer3()`] | which of `a`, `b` is nearer to `o`? | 2 |
//! | [`incircle()`] | does `d` lie inside the circle `abc`? | 4 |
//! | [`orient3d()`] | on which side of the plane `abc` does `d` lie? | 3 |
//! | [`insphere()`] | does `e` lie inside the sphere `abcd`? | 5 |
//!
//! The answer is a [`Sign`], exact for the given doubles: no tolerance, no range limit, subnormals
//! and `f64::MAX` included. [`incircle_canonical`] and [`insphere_canonical`] break ties by the
//! coordinates of the points only, never by their order. [`sphere`] has the predicates of
//! directions, which include square roots.
//!
//! # Stages
//!
//! Each predicate tries cheap stages first; a stage answers only if it can prove the sign.
//!
//! 1. *Filter*: the determinant in plain floating point against a forward error bound. Overflow
//!    and NaN fail the comparison, underflow is part of the bound. Inlined at the call.
//! 2. *Lattice*: where all coordinate differences are integer multiples, up to 2^61, of one power
//!    of two, integers of 64, 128 and 256 bits (320 for the sphere) give the exact answer. This
//!    settles the ties of grids, integers and quantized data.
//! 3. *Expansion*: double-double arithmetic, if the exponents rule out overflow and underflow.
//! 4. Stages 1 to 3 once more on coordinates scaled by a power of two, where stage 3 was out of
//!    range.
//! 5. *Integer*: fixed-size integers on the stack, up to the full 2098 bits between the last bit
//!    of a subnormal and `f64::MAX`. Always right; no allocation.
//!
//! The functions `*_exact` are stages 2 to 5, for callers with a filter of their own.
//!
//! # Numbers that are not finite
//!
//! A NaN or infinite coordinate makes the determinant meaningless; the answer is then
//! [`Sign::Zero`]. No function panics.
//!
//! # Sources
//!
//! J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
//! predicates", Discrete & Computational Geometry 18 (1997), for filters and expansions;
//! M. Joldes, J.-M. Muller and V. Popescu, "Tight and rigorous error bounds for basic building
//! blocks of double-word arithmetic", ACM TOMS 44 (2017); H. Edelsbrunner and E. P. Mücke,
//! "Simulation of simplicity", ACM TOG 9 (1990), and O. Devillers and M. Teillaud, "Perturbations
//! for Delaunay and weighted Delaunay 3D triangulations", Computational Geometry 44 (2011), for
//! ties.

mod angle;
mod distance;
mod expansion;
mod incircle;
mod insphere;
mod integer;
mod orient2d;
mod orient3d;
pub mod proximity;
mod range;
mod sign;
pub mod sphere;
pub mod sweep;
mod ties;

pub use angle::angle;
pub use distance::{nearer, nearer3};
pub use incircle::{incircle, incircle_exact};
pub use insphere::{insphere, insphere_exact};
pub use orient2d::{orient2d, orient2d_exact};
pub use orient3d::{orient3d, orient3d_exact};
pub use sign::Sign;
pub use ties::{incircle_canonical, insphere_canonical, lexicographic, tie_flips};

/// A point in 2-D.
pub type Point2 = [f64; 2];

/// A point in 3-D.
pub type Point3 = [f64; 3];

/// The arithmetic beneath the stages, for constructions on points; not part of the stable interface.
#[doc(hidden)]
pub mod arithmetic {
    pub use crate::expansion::{Pair, two_sum};
    pub use crate::range::{bit_span, decode_odd, is_safe};
}

/// Each stage by itself, for tests and measurements; not part of the stable interface.
#[doc(hidden)]
pub mod stages {
    /// The stages of `orient2d`.
    pub mod orient2d {
        pub use crate::orient2d::{expansion, filter, integer, lattice, scaled};
    }
    /// The stages of `incircle`.
    pub mod incircle {
        pub use crate::incircle::{expansion, filter, integer, lattice, scaled};
    }
    /// The stages of `orient3d`.
    pub mod orient3d {
        pub use crate::orient3d::{expansion, filter, integer, lattice, scaled};
    }
    /// The stages of `insphere`.
    pub mod insphere {
        pub use crate::insphere::{expansion, filter, integer, lattice, scaled};
    }
}
