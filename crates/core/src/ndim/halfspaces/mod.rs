//! The intersection of half-spaces, as the convex hull of their exact dual points.
//!
//! A half-space a x + b <= 0 that contains the interior point p is the vector v = (a, b) with V = D + 1
//! components, all of them given doubles. Its dual point is q = a / |a p + b|, a rational point in a
//! section of the cone of the vectors. A facet of the hull has D dual points as vertices, and a *normal*
//! Y with Y v = 0 for these and Y v < 0 for points inside. If the last component of Y is positive, the
//! boundaries meet at the corner Y / Y_D of the intersection, and a half-space sees the facet if it
//! cuts off that corner. Otherwise, the intersection is unbounded there.
//!
//! # Decisions
//!
//! Whether w is outside a facet is decided by the sign of the determinant of its vectors and w. Rows may
//! be multiplied by powers of two, so nothing is divided, and nothing depends on p. Rounded dual points
//! decide where a bound on their rounding errors allows it (`rounded`); integers decide the rest
//! (`normal`).
//!
//! # Ties
//!
//! Where Y w = 0, points are moved away from the center of the hull by infinitesimals eps; a
//! lexicographically smaller dual point has an infinitely larger eps. Let w = sum l_i v_i with w and
//! v_i in the section. The height of w above the moved facet is eps(w) - sum l_i eps(v_i), so among w
//! and the v_i with nonzero l_i, the smallest decides: if it is w, then w is outside; if it is v_i, then
//! w is outside if l_i is negative. A point that others enclose is never the smallest, so only extreme
//! points become vertices, and redundant half-spaces are left out without another test. Facets are
//! simplices; those in one plane are joined at the end.
//!
//! # Insertion
//!
//! As in `hull`: the farthest point outside a facet is inserted, and points outside the removed facets
//! are assigned to new ones (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm
//! for convex hulls", 1996). Expected time n log n + n^floor(D/2).

mod corner;
mod normal;
mod output;
mod rounded;
mod sites;
mod start;
#[cfg(test)]
mod tests;
mod wrap;

pub use output::{Corners, Found, Trouble, intersect};
