//! The predicates against exact arithmetic.
//!
//! One program for all of them: what they share is compiled and linked once.

mod angle;
mod bounds;
mod degenerate;
mod distance;
mod filter;
mod neighbours;
mod oracle;
mod proximity;
mod range;
mod sphere;
mod sweep;
mod symmetry;
#[path = "../../../core/tests/suite/tier.rs"]
mod tier;
mod ties;
