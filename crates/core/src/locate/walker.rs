//! Walks from query to query of a 2-D batch.

use delone_predicates::Point2;

use super::batch::{Walks, squared};
use super::tiling::Side;
use super::{Kept, Located, Locator, Star};
use crate::error::Result;

/// How far a walk goes, in lengths of an edge of the last triangle, squared; beyond that the tree
/// of starting triangles is cheaper: its depth costs about as much as a dozen triangles.
const REACH: f64 = 64.0;

impl Walks<2, 3> for Kept {
    type Located = Located;

    fn walker(locator: &Locator) -> impl FnMut(Point2) -> Result<Located> + Send {
        let mut walker = Walker {
            locator,
            star: Star::default(),
            near: 0,
            last: [f64::NAN; 2],
            reach: 0.0,
        };
        move |q| walker.go(q)
    }

    #[inline]
    fn holder(at: &Located) -> i32 {
        match at {
            Located::Inside(place) => place.triangle as i32,
            Located::Outside(_) => -1,
        }
    }
}

/// The location of the last query; the next walk starts there, or from the tree.
struct Walker<'a> {
    locator: &'a Locator<'a>,
    star: Star,
    near: usize,
    last: Point2,
    reach: f64,
}

impl Walker<'_> {
    #[inline]
    fn go(&mut self, q: Point2) -> Result<Located> {
        // False for NaN, initially and if squares overflow: then the tree gives the start.
        let close = squared(q, self.last) <= self.reach;
        if !close {
            self.near = self.locator.near(q);
        }
        let at = self.locator.locate_from(self.near, q, &mut self.star)?;
        self.near = match at {
            Located::Inside(place) => place.triangle,
            Located::Outside(Side { triangle, .. }) => triangle,
        };
        let [a, b, _] = self.locator.given.corners(self.near);
        (self.last, self.reach) = (q, REACH * squared(a, b));
        Ok(at)
    }
}
