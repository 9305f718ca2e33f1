//! Closed surfaces and the tetrahedra inside them: checked, filled, improved and refined.

pub mod imprint;
pub mod improve;
pub mod recover;
pub mod refine;
pub mod surface;
