//! Gaps between a line and an apex next to it, and the length over which another line faces it
//! there.

use delone_predicates::{Point2, lexicographic};

use super::shape::{cross, dot, minus};

/// Lines face each other if they are no farther apart than this times the gap.
const FACING: f64 = 2.0;

/// Heights below this fraction of the coordinates are rounding errors.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// A line with an apex beside it.
pub struct Base {
    from: Point2,
    /// The unit direction.
    along: Point2,
    length: f64,
    /// The height of the apex.
    pub gap: f64,
    /// 1 if the apex is on the left.
    side: f64,
}

impl Base {
    /// The line between two points, in either order, and its apex.
    pub fn of([a, b]: [Point2; 2], apex: Point2) -> Self {
        // The same for both directions of the line.
        let [a, b] = if lexicographic(a, b).is_gt() {
            [b, a]
        } else {
            [a, b]
        };
        let step = minus(b, a);
        let length = step[0].hypot(step[1]);
        let along = step.map(|x| x / length);
        let height = cross(along, minus(apex, a));
        let largest = [a, b, apex]
            .as_flattened()
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        Self {
            from: a,
            along,
            length,
            gap: height.abs().max(ROUNDING * largest),
            side: height.signum(),
        }
    }

    fn place(&self, p: Point2) -> [f64; 2] {
        let w = minus(p, self.from);
        [dot(self.along, w), self.side * cross(self.along, w)]
    }

    /// The length over which the line `c d` faces this one at a distance of at most about `gap`.
    pub fn facing(&self, [c, d]: [Point2; 2], gap: f64) -> f64 {
        let [c, d] = if lexicographic(c, d).is_gt() {
            [d, c]
        } else {
            [c, d]
        };
        let ([x, y], [z, w]) = (self.place(c), self.place(d));
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (from, to, least, most) in [(x, z, 0.0, self.length), (y, w, -self.gap, FACING * gap)] {
            if from == to {
                if from < least || from > most {
                    return 0.0;
                }
                continue;
            }
            let [s, t] = [least, most].map(|bound| (bound - from) / (to - from));
            first = first.max(s.min(t));
            last = last.min(s.max(t));
        }
        (last - first).max(0.0) * (z - x).abs()
    }
}
