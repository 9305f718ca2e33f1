//! Disks that contain the closed circumdisk of a triangle, in doubles, rounded outward.
//!
//! With b and c the corners relative to a, D their cross product and N the vector |b|² (c.y,
//! -c.x) - |c|² (b.y, -b.x), the center is a + N / 2D. Write u = 2^-53 for the unit roundoff, P for the
//! sum of the absolute products in D and Q for that in a coordinate of N. A product in D has at
//! most 4 roundings and one in N at most 7, so D errs by less than 5 u P and N by less than 8 u Q,
//! with P and Q as computed. From N' = N + e, D' = D + f it follows that
//!
//! ```text
//! |N/D - N'/D'| = |N' f - e D'| / |D D'| <= (|e| + |N'/D'| |f|) / (|D'| - |f|)
//! ```
//!
//! `ROUND` = 16 u covers 5 u, 8 u and the rounding of the bound itself, provided that |D'| > 2
//! ROUND P. The radius is at most the length of the computed vector plus its error, and the final
//! addition of a moves the center by u times the result: `PAD` = 64 u of radius and center covers
//! these, and the caller's center ± radius.
//!
//! Large and small b and c are measured in a power of two, so that their products are doubles.
//! Underflow changes a coordinate or a product by less than 2^-1074. If |D| > `TINY` = 1e-200, then
//! b or c is longer than 1e-100, the radius is more than half of that, and PAD times the radius
//! exceeds all effects of underflow, divided by D. `LEAST` covers underflow when converting back.
//! Overflow produces infinities or NaN, and a comparison fails. Whenever a check fails, the result
//! is the whole plane.

use delone_predicates::Point2;

use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::locate::seen_from;

const UNIT: f64 = f64::EPSILON / 2.0;
const ROUND: f64 = 16.0 * UNIT;
const PAD: f64 = 64.0 * UNIT;
const TINY: f64 = 1e-200;
/// Eight times the smallest double.
pub const LEAST: f64 = f64::from_bits(8);

/// Triangles per task.
const TASK: usize = 1 << 16;

/// Center and radius of a disk that contains the closed circumdisk of the triangle; the radius is
/// infinite if no finite one is certain.
pub fn disk([a, b, c]: [Point2; 3]) -> [f64; 3] {
    let whole = [0.0, 0.0, f64::INFINITY];
    let ([b, c], unit) = seen_from(a, [b, c]);
    let [s, t] = [b[0] * c[1], b[1] * c[0]];
    let (det, magnitude) = (s - t, s.abs() + t.abs());
    let off = ROUND * magnitude;
    if !(det.abs() > 2.0 * off && det.abs() > TINY) {
        return whole;
    }
    let [bb, cc] = [b, c].map(|p| p[0] * p[0] + p[1] * p[1]);
    let part = |p: f64, q: f64| {
        let at = (p - q) / det;
        let error = (ROUND * (p.abs() + q.abs()) + at.abs() * off) / (det.abs() - off);
        (0.5 * at, error)
    };
    let (x, wrong_x) = part(c[1] * bb, b[1] * cc);
    let (y, wrong_y) = part(b[0] * cc, c[0] * bb);
    let center = [a[0] + x * unit, a[1] + y * unit];
    let length = ((x * x + y * y).sqrt() + wrong_x + wrong_y) * unit;
    let radius = length + PAD * (length + center[0].abs() + center[1].abs()) + LEAST;
    if radius.is_finite() {
        [center[0], center[1], radius]
    } else {
        whole
    }
}

/// Which triangles have all corners among the first `own` points and their disks in a closed box,
/// given as left, bottom, right, top.
pub fn within(
    points: &[Point2],
    simplices: &[[i32; 3]],
    own: usize,
    bounds: [f64; 4],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<bool>> {
    let [left, bottom, right, top] = bounds;
    // If the box is the whole plane, no disk needs to be computed.
    let whole = [left, bottom, -right, -top] == [f64::NEG_INFINITY; 4];
    let inside = |corners: [Point2; 3]| {
        let [x, y, r] = disk(corners);
        x - r >= left && x + r <= right && y - r >= bottom && y + r <= top
    };
    let mut found = with_room(simplices.len())?;
    found.resize(simplices.len(), false);
    let tasks = simplices.chunks(TASK).zip(found.chunks_mut(TASK)).collect();
    let look = |(some, found): (&[[i32; 3]], &mut [bool])| {
        watch.check()?;
        for (corners, found) in some.iter().zip(found) {
            *found = corners.iter().all(|&v| (v as usize) < own)
                && (whole || inside(corners.map(|v| points[v as usize])));
        }
        Ok(())
    };
    let parts = parallel::map(workers, tasks, look);
    parts.into_iter().collect::<Result<()>>()?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    #[test]
    fn triangles_within_a_box_are_distinguished() {
        let points = [[0.0, 0.0], [6.0, 0.0], [0.0, 8.0], [6.0, 8.0]];
        let both = [[0, 1, 2], [1, 3, 2]];
        let look = |own, bounds| within(&points, &both, own, bounds, 2, &Watch::idle()).unwrap();
        let wide = [-2.1, -1.1, 8.1, 9.1];
        assert_eq!(look(4, wide), [true, true]);
        assert_eq!(look(3, wide), [true, false]);
        assert_eq!(look(4, [-1.9, -1.1, 8.1, 9.1]), [false, false]);
        assert_eq!(look(4, [-2.1, -1.1, 8.1, 8.9]), [false, false]);
        let whole = [
            f64::NEG_INFINITY,
            f64::NEG_INFINITY,
            f64::INFINITY,
            f64::INFINITY,
        ];
        assert_eq!(look(4, whole), [true, true]);
    }

    #[test]
    fn the_hypotenuse_of_a_right_triangle_is_a_diameter() {
        let [x, y, r] = disk([[0.0, 0.0], [6.0, 0.0], [0.0, 8.0]]);
        assert_eq!([x, y], [3.0, 4.0]);
        assert!((5.0..5.0 + 1e-12).contains(&r));
    }

    #[test]
    fn units_change_nothing() {
        for exponent in [-1070, -600, 600, 1018] {
            let unit = 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
            let [x, y, r] = disk([[0.0, 0.0], [6.0 * unit, 0.0], [0.0, 8.0 * unit]]);
            assert_eq!([x, y], [3.0 * unit, 4.0 * unit]);
            assert!((5.0 * unit..=5.0 * unit * (1.0 + 1e-12) + 2.0 * LEAST).contains(&r));
        }
    }

    #[test]
    fn uncertain_disks_are_the_whole_plane() {
        for corners in [
            [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]],
            [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0 + 1e-15]],
            [[0.0, 0.0], [1e-150, 0.0], [1.0, 1e-290]],
            [[0.0, 0.0], [1.5e308, 0.0], [0.0, 1.5e308]],
        ] {
            assert_eq!(disk(corners)[2], f64::INFINITY, "{corners:?}");
        }
    }

    #[test]
    fn corners_lie_in_the_disk() {
        let mut random = uniform(7);
        for i in 0..10_000 {
            let flat = 10f64.powi(-(i % 14));
            let far = 10f64.powi(i % 7);
            let corners = [0; 3].map(|_| [far + random(), -far + flat * random()]);
            let [x, y, r] = disk(corners);
            for p in corners {
                // The distance is rounded by far less than the padding of the radius.
                let distance = (p[0] - x).hypot(p[1] - y);
                assert!(distance <= r * (1.0 + 2.0 * f64::EPSILON), "{corners:?}");
            }
        }
    }
}
