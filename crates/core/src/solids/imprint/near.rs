//! Distances in doubles: whether vertices, edges and triangles are within the tolerance.
//!
//! Coordinates are at most 1 in absolute value, and the tolerance is many times their rounding errors.

use delone_predicates::{Point3, Sign, orient3d};

use crate::base::vector::{cross, dot, minus};

/// The corners at the ends of each edge of a triangle.
pub const EDGES: [(usize, usize); 3] = [(0, 1), (1, 2), (2, 0)];

/// Where a vertex is on a triangle, within the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Spot {
    /// Whether it is a corner.
    pub corner: bool,
    /// Whether it is inside each of the edges.
    pub edges: [bool; 3],
    /// Whether it is in the interior.
    pub inside: bool,
}

impl Spot {
    /// Whether it is anywhere on the triangle.
    pub fn is_on(self) -> bool {
        self.corner || self.inside || self.edges.contains(&true)
    }
}

/// The point at `s` between `p` and `q`.
pub fn between(p: Point3, q: Point3, s: f64) -> Point3 {
    std::array::from_fn(|k| p[k] + (q[k] - p[k]) * s)
}

/// The square of the distance.
pub fn square(p: Point3, q: Point3) -> f64 {
    let d = minus(p, q);
    dot(d, d)
}

/// The parameter of the point of the line through `p` and `q` that is nearest to `x`, if it is
/// strictly between them and the distance is at most `tolerance`.
pub fn inside_edge(x: Point3, p: Point3, q: Point3, tolerance: f64) -> Option<f64> {
    let (along, to) = (minus(q, p), minus(x, p));
    let s = dot(to, along) / dot(along, along);
    let near = s > 0.0 && s < 1.0 && square(x, between(p, q, s)) <= tolerance * tolerance;
    near.then_some(s)
}

/// Where a point that is not a corner is on a triangle. Its distance from the corners must exceed the
/// tolerance.
pub fn spot(x: Point3, t: [Point3; 3], tolerance: f64) -> Spot {
    let mut found = Spot::default();
    let normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    let length = dot(normal, normal).sqrt();
    // The height of a thin triangle can be less than the tolerance, so its edges are always tested.
    if dot(normal, minus(x, t[0])).abs() > 2.0 * tolerance * length && length > tolerance {
        return found;
    }
    for (k, (i, j)) in EDGES.into_iter().enumerate() {
        found.edges[k] = inside_edge(x, t[i], t[j], tolerance).is_some();
    }
    if found.is_on() || dot(normal, minus(x, t[0])).abs() > tolerance * length {
        return found;
    }
    // Away from the edges, rounding cannot change which side of them it is on.
    found.inside = EDGES.into_iter().all(|(i, j)| {
        let side = cross(minus(t[j], t[i]), minus(x, t[i]));
        dot(side, normal) > 0.0
    });
    found
}

/// Whether a plane proves that two triangles are farther apart than the tolerance, except at
/// vertices that they share: the plane of one of them, or one through an edge that is perpendicular to it.
pub fn apart(a: [Point3; 3], b: [Point3; 3], shared: [[bool; 3]; 2], tolerance: f64) -> bool {
    separated(a, b, shared, tolerance) || separated(b, a, [shared[1], shared[0]], tolerance)
}

/// The same with the planes of `b` only.
fn separated(a: [Point3; 3], b: [Point3; 3], shared: [[bool; 3]; 2], tolerance: f64) -> bool {
    let normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
    if is_beyond(a, b, shared, (normal, b[0]), tolerance)
        || is_beyond(a, b, shared, (normal.map(|x| -x), b[0]), tolerance)
    {
        return true;
    }
    EDGES.into_iter().any(|(i, j)| {
        let opposite = 3 - i - j;
        let out = cross(minus(b[j], b[i]), normal);
        !shared[1][opposite] && is_beyond(a, b, shared, (out, b[i]), tolerance)
    })
}

/// Whether `a` is on the positive side of a plane through the shared vertices, and `b` is not: the
/// vertices that are not shared are farther away than the tolerance, and the angle at shared ones
/// keeps the others of `b` away. If all vertices v of `a` have depths of at least k |v - s|, for the
/// shared vertex s, then so have all points x of `a`; a point w that is not beyond the plane has at
/// least the distances k |x - s| and |w - s| - |x - s| from x, one of which is k |w - s| / 2.
fn is_beyond(
    a: [Point3; 3],
    b: [Point3; 3],
    shared: [[bool; 3]; 2],
    (direction, on): (Point3, Point3),
    tolerance: f64,
) -> bool {
    let length = dot(direction, direction).sqrt();
    let Some(common) = (0..3).find(|&i| shared[0][i]) else {
        return a
            .iter()
            .all(|&v| dot(direction, minus(v, on)) > 2.0 * tolerance * length);
    };
    let s = a[common];
    let mut least = f64::INFINITY;
    for i in (0..3).filter(|&i| !shared[0][i]) {
        let depth = dot(direction, minus(a[i], on));
        if depth <= 2.0 * tolerance * length {
            return false;
        }
        least = least.min(depth / (length * square(a[i], s).sqrt()));
    }
    // With two shared vertices, distances from the line through them.
    let other = (common + 1..3).find(|&i| shared[0][i]);
    (0..3).filter(|&i| !shared[1][i]).all(|i| {
        let to = minus(b[i], s);
        let reach = match other {
            None => dot(to, to),
            Some(other) => {
                let along = minus(a[other], s);
                let across = cross(along, to);
                dot(across, across) / dot(along, along)
            }
        };
        least * reach.sqrt() > 4.0 * tolerance
    })
}

/// The middle of the shortest connection of two segments, if it is strictly inside both and at most
/// as long as the tolerance; `None` for parallel ones.
pub fn crossing([p, q]: [Point3; 2], [r, s]: [Point3; 2], tolerance: f64) -> Option<Point3> {
    let (x, y) = nearest([p, q], [r, s])?;
    (square(x, y) <= tolerance * tolerance).then(|| between(x, y, 0.5))
}

/// The points of two segments that are nearest to each other, if both are strictly inside.
pub fn nearest([p, q]: [Point3; 2], [r, s]: [Point3; 2]) -> Option<(Point3, Point3)> {
    let (u, v, w) = (minus(q, p), minus(s, r), minus(r, p));
    let normal = cross(u, v);
    let squared = dot(normal, normal);
    if squared == 0.0 {
        return None;
    }
    let (a, b) = (
        dot(cross(w, v), normal) / squared,
        dot(cross(w, u), normal) / squared,
    );
    let inside = a > 0.0 && a < 1.0 && b > 0.0 && b < 1.0;
    inside.then(|| (between(p, q, a), between(r, s, b)))
}

/// The point where a segment pierces the interior of a triangle; its ends must not be on it.
pub fn piercing([p, q]: [Point3; 2], [a, b, c]: [Point3; 3]) -> Option<Point3> {
    let (side_p, side_q) = (orient3d(a, b, c, p), orient3d(a, b, c, q));
    if side_p.is_zero() || side_q.is_zero() || side_p == side_q {
        return None;
    }
    let turns = [
        orient3d(p, q, a, b),
        orient3d(p, q, b, c),
        orient3d(p, q, c, a),
    ];
    if turns[0] == Sign::Zero || turns[1] != turns[0] || turns[2] != turns[0] {
        return None;
    }
    let normal = cross(minus(b, a), minus(c, a));
    let (of_p, of_q) = (dot(normal, minus(p, a)), dot(normal, minus(q, a)));
    let s = of_p / (of_p - of_q);
    Some(between(p, q, if s > 0.0 && s < 1.0 { s } else { 0.5 }))
}

/// The distance of a point from a triangle.
pub fn distance(x: Point3, t: [Point3; 3]) -> f64 {
    let normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    let squared = dot(normal, normal);
    let over =
        |(i, j): (usize, usize)| dot(cross(minus(t[j], t[i]), minus(x, t[i])), normal) >= 0.0;
    if squared > 0.0 && EDGES.into_iter().all(over) {
        return dot(normal, minus(x, t[0])).abs() / squared.sqrt();
    }
    let to_edge = EDGES.map(|(i, j)| {
        let along = minus(t[j], t[i]);
        let length = dot(along, along);
        let s = if length > 0.0 {
            (dot(minus(x, t[i]), along) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        square(x, between(t[i], t[j], s))
    });
    to_edge.into_iter().fold(f64::INFINITY, f64::min).sqrt()
}
