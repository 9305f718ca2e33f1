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
/// Areas beyond these, 2^-600 and 2^600, are measured in other units.
const TINY: f64 = f64::from_bits((1023 - 600) << 52);
const HUGE: f64 = f64::from_bits((1023 + 600) << 52);

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
    let size = |scale: f64| measure_in_units(corners, scale);
    let (area, centroid, around) = size(1.0);
    // Nothing over- or underflows to any effect between these, which NaN is not.
    if corners.is_empty() || (area > TINY && area < HUGE) || (area == 0.0 && around == 0.0) {
        return (area, centroid, around);
    }
    // A power of two, by which the largest coordinate comes near 1.
    let largest = corners
        .as_flattened()
        .iter()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    let exponent = (largest.to_bits() >> 52) as i64 - 1023;
    let power = |e: i64| f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52);
    let (scale, back) = (power(-exponent - 2), power(exponent + 2));
    let (area, [x, y], around) = size(scale);
    (area * back * back, [x * back, y * back], around * back)
}

/// Measures in which the unit of length is the inverse of a power of two.
fn measure_in_units(corners: &[Point2], scale: f64) -> (f64, Point2, f64) {
    let Some(first) = corners.first() else {
        return (0.0, [f64::NAN; 2], 0.0);
    };
    let [ox, oy] = first.map(|x| x * scale);
    let (mut twice, mut x, mut y, mut around) = (0.0, 0.0, 0.0, 0.0);
    let mut last = [0.0, 0.0];
    for p in corners[1..].iter().chain(&corners[..1]) {
        let here = [p[0] * scale - ox, p[1] * scale - oy];
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
    // As thin as rounding allows, or too large: the middle of the corners stands for the centre.
    let n = corners.len() as f64;
    let mean = |k: usize, o: f64| o + corners.iter().map(|p| (p[k] * scale - o) / n).sum::<f64>();
    let area = if twice.is_nan() { twice } else { 0.0 };
    (area, [mean(0, ox), mean(1, oy)], around)
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

    #[test]
    fn the_ends_of_the_range() {
        let huge = f64::from_bits(2046 << 52);
        let square = |h: f64| [[-h, -h], [h, -h], [h, h], [-h, h]];
        let found = measures(&[0, 4], &square(huge), 1).unwrap();
        assert_eq!(found.areas, [f64::INFINITY]);
        assert_eq!(found.centroids, [[0.0, 0.0]]);
        let corners = [[0.0, 0.0], [1e-200, 0.0], [1e-200, 1e-200], [0.0, 1e-200]];
        let found = measures(&[0, 4], &corners, 1).unwrap();
        assert_eq!(
            (found.areas[0], found.centroids[0]),
            (0.0, [5e-201, 5e-201])
        );
        assert_eq!(found.perimeters, [4e-200]);
    }
}
