//! Vertices of periodic diagrams: exact centers of triangles of copies, rounded once at the end.
//!
//! The coordinates of copies are in general not doubles.

use delone_predicates::{Point2, Sign};

use crate::base::error::{Error, Result};
use crate::base::memory::{filled, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::measure::center::Center;
use crate::measure::circle::meeting;
use crate::regular::{Images, Sites};

/// Triangles per task.
const SHARE: usize = 1 << 10;

/// For the three corners of each triangle (row, and the number of periods by which it is translated
/// in x and y), the center, correctly rounded, and for each edge whether the apex across it is on
/// the circumcircle.
pub fn centers(
    points: &[Point2],
    weights: &[f64],
    periods: Point2,
    corners: &[[i32; 3]],
    apexes: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<Point2>, Vec<[bool; 3]>)> {
    let count = corners.len() / 3;
    let mut centers = zeroed(count)?;
    let mut shared = filled(count, [false; 3])?;
    let parts = centers.chunks_mut(SHARE).zip(shared.chunks_mut(SHARE));
    let tasks = parts.enumerate().collect();
    let done = parallel::map(workers, tasks, |(i, (centers, shared))| {
        watch.check()?;
        for (j, (center, shared)) in centers.iter_mut().zip(shared).enumerate() {
            let rows = 3 * (i * SHARE + j)..3 * (i * SHARE + j) + 3;
            (*center, *shared) = one(
                (points, weights),
                periods,
                &corners[rows.clone()],
                &apexes[rows],
            )?;
        }
        Ok(())
    });
    done.into_iter().collect::<Result<()>>()?;
    Ok((centers, shared))
}

fn one(
    (points, weights): (&[Point2], &[f64]),
    periods: Point2,
    corners: &[[i32; 3]],
    apexes: &[[i32; 3]],
) -> Result<(Point2, [bool; 3])> {
    let images = Images {
        points,
        periods,
        weights,
        of: corners
            .iter()
            .chain(apexes)
            .map(|&[row, x, y]| (row as u32, [x, y]))
            .collect(),
    };
    let (at, low) = images.coordinates([0, 1, 2]);
    let weights = images.exact_weights([0, 1, 2], low);
    let Center::At(center) = meeting(&at, &weights, low) else {
        return Err(Error::Shape(
            "a vertex is beyond the range of doubles".into(),
        ));
    };
    let shared = [3, 4, 5].map(|apex| images.height([0, 1, 2, apex]) == Sign::Zero);
    Ok((center, shared))
}
