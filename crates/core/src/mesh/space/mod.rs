//! A tetrahedral mesh with ghosts: topology only, no coordinates and no predicates.
//!
//! A tetrahedron has four corners, positively oriented: seen from corner 3 the corners 0, 1, 2 are
//! clockwise, which means `orient3d > 0`. The [`Code`] `4 t + k` is the facet of tetrahedron t
//! opposite its corner k, and `opposite` is the same facet as seen from the other side. Each hull
//! facet has a ghost; all ghosts share one vertex at infinity, which is on the positive side of
//! their hull facet. So each facet always joins two records.

mod storage;

pub use crate::base::arrays::FACETS;
pub use storage::{Code, LIMIT, Mesh3, Records, corner, tetrahedron};
