//! Areas, centroids and perimeters of polygons, and the lengths of their edges.
//!
//! Coordinates enter as differences to the first corner of a polygon, so that nothing is lost far
//! from the origin.

use delone_predicates::Point2;

use crate::error::Result;
use crate::memory::{filled, zeroed};
use crate::parallel;

/// Polygons that one task does.
const SHARE: usize = 1 << 13;

/// What is measured on polygons; zero, and NaN for centroids, where a polygon has no corners.
#[derive(Debug)]
pub struct Measures {
    /// Areas.
    pub areas: Vec<f64>,
    /// Centres of gravity.
    pub centroids: Vec<Point2>,
    /// Lengths of boundaries.
    pub perimeters: Vec<f64>,
}

/// Measures polygons whose corners are `points[starts[i]..starts[i + 1]]`, counter-clockwise.
pub fn measures(starts: &[i32], points: &[Point2], workers: usize) -> Result<Measures> {
    let n = starts.len().saturating_sub(1);
    let mut out = Measures {
        areas: filled(n, 0.0)?,
        centroids: zeroed(n)?,
        perimeters: filled(n, 0.0)?,
    };
    let parts = out
        .areas
        .chunks_mut(SHARE)
        .zip(out.centroids.chunks_mut(SHARE));
    let parts = parts.zip(out.perimeters.chunks_mut(SHARE)).enumerate();
    parallel::map(
        workers,
        parts.collect(),
        |(i, ((areas, centroids), perimeters))| {
            for (k, ((area, centroid), perimeter)) in
                areas.iter_mut().zip(centroids).zip(perimeters).enumerate()
            {
                let row = i * SHARE + k;
                let corners = &points[starts[row] as usize..starts[row + 1] as usize];
                (*area, *centroid, *perimeter) = measure(corners);
            }
        },
    );
    Ok(out)
}

fn measure(corners: &[Point2]) -> (f64, Point2, f64) {
    let Some(&[ox, oy]) = corners.first() else {
        return (0.0, [f64::NAN; 2], 0.0);
    };
    let (mut twice, mut x, mut y, mut around) = (0.0, 0.0, 0.0, 0.0);
    let mut last = [0.0, 0.0];
    for p in corners[1..].iter().chain(&corners[..1]) {
        let here = [p[0] - ox, p[1] - oy];
        let cross = last[0] * here[1] - last[1] * here[0];
        twice += cross;
        x += cross * (last[0] + here[0]);
        y += cross * (last[1] + here[1]);
        around += (here[0] - last[0]).hypot(here[1] - last[1]);
        last = here;
    }
    if twice > 0.0 {
        return (
            twice / 2.0,
            [ox + x / twice / 3.0, oy + y / twice / 3.0],
            around,
        );
    }
    // As thin as rounding allows: the middle of the corners stands for the centre.
    let n = corners.len() as f64;
    let mean = |k: usize, o: f64| o + corners.iter().map(|p| p[k] - o).sum::<f64>() / n;
    (0.0, [mean(0, ox), mean(1, oy)], around)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_far_away() {
        let corners = [
            [1e9, 1e9],
            [1e9 + 4.0, 1e9],
            [1e9 + 4.0, 1e9 + 2.0],
            [1e9, 1e9 + 2.0],
        ];
        let found = measures(&[0, 4, 4], &corners, 1).unwrap();
        assert_eq!(found.areas, [8.0, 0.0]);
        assert_eq!(found.centroids[0], [1e9 + 2.0, 1e9 + 1.0]);
        assert!(found.centroids[1][0].is_nan());
        assert_eq!(found.perimeters, [12.0, 0.0]);
    }
}
