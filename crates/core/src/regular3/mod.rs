//! Regular triangulations of space: the lower hull of sites lifted to |p|^2 - w, exact and canonical.

mod power;

pub(crate) use power::determinant;
pub use power::{power_canonical, power_sign};
