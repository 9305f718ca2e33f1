//! The core of delone: point orders, meshes and the Delaunay triangulations on them.
//!
//! The core has no knowledge of Python. Data flows one way: `points` and `order` feed `delaunay2`,
//! which fills a `mesh2`; later stages read that mesh and return arrays.

pub mod alpha;
pub mod arrays;
pub mod cluster;
pub mod consistency;
pub mod constrained;
pub mod contour;
pub mod delaunay2;
pub mod delaunay3;
pub mod distributed;
pub mod error;
pub mod graphs;
pub mod hull;
pub mod improve;
pub mod interpolate;
pub mod interpolate3;
pub mod interpolate_sphere;
pub mod joins;
pub mod live;
pub mod locate;
pub mod locate3;
pub mod measure;
pub mod memory;
pub mod mesh2;
pub mod mesh3;
pub mod ndim;
pub mod order;
pub mod overlap;
pub mod overlay;
mod parallel;
pub mod points;
pub mod proof;
pub mod recover;
pub mod refine;
pub mod refine3;
pub mod regular;
pub mod regular3;
pub mod simplify;
pub mod sphere;
pub mod surface;
pub mod voronoi;
pub mod voronoi3;
pub mod watch;
mod wide;

pub use delone_predicates::{Point2, Point3};
