//! Alpha complexes: the value of each simplex of a triangulation, correctly rounded, the outlines of
//! the simplices that remain, and concave hulls.
//!
//! H. Edelsbrunner and E. P. Mücke, "Three-dimensional alpha shapes", ACM Transactions on Graphics
//! 13 (1994). The value of a simplex is the squared radius of the smallest ball orthogonal to its
//! sites that no other site is in conflict with. If no opposite corner of a coface is in conflict
//! with its own smallest ball (`ball`), it is that; otherwise the least value of a coface. Conflicts
//! are decided exactly and rounding is monotone, so no face has a value above that of a coface.
//!
//! Tasks depend on the input only, and each writes its own part, so that the result is independent
//! of the number of threads.

mod ball;
mod erode;
mod faces;
mod gram;
mod number;
mod parts;
mod rings;
mod simplices;
mod tetrahedra;
mod triangles;
mod vertices;

pub use erode::{Limit, erode2, erode3};
pub use faces::{Level, faces};
pub use gram::Cloud;
pub use parts::{counts, labels};
pub use rings::{Rings, rings};
pub use simplices::Sites;
pub use tetrahedra::{Solid, solid};
pub use triangles::{Flat, Torus, edges, flat, torus};
pub use vertices::vertices;
