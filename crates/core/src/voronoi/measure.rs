//! Areas, centroids and perimeters of polygons, and the lengths of their edges.
//!
//! Coordinates enter as differences from the first corner of a polygon, so that no digits are lost
//! far from the origin.

use delone_predicates::Point2;

use crate::base::error::Result;
use crate::base::memory::{filled, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Polygons per task.
const SHARE: usize = 1 << 13;
/// Areas outside this range, 2^-600 to 2^600, are measured in other units.
const TINY: f64 = f64::from_bits((1023 - 600) << 52);
const HUGE: f64 = f64::from_bits((1023 + 600) << 52);

/// The measures of polygons; for a polygon without corners zero, and NaN for the centroid.
#[derive(Debug, Default)]
pub struct Measures {
    /// Areas.
    pub areas: Vec<f64>,
    /// Centroids.
    pub centroids: Vec<Point2>,
    /// Perimeters.
    pub perimeters: Vec<f64>,
}

/// Measures polygons whose corners are `points[starts[i]..starts[i + 1]]`, counterclockwise.
pub fn measures(
    starts: &[i32],
    points: &[Point2],
    workers: usize,
    watch: &Watch,
) -> Result<Measures> {
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
    parallel::map_watched(
        workers,
        parts.collect(),
        watch,
        |(i, ((areas, centroids), perimeters))| {
            for (k, ((area, centroid), perimeter)) in
                areas.iter_mut().zip(centroids).zip(perimeters).enumerate()
            {
                let row = i * SHARE + k;
                let corners = &points[starts[row] as usize..starts[row + 1] as usize];
                (*area, *centroid, *perimeter) = measure(corners);
            }
            Ok(())
        },
    )?;
    Ok(out)
}

fn measure(corners: &[Point2]) -> (f64, Point2, f64) {
    let (area, centroid, around) = measure_in_units(corners, [1.0; 2]);
    // Within these bounds, which NaN fails, only moments may overflow or underflow noticeably.
    let usual = area > TINY && area < HUGE && centroid.iter().all(|x| x.is_finite());
    if corners.is_empty() || usual || (area == 0.0 && around == 0.0) {
        return (area, centroid, around);
    }
    // Powers of two that scale the largest coordinates to near 1, by axis: a cell may be as long as
    // the range and as thin as its smallest double.
    let [wide, high] = [0, 1].map(|k| exponent(corners, k));
    let (area, [x, y], _) = measure_in_units(corners, [power_of_two(-wide), power_of_two(-high)]);
    let long = wide.max(high);
    let (_, _, around) = measure_in_units(corners, [power_of_two(-long); 2]);
    let (half, both) = ((wide + high) / 2, wide + high);
    (
        area * power_of_two(half) * power_of_two(both - half),
        [x * power_of_two(wide), y * power_of_two(high)],
        around * power_of_two(long),
    )
}

/// The exponent of the largest coordinate on an axis plus two, clamped so that it and its negative
/// are exponents of doubles.
fn exponent(corners: &[Point2], axis: usize) -> i32 {
    let largest = corners.iter().fold(0.0_f64, |m, p| m.max(p[axis].abs()));
    ((largest.to_bits() >> 52) as i32 - 1021).clamp(-1022, 1022)
}

/// 2^exponent, from -1022 to 1023.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// Twice the signed area of a ring, six times its moment relative to `origin`, and its length.
pub(super) fn ring(
    corners: impl Iterator<Item = Point2> + Clone,
    origin: Point2,
) -> (f64, Point2, f64) {
    let (mut twice, mut moment, mut around) = (0.0, [0.0; 2], 0.0);
    let seen = |p: Point2| [p[0] - origin[0], p[1] - origin[1]];
    let Some(first) = corners.clone().next() else {
        return (twice, moment, around);
    };
    let mut last = seen(first);
    for p in corners.skip(1).chain([first]) {
        let here = seen(p);
        let cross = last[0] * here[1] - last[1] * here[0];
        twice += cross;
        moment[0] += cross * (last[0] + here[0]);
        moment[1] += cross * (last[1] + here[1]);
        around += (here[0] - last[0]).hypot(here[1] - last[1]);
        last = here;
    }
    (twice, moment, around)
}

/// Measures in which the units of length, by axis, are the inverses of powers of two.
fn measure_in_units(corners: &[Point2], scale: [f64; 2]) -> (f64, Point2, f64) {
    let Some(first) = corners.first() else {
        return (0.0, [f64::NAN; 2], 0.0);
    };
    let [ox, oy] = [first[0] * scale[0], first[1] * scale[1]];
    let scaled = corners.iter().map(|p| [p[0] * scale[0], p[1] * scale[1]]);
    let (twice, [x, y], around) = ring(scaled, [ox, oy]);
    if twice > 0.0 {
        return (
            twice / 2.0,
            [ox + x / twice / 3.0, oy + y / twice / 3.0],
            around,
        );
    }
    // As thin as rounding allows, or too large: use the mean of the corners.
    let n = corners.len() as f64;
    let part = |p: &Point2, k: usize, o: f64| (p[k] * scale[k] - o) / n;
    let mean = |k: usize, o: f64| o + corners.iter().map(|p| part(p, k, o)).sum::<f64>();
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
        let found = measures(&[0, 4, 4], &corners, 1, &Watch::idle()).unwrap();
        assert_eq!(found.areas, [8.0, 0.0]);
        assert_eq!(found.centroids[0], [1e9 + 2.0, 1e9 + 1.0]);
        assert!(found.centroids[1][0].is_nan());
        assert_eq!(found.perimeters, [12.0, 0.0]);
    }

    #[test]
    fn the_ends_of_the_range() {
        let huge = f64::from_bits(2046 << 52);
        let square = |h: f64| [[-h, -h], [h, -h], [h, h], [-h, h]];
        let found = measures(&[0, 4], &square(huge), 1, &Watch::idle()).unwrap();
        assert_eq!(found.areas, [f64::INFINITY]);
        assert_eq!(found.centroids, [[0.0, 0.0]]);
        let corners = [[0.0, 0.0], [1e-200, 0.0], [1e-200, 1e-200], [0.0, 1e-200]];
        let found = measures(&[0, 4], &corners, 1, &Watch::idle()).unwrap();
        assert_eq!(
            (found.areas[0], found.centroids[0]),
            (0.0, [5e-201, 5e-201])
        );
        assert_eq!(found.perimeters, [4e-200]);
        // As long and as thin as the range allows: areas, centroids and perimeters are still
        // doubles.
        for (w, h) in [
            (1.0, huge),
            (1.0, huge / 2.0),
            (1e-300, huge),
            (5e-324, huge),
        ] {
            let corners = [[0.0, 0.0], [w, 0.0], [w, h / 2.0], [0.0, h / 2.0]];
            let found = measures(&[0, 4], &corners, 1, &Watch::idle()).unwrap();
            assert_eq!(found.areas, [w * (h / 2.0)]);
            assert_eq!(found.centroids, [[w / 2.0, h / 4.0]]);
            assert_eq!(found.perimeters, [h]);
        }
    }
}
