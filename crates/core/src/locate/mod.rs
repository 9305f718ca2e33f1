//! 2-D point location: exact, boundary included, for any tiling in exported arrays.
//!
//! `Locator` holds what calls share: a tree of starting simplices, the boundary. `batch` takes
//! queries in curve order, or in their given order if that is as good, and `walker` goes from each
//! to the next. Modules that are independent of triangles, such as `batch` and `boxes`, serve
//! tetrahedra as well.

mod barycentric;
mod batch;
mod boundary;
mod boxes;
mod coordinates;
mod cross;
mod nearest;
mod output;
mod range;
mod segment;
mod sites;
mod star;
mod start;
mod straight;
mod tiling;
mod walk;
mod walker;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use delone_predicates::{Point2, Sign, orient2d};

pub use barycentric::{barycentric, weights as barycentric_weights};
pub use batch::{Batch, Walks, find, is_finite, squared};
pub use boundary::Boundary;
pub use boxes::{Boxes, length};
pub use coordinates::{Coordinates, coordinates};
pub use cross::{certain, cross, plain};
pub use nearest::nearest;
pub use output::Output;
pub use range::{in_unit, longest_side, seen_from, unit_of};
pub use segment::along;
pub use sites::Sites;
pub use star::{Place, Star};
pub use start::Start;
pub use tiling::{Side, next, prev};

use crate::arrays::{Given, Triangles};
use crate::error::Result;
use crate::points::Extent;
use crate::watch::Watch;
use walk::{Found, walk};

/// What is cached between calls for one triangulation.
#[derive(Debug)]
pub struct Kept {
    start: Start<2>,
    boundary: OnceLock<Boundary>,
    boxes: OnceLock<Boxes<2>>,
    sites: OnceLock<Sites<2>>,
    /// How many neighbors nearest-vertex queries have tested without finding the answer.
    strayed: AtomicUsize,
}

impl Kept {
    /// A tree of starting triangles for many calls; the rest is built when needed.
    pub fn of(given: &Triangles, watch: &Watch) -> Result<Self> {
        let first = |t: usize| given.point(given.simplices[t][0]);
        Ok(Self {
            start: Start::of(given.simplices.len(), first, watch)?,
            boundary: OnceLock::new(),
            boxes: OnceLock::new(),
            sites: OnceLock::new(),
            strayed: AtomicUsize::new(0),
        })
    }
}

/// A triangulation and its cache; 2-D by default.
pub struct Locator<'a, K = Kept, const D: usize = 2, const N: usize = 3> {
    /// The arrays.
    pub given: Given<'a, D, N>,
    pub(crate) kept: &'a K,
    /// Checked while something to be cached is built.
    pub(crate) watch: &'a Watch<'a>,
}

impl<K, const D: usize, const N: usize> Copy for Locator<'_, K, D, N> {}

// Not derived: that would require `Clone` of the cache.
impl<K, const D: usize, const N: usize> Clone for Locator<'_, K, D, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, K, const D: usize, const N: usize> Locator<'a, K, D, N> {
    /// A locator with the cache of the same arrays.
    pub fn new(given: Given<'a, D, N>, kept: &'a K, watch: &'a Watch<'a>) -> Self {
        Self { given, kept, watch }
    }
}

/// The location of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Located {
    /// In a triangle.
    Inside(Place),
    /// Outside of all triangles, strictly beyond this boundary edge if the boundary is convex.
    Outside(Side),
}

impl<'a> Locator<'a> {
    /// The boundary.
    pub fn boundary(&self) -> Result<&'a Boundary> {
        kept(&self.kept.boundary, || {
            Boundary::of(&self.given, self.watch)
        })
    }

    /// A triangle near `q`.
    #[inline]
    pub fn near(&self, q: Point2) -> usize {
        self.kept.start.near(q)
    }

    /// The vertices in boxes, once queries have tested in vain as many neighbors, now `more` of
    /// them, as there are points: about the cost of building the boxes.
    fn sites(&self, more: usize) -> Result<Option<&'a Sites<2>>> {
        let asked = self.kept.strayed.fetch_add(more, Ordering::Relaxed) + more;
        if asked < self.given.points.len() {
            return Ok(None);
        }
        kept(&self.kept.sites, || Sites::of(&self.given, self.watch)).map(Some)
    }

    /// Locates `q` by a walk from triangle `from`.
    #[inline]
    pub fn locate_from(&self, from: usize, q: Point2, star: &mut Star) -> Result<Located> {
        match walk(&self.given, from, q)? {
            Found::Inside(triangle, on) => {
                let first = star.first(&self.given, Place { triangle, on });
                if first.open && !self.boundary()?.convex {
                    let place = self.first_of_all(q)?;
                    return Ok(Located::Inside(place.unwrap_or(first.place)));
                }
                Ok(Located::Inside(first.place))
            }
            Found::Beyond(side) => self.beyond(side, q),
        }
    }

    /// Locates `q`; `None` if it is not finite or there is no triangle.
    pub fn locate(&self, q: Point2) -> Result<Option<Located>> {
        if !is_finite(&q) || self.given.simplices.is_empty() {
            return Ok(None);
        }
        let located = self.locate_from(self.near(q), q, &mut Star::default())?;
        Ok(Some(located))
    }

    /// What lies beyond a boundary edge: unless the boundary is convex, there may be more
    /// triangles.
    fn beyond(&self, side: Side, q: Point2) -> Result<Located> {
        if self.boundary()?.convex {
            return Ok(Located::Outside(side));
        }
        Ok(match self.first_of_all(q)? {
            Some(place) => Located::Inside(place),
            None => Located::Outside(side),
        })
    }

    /// The first of all triangles that contain `q`.
    fn first_of_all(&self, q: Point2) -> Result<Option<Place>> {
        let given = &self.given;
        let boxes = kept(&self.kept.boxes, || {
            Boxes::over(
                given.simplices.len(),
                |t| Extent::of(given.corners(t)),
                self.watch,
            )
        })?;
        let mut best: Option<Place> = None;
        boxes.around(q, |triangle| {
            if best.is_none_or(|b| triangle < b.triangle)
                && let Some(on) = holds(given, triangle, q)
            {
                best = Some(Place { triangle, on });
            }
        });
        Ok(best)
    }
}

/// On which edges `q` is, if the closed triangle contains it.
fn holds(given: &Triangles, t: usize, q: Point2) -> Option<[bool; 3]> {
    let [a, b, c] = given.corners(t);
    let signs = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)];
    (!signs.contains(&Sign::Negative)).then(|| signs.map(|s| s == Sign::Zero))
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
