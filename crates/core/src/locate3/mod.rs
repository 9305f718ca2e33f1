//! 3-D point location: exact, boundary included, for any tiling in exported arrays.
//!
//! The rooms are those of `locate`, whose `batch` takes queries in order here as well: `Kept` has a tree
//! of starts, `walker` goes from query to query, `star` finds the first of several that hold a point,
//! `boundary` what is nearest outside.

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

/// What is kept between calls for one triangulation.
#[derive(Debug)]
pub struct Kept {
    /// All points: beyond it there is no tetrahedron.
    extent: Extent<3>,
    start: Start<3>,
    boundary: OnceLock<Boundary>,
    boxes: OnceLock<Boxes<3>>,
    sites: OnceLock<Sites<3>>,
}

impl Kept {
    /// A tree of starts for many calls; the rest is found out when it is needed.
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

/// A triangulation of space and what is kept for it.
pub type Locator<'a> = locate::Locator<'a, Kept, 3, 4>;
/// Queries in space of one call.
pub type Batch<'a> = locate::Batch<'a, Kept, 3, 4>;

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Located {
    /// In a tetrahedron.
    Inside(Place),
    /// Outside of all; where a walk has met a boundary face with the point strictly beyond, by this one.
    Outside(Option<Side>),
}

impl<'a> Locator<'a> {
    /// A tetrahedron near `q`.
    #[inline]
    pub fn near(&self, q: Point3) -> usize {
        self.kept.start.near(q)
    }

    /// Whether one comparison tells that `q` is outside of all.
    #[inline]
    pub fn is_far(&self, q: Point3) -> bool {
        let Extent { min, max } = self.kept.extent;
        (0..3).any(|k| q[k] < min[k] || q[k] > max[k])
    }

    /// Whether `q` is strictly beyond a boundary face, and thereby outside of all.
    #[inline]
    pub fn is_beyond(&self, side: Side, q: Point3) -> Result<bool> {
        let [a, b, c] = self.given.face(side).map(|v| self.given.point(v));
        Ok(self.boundary()?.convex && orient3d(a, b, c, q) == Sign::Positive)
    }

    /// Where `q` is, on the way from tetrahedron `from`.
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

    /// Where `q` is; nothing for what is not finite, or where there is no tetrahedron.
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

    /// The boundary face with the nearest point to `q`, and how its corners share in that.
    fn nearest_beside(
        &self,
        q: Point3,
        last: &mut Option<usize>,
    ) -> Result<Option<(Side, [f64; 3])>> {
        self.boundary()?.nearest(&self.given, q, last, self.watch)
    }

    /// The vertices, for the nearest of them.
    fn sites(&self) -> Result<&'a Sites<3>> {
        kept(&self.kept.sites, || Sites::of(&self.given, self.watch))
    }

    /// The first tetrahedron that holds `q`, of all.
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
