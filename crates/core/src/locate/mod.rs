//! 2-D point location: exact, boundary included, for any tiling in exported arrays.
//!
//! `locator` holds what calls share: a tree of starting simplices, the boundary. `batch` takes
//! queries in curve order, or in their given order if that is as good, and `walker` goes from each
//! to the next. These and others, such as `boxes`, serve tetrahedra as well; what differs is behind
//! the trait `Dimension`, of which `plane` has the 2-D half.

mod around;
mod barycentric;
mod batch;
mod boundary;
pub(crate) mod boxes;
mod coordinates;
mod cross;
mod excess;
mod locator;
mod nearest;
mod output;
mod plane;
mod range;
mod segment;
mod sites;
pub mod space;
mod star;
mod start;
mod straight;
mod tiling;
mod walk;
mod walker;

pub use around::first_around;
pub use barycentric::{barycentric, weights as barycentric_weights};
pub use batch::{Batch, find};
pub use boundary::{Boundary, outer_sides};
pub use boxes::{Boxes, length};
pub use coordinates::{Coordinates, coordinates};
pub use cross::{certain, cross, plain};
pub use excess::Excess;
pub use locator::{Cache, Dimension, Located, Locator, kept};
pub use nearest::nearest;
pub use output::Output;
pub use plane::Plane;
pub use range::{in_unit, is_finite, longest_side, seen_from, squared, unit_of};
pub use segment::along;
pub use sites::Sites;
pub use star::{First, Place, Star};
pub(crate) use start::Start;
pub use tiling::{next, prev};

/// What is cached between calls for one triangulation.
pub type Kept = Cache<Plane, 2, 3>;
