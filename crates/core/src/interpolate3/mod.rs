//! Natural neighbours in space: what a query would have for neighbours as a site, and how they count.

mod cavity;
mod center;
mod exact;
mod laplace;

pub use laplace::natural;
