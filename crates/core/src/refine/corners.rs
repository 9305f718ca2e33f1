//! Corners of the input where segments meet at a small angle, which no refinement can improve.
//!
//! They are marked so that refinement leaves them alone.

use delone_predicates::Point2;

use crate::base::error::Result;
use crate::base::memory::filled;

/// Two segments that meet at a smaller angle make a sharp corner, where splitting one segment may
/// encroach upon the other.
pub const SHARP: f64 = std::f64::consts::FRAC_PI_2;

/// Whether two segments at each vertex meet at an angle below `bound`.
pub fn sharp(
    points: &[Point2],
    segments: &[[u32; 2]],
    vertices: usize,
    bound: f64,
) -> Result<Vec<bool>> {
    let mut directions: Vec<(u32, f64)> = Vec::with_capacity(2 * segments.len());
    for &[u, v] in segments {
        let [p, q] = [u, v].map(|v| points[v as usize]);
        let angle = (q[1] - p[1]).atan2(q[0] - p[0]);
        let back = (p[1] - q[1]).atan2(p[0] - q[0]);
        directions.extend([(u, angle), (v, back)]);
    }
    directions.sort_unstable_by(|s, t| s.0.cmp(&t.0).then(s.1.total_cmp(&t.1)));
    let mut sharp = filled(vertices, false)?;
    for star in directions.chunk_by(|s, t| s.0 == t.0) {
        let (first, last) = (star[0], star[star.len() - 1]);
        let round = first.1 + std::f64::consts::TAU - last.1;
        let narrow = star.windows(2).any(|w| w[1].1 - w[0].1 < bound);
        sharp[first.0 as usize] = star.len() > 1 && (narrow || round < bound);
    }
    Ok(sharp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_sharp_below_a_right_angle() {
        let points = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [-1.0, 0.1],
            [-1.0, -0.1],
        ];
        let found = sharp(&points, &[[0, 1], [1, 2], [2, 0], [0, 3]], 5, SHARP).unwrap();
        assert_eq!(found, [true, false, true, false, false]);
        // Across the branch cut of the arc tangent.
        let found = sharp(&points, &[[0, 3], [0, 4]], 5, SHARP).unwrap();
        assert_eq!(found, [true, false, false, false, false]);
    }
}
