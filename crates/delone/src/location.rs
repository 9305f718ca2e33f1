//! Where a query point lies in a triangulation.

/// Where a point lies: `D` is the dimension, `N` the number of corners of a simplex.
///
/// ```
/// use delone::{Location, Triangulation};
///
/// let t = Triangulation::new(&[[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])?;
/// let heights = [0.0, 8.0, 4.0];
/// let Location::Inside { simplex, weights } = t.locate(&[[1.0, 2.0]])?[0] else { panic!() };
/// let corners = t.simplices().nth(simplex).unwrap();
/// let height: f64 = (0..3).map(|k| weights[k] * heights[corners[k]]).sum();
/// assert_eq!(height, 4.0);
/// let Location::Outside { facet, weights, .. } = t.locate(&[[1.0, -2.0]])?[0] else { panic!() };
/// assert_eq!((facet, weights), ([0, 1], [0.75, 0.25]));
/// # Ok::<(), delone::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Location<const D: usize, const N: usize> {
    /// In a simplex, which is closed: a point on an edge or a vertex is inside.
    Inside {
        /// The simplex; the first of those that contain the point.
        simplex: usize,
        /// Barycentric weights of its corners: none is negative, and their sum is 1.
        weights: [f64; N],
    },
    /// Outside of all simplices. If the nearest point is a vertex, several facets and simplices are as
    /// near, and any of them is given.
    Outside {
        /// The simplex at the nearest point of the boundary.
        simplex: usize,
        /// The boundary edge, or in 3-D the face, that the nearest point lies on.
        facet: [usize; D],
        /// Weights of the vertices of the facet: their weighted mean is the nearest point.
        weights: [f64; D],
    },
}

impl<const D: usize, const N: usize> Location<D, N> {
    /// The simplex that contains the point; `None` outside.
    pub fn simplex(&self) -> Option<usize> {
        match *self {
            Self::Inside { simplex, .. } => Some(simplex),
            Self::Outside { .. } => None,
        }
    }
}
