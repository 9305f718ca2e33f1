//! Sites as seen from a query: in its tangent plane, by differences that do not cancel.
//!
//! Let q be the query and s a site, unit vectors with difference d = s - q. The tangent plane has the axes
//! east and north. The site is given by p, the part of d along them, and m = d^2 / 2 = 1 - q s. The
//! projection from the center takes the tangent vector y to the direction of q + y; the directions
//! equally far from q and s are the line p y = m, those equally far from s and s' the line
//! (p - p') y = m - m'. Both p and m are right to a few units of rounding at any distance, as d comes from
//! directions in pairs of doubles.
//!
//! If the query moves by the tangent vector t, and the axes with it, p moves by -(1 - m) t and m by -p t, up
//! to terms of second order.

use delone_predicates::Point3;
use delone_predicates::sphere::Unit;

use crate::base::vector::dot;
use crate::interpolate::Number;

/// The tangent plane of a query.
pub struct Frame {
    origin: Unit,
    east: Point3,
    north: Point3,
}

/// A site in the tangent plane of the query.
#[derive(Debug, Clone, Copy)]
pub struct Seen<N> {
    /// Toward east and north.
    pub p: [N; 2],
    /// Half the square of the distance.
    pub m: N,
}

impl Frame {
    /// The frame of a direction; at a pole that of longitude 0.
    pub fn of(origin: Unit) -> Self {
        let [x, y, z] = origin.hi;
        let across = x.hypot(y);
        let (cos, sin) = if across > 0.0 {
            (x / across, y / across)
        } else {
            (1.0, 0.0)
        };
        Self {
            origin,
            east: [-sin, cos, 0.0],
            north: [-z * cos, -z * sin, across],
        }
    }

    /// The site with a direction.
    #[inline]
    pub fn see<N: Number>(&self, site: &Unit) -> Seen<N> {
        let d =
            [0, 1, 2].map(|k| (site.hi[k] - self.origin.hi[k]) + (site.lo[k] - self.origin.lo[k]));
        let [x, y, m] = [dot(d, self.east), dot(d, self.north), 0.5 * dot(d, d)];
        let moved = m - 1.0;
        Seen {
            p: [N::linear(x, [moved, 0.0]), N::linear(y, [0.0, moved])],
            m: N::linear(m, [-x, -y]),
        }
    }
}
