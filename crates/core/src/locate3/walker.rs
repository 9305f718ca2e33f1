//! Walks from query to query of a 3-D batch.

use delone_predicates::Point3;

use super::tiling::Side;
use super::{Kept, Located, Locator, Star};
use crate::error::Result;
use crate::locate::{Walks, squared};

/// How far a walk goes, in lengths of an edge of the last tetrahedron, squared; beyond that the
/// tree of starting tetrahedra is cheaper. Each step costs more than in 2-D.
const REACH: f64 = 16.0;

impl Walks<3, 4> for Kept {
    type Located = Located;

    fn walker(locator: &Locator) -> impl FnMut(Point3) -> Result<Located> + Send {
        let mut walker = Walker {
            locator,
            star: Star::default(),
            near: 0,
            last: [f64::NAN; 3],
            reach: 0.0,
            beyond: None,
        };
        move |q| walker.go(q)
    }

    #[inline]
    fn holder(at: &Located) -> i32 {
        match at {
            Located::Inside(place) => place.simplex as i32,
            Located::Outside(_) => -1,
        }
    }
}

/// Walks from query to query, or from the tree of starting tetrahedra if the next one is far. Most
/// queries outside are recognized without a walk: they are outside the box of all points, or beyond
/// the boundary face through which the last walk left a convex body, which proves it for each point
/// on that side of its plane.
struct Walker<'a> {
    locator: &'a Locator<'a>,
    star: Star,
    near: usize,
    last: Point3,
    reach: f64,
    beyond: Option<Side>,
}

impl Walker<'_> {
    #[inline]
    fn go(&mut self, q: Point3) -> Result<Located> {
        let beyond = match self.beyond {
            Some(side) => self.locator.is_beyond(side, q)?,
            None => false,
        };
        if self.locator.is_far(q) || beyond {
            return Ok(Located::Outside(self.beyond));
        }
        // False for NaN, initially and if squares overflow: then the tree gives the start.
        let close = squared(q, self.last) <= self.reach;
        if !close {
            self.near = self.locator.near(q);
        }
        let at = self.locator.locate_from(self.near, q, &mut self.star)?;
        (self.near, self.beyond) = match at {
            Located::Inside(place) => (place.simplex, None),
            Located::Outside(side) => (side.map_or(self.near, |side| side.simplex), side),
        };
        let [a, b, ..] = self.locator.given.corners(self.near);
        (self.last, self.reach) = (q, REACH * squared(a, b));
        Ok(at)
    }
}
