//! 3-D natural neighbor weights of queries, and gradients at vertices.

mod cavity;
mod center;
mod exact;
mod gradients;
mod laplace;

pub use gradients::local_gradients;
pub use laplace::natural;
