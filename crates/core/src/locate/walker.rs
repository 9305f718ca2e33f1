//! Walks from query to query of a batch, in 2-D and 3-D.

use super::locator::{Dimension, Located, Locator};
use super::range::squared;
use super::star::Star;
use crate::base::arrays::Side;
use crate::base::error::Result;

/// The location of the last query: the next walk starts there, or from the tree if it is far away.
pub struct Walker<'a, P: Dimension<D, N>, const D: usize, const N: usize> {
    locator: &'a Locator<'a, P, D, N>,
    star: Star<N>,
    near: usize,
    last: [f64; D],
    reach: f64,
    /// The boundary facet that has it strictly outside.
    beyond: Option<Side>,
}

impl<'a, P: Dimension<D, N>, const D: usize, const N: usize> Walker<'a, P, D, N> {
    /// Starts from the tree.
    pub fn new(locator: &'a Locator<'a, P, D, N>) -> Self {
        Self {
            locator,
            star: Star::default(),
            near: 0,
            last: [f64::NAN; D],
            reach: 0.0,
            beyond: None,
        }
    }

    /// Locates the next query.
    #[inline]
    pub fn go(&mut self, q: [f64; D]) -> Result<Located<N>> {
        if P::is_outside(self.locator, self.beyond, q)? {
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
        let corners = self.locator.given.corners(self.near);
        (self.last, self.reach) = (q, P::REACH * squared(corners[0], corners[1]));
        Ok(at)
    }
}
