//! 3-D point location: exact, boundary included, for any tiling in exported arrays.
//!
//! The parts are those of `locate`, whose `batch` sorts queries here as well: `Kept` has a tree of
//! starting tetrahedra, `walker` goes from query to query, `star` finds the first of several
//! tetrahedra that contain a point, `boundary` the nearest face outside.

mod barycentric;
mod boundary;
mod coordinates;
mod excess;
mod face;
mod foot;
mod nearest;
mod star;
mod tiling;
mod walk;
mod walker;

use std::sync::OnceLock;

use delone_predicates::{Point3, Sign, orient3d};

pub use barycentric::barycentric;
pub use coordinates::{Coordinates, Within, coordinates, within};
pub use nearest::nearest;
pub use star::{Place, Star};
pub use tiling::{FACES, Side, Tetrahedra};

use crate::error::Result;
pub use crate::locate::find;
use crate::locate::{self, Boxes, Sites, Start, is_finite, kept};
use crate::points::Extent;
use crate::watch::Watch;
use boundary::Boundary;
use walk::{Found, walk};

/// What is cached between calls for one triangulation.
#[derive(Debug)]
pub struct Kept {
    /// The bounding box of all points: there is no tetrahedron outside.
    extent: Extent<3>,
    start: Start<3>,
    boundary: OnceLock<Boundary>,
    boxes: OnceLock<Boxes<3>>,
    sites: OnceLock<Sites<3>>,
}

impl Kept {
    /// A tree of starting tetrahedra for many calls; the rest is built when needed.
    pub fn of(given: &Tetrahedra, watch: &Watch) -> Result<Self> {
        let first = |t: usize| given.point(given.simplices[t][0]);
        Ok(Self {
            extent: Extent::of(given.points.iter().copied()),
            start: Start::of(given.simplices.len(), first, watch)?,
            boundary: OnceLock::new(),
            boxes: OnceLock::new(),
            sites: OnceLock::new(),
        })
    }
}

/// A 3-D triangulation and its cache.
pub type Locator<'a> = locate::Locator<'a, Kept, 3, 4>;
/// The 3-D queries of one call.
pub type Batch<'a> = locate::Batch<'a, Kept, 3, 4>;

/// The location of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Located {
    /// In a tetrahedron.
    Inside(Place),
    /// Outside of all tetrahedra; with a boundary face if a walk found one that has the point
    /// strictly outside.
    Outside(Option<Side>),
}

impl<'a> Locator<'a> {
    /// A tetrahedron near `q`.
    #[inline]
    pub fn near(&self, q: Point3) -> usize {
        self.kept.start.near(q)
    }

    /// Whether one comparison proves that `q` is outside of all.
    #[inline]
    pub fn is_far(&self, q: Point3) -> bool {
        let Extent { min, max } = self.kept.extent;
        (0..3).any(|k| q[k] < min[k] || q[k] > max[k])
    }

    /// Whether `q` is strictly beyond a boundary face of a convex body, and so outside of all.
    #[inline]
    pub fn is_beyond(&self, side: Side, q: Point3) -> Result<bool> {
        let [a, b, c] = self.given.face(side).map(|v| self.given.point(v));
        Ok(self.boundary()?.convex && orient3d(a, b, c, q) == Sign::Positive)
    }

    /// Locates `q` by a walk from tetrahedron `from`.
    #[inline]
    pub fn locate_from(&self, from: usize, q: Point3, star: &mut Star) -> Result<Located> {
        match walk(&self.given, from, q) {
            Some(Found::Inside(place)) => {
                let first = star.first(&self.given, place);
                if first.open && !self.boundary()?.convex {
                    let place = self.first_of_all(q)?;
                    return Ok(Located::Inside(place.unwrap_or(first.place)));
                }
                Ok(Located::Inside(first.place))
            }
            Some(Found::Beyond(side)) if self.boundary()?.convex => {
                Ok(Located::Outside(Some(side)))
            }
            Some(Found::Beyond(side)) => {
                let found = self.first_of_all(q)?;
                Ok(found.map_or(Located::Outside(Some(side)), Located::Inside))
            }
            None => {
                let found = self.first_of_all(q)?;
                Ok(found.map_or(Located::Outside(None), Located::Inside))
            }
        }
    }

    /// Locates `q`; `None` if it is not finite or there is no tetrahedron.
    pub fn locate(&self, q: Point3) -> Result<Option<Located>> {
        if !is_finite(&q) || self.given.simplices.is_empty() {
            return Ok(None);
        }
        if self.is_far(q) {
            return Ok(Some(Located::Outside(None)));
        }
        let located = self.locate_from(self.near(q), q, &mut Star::default())?;
        Ok(Some(located))
    }

    /// The boundary.
    pub fn boundary(&self) -> Result<&'a Boundary> {
        kept(&self.kept.boundary, || {
            Boundary::of(&self.given, self.watch)
        })
    }

    /// The boundary face nearest to `q`, and the weights of its corners in the nearest point.
    fn nearest_beside(
        &self,
        q: Point3,
        last: &mut Option<usize>,
    ) -> Result<Option<(Side, [f64; 3])>> {
        self.boundary()?.nearest(&self.given, q, last, self.watch)
    }

    /// The vertices, for nearest-vertex queries.
    fn sites(&self) -> Result<&'a Sites<3>> {
        kept(&self.kept.sites, || Sites::of(&self.given, self.watch))
    }

    /// The first of all tetrahedra that contain `q`.
    #[cold]
    #[inline(never)]
    fn first_of_all(&self, q: Point3) -> Result<Option<Place>> {
        let given = &self.given;
        let boxes = kept(&self.kept.boxes, || {
            Boxes::over(
                given.simplices.len(),
                |t| Extent::of(given.corners(t)),
                self.watch,
            )
        })?;
        let mut best: Option<Place> = None;
        boxes.around(q, |t| {
            if best.is_none_or(|b| t < b.simplex) {
                let signs = given.sides(t, q);
                if !signs.contains(&Sign::Negative) {
                    best = Some(Place::of(t, signs));
                }
            }
        });
        Ok(best)
    }
}
