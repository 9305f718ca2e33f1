//! 3-D point location: exact, boundary included, for any tiling in exported arrays.
//!
//! Points are located by `locate`, which takes from `space` what tetrahedra have of their own:
//! `walk`, which ends at one of them, and `boundary`, which has the nearest face outside.

mod barycentric;
mod boundary;
mod coordinates;
mod dimension;
mod distance;
mod excess;
mod face;
mod foot;
mod nearest;
mod walk;

pub use barycentric::barycentric;
pub use coordinates::{Coordinates, Within, coordinates, within};
pub use dimension::Space;
pub use distance::Distances;
pub use nearest::nearest;

pub use crate::base::arrays::{OUTWARD as FACES, Tetrahedra};
use crate::locate;
pub use crate::locate::find;

/// What is cached between calls for one triangulation.
pub type Kept = locate::Cache<Space, 3, 4>;
/// A 3-D triangulation and its cache.
pub type Locator<'a> = locate::Locator<'a, Space, 3, 4>;
/// The 3-D queries of one call.
pub type Batch<'a> = locate::Batch<'a, Space, 3, 4>;
/// The location of a point.
pub type Located = locate::Located<4>;
/// A point in a closed tetrahedron.
pub type Place = locate::Place<4>;
