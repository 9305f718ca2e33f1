//! The intersection of half-spaces, as the convex hull of their dual points, which are not rounded.
//!
//! A half-space a x + b <= 0 that contains the interior point p is the vector v = (a, b) with V = D + 1
//! components, all of them given doubles. Its dual point is q = a / |a p + b|, a rational point of a
//! section of the cone of the vectors. A facet of the hull has D of them as vertices, and a *normal* Y
//! with Y v = 0 for these and Y v < 0 for points inside: if the last component of Y is positive, the
//! boundaries meet in the corner Y / Y_D of the intersection, and a half-space sees the facet if it
//! cuts off that corner. If not, the intersection is unbounded there.
//!
//! # Decisions
//!
//! Whether w is outside of a facet is the sign of the determinant of its vectors and w. Rows may be
//! multiplied by powers of two, so no division takes place, and nothing depends on p. Rounded dual
//! points decide where a bound that covers their roundings allows it (`rounded`); integers decide the
//! rest (`normal`).
//!
//! # Ties
//!
//! Where Y w = 0, points are moved away from the middle of the hull by infinitesimals, of which that
//! of a lexicographically smaller dual point is infinitely larger. Let w = sum l_i v_i with w and v_i
//! in the section. The height of w above the moved facet is eps(w) - sum l_i eps(v_i): of w and of the
//! v_i with l_i other than zero, the smallest decides. If it is w, then w is outside, otherwise if its
//! l_i is negative. A point that others enclose is never the smallest, so only extreme points become
//! vertices, and redundant half-spaces are left out without another test. Facets are simplices; those
//! of one plane are joined at the end.
//!
//! # Insertion
//!
//! As in `hull`: the farthest point outside of a facet is inserted, and points outside of the removed
//! facets are kept with new ones (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The quickhull algorithm
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
