//! Convex polygons, cut by triangles: I. E. Sutherland and G. W. Hodgman, "Reentrant polygon
//! clipping", Communications of the ACM 17 (1974).

use crate::points::Extent;
use delone_predicates::Point2;

/// A triangle cut by two others has nine corners at most.
pub const MOST: usize = 10;

/// A convex polygon, counterclockwise, relative to an origin.
#[derive(Clone, Copy)]
pub struct Polygon {
    corners: [Point2; MOST],
    len: usize,
}

impl Polygon {
    const EMPTY: Self = Self {
        corners: [[0.0; 2]; MOST],
        len: 0,
    };

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

    /// The box around it.
    pub fn extent(&self) -> Extent<2> {
        Extent::of(self.corners().iter().copied())
    }

    /// The part in a triangle; `None` if it has no area.
    #[inline]
    pub fn clipped(&self, &[a, b, c]: &[Point2; 3]) -> Option<Self> {
        let lines = [(a, b), (b, c), (c, a)].map(|(a, b)| Line::new(a, b));
        // Most triangles whose boxes meet are on different sides of one of these lines.
        let beyond = |line: &Line| self.corners().iter().all(|&p| line.side(p) <= 0.0);
        if lines.iter().any(beyond) {
            return None;
        }
        let (mut found, mut other) = (Self::EMPTY, Self::EMPTY);
        self.cut(&lines[0], &mut found);
        found.cut(&lines[1], &mut other);
        other.cut(&lines[2], &mut found);
        (found.len >= 3).then_some(found)
    }

    /// Writes the part to the left of a line.
    #[inline]
    fn cut(&self, line: &Line, found: &mut Self) {
        found.len = 0;
        let Some(&last) = self.corners().last() else {
            return;
        };
        let (mut from, mut before) = (last, line.side(last));
        for &to in self.corners() {
            let after = line.side(to);
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                let share = before / (before - after);
                found.push(std::array::from_fn(|k| from[k] + share * (to[k] - from[k])));
            }
            if after >= 0.0 {
                found.push(to);
            }
            (from, before) = (to, after);
        }
    }

    fn push(&mut self, corner: Point2) {
        // Rounding cannot add a corner for each cut and one more; such a corner would be left out.
        if self.len < MOST {
            self.corners[self.len] = corner;
            self.len += 1;
        }
    }
}

/// A directed line.
struct Line {
    at: Point2,
    along: Point2,
}

impl Line {
    fn new(a: Point2, b: Point2) -> Self {
        Self {
            at: a,
            along: relative(b, a),
        }
    }

    /// Above zero to the left.
    #[inline]
    fn side(&self, p: Point2) -> f64 {
        let [x, y] = relative(p, self.at);
        self.along[0] * y - self.along[1] * x
    }
}

/// A triangle that may overlap others, relative to an origin.
pub struct Candidate {
    /// Its corners, counterclockwise.
    pub corners: [Point2; 3],
    extent: Extent<2>,
}

impl Candidate {
    /// A triangle.
    pub fn new(corners: [Point2; 3], origin: Point2) -> Self {
        let corners = corners.map(|p| relative(p, origin));
        Self {
            corners,
            extent: Extent::of(corners),
        }
    }

    /// A box relative to the origin.
    pub fn extent_of(extent: &Extent<2>, origin: Point2) -> Extent<2> {
        Extent {
            min: relative(extent.min, origin),
            max: relative(extent.max, origin),
        }
    }

    /// Whether its box has an area in common with another one.
    #[inline]
    pub fn meets(&self, other: &Extent<2>) -> bool {
        (0..2).all(|k| self.extent.min[k] < other.max[k] && other.min[k] < self.extent.max[k])
    }
}

fn relative(p: Point2, origin: Point2) -> Point2 {
    [p[0] - origin[0], p[1] - origin[1]]
}
