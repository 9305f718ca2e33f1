//! The first of the triangles that contain a point.
//!
//! A query on an edge or a vertex is in several triangles. The one with the smallest number is the
//! answer, so it is independent of where a walk came from, and thus of the other queries and the
//! threads.

use super::tiling::Side;
use crate::arrays::Triangles;

/// A point in a closed triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The triangle, the first one that contains the point.
    pub triangle: usize,
    /// Whether the point is on the edge opposite each corner.
    pub on: [bool; 3],
}

impl Place {
    /// The corner at which the point is.
    #[inline]
    pub fn site(&self) -> Option<usize> {
        match self.on {
            [true, true, _] => Some(2),
            [true, _, true] => Some(1),
            [_, true, true] => Some(0),
            _ => None,
        }
    }

    /// The corner opposite the open edge on which the point is.
    pub fn edge(&self) -> Option<usize> {
        match self.on {
            [true, false, false] => Some(0),
            [false, true, false] => Some(1),
            [false, false, true] => Some(2),
            _ => None,
        }
    }

    fn at_corner(side: Side) -> Self {
        Self {
            triangle: side.triangle,
            on: std::array::from_fn(|k| k != side.corner),
        }
    }

    fn on_edge(side: Side) -> Self {
        Self {
            triangle: side.triangle,
            on: std::array::from_fn(|k| k == side.corner),
        }
    }
}

/// The answer for the last vertex: equal queries are consecutive along the curve, and a vertex may
/// have very many triangles.
#[derive(Debug, Default)]
pub struct Star {
    last: Option<(Side, First)>,
}

/// The first of the triangles that can be reached around a vertex or an edge.
#[derive(Debug, Clone, Copy)]
pub struct First {
    /// The place in that triangle.
    pub place: Place,
    /// Whether the point is a boundary vertex: if the boundary is not convex, there may be
    /// triangles that touch it without being reached.
    pub open: bool,
}

impl Star {
    /// The first of the triangles that contain the point at `place`.
    #[inline]
    pub fn first(&mut self, given: &Triangles, place: Place) -> First {
        if place.on == [false; 3] {
            return First { place, open: false };
        }
        self.first_beside(given, place)
    }

    #[inline(never)]
    fn first_beside(&mut self, given: &Triangles, place: Place) -> First {
        let triangle = place.triangle;
        if let Some(corner) = place.edge() {
            let place = match given.beyond(Side { triangle, corner }) {
                Some(there) if there.triangle < triangle => Place::on_edge(there),
                _ => place,
            };
            return First { place, open: false };
        }
        let Some(corner) = place.site() else {
            return First { place, open: false };
        };
        let here = Side { triangle, corner };
        if let Some((asked, first)) = self.last
            && asked == here
        {
            return first;
        }
        let mut least = here;
        let open = given.around(here, |side| {
            least = least.min(side);
            true
        });
        let place = Place::at_corner(least);
        // The next walk to this vertex starts in the triangle found now.
        self.last = Some((least, First { place, open }));
        First { place, open }
    }
}
