//! 2-D interpolation of scattered data on a triangulation and its locator.
//!
//! `linear` in each triangle, `clough_tocher` on each triangle split in three, `natural` by the
//! cavity of a query. All are linear in the values (and gradients), so weights serve many fields.

mod adjacency;
mod cavity;
mod clough_tocher;
mod exact;
mod field;
mod gradients;
mod hubs;
mod kind;
mod leave_one_out;
mod linear;
mod natural;
mod number;
mod rows;
pub mod space;
pub mod sphere;
mod weights;

pub use adjacency::Adjacency;
pub use cavity::Barrier;
pub use clough_tocher::{clough_tocher, clough_tocher_weights};
pub use field::Field;
pub use gradients::{CLOSE, NEAR, NOISY, WIDE, WIDER, global_gradients, local_gradients};
pub use kind::Kind;
pub use leave_one_out::{Method, leave_one_out};
pub use linear::linear;
pub use natural::{natural, natural_values};
pub use number::{Jet, Number};
pub use rows::{Part, Rows, Table};

/// What is requested of an interpolant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Its value.
    Value,
    /// Its derivatives by x and y.
    Gradient,
    /// Its second derivatives xx, xy and yy.
    Hessian,
}

impl Order {
    /// The order with this number of derivatives.
    pub fn of(number: usize) -> Option<Self> {
        [Self::Value, Self::Gradient, Self::Hessian]
            .get(number)
            .copied()
    }

    /// How many components it has.
    pub fn components(self) -> usize {
        match self {
            Self::Value => 1,
            Self::Gradient => 2,
            Self::Hessian => 3,
        }
    }
}
