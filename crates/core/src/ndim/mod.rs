//! Delaunay triangulations in four to eight dimensions: exact, canonical, one code for all.
//!
//! Everything is generic over three constants: `D` coordinates, `V = D + 1` corners, and `P`, `D`
//! rounded up to whole vector registers. In 2-D and 3-D the result is that of `delaunay::plane` and
//! `delaunay::space`, which tests use.
//!
//! # The rule
//!
//! As in two and three dimensions (`delone_predicates` on ties), a point p has the height
//! h(p) = |p|^2 - eps(p), where eps of a lexicographically smaller point is infinitely larger, and the
//! triangulation is the lower hull. Let S be a simplex, p another point, P its power with respect
//! to the sphere of S, and l_i its barycentric coordinates in S. The height of p above the plane of S
//! is P - eps(p) + sum l_i eps(v_i). If P = 0, the largest infinitesimal with a coefficient other than
//! zero decides: of p and of the v_i with l_i != 0, take the smallest; p is in conflict if that is p, or
//! if its l_i < 0. The coefficient of eps(p) is never zero, so no tie remains, no simplex is flat, and
//! each distinct point is a vertex. Heights depend on coordinates only, so the order of rows does not
//! matter.
//!
//! A ghost is in conflict if p is strictly beyond its facet, or in its hyperplane and in conflict with
//! the simplex behind it: there the barycentric coordinate of the opposite vertex is zero.
//!
//! # Stages of a decision
//!
//! | stage | file | decides |
//! |---|---|---|
//! | rounded, with a bound proven afterward | `filter`, `lanes` | nearly everything |
//! | double-double, with the same proof | `fine`, `simplex` | points near a sphere or a plane |
//! | residues modulo primes | `residues` | that a value is zero |
//! | integers | `frame`, `limbs` | the rest |
//!
//! Cavities with ghosts in any dimension: J.-D. Boissonnat, O. Devillers, S. Hornus, "Incremental
//! construction of the Delaunay triangulation and the Delaunay graph in medium dimension" (2009).

#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns of small matrices have numbers"
)]

mod cavity;
mod cell;
mod decide;
mod dispatch;
mod filter;
mod fine;
mod flat;
mod frame;
pub mod halfspaces;
mod hull;
mod lanes;
mod lazy;
mod limbs;
mod location;
mod measure;
mod order;
mod residues;
mod simplex;
mod sites;
#[cfg(test)]
mod tests;
mod triangulate;
mod validate;
mod walk;
mod wrapping;

pub use flat::{hull_in_flat, triangulate_in_flat};
pub use hull::{Hull, hull};
pub use lazy::{Lazy, Limits, Located};
pub use location::{Hyper, Weighed, Within, nearest, within};
pub use measure::{circumcenters, fault, orientations, transforms, volumes};
pub use sites::{MOST, Rest};
pub use triangulate::{Simplices, regular, triangulate};
pub use validate::{Findings, validate, validate_in_flat, validate_regular};
