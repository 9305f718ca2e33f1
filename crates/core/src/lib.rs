//! The core of delone: point orders, meshes and the Delaunay triangulations on them.
//!
//! The core has no knowledge of Python. Data flows one way: `base::points` and `order` feed `delaunay`,
//! which fills a `mesh`; later stages read that mesh and return arrays.
//!
//! A room is a subject. Where it has more than one dimension, `space` has the tetrahedra and `sphere`
//! the globe; the plane and what all share are `plane`, or the files of the room itself.

pub mod alpha;
pub mod base;
pub mod constrained;
pub mod delaunay;
pub mod distributed;
pub mod graphs;
pub mod hull;
pub mod interpolate;
pub mod live;
pub mod locate;
pub mod measure;
pub mod mesh;
pub mod ndim;
pub mod order;
pub mod overlap;
pub mod refine;
pub mod regular;
pub mod solids;
pub mod sphere;
pub mod terrain;
pub mod voronoi;

pub use delone_predicates::{Point2, Point3};
