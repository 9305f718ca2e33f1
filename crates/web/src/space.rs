//! 3-D triangulations.

use delone::{Options, Point3, Tiling};
use delone_core::measure;
use delone_core::watch::Watch;
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, answer, repeats};

/// Integers: tetrahedra, neighbors, faces of the hull, duplicates; numbers: volumes, and the
/// smallest and largest dihedral angles.
#[wasm_bindgen]
pub fn tetrahedra(xyz: &[f64]) -> Answer {
    answer(|| {
        let points: &[Point3] = xyz.as_chunks().0;
        let made = Options::new().threads(1).triangulate(points)?;
        let hull = made
            .boundary()?
            .as_flattened()
            .iter()
            .map(|&v| v as i32)
            .collect();
        let duplicates = repeats(made.duplicates());
        let (simplices, neighbors) = Tiling::from(made).into_arrays();
        let watch = Watch::idle();
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
