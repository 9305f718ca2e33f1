//! Contour lines of a triangulated surface, and the bands between levels.
//!
//! The surface is linear in each triangle. A vertex is above a level if its height is at least the
//! level, exactly; so a level crosses an edge if one end is above and the other is not, and each
//! triangle has no or two such edges. Topologically, contours are therefore disjoint curves that
//! end at the outline only, and those of one level enclose those of the next.
//!
//! Coordinates are rounded once, for each pair of an edge and a level, so that both triangles of an
//! edge have the same *node*. A node at the height of the upper end of its edge is that vertex.
//! `nodes` numbers and computes the nodes; `untangle` merges nodes until the pieces into which
//! contours cut the triangles are positively oriented or collapsed, so that lines touch but never
//! cross, and proves it; `edges` collects the edges of each level or band; `link` joins them into simple
//! lines and rings; `lines` and `bands` have the results.
//!
//! Threads share the triangles, and then the levels; the result does not depend on their number.

mod bands;
mod edges;
mod lines;
mod link;
mod nodes;
mod untangle;

pub use bands::{Bands, bands};
pub use lines::{Lines, lines};
