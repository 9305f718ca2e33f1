//! Delaunay triangulations of directions, exact and canonical: the whole sphere, or a hull on it.
//!
//! A vector means its direction, whatever its length (see `delone_predicates::sphere`). Triangles are
//! the facets of the convex hull of the directions that the center sees from inside: those with a
//! positive determinant. If the directions lie in a half-space, the hull on the sphere has a boundary,
//! and a ghost for each of its edges stands for the facets beyond, as in 2-D.
//!
//! | file | contents |
//! |---|---|
//! | `directions`, `arrange` | vectors and their directions; predicates by number; insertion order |
//! | `kernel`, `close`, `walk` | insertion; the one that covers the rest of the sphere; the walk |
//! | `fill` | the insertion of all directions of a block |
//! | `join` | two triangulations, on both sides of a plane, as one |
//! | `constrain` | arcs as edges, by the insertion of segments in the plane |
//! | `angles`, `sines` | longitudes and latitudes to vectors |
//! | `locate`, `measure` | queries on arrays; areas and circumcenters |
//! | `void`, `dual`, `span` | the facets beyond a hull; the Voronoi diagram; its ridges and areas |
//! | `triangulate`, `degenerate` | rows to arrays; what exists where there is no triangle |

pub mod angles;
mod arrange;
#[cfg(test)]
mod bounds;
mod close;
mod constrain;
mod degenerate;
pub mod directions;
pub mod dual;
mod fill;
mod join;
mod kernel;
pub mod locate;
pub mod measure;
mod sines;
pub mod span;
mod triangulate;
pub mod void;
mod walk;

pub use constrain::{Constrained, constrain};
pub use triangulate::{Triangulation, triangulate};
