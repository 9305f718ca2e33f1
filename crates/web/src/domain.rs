//! The part of a constrained triangulation that segments enclose, outside holes.

use std::collections::HashSet;

use delone_core::base::arrays::{Arrays, Given};
use delone_core::constrained::{Constrained, components};
use delone_core::locate::find;
use delone_core::base::watch::Watch;
use delone_predicates::{Point2, orient2d};

use crate::answer::{Failure, Outcome};
use crate::plane::located;

/// For each triangle of the hull, whether it is kept: if only what segments enclose is `wanted`, not
/// those outside; never those around the seeds of holes.
pub fn kept(
    points: &[Point2],
    made: &Constrained,
    wanted: bool,
    holes: &[Point2],
    watch: &Watch,
) -> Outcome<Vec<bool>> {
    let (neighbors, walls) = (&made.arrays.neighbors, &made.constrained);
    let label = components(neighbors, walls, watch)?;
    let count = label.iter().max().map_or(0, |last| *last as usize + 1);
    let mut gone = vec![false; count];
    // An area is outside if it reaches the hull across an edge that is not a segment.
    for ((across, walls), &area) in neighbors.iter().zip(walls).zip(&label).filter(|_| wanted) {
        gone[area as usize] |= (0..3).any(|k| across[k] < 0 && !walls[k]);
    }
    for t in seeds(points, made, holes)? {
        gone[label[t] as usize] = true;
    }
    let kept: Vec<bool> = label.iter().map(|&area| !gone[area as usize]).collect();
    if kept.contains(&true) {
        return Ok(kept);
    }
    let text = "the domain is empty: the segments enclose no triangle that is in no hole";
    Err(Failure::Input(text.into(), None))
}

/// The triangles that contain the seeds of holes, none of which may be on a segment.
fn seeds(points: &[Point2], made: &Constrained, holes: &[Point2]) -> Outcome<Vec<usize>> {
    let given = Given {
        points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let ends: HashSet<i32> = made
        .subsegments
        .ends
        .as_flattened()
        .iter()
        .copied()
        .collect();
    let found = located(given, holes, find)?;
    let each = holes.iter().zip(found).enumerate();
    let each = each.map(|(hole, (&q, t))| {
        let wrong = || {
            let text =
                format!("the seed of hole {hole} is on a segment or outside of the convex hull");
            Failure::Input(text, Some(hole))
        };
        let t = usize::try_from(t).map_err(|_| wrong())?;
        let corners = given.corners(t);
        let on = |k: usize| orient2d(corners[(k + 1) % 3], corners[(k + 2) % 3], q).is_zero();
        // At a vertex it may be on a segment that is not an edge of this triangle.
        let at_end = |k: usize| corners[k] == q && ends.contains(&given.simplices[t][k]);
        if (0..3).any(|k| (made.constrained[t][k] && on(k)) || at_end(k)) {
            return Err(wrong());
        }
        Ok(t)
    });
    each.collect()
}

/// The triangles that are `kept`, numbered from 0 in their order, and the rows that they had.
pub fn restricted(all: &Arrays<3>, kept: &[bool]) -> (Arrays<3>, Vec<usize>) {
    let rows: Vec<usize> = (0..kept.len()).filter(|&t| kept[t]).collect();
    let mut number = vec![-1; kept.len()];
    for (new, &t) in rows.iter().enumerate() {
        number[t] = new as i32;
    }
    let across = |n: i32| usize::try_from(n).map_or(-1, |n| number[n]);
    let arrays = Arrays {
        simplices: rows.iter().map(|&t| all.simplices[t]).collect(),
        neighbors: rows.iter().map(|&t| all.neighbors[t].map(across)).collect(),
    };
    (arrays, rows)
}
