//! The nearest point of a triangle in 3-D, rounded.

use delone_predicates::Point3;

use crate::base::vector::dot;
use crate::locate::length;

/// The distance of `q` from a triangle, of coordinates times `unit`, and the weights of its corners
/// in the nearest point.
pub fn on_face(corners: [Point3; 3], q: Point3, unit: f64) -> (f64, [f64; 3]) {
    let relative = corners.map(|p| [0, 1, 2].map(|k| p[k] * unit - q[k] * unit));
    let most = relative
        .as_flattened()
        .iter()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    if most == 0.0 {
        return (0.0, [1.0, 0.0, 0.0]);
    }
    // In a unit of its own, so that nothing overflows or underflows.
    let relative = relative.map(|p| p.map(|x| x / most));
    let distance = |shares: [f64; 3]| {
        length([0, 1, 2].map(|k| (0..3).map(|i| shares[i] * relative[i][k]).sum()))
    };
    let mut best = inside(relative).map(|shares| (distance(shares), shares));
    if best.is_none() {
        for i in 0..3 {
            let shares = on_edge(relative, i, (i + 1) % 3);
            let found = (distance(shares), shares);
            if best.is_none_or(|b| found.0 < b.0) {
                best = Some(found);
            }
        }
    }
    best.map_or((f64::INFINITY, [f64::NAN; 3]), |(d, s)| (d * most, s))
}

/// The weights of the corners in the point of their plane nearest to the origin; `None` if it is
/// not inside the triangle.
fn inside([a, b, c]: [Point3; 3]) -> Option<[f64; 3]> {
    let minus = |p: Point3, q: Point3| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross = |p: Point3, q: Point3| {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    };
    let n = cross(minus(b, a), minus(c, a));
    let parts = [
        dot(cross(b, c), n),
        dot(cross(c, a), n),
        dot(cross(a, b), n),
    ];
    let sum: f64 = parts.iter().sum();
    // Written so that NaN is not inside.
    (sum > 0.0 && parts.iter().all(|&x| x >= 0.0)).then(|| parts.map(|x| x / sum))
}

/// The weights of two corners in the point between them nearest to the origin.
fn on_edge(relative: [Point3; 3], i: usize, j: usize) -> [f64; 3] {
    let (a, b) = (relative[i], relative[j]);
    let way = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let square = dot(way, way);
    let share = if square > 0.0 {
        (-dot(a, way) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mut shares = [0.0; 3];
    (shares[i], shares[j]) = (1.0 - share, share);
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn above_beside_and_at_a_corner() {
        for (scale, unit) in [(1.0, 1.0), (5e-324, 1.0), (2f64.powi(1020), 0.25)] {
            let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
            let corners = corners.map(|p: Point3| p.map(|x| x * scale));
            let shares = |q: Point3| on_face(corners, q.map(|x| x * scale), unit).1;
            assert_eq!(shares([1.0, 1.0, -3.0]), [0.5, 0.25, 0.25]);
            assert_eq!(shares([1.0, -5.0, 0.0]), [0.75, 0.25, 0.0]);
            assert_eq!(shares([-1.0, -1.0, -1.0]), [1.0, 0.0, 0.0]);
        }
    }
}
