//! Triangulations as arrays: vertices are rows of points, neighbors are simplices or -1 outside.
//! Simplices are triangles, `N` = 3 corners with `D` = 2 coordinates, or tetrahedra, 4 with 3.

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
}

/// A computed triangulation: one row per simplex.
#[derive(Debug, Default)]
pub struct Arrays<const N: usize> {
    /// The vertices of each, positively oriented.
    pub simplices: Vec<[i32; N]>,
    /// The simplex opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; N]>,
}
