//! The common interface of the centers of triangles and tetrahedra.

/// A center, within or beyond the range of doubles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Center<const D: usize> {
    /// Its rounded coordinates.
    At([f64; D]),
    /// A coordinate is beyond the range of doubles. In 2-D it is infinite here, and the other one
    /// is rounded; in 3-D this is the direction of the center, of length 1.
    Beyond([f64; D]),
}

/// The sites of a simplex and their weights.
pub(crate) trait Centered<const D: usize, const N: usize>: Copy {
    /// Corners with their weights, 0 for none.
    fn new(points: [[f64; D]; N], weights: [f64; N]) -> Self;
    /// The center, each coordinate within 4 units in the last place.
    fn center(&self) -> Center<D>;
    /// The center, each coordinate rounded correctly.
    fn rounded(&self) -> Center<D>;
    /// The center, each coordinate rounded correctly, and infinite beyond the range of doubles.
    fn coordinates(&self) -> [f64; D];
}
