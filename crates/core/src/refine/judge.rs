//! Judges all triangles for a report: those with an angle below a bound, exactly, and the extreme
//! angles.

use delone_predicates::Point2;

use super::shape::{Shape, cross, dot, minus};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::watch::Watch;

/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 16;

/// If twice the area is a smaller fraction of the product of the two shorter edges, rounding has
/// cost it too many bits: an angle is below 1.8 degrees or above 178.2.
const THIN: f64 = 1.0 / 32.0;

/// The result of judging.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Judged {
    /// Triangles with an angle below the bound, ascending.
    pub below: Vec<u32>,
    /// Triangles that include those with the smallest and the largest angle: all thin ones, and the
    /// two extremes of the others.
    pub extremes: Vec<u32>,
    /// Triangles that are not judged because their squares leave the range of doubles.
    pub beyond: Vec<u32>,
}

/// A triangle in plain floating point.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Extent {
    /// The squared sine of the smallest angle, and the squared cosine of the largest one with the
    /// sign of the cosine.
    Plain([f64; 2]),
    /// So thin that rounding makes these useless.
    Thin,
    /// Products of squares of its edges leave the range of doubles.
    Beyond,
}

/// The most extreme triangle so far.
#[derive(Debug, Clone, Copy)]
struct Least {
    triangle: Option<u32>,
    value: f64,
}

impl Least {
    const NONE: Self = Self {
        triangle: None,
        value: f64::INFINITY,
    };

    fn see(&mut self, triangle: u32, value: f64) {
        if value < self.value {
            *self = Self {
                triangle: Some(triangle),
                value,
            };
        }
    }
}

/// Judges triangles, given as rows of `points`, by the squared cosine of the smallest allowed
/// angle.
pub fn judge(
    points: &[Point2],
    simplices: &[[i32; 3]],
    cos2: f64,
    watch: &Watch,
) -> Result<Judged> {
    let shape = Shape::of_square(cos2);
    let mut found = Judged::default();
    let (mut smallest, mut largest) = (Least::NONE, Least::NONE);
    for (t, simplex) in (0..).zip(simplices) {
        if (t as usize).is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        let corners = simplex.map(|row| points[row as usize]);
        match extent(corners) {
            Extent::Plain([sine, cosine]) => {
                smallest.see(t, sine);
                largest.see(t, cosine);
            }
            Extent::Thin => push(&mut found.extremes, t)?,
            Extent::Beyond => {
                push(&mut found.beyond, t)?;
                continue;
            }
        }
        if shape.see(corners).skinny {
            push(&mut found.below, t)?;
        }
    }
    for t in [smallest, largest].iter().filter_map(|l| l.triangle) {
        push(&mut found.extremes, t)?;
    }
    Ok(found)
}

fn extent([a, b, c]: [Point2; 3]) -> Extent {
    let edges = [minus(c, b), minus(a, c), minus(b, a)];
    let mut sides = edges.map(|e| dot(e, e));
    let area2 = cross(edges[0], edges[1]);
    sides.sort_unstable_by(f64::total_cmp);
    let [x, y, z] = sides;
    let (square, around, across) = (area2 * area2, x * y, y * z);
    if !(around > 1e-250 && across < 1e250) {
        return Extent::Beyond;
    }
    if square <= THIN * THIN * around {
        return Extent::Thin;
    }
    // By the law of cosines; the largest angle is between the two shorter edges.
    let cosine = 0.5 * (x + y - z);
    Extent::Plain([square / across, cosine * cosine.abs() / around])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(points: &[Point2], cos2: f64) -> Judged {
        let simplices: Vec<[i32; 3]> = (0..points.len() as i32 / 3)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect();
        judge(points, &simplices, cos2, &Watch::idle()).unwrap()
    }

    #[test]
    fn extremes_are_found_and_ties_are_not_below() {
        let equilateral = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.8]];
        let right = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let obtuse = [[0.0, 0.0], [1.0, 0.0], [-0.9, 0.9]];
        let all = [equilateral, right, obtuse].concat();
        let found = judged(&all, 0.5);
        assert_eq!(found.below, [2]);
        assert_eq!(found.extremes, [2, 2]);
        assert_eq!(judged(&all[..6], 0.5).below, []);
        assert_eq!(judged(&all[..6], 0.5).extremes, [1, 1]);
    }

    #[test]
    fn inaccurate_triangles_are_left_to_the_caller() {
        let thin = [[0.0, 0.0], [1.0, 0.0], [0.5, 1e-9]];
        let tiny = [[0.0, 0.0], [1e-200, 0.0], [0.0, 1e-200]];
        let right = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let found = judged(&[thin, tiny, right].concat(), 0.75);
        assert_eq!(found.extremes, [0, 2, 2]);
        assert_eq!(found.beyond, [1]);
        assert_eq!(found.below, [0]);
    }
}
