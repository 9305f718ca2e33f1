//! Live triangulations: points are inserted, removed and moved, and every state is canonical.
//!
//! # Why every order of edits ends in the same triangles
//!
//! Ties are broken by coordinates only (see `delaunay::plane`): each point has a perturbed height that does
//! not depend on the other points, no two of which are tied. So a set of points has one triangulation,
//! the lower hull of its lifted points, and an edit that turns the lower hull of the points before it
//! into that of the points after it leaves nothing of the history behind. Each of the edits does:
//!
//! - *Insertion.* The facets of the lower hull that the new lifted point sees are replaced by the cone
//!   from it to their border.
//! - *Removal.* A facet that does not have the removed point as a corner stays below all other points,
//!   hence a facet. The hole is the star of the point. A facet that fills it was hidden by the point,
//!   and all of its corners were neighbors of it: otherwise one would see the facet past the star. The
//!   facet at a border edge of the hole is spanned by the corner for which no other is below, and the
//!   corner is unique because no four perturbed points are coplanar; so the hole is filled from edge to
//!   edge, by comparisons among its corners.
//! - *Movement.* Where the star of a vertex keeps its orientation, the moved surface is a triangulation
//!   of the moved points, and flips turn any triangulation into the lower hull (see
//!   `delaunay::plane::lawson`); a surface without an edge to flip is the lower hull already. Otherwise a
//!   movement is a removal and an insertion.
//! - *A rebuild* computes the lower hull from the points.
//!
//! A ghost is a facet through the point at infinity, and the hull of points in a plane is not
//! perturbed, so all of this holds at the hull, too. Points on one line have no triangle; they are
//! kept in order along the line until a point restores the plane.
//!
//! # All or nothing
//!
//! Edits reserve memory before they change anything. A batch that fails in the middle, because memory
//! is refused or the caller wants to stop, is taken back by the inverse edits in reverse order; as each
//! state is unique, they lead to the triangles of the start. Among segments, what an edit replaces is
//! recorded (see `journal`).

pub mod chunks;
mod journal;
pub mod plane;
pub mod rows;
pub mod space;
