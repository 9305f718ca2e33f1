//! Measures of triangles and tetrahedra: edges and faces, centers, sizes, shapes.
//!
//! `skeleton` lists edges and faces, without coordinates. The others read coordinates and round
//! only their results: what cancels in a thin simplex is recomputed with more digits. `circle` and
//! `sphere` compute the centers (with weights, too), `corners` the vectors of a simplex in a unit
//! of its own, `size` areas and volumes, `affine` the maps to barycentric coordinates, `triangle`
//! and `tetrahedron` the quality measures. Simplices must be positively oriented, exactly.

mod affine;
mod batch;
pub(crate) mod center;
pub(crate) mod circle;
mod circumcenter;
mod component;
mod corners;
mod size;
mod skeleton;
pub(crate) mod sphere;
mod tetrahedron;
mod triangle;

pub use affine::{transforms2, transforms3};
pub use batch::each;
pub use circumcenter::{circumcenters2, circumcenters3};
pub use size::{areas, face_areas, face_normals, volumes};
pub(crate) use skeleton::{Buckets, distinct};
pub use skeleton::{around, edges, edges2, faces3};
pub use tetrahedron::{dihedral_angles, qualities3};
pub use triangle::{below, is_below, qualities2, smallest_angle};
