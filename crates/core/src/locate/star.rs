//! The first of the simplices that contain a point.
//!
//! A query on a facet, an edge or a vertex is in several simplices. The one with the smallest number
//! is the answer, so it is independent of where a walk came from, and thus of the other queries and
//! the threads.

use delone_predicates::Sign;

use crate::base::arrays::{Side, Triangles};

/// A point in a closed simplex; 2-D by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place<const N: usize = 3> {
    /// The simplex, the first one that contains the point.
    pub simplex: usize,
    /// Whether the point is on the facet opposite each corner.
    pub on: [bool; N],
}

impl<const N: usize> Place<N> {
    /// The place given by the sides of the facets, none of which is negative.
    #[inline]
    pub fn of(simplex: usize, sides: [Sign; N]) -> Self {
        Self {
            simplex,
            on: sides.map(|s| s == Sign::Zero),
        }
    }

    /// Whether the point is on no facet.
    #[inline]
    pub fn is_interior(&self) -> bool {
        !self.on.iter().any(|&on| on)
    }

    /// The corner at which the point is.
    #[inline]
    pub fn site(&self) -> Option<usize> {
        let off = self.on.iter().filter(|&&on| !on).count();
        (off == 1).then(|| self.on.iter().position(|&on| !on))?
    }
}

impl Place {
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
            simplex: side.simplex,
            on: std::array::from_fn(|k| k != side.corner),
        }
    }

    fn on_edge(side: Side) -> Self {
        Self {
            simplex: side.simplex,
            on: std::array::from_fn(|k| k == side.corner),
        }
    }
}

/// The first of the simplices that can be reached around a vertex, an edge or a face.
#[derive(Debug, Clone, Copy)]
pub struct First<const N: usize> {
    /// The place in that simplex.
    pub place: Place<N>,
    /// Whether there may be simplices that contain the point without being reached if the boundary
    /// is not convex.
    pub open: bool,
}

/// The answer for the last query that was not inside a simplex: equal queries are consecutive along
/// the curve, and a vertex may have very many simplices.
#[derive(Debug, Default)]
pub struct Star<const N: usize> {
    last: Option<First<N>>,
}

impl<const N: usize> Star<N> {
    /// The first of the simplices that contain the point at `place`, which is on a facet; by
    /// `around` if it must be searched.
    #[inline]
    pub fn first(
        &mut self,
        place: Place<N>,
        around: impl FnOnce(Place<N>) -> First<N>,
    ) -> First<N> {
        // The next walk to this place ends in the simplex found now.
        match self.last {
            Some(last) if last.place == place => last,
            _ => *self.last.insert(around(place)),
        }
    }
}

/// The first of the triangles around the edge or the vertex at `place`.
#[inline(never)]
pub fn first_around(given: &Triangles, place: Place) -> First<3> {
    let simplex = place.simplex;
    if let Some(corner) = place.edge() {
        let place = match given.beyond(Side { simplex, corner }) {
            Some(there) if there.simplex < simplex => Place::on_edge(there),
            _ => place,
        };
        return First { place, open: false };
    }
    let Some(corner) = place.site() else {
        return First { place, open: false };
    };
    let mut least = Side { simplex, corner };
    let open = given.around(least, |side| {
        least = least.min(side);
        true
    });
    let place = Place::at_corner(least);
    First { place, open }
}
