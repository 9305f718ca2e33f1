//! Constrained triangulations and refined meshes.

use delone_core::constrained::{Constrained, Options, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::base::error::Error;
use delone_core::refine::{Task, refine};
use delone_core::base::watch::Watch;
use delone_predicates::Point2;
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, Arrays, Failure, Outcome, answer, pairs, repeats, rows};
use crate::domain::{kept, restricted};

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
        let (points, holes, watch) = (pairs(xy), pairs(holes), Watch::idle());
        let options = Options {
            split: choices.split,
            conforming: choices.conforming,
            max_vertices: choices.max_points,
            method: Method::Auto,
            workers: 1,
        };
        let made = constrain(points, &ends(segments, points.len())?, options, &watch)?;
        let all = [points, &made.added].concat();
        let kept = if choices.enclosed || !holes.is_empty() {
            kept(&all, &made, choices.enclosed, holes, &watch)?
        } else {
            vec![true; made.arrays.simplices.len()]
        };
        if choices.refine {
            return refined(all, &made, &kept, choices);
        }
        let (part, of) = restricted(&made.arrays, &kept);
        let walls: Vec<[bool; 3]> = of.iter().map(|&t| made.constrained[t]).collect();
        let counts = [made.added.len() as i32, 1];
        let subsegments = made.subsegments.ends;
        Ok(arrays(
            all,
            part,
            &walls,
            subsegments,
            &made.duplicates,
            counts,
        ))
    })
}

/// Segments as the core takes them.
fn ends(flat: &[i32], points: usize) -> Outcome<Vec<[u32; 2]>> {
    let within = |row: i32| usize::try_from(row).is_ok_and(|row| row < points);
    for (segment, ends) in rows::<2>(flat).iter().enumerate() {
        if let Some(row) = ends.iter().find(|row| !within(**row)) {
            let text =
                format!("segment {segment} ends at row {row}, but there are {points} points");
            return Err(Error::Shape(text).into());
        }
    }
    Ok(rows::<2>(flat)
        .iter()
        .map(|ends| ends.map(|row| row as u32))
        .collect())
}

/// Refuses bounds that are out of range.
fn require_bounds(angle: f64, area: f64) -> Outcome<()> {
    let text = if !(0.0..60.0).contains(&angle) {
        format!("min_angle must be at least 0 and below 60 degrees, got {angle}")
    } else if area.is_nan() || area <= 0.0 {
        format!("max_area must be positive, got {area}")
    } else {
        return Ok(());
    };
    Err(Failure::Input(text, None))
}

fn refined(
    mut points: Vec<Point2>,
    domain: &Constrained,
    kept: &[bool],
    choices: &Choices,
) -> Outcome<Arrays> {
    require_bounds(choices.min_angle, choices.max_area)?;
    let labels: Vec<i32> = kept.iter().map(|&kept| if kept { 0 } else { -1 }).collect();
    let segments = lines(domain, kept);
    let made = refine(
        Task {
            points: &points,
            simplices: &domain.arrays.simplices,
            neighbors: Some(&domain.arrays.neighbors),
            labels: &labels,
            areas: &vec![choices.max_area; labels.len()],
            segments: &segments,
            lines: None,
            frozen: &vec![false; segments.len()],
            min_angle: choices.min_angle,
            circles: false,
            sizes_yield: false,
            max_vertices: choices.max_points,
        },
        &Watch::idle(),
    )?;
    let counts = [
        (domain.added.len() + made.added.len()) as i32,
        i32::from(!made.exhausted),
    ];
    points.extend_from_slice(&made.added);
    let all = delone_core::base::arrays::Arrays {
        simplices: made.simplices,
        neighbors: made.neighbors,
    };
    let kept: Vec<bool> = made.labels.iter().map(|&label| label >= 0).collect();
    let (part, of) = restricted(&all, &kept);
    let walls: Vec<[bool; 3]> = of
        .iter()
        .map(|&t| made.sides[t].map(|line| line >= 0))
        .collect();
    // The edges under lines, each once.
    let mut walled = vec![];
    for (corners, walls) in part.simplices.iter().zip(&walls) {
        for k in (0..3).filter(|&k| walls[k]) {
            let [u, v] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            walled.push([u.min(v), u.max(v)]);
        }
    }
    walled.sort_unstable();
    walled.dedup();
    Ok(arrays(
        points,
        part,
        &walls,
        walled,
        &domain.duplicates,
        counts,
    ))
}

/// The edges that refinement keeps: subsegments, and edges of the hull that bound the domain.
fn lines(domain: &Constrained, kept: &[bool]) -> Vec<[u32; 2]> {
    let ends = domain.subsegments.ends.iter();
    let mut found: Vec<[u32; 2]> = ends.map(|ends| ends.map(|v| v as u32)).collect();
    for t in (0..kept.len()).filter(|&t| kept[t]) {
        let (corners, across) = (domain.arrays.simplices[t], domain.arrays.neighbors[t]);
        for k in (0..3).filter(|&k| across[k] < 0 && !domain.constrained[t][k]) {
            found.push([1, 2].map(|j| corners[(k + j) % 3] as u32));
        }
    }
    found
}

fn arrays(
    points: Vec<Point2>,
    part: delone_core::base::arrays::Arrays<3>,
    walls: &[[bool; 3]],
    subsegments: Vec<[i32; 2]>,
    duplicates: &[[u32; 2]],
    counts: [i32; 2],
) -> Arrays {
    let walls = walls.as_flattened().iter().map(|&wall| i32::from(wall));
    let integers = vec![
        part.simplices.into_flattened(),
        part.neighbors.into_flattened(),
        walls.collect(),
        subsegments.into_flattened(),
        repeats(duplicates),
        counts.into(),
    ];
    (integers, vec![points.into_flattened()])
}
