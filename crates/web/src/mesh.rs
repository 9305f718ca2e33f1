//! Constrained triangulations and refined meshes.

use delone::{Constrained, Options, Result, Tiling};
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, Arrays, answer, pairs, repeats, rows};

/// The options of a call.
#[wasm_bindgen]
#[derive(Default)]
pub struct Choices {
    /// Whether crossing segments are split.
    pub split: bool,
    /// Whether segments are split until all triangles are Delaunay.
    pub conforming: bool,
    /// Whether only what segments enclose is kept.
    pub enclosed: bool,
    /// Whether to refine.
    pub refine: bool,
    /// The smallest angle, in degrees.
    pub min_angle: f64,
    /// The largest area, infinite for none.
    pub max_area: f64,
    /// The most points to add.
    pub max_points: usize,
}

#[wasm_bindgen]
impl Choices {
    /// Nothing chosen.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }
}

/// Integers: triangles, neighbors, which edges are constrained, subsegments, duplicates, and the
/// number of points added with whether refinement is complete; numbers: the points.
#[wasm_bindgen]
pub fn mesh(xy: &[f64], segments: &[i32], holes: &[f64], choices: &Choices) -> Answer {
    answer(|| {
        let segments: Vec<[i32; 2]> = rows(segments).to_vec();
        let options = Options::new()
            .threads(1)
            .split_crossings(choices.split)
            .conforming(choices.conforming)
            .enclosed_only(choices.enclosed)
            .holes(pairs(holes))
            .max_points(choices.max_points);
        let made = options.constrain(pairs(xy), &segments)?;
        if choices.refine {
            refined(&made, &options, choices)
        } else {
            Ok(constrained(made))
        }
    })
}

fn constrained(made: Constrained) -> Arrays {
    let added = made.added().len();
    let duplicates = repeats(made.duplicates());
    let (tiling, walls, segments) = made.into_parts();
    let subsegments = segments.ends.into_flattened();
    arrays(tiling, &walls, subsegments, duplicates, [added as i32, 1])
}

fn refined(domain: &Constrained, options: &Options, choices: &Choices) -> Result<Arrays> {
    let options = options
        .min_angle(choices.min_angle)
        .max_area(choices.max_area);
    let made = options.mesh(domain)?;
    let added = domain.added().len() + made.added().len();
    let mut walled = vec![];
    for (corners, walls) in made.simplices().zip(made.is_constrained()) {
        for k in (0..3).filter(|&k| walls[k]) {
            let [u, v] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            walled.push([u.min(v) as i32, u.max(v) as i32]);
        }
    }
    walled.sort_unstable();
    walled.dedup();
    let counts = [added as i32, i32::from(made.is_complete())];
    let triangles: Vec<[i32; 3]> = made.simplices().map(|t| t.map(|v| v as i32)).collect();
    let neighbors: Vec<[i32; 3]> = made
        .neighbors()
        .map(|row| row.map(|t| t.map_or(-1, |t| t as i32)))
        .collect();
    let tiling = Tiling::from_arrays(made.points(), &triangles, &neighbors)?;
    let duplicates = repeats(domain.duplicates());
    Ok(arrays(
        tiling,
        made.is_constrained(),
        walled.into_flattened(),
        duplicates,
        counts,
    ))
}

fn arrays(
    tiling: Tiling,
    walls: &[[bool; 3]],
    subsegments: Vec<i32>,
    duplicates: Vec<i32>,
    counts: [i32; 2],
) -> Arrays {
    let points = tiling.points().as_flattened().to_vec();
    let walls = walls
        .as_flattened()
        .iter()
        .map(|&wall| i32::from(wall))
        .collect();
    let (triangles, neighbors) = tiling.into_arrays();
    let integers = vec![
        triangles.into_flattened(),
        neighbors.into_flattened(),
        walls,
        subsegments,
        duplicates,
        counts.into(),
    ];
    (integers, vec![points])
}
