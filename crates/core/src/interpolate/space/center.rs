//! Centers of spheres through the query and three of its neighbors, with bounds on their errors.

pub use crate::base::vector::{cross, dot, minus, plus};
use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;

/// Ratio of the magnitude of the products to the volume above which plain floating point does not
/// suffice.
const THIN: f64 = 32.0;
/// The rounding of double-double arithmetic relative to that of doubles, with some room.
const REST: f64 = 1.0 / (1u64 << 48) as f64;
/// The square of a product of three distances, each at most 4, below which products may lose digits
/// to underflow.
const LEAST: f64 = 1e-280;

/// A center relative to the query.
#[derive(Debug, Clone, Copy)]
pub struct Center {
    /// Its position.
    pub at: Point3,
    /// Its distance.
    pub radius: f64,
    /// About how many roundings of the radius it is off: at least 1.
    pub doubt: f64,
}

impl Center {
    /// The center of the sphere through the origin and three points, positively oriented, none of
    /// whose coordinates exceeds 2; `None` if the four are too nearly coplanar.
    #[inline]
    pub fn plain([a, b, c]: [Point3; 3]) -> Option<Self> {
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let det = dot(a, bc);
        let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
        let product = aa * bb * cc;
        let sure = det * THIN >= dot(sizes(a), terms(b, c)) && product > LEAST;
        if !sure {
            return None;
        }
        let one = 1.0 / det;
        let half = 0.5 * one;
        let at = [0, 1, 2].map(|k| (aa * bc[k] + bb * ca[k] + cc * ab[k]) * half);
        let radius = dot(at, at).sqrt();
        let doubt = product.sqrt() * one;
        Some(Self { at, radius, doubt })
    }

    /// About how many roundings of 1 each coordinate is off: at least that of the coordinate
    /// itself. `corners` are those from which `plain` computed it, or failed to.
    pub fn doubts(&self, [a, b, c]: [Point3; 3]) -> Point3 {
        let (bc, ca, ab) = (terms(b, c), terms(c, a), terms(a, b));
        let det = dot(a, cross(b, c));
        let size = dot(sizes(a), bc);
        let sure = det * THIN >= size;
        if !sure {
            let rest = self.radius * (self.doubt - 1.0);
            return self.at.map(|x| x.abs() + rest);
        }
        let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
        [0, 1, 2].map(|k| {
            let terms = aa * bc[k] + bb * ca[k] + cc * ab[k];
            (0.5 * terms + self.at[k].abs() * size) / det
        })
    }

    /// The same for three points relative to `q`, in double-double arithmetic; coordinates are
    /// divided by `unit`.
    #[cold]
    #[inline(never)]
    pub fn paired(corners: [Point3; 3], q: Point3, unit: f64) -> Option<Self> {
        let seen = |p: f64, q: f64| {
            let Pair { hi, lo } = Pair::difference(p, q);
            Pair {
                hi: hi / unit,
                lo: lo / unit,
            }
        };
        let [a, b, c] = corners.map(|p| [0, 1, 2].map(|k| seen(p[k], q[k])));
        let cross = |p: [Pair; 3], q: [Pair; 3]| {
            [0, 1, 2].map(|k| {
                let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                p[x] * q[y] - p[y] * q[x]
            })
        };
        let dot = |p: [Pair; 3], q: [Pair; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let det = dot(a, bc).hi;
        let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
        let product = aa.hi * bb.hi * cc.hi;
        let rest = product.sqrt() / det * REST;
        let sure = det > 0.0 && rest < 1.0 && product > LEAST;
        if !sure {
            return None;
        }
        let at = [0, 1, 2].map(|k| (aa * bc[k] + bb * ca[k] + cc * ab[k]).hi / (2.0 * det));
        let radius = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let doubt = 1.0 + rest;
        Some(Self { at, radius, doubt })
    }
}

/// The absolute values of the coordinates.
#[inline]
pub fn sizes(p: Point3) -> Point3 {
    p.map(f64::abs)
}

/// The sizes of the terms of a cross product.
#[inline]
pub fn terms(p: Point3, q: Point3) -> Point3 {
    [
        (p[1] * q[2]).abs() + (p[2] * q[1]).abs(),
        (p[2] * q[0]).abs() + (p[0] * q[2]).abs(),
        (p[0] * q[1]).abs() + (p[1] * q[0]).abs(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_center_is_as_far_from_all() {
        let corners = [[0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]];
        let found = [
            Center::plain(corners),
            Center::paired(corners, [0.0; 3], 1.0),
        ];
        for center in found {
            assert_eq!(center.map(|c| c.at), Some([0.25, 0.5, 0.75]));
        }
        let flat = [[1.0, 1.0, 1.0], [1.0, 1.5, 2.0], [1.5, 1.75, 2.0 + 1e-9]];
        assert!(Center::plain(flat).is_none());
        let tiny = corners.map(|p| p.map(|x| x * 1e-60));
        assert!(Center::plain(tiny).is_none());
        assert!(Center::paired(tiny, [0.0; 3], 1.0).is_none());
        let unit = 2f64.powi(-200);
        let tiny = corners.map(|p| p.map(|x| x * unit));
        let center = Center::paired(tiny, [0.0; 3], unit);
        assert_eq!(center.map(|c| c.at), Some([0.25, 0.5, 0.75]));
    }
}
