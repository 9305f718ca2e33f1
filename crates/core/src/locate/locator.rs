//! Shared by point location in 2-D and 3-D: the cache of a triangulation, and location by a walk
//! or, if walks may miss simplices, by bounding boxes.

use std::sync::OnceLock;

use delone_predicates::Sign;

use super::boxes::Boxes;
use super::range::is_finite;
use super::sites::Sites;
use super::star::{First, Place, Star};
use super::start::Start;
use crate::base::arrays::{Given, Side};
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Watch;

/// The location of a point; 2-D by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Located<const N: usize = 3> {
    /// In a simplex.
    Inside(Place<N>),
    /// Outside of all simplices; with a boundary facet that has the point strictly outside if a walk
    /// found one, in 2-D always.
    Outside(Option<Side>),
}

/// What is specific to location in a dimension; the type is what it keeps besides a [`Cache`].
pub trait Dimension<const D: usize, const N: usize>: Sized + Send + Sync {
    /// The boundary of a tiling.
    type Boundary: Send + Sync;

    /// How far a walk goes from query to query, in lengths of an edge of the last simplex, squared;
    /// beyond that the tree of starting simplices is cheaper.
    const REACH: f64;

    /// What is kept besides.
    fn of(given: &Given<D, N>) -> Self;

    /// The boundary, extracted from the arrays.
    fn boundary(given: &Given<D, N>, watch: &Watch) -> Result<Self::Boundary>;

    /// Whether the simplices fill one convex region.
    fn is_convex(boundary: &Self::Boundary) -> bool;

    /// On which side of the facet opposite each corner of a simplex `q` is: positive is inside.
    fn sides(corners: [[f64; D]; N], q: [f64; D]) -> [Sign; N];

    /// Where a walk from simplex `from` to `q` ends: in any simplex that contains it, or at a
    /// boundary facet, or undecided, which is outside without a facet.
    fn walk(given: &Given<D, N>, from: usize, q: [f64; D]) -> Result<Located<N>>;

    /// The first of the simplices that can be reached around the facet, edge or vertex at `place`.
    fn first_around(given: &Given<D, N>, place: Place<N>) -> First<N>;

    /// Whether little proves `q` to be outside all simplices, after a query that was strictly
    /// outside boundary facet `last`.
    #[inline]
    fn is_outside(
        _locator: &Locator<Self, D, N>,
        _last: Option<Side>,
        _q: [f64; D],
    ) -> Result<bool> {
        Ok(false)
    }
}

/// What is cached between calls for one triangulation.
#[derive(Debug)]
pub struct Cache<P: Dimension<D, N>, const D: usize, const N: usize> {
    pub(crate) own: P,
    start: Start<D>,
    boundary: OnceLock<P::Boundary>,
    boxes: OnceLock<Boxes<D>>,
    sites: OnceLock<Sites<D>>,
}

impl<P: Dimension<D, N>, const D: usize, const N: usize> Cache<P, D, N> {
    /// A tree of starting simplices for many calls; the rest is built when needed.
    pub fn of(given: &Given<D, N>, watch: &Watch) -> Result<Self> {
        let first = |t: usize| given.point(given.simplices[t][0]);
        Ok(Self {
            own: P::of(given),
            start: Start::of(given.simplices.len(), first, watch)?,
            boundary: OnceLock::new(),
            boxes: OnceLock::new(),
            sites: OnceLock::new(),
        })
    }
}

/// A triangulation and its cache.
pub struct Locator<'a, P: Dimension<D, N>, const D: usize, const N: usize> {
    /// The arrays.
    pub given: Given<'a, D, N>,
    pub(crate) kept: &'a Cache<P, D, N>,
    /// Checked while something to be cached is built.
    pub(crate) watch: &'a Watch<'a>,
}

impl<P: Dimension<D, N>, const D: usize, const N: usize> Copy for Locator<'_, P, D, N> {}

// Not derived: that would require `Clone` of the cache.
impl<P: Dimension<D, N>, const D: usize, const N: usize> Clone for Locator<'_, P, D, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, P: Dimension<D, N>, const D: usize, const N: usize> Locator<'a, P, D, N> {
    /// A locator with the cache of the same arrays.
    pub fn new(given: Given<'a, D, N>, kept: &'a Cache<P, D, N>, watch: &'a Watch<'a>) -> Self {
        Self { given, kept, watch }
    }

    /// The boundary.
    pub fn boundary(&self) -> Result<&'a P::Boundary> {
        kept(&self.kept.boundary, || P::boundary(&self.given, self.watch))
    }

    /// Whether the simplices fill one convex region.
    pub fn is_convex(&self) -> Result<bool> {
        self.boundary().map(P::is_convex)
    }

    /// A simplex near `q`.
    #[inline]
    pub fn near(&self, q: [f64; D]) -> usize {
        self.kept.start.near(q)
    }

    /// The vertices, for nearest-vertex queries.
    pub(crate) fn sites(&self) -> Result<&'a Sites<D>> {
        kept(&self.kept.sites, || Sites::of(&self.given, self.watch))
    }

    /// Locates `q` by a walk from simplex `from`.
    #[inline]
    pub fn locate_from(&self, from: usize, q: [f64; D], star: &mut Star<N>) -> Result<Located<N>> {
        let found = match P::walk(&self.given, from, q)? {
            Located::Inside(place) if place.is_interior() => return Ok(Located::Inside(place)),
            Located::Inside(place) => {
                let first = star.first(place, |place| P::first_around(&self.given, place));
                if !first.open {
                    return Ok(Located::Inside(first.place));
                }
                Located::Inside(first.place)
            }
            outside => outside,
        };
        // Unless the boundary is convex, there may be simplices beyond it.
        if found != Located::Outside(None) && self.is_convex()? {
            return Ok(found);
        }
        Ok(self.first_of_all(q)?.map_or(found, Located::Inside))
    }

    /// Locates `q`; `None` if it is not finite or there is no simplex.
    pub fn locate(&self, q: [f64; D]) -> Result<Option<Located<N>>> {
        if !is_finite(&q) || self.given.simplices.is_empty() {
            return Ok(None);
        }
        if P::is_outside(self, None, q)? {
            return Ok(Some(Located::Outside(None)));
        }
        let located = self.locate_from(self.near(q), q, &mut Star::default())?;
        Ok(Some(located))
    }

    /// The first of all simplices that contain `q`.
    #[cold]
    #[inline(never)]
    fn first_of_all(&self, q: [f64; D]) -> Result<Option<Place<N>>> {
        let given = &self.given;
        let boxes = kept(&self.kept.boxes, || {
            let box_of = |t| Extent::of(given.corners(t));
            Boxes::over(given.simplices.len(), box_of, self.watch)
        })?;
        let mut best: Option<Place<N>> = None;
        boxes.around(q, |t| {
            if best.is_none_or(|b| t < b.simplex) {
                let sides = P::sides(given.corners(t), q);
                if !sides.contains(&Sign::Negative) {
                    best = Some(Place::of(t, sides));
                }
            }
        });
        Ok(best)
    }
}

/// The value in the cell, built now if it is empty; if two threads build it, one of the two equal
/// values.
pub fn kept<T>(cell: &OnceLock<T>, make: impl FnOnce() -> Result<T>) -> Result<&T> {
    match cell.get() {
        Some(value) => Ok(value),
        None => {
            let made = make()?;
            Ok(cell.get_or_init(|| made))
        }
    }
}
