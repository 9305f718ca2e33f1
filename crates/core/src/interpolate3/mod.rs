//! Interpolation in 3-D: what a query would have for neighbors as a site, and how they count; gradients at
//! vertices.

mod cavity;
mod center;
mod exact;
mod gradients;
mod laplace;

pub use gradients::local_gradients;
pub use laplace::natural;
