//! The parts of point location that are specific to 2-D.

use std::sync::atomic::{AtomicUsize, Ordering};

use delone_predicates::{Point2, Sign};

use super::boundary::Boundary;
use super::locator::{Dimension, Located, Locator};
use super::sites::Sites;
use super::star::{First, Place, first_around};
use super::walk::{sides_of, walk};
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::watch::Watch;

/// What is kept of triangles.
#[derive(Debug)]
pub struct Plane {
    /// How many neighbors nearest-vertex queries have tested without finding the answer.
    strayed: AtomicUsize,
}

impl Dimension<2, 3> for Plane {
    type Boundary = Boundary;

    /// The depth of the tree costs about as much as a dozen triangles.
    const REACH: f64 = 64.0;

    fn of(_: &Triangles) -> Self {
        Self {
            strayed: AtomicUsize::new(0),
        }
    }

    fn boundary(given: &Triangles, watch: &Watch) -> Result<Boundary> {
        Boundary::of(given, watch)
    }

    fn is_convex(boundary: &Boundary) -> bool {
        boundary.convex
    }

    #[inline(always)]
    fn sides(corners: [Point2; 3], q: Point2) -> [Sign; 3] {
        sides_of(corners, q)
    }

    #[inline]
    fn walk(given: &Triangles, from: usize, q: Point2) -> Result<Located> {
        walk(given, from, q)
    }

    #[inline]
    fn first_around(given: &Triangles, place: Place) -> First<3> {
        first_around(given, place)
    }
}

impl<'a> Locator<'a, Plane, 2, 3> {
    /// The vertices in boxes, once queries have tested in vain as many neighbors, now `more` of
    /// them, as there are points: about the cost of building the boxes.
    pub(super) fn sites_after(&self, more: usize) -> Result<Option<&'a Sites<2>>> {
        let strayed = &self.kept.own.strayed;
        let tested = strayed.fetch_add(more, Ordering::Relaxed) + more;
        if tested < self.given.points.len() {
            return Ok(None);
        }
        self.sites().map(Some)
    }
}
