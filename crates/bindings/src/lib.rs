//! The bindings between Python and Rust: arrays in, arrays out, errors as Python exceptions. No
//! algorithm lives here.
//!
//! A function checks its arguments, runs the core without the lock of the interpreter (`signals`), and
//! makes arrays of the result. `stub.py` writes the types of Python from these files.

mod alpha;
mod arrays;
mod cluster;
mod consistency;
mod constrained;
mod distributed;
mod errors;
mod faults;
mod given;
mod graphs;
mod hull;
mod improve;
mod interpolate;
mod joins;
mod lawson;
mod live;
mod locate;
mod locate3;
mod locator;
mod measure;
mod ndim;
mod overlap;
mod predicates;
mod recover;
mod refine;
mod refine3;
mod regular;
mod results;
mod signals;
mod sphere;
mod surface;
mod terrain;
mod triangulation;
mod voronoi;
mod voronoi3;

use pyo3::prelude::*;

/// The version of the package as Python writes it: 0.1.0a1 where Cargo has 0.1.0-alpha.1.
fn version() -> String {
    let mut written = env!("CARGO_PKG_VERSION").to_owned();
    for (long, short) in [("-alpha.", "a"), ("-beta.", "b"), ("-rc.", "rc")] {
        written = written.replace(long, short);
    }
    written
}

/// The compiled core of delone.
#[pymodule(gil_used = false)]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::alpha::{
        alpha_counts, alpha_edges, alpha_faces, alpha_flat, alpha_labels, alpha_rings2,
        alpha_solid3, alpha_torus2, alpha_vertices, erode,
    };
    #[pymodule_export]
    use super::cluster::{condensed, density, linkage};
    #[pymodule_export]
    use super::consistency::fault;
    #[pymodule_export]
    use super::constrained::{
        ConstrainedTriangulation, areas2, closed_polygons, components_beside2, components_inside2,
        components2, constrained2, numbered_components, odd_pairs2, polygon2, ring2,
    };
    #[pymodule_export]
    use super::distributed::{DeepestPoints, deepest2, disks2, within2};
    #[pymodule_export]
    use super::faults::{
        Faults, PeriodicFaults, validate, validate_in_flat, validate_periodic2, validate_regular,
    };
    #[pymodule_export]
    use super::graphs::{
        antipodes, graph_components, influence, knn, not_longer, of_triangles2, proximity,
        spanning, spanning_triangles2,
    };
    #[pymodule_export]
    use super::hull::{Hull3, hull2, hull3};
    #[pymodule_export]
    use super::improve::{ImprovedMesh, ImprovementCounts, coarsen3, improve3, smooth3};
    #[pymodule_export]
    use super::interpolate::{
        CornerWeights, NaturalWeights, WeightRows, combine2, gradients_global2, gradients_local2,
        gradients_local3,
    };
    #[pymodule_export]
    use super::joins::{facet_neighbors, facet_rows};
    #[pymodule_export]
    use super::lawson::{FlippedTriangulation, lawson2, neighbors2};
    #[pymodule_export]
    use super::live::{Live, LiveArrays, LiveSegments, LiveState};
    #[pymodule_export]
    use super::locate::{Location2, Locator2, find_simplex2};
    #[pymodule_export]
    use super::locate3::{Distances3, Location3, Locator3};
    #[pymodule_export]
    use super::measure::{
        around, below2, circumcenters, dihedral_angles3, edges, face_areas3, face_normals3, faces3,
        qualities, sizes, smallest_angle2, transforms,
    };
    #[pymodule_export]
    use super::ndim::{
        Halfspaces, HullN, LazyN, LocatorN, halfspaces, hull_in_flat, hull_n, orientations_n,
        triangulate_in_flat, triangulate_n,
    };
    #[pymodule_export]
    use super::overlap::{CellGrid, CheckedCells, PlaneCells, SharedCells};
    #[pymodule_export]
    use super::predicates::{incircle, insphere, orient2d, orient3d};
    #[pymodule_export]
    use super::recover::{RecoveredFaces, RecoveryCounts, recover_faces};
    #[pymodule_export]
    use super::refine::{
        JudgedTriangles, RefinedMesh, Refinement2, SmoothedMesh, judge2, refine2, smooth2,
    };
    #[pymodule_export]
    use super::refine3::{RefinedTetrahedra, Refinement3};
    #[pymodule_export]
    use super::regular::{
        PeriodicTriangulation, RegularTriangulation, periodic_centers2, periodic2, regular,
    };
    #[pymodule_export]
    use super::sphere::{
        SphereDual, SphereLocator, SphereTriangulation, SphereWeights, sphere_areas,
        sphere_circumcenters, sphere_constrained, sphere_delaunay, sphere_directions, sphere_dual,
        sphere_spans, sphere_units,
    };
    #[pymodule_export]
    use super::surface::{
        CheckedSurface, CutSurface, FacePairs, check_surface3, imprint_surface3, resolve_touches3,
    };
    #[pymodule_export]
    use super::terrain::{
        ContourBands, ContourLines, Simplified2, contour_bands2, contour_lines2, simplify2,
        volumes2,
    };
    #[pymodule_export]
    use super::triangulation::{Triangulation, methods2, triangulate2, triangulate3};
    #[pymodule_export]
    use super::voronoi::{
        CellMeasures2, CellPieces2, ClippedCells2, Diagram2, measures2, pieces2, touched2,
        voronoi_clip2, voronoi2,
    };
    #[pymodule_export]
    use super::voronoi3::{
        CellMeasures3, ClippedCells3, Diagram3, measures3, voronoi_clip3, voronoi3,
    };

    #[pymodule_init]
    fn init(m: &Bound<'_, PyModule>) -> PyResult<()> {
        m.add("__version__", super::version())
    }
}
