//! Convex polygons, cut by triangles: I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
//! clipping", Communications of the ACM 17 (1974).

use crate::Point2;
use crate::points::Extent;

/// A triangle cut by two others has nine corners at most.
const MOST: usize = 12;

/// A convex polygon, counterclockwise, relative to an origin.
#[derive(Clone, Copy)]
pub struct Polygon {
    corners: [Point2; MOST],
    len: usize,
}

impl Polygon {
    /// A triangle.
    pub fn triangle(corners: [Point2; 3], origin: Point2) -> Self {
        let mut polygon = Self {
            corners: [[0.0; 2]; MOST],
            len: 3,
        };
        for (to, from) in polygon.corners.iter_mut().zip(corners) {
            *to = relative(from, origin);
        }
        polygon
    }

    /// Its corners; empty if fewer than three.
    pub fn corners(&self) -> &[Point2] {
        &self.corners[..self.len]
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.len < 3
    }

    /// The box around it.
    pub fn extent(&self) -> Extent<2> {
        Extent::of(self.corners().iter().copied())
    }

    /// The part in a triangle.
    pub fn clipped(&self, triangle: [Point2; 3], origin: Point2) -> Self {
        let [a, b, c] = triangle.map(|p| relative(p, origin));
        let mut found = *self;
        for (a, b) in [(a, b), (b, c), (c, a)] {
            found = found.left_of(a, b);
            if found.is_empty() {
                break;
            }
        }
        found
    }

    /// The part to the left of a line.
    fn left_of(&self, a: Point2, b: Point2) -> Self {
        let [x, y] = relative(b, a);
        let side = |p: Point2| x * (p[1] - a[1]) - y * (p[0] - a[0]);
        let mut found = Self {
            corners: [[0.0; 2]; MOST],
            len: 0,
        };
        let Some(&last) = self.corners().last() else {
            return found;
        };
        let (mut from, mut before) = (last, side(last));
        for &to in self.corners() {
            let after = side(to);
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                let share = before / (before - after);
                found.push(std::array::from_fn(|k| from[k] + share * (to[k] - from[k])));
            }
            if after >= 0.0 {
                found.push(to);
            }
            (from, before) = (to, after);
        }
        found
    }

    fn push(&mut self, corner: Point2) {
        // Rounding cannot add a corner for each cut and one more; such a corner would be left out.
        if self.len < MOST {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }
}

/// Whether a triangle is on one side of a box.
pub fn apart(extent: &Extent<2>, triangle: [Point2; 3], origin: Point2) -> bool {
    let corners = triangle.map(|p| relative(p, origin));
    (0..2).any(|k| {
        corners.iter().all(|p| p[k] <= extent.min[k])
            || corners.iter().all(|p| p[k] >= extent.max[k])
    })
}

fn relative(p: Point2, origin: Point2) -> Point2 {
    [p[0] - origin[0], p[1] - origin[1]]
}
