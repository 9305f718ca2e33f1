//! Natural neighbours in space: what a query would have for neighbours as a site, and how they count;
//! and the nearest point of the hull for what is outside.

mod cavity;
mod hull;
mod laplace;

pub use hull::nearest_on_faces;
pub use laplace::natural;
