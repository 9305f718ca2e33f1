//! The bindings between Python and Rust: arrays in, arrays out, errors as Python exceptions. No
//! algorithm lives here.
//!
//! They use the public crate `delone`, and the core only where that crate has nothing: weights,
//! periodic sets, tiles, interpolation and location with a shared index, hulls, measures, proofs,
//! clipped cells, and tetrahedral improvement.

mod arrays;
mod consistency;
mod constrained;
mod distributed;
mod errors;
mod given;
mod graphs;
mod hull;
mod improve;
mod interpolate;
mod lawson;
mod locate;
mod locate3;
mod locator;
mod measure;
mod predicates;
mod refine;
mod regular;
mod regular_faults;
mod results;
mod signals;
mod space;
mod triangulation;
mod voronoi;
mod voronoi3;

use pyo3::prelude::*;

/// The compiled core of delone.
#[pymodule(gil_used = false)]
fn _core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add_function(wrap_pyfunction!(predicates::orient2d, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::incircle, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::orient3d, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::insphere, m)?)?;
    m.add_class::<triangulation::Triangulation>()?;
    m.add_class::<triangulation::Faults2>()?;
    m.add_class::<space::Faults3>()?;
    m.add_class::<regular::RegularTriangulation>()?;
    m.add_class::<regular::PeriodicTriangulation>()?;
    m.add_class::<regular_faults::RegularFaults2>()?;
    m.add_class::<regular_faults::RegularFaults3>()?;
    m.add_class::<regular_faults::PeriodicFaults>()?;
    m.add_class::<hull::Hull3>()?;
    m.add_class::<lawson::FlippedTriangulation>()?;
    m.add_class::<constrained::ConstrainedTriangulation>()?;
    m.add_class::<refine::RefinedMesh>()?;
    m.add_class::<refine::JudgedTriangles>()?;
    m.add_class::<voronoi::Diagram2>()?;
    m.add_class::<voronoi::ClippedCells2>()?;
    m.add_class::<voronoi::CellMeasures2>()?;
    m.add_class::<voronoi::CellPieces2>()?;
    m.add_class::<voronoi3::Diagram3>()?;
    m.add_class::<voronoi3::ClippedCells3>()?;
    m.add_class::<voronoi3::CellMeasures3>()?;
    m.add_class::<locate::Location2>()?;
    m.add_class::<locate3::Location3>()?;
    m.add_class::<interpolate::CornerWeights>()?;
    m.add_class::<interpolate::NaturalWeights>()?;
    m.add_class::<interpolate::WeightRows>()?;
    m.add_class::<distributed::DeepestPoints>()?;
    m.add_class::<improve::ImprovedMesh>()?;
    m.add_class::<improve::ImprovementCounts>()?;
    m.add_function(wrap_pyfunction!(triangulation::methods2, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::triangulate2, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::validate2, m)?)?;
    m.add_function(wrap_pyfunction!(space::triangulate3, m)?)?;
    m.add_function(wrap_pyfunction!(space::validate3, m)?)?;
    m.add_function(wrap_pyfunction!(regular_faults::validate_regular2, m)?)?;
    m.add_function(wrap_pyfunction!(regular_faults::validate_regular3, m)?)?;
    m.add_function(wrap_pyfunction!(regular_faults::validate_periodic2, m)?)?;
    m.add_function(wrap_pyfunction!(locate::find_simplex2, m)?)?;
    m.add_function(wrap_pyfunction!(constrained::constrained2, m)?)?;
    m.add_function(wrap_pyfunction!(constrained::components2, m)?)?;
    m.add_function(wrap_pyfunction!(constrained::polygon2, m)?)?;
    m.add_function(wrap_pyfunction!(constrained::ring2, m)?)?;
    m.add_function(wrap_pyfunction!(distributed::disks2, m)?)?;
    m.add_function(wrap_pyfunction!(distributed::within2, m)?)?;
    m.add_function(wrap_pyfunction!(distributed::deepest2, m)?)?;
    m.add_class::<locate::Locator2>()?;
    m.add_class::<locate3::Locator3>()?;
    m.add_function(wrap_pyfunction!(interpolate::combine2, m)?)?;
    m.add_function(wrap_pyfunction!(interpolate::gradients_global2, m)?)?;
    m.add_function(wrap_pyfunction!(interpolate::gradients_local2, m)?)?;
    m.add_function(wrap_pyfunction!(interpolate::gradients_local3, m)?)?;
    m.add_function(wrap_pyfunction!(refine::refine2, m)?)?;
    m.add_function(wrap_pyfunction!(refine::judge2, m)?)?;
    m.add_function(wrap_pyfunction!(improve::improve3, m)?)?;
    m.add_function(wrap_pyfunction!(consistency::fault2, m)?)?;
    m.add_function(wrap_pyfunction!(consistency::fault3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::edges2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::around, m)?)?;
    m.add_function(wrap_pyfunction!(measure::edges3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::faces3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::areas2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::volumes3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::face_areas3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::face_normals3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::circumcenters2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::circumcenters3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::below2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::qualities2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::qualities3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::dihedral_angles3, m)?)?;
    m.add_function(wrap_pyfunction!(measure::transforms2, m)?)?;
    m.add_function(wrap_pyfunction!(measure::transforms3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::proximity2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::proximity3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::antipodes2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::antipodes3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::spanning2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::spanning3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::urquhart2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::spanning_triangles2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::knn2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::knn3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::influence2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::influence3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::not_longer2, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::not_longer3, m)?)?;
    m.add_function(wrap_pyfunction!(graphs::graph_components, m)?)?;
    m.add_function(wrap_pyfunction!(hull::hull2, m)?)?;
    m.add_function(wrap_pyfunction!(hull::hull3, m)?)?;
    m.add_function(wrap_pyfunction!(lawson::lawson2, m)?)?;
    m.add_function(wrap_pyfunction!(lawson::neighbors2, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi::voronoi2, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi::voronoi_clip2, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi::measures2, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi3::voronoi3, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi3::measures3, m)?)?;
    m.add_function(wrap_pyfunction!(regular::regular3, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi3::voronoi_clip3, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi::touched2, m)?)?;
    m.add_function(wrap_pyfunction!(voronoi::pieces2, m)?)?;
    m.add_function(wrap_pyfunction!(regular::regular2, m)?)?;
    m.add_function(wrap_pyfunction!(regular::periodic2, m)?)?;
    m.add_function(wrap_pyfunction!(regular::periodic_centers2, m)?)?;
    Ok(())
}
