//! Triangulations as arrays: vertices are rows of points, neighbors are simplices or -1 outside.
//! Simplices are triangles, `N` = 3 corners with `D` = 2 coordinates, or tetrahedra, 4 with 3.
//! `Side` leads from simplex to simplex by neighbors, never by vertices: so the two sides of a facet
//! may name different rows with equal coordinates.

/// A given triangulation. Vertices must be rows of `points`, neighbors simplices or -1.
#[derive(Debug, Clone, Copy)]
pub struct Given<'a, const D: usize, const N: usize> {
    /// Coordinates, finite.
    pub points: &'a [[f64; D]],
    /// The vertices of each simplex, positively oriented.
    pub simplices: &'a [[i32; N]],
    /// The simplex opposite each corner, -1 outside.
    pub neighbors: &'a [[i32; N]],
}

/// A corner of a simplex, and the opposite facet: an edge of a triangle, a face of a tetrahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The simplex.
    pub simplex: usize,
    /// The corner, below `N`.
    pub corner: usize,
}

/// The corners of the facet opposite each corner of a tetrahedron, from the side of that corner: a
/// facet followed by its opposite corner is positively oriented if the tetrahedron is.
pub const FACETS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];
/// The same facets counterclockwise seen from outside.
pub const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// Triangles in 2-D.
pub type Triangles<'a> = Given<'a, 2, 3>;
/// Tetrahedra in 3-D.
pub type Tetrahedra<'a> = Given<'a, 3, 4>;

impl<const D: usize, const N: usize> Given<'_, D, N> {
    /// The coordinates of a vertex.
    #[inline]
    pub fn point(&self, v: i32) -> [f64; D] {
        self.points[v as usize]
    }

    /// The coordinates of the corners of a simplex.
    #[inline]
    pub fn corners(&self, t: usize) -> [[f64; D]; N] {
        self.simplices[t].map(|v| self.point(v))
    }

    /// The vertex at a corner.
    #[inline]
    pub fn vertex(&self, side: Side) -> i32 {
        self.simplices[side.simplex][side.corner]
    }

    /// The coordinates of the vertex at a corner.
    #[inline]
    pub fn at(&self, side: Side) -> [f64; D] {
        self.point(self.vertex(side))
    }

    /// The same facet seen from the simplex beyond; `None` at the boundary.
    #[inline]
    pub fn beyond(&self, side: Side) -> Option<Side> {
        let t = self.neighbors[side.simplex][side.corner];
        if t < 0 {
            return None;
        }
        let back = &self.neighbors[t as usize];
        let here = side.simplex as i32;
        // A sum instead of a search, whose branches would be unpredictable.
        let corner: usize = (1..N).map(|k| k * usize::from(back[k] == here)).sum();
        Some(Side {
            simplex: t as usize,
            // Invalid arrays, in which two facets are shared, must not cause access out of range.
            corner: corner.min(N - 1),
        })
    }
}

/// A computed triangulation: one row per simplex.
#[derive(Debug, Default)]
pub struct Arrays<const N: usize> {
    /// The vertices of each, positively oriented.
    pub simplices: Vec<[i32; N]>,
    /// The simplex opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; N]>,
}

impl Tetrahedra<'_> {
    /// The vertices of the face opposite a corner, counterclockwise seen from outside.
    #[inline]
    pub fn face(&self, side: Side) -> [i32; 3] {
        OUTWARD[side.corner].map(|corner| self.vertex(Side { corner, ..side }))
    }
}
