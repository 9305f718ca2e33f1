//! The parts of point location that are specific to 3-D.

use delone_predicates::{Point3, Sign, orient3d};

use super::boundary::Boundary;
use super::walk::{sides_of, walk};
use super::{Located, Locator, Place};
use crate::base::arrays::{Side, Tetrahedra};
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::locate::{self, Dimension, First};

/// What is kept of tetrahedra.
#[derive(Debug)]
pub struct Space {
    /// The bounding box of all points: there is no tetrahedron outside.
    extent: Extent<3>,
}

impl Dimension<3, 4> for Space {
    type Boundary = Boundary;

    /// Each step costs more than in 2-D.
    const REACH: f64 = 16.0;

    fn of(given: &Tetrahedra) -> Self {
        Self {
            extent: Extent::of(given.points.iter().copied()),
        }
    }

    fn boundary(given: &Tetrahedra, watch: &Watch) -> Result<Boundary> {
        Boundary::of(given, watch)
    }

    fn is_convex(boundary: &Boundary) -> bool {
        boundary.convex
    }

    #[inline]
    fn sides(corners: [Point3; 4], q: Point3) -> [Sign; 4] {
        sides_of(corners, q)
    }

    #[inline]
    fn walk(given: &Tetrahedra, from: usize, q: Point3) -> Result<Located> {
        Ok(walk(given, from, q))
    }

    #[inline]
    fn first_around(given: &Tetrahedra, place: Place) -> First<4> {
        locate::first_around(given, place)
    }

    /// Outside of the box of all points, or beyond the boundary face through which the last walk
    /// left a convex body, which proves it for each point on that side of its plane.
    #[inline]
    fn is_outside(locator: &Locator, last: Option<Side>, q: Point3) -> Result<bool> {
        let Extent { min, max } = locator.kept.own.extent;
        if (0..3).any(|k| q[k] < min[k] || q[k] > max[k]) {
            return Ok(true);
        }
        let Some(side) = last else {
            return Ok(false);
        };
        let [a, b, c] = locator.given.face(side).map(|v| locator.given.point(v));
        Ok(locator.is_convex()? && orient3d(a, b, c, q) == Sign::Positive)
    }
}
