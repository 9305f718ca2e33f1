//! 3-D triangulations.

use delone_core::base::arrays::OUTWARD;
use delone_core::delaunay::space::triangulate;
use delone_core::measure;
use delone_core::base::watch::Watch;
use delone_predicates::Point3;
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, answer, repeats};

/// Integers: tetrahedra, neighbors, faces of the hull, duplicates; numbers: volumes, and the
/// smallest and largest dihedral angles.
#[wasm_bindgen]
pub fn tetrahedra(xyz: &[f64]) -> Answer {
    answer(|| {
        let points: &[Point3] = xyz.as_chunks().0;
        let watch = Watch::idle();
        let made = triangulate(points, 1, &watch)?;
        let (simplices, neighbors) = (made.arrays.simplices, made.arrays.neighbors);
        let mut hull = vec![];
        for (corners, across) in simplices.iter().zip(&neighbors) {
            for k in (0..4).filter(|&k| across[k] < 0) {
                hull.extend(OUTWARD[k].map(|i| corners[i]));
            }
        }
        let duplicates = repeats(&made.duplicates);
        let volumes = measure::volumes(points, &simplices, 1, &watch)?;
        let [low, high, ..] = measure::qualities3(points, &simplices, 1, &watch)?;
        let integers = vec![
            simplices.into_flattened(),
            neighbors.into_flattened(),
            hull,
            duplicates,
        ];
        Ok((integers, vec![volumes, low, high]))
    })
}
