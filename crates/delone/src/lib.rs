//! Exact, canonical and fast Delaunay triangulation in 2-D and 3-D.
//!
//! | you have | you want | start with |
//! |---|---|---|
//! | points in 2-D or 3-D | triangles or tetrahedra | [`Triangulation::new`] |
//! | points and segments | triangles whose edges include the segments | [`Constrained::new`] |
//! | polygons with holes | the triangles inside | [`Constrained::polygon`] |
//! | a constrained triangulation | a mesh without small angles | [`Mesh::new`] |
//! | a triangulation | cells, their areas and volumes | [`Voronoi::new`] |
//! | a triangulation and queries | the triangles that contain them | [`Tiling::locate`] |
//!
//! ```
//! use delone::Triangulation;
//!
//! let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [2.0, 1.0]];
//! let triangulation = Triangulation::new(&points)?;
//! for [a, b, c] in triangulation.simplices() {
//!     println!("{:?} {:?} {:?}", points[a], points[b], points[c]);
//! }
//! assert_eq!(triangulation.simplices().len(), 4);
//! # Ok::<(), delone::Error>(())
//! ```
//!
//! # Guarantees
//!
//! - **Exact.** The triangles are right for the given doubles, for every finite input. There is no
//!   tolerance, no limit on the range of coordinates, and no super-triangle.
//! - **Canonical.** A point set has one result. Cocircular points are triangulated by a rule that
//!   uses coordinates only, so neither the order of the rows nor the number of threads changes the
//!   set of triangles.
//! - **Nothing is lost.** Every distinct point is a vertex. A duplicate is reported with the row of
//!   its first occurrence ([`Tiling::duplicates`]). Input without a valid result is an [`Error`]
//!   that names the rows.
//! - **No panics by design.** Bad input, memory that the system refuses and requests to stop are
//!   errors. This crate contains no `unsafe` code; the crates that it uses contain some in two files.
//!
//! # Points, borrowed or owned
//!
//! Points are arrays of coordinates, [`Point2`] and [`Point3`]. A function that takes points takes a
//! reference to a `Vec`, slice or array, which is borrowed and not copied, or a `Vec`, which it
//! keeps: then the result has no lifetime.
//!
//! ```
//! use delone::Triangulation;
//!
//! fn read() -> Result<Triangulation<'static>, delone::Error> {
//!     Triangulation::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
//! }
//! assert_eq!(read()?.simplices().len(), 1);
//! # Ok::<(), delone::Error>(())
//! ```
//!
//! # Options
//!
//! [`Options`] has all settings, and a method for each computation that uses them: bounds on angles and
//! areas, holes, the number of threads, which does not affect the result, and a function that long
//! calls ask whether to stop.
//!
//! # Arrays
//!
//! Iterators and slices of `usize` serve most programs. [`arrays`] has what is behind them, for
//! bindings to other languages and for files.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod areas;
pub mod arrays;
mod cells;
mod checks;
mod constrained;
mod dimension;
mod error;
mod location;
mod mesh;
mod options;
mod tiling;
mod triangulation;
mod voronoi;

pub use cells::Cells;
pub use constrained::{Constrained, Subsegment};
pub use delone_core::delaunay2::Method;
pub use delone_predicates::{Point2, Point3};
pub use dimension::Dimension;
pub use error::{Error, Result};
pub use location::Location;
pub use mesh::Mesh;
pub use options::Options;
pub use tiling::Tiling;
pub use triangulation::{Triangulation, Triangulation3};
pub use voronoi::{Corner, Ridge, Voronoi};

/// Exact geometric predicates: the signs of determinants, for every finite double.
///
/// ```
/// use delone::predicates::{Sign, orient2d};
///
/// // The last point lies left of the line by less than rounded arithmetic can see.
/// let right = 0.1 + 2.0_f64.powi(-56);
/// assert_eq!(orient2d([0.0, 0.0], [0.3, 0.3], [0.1, right]), Sign::Positive);
/// ```
pub mod predicates {
    pub use delone_predicates::{Sign, incircle, insphere, orient2d, orient3d};
}

/// Runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
