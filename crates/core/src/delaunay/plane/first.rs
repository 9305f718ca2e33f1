//! The triangle from which an incremental insertion starts.

use delone_predicates::{Point2, Sign, orient2d};

/// The first two vertices of `order` and the first that is not collinear with them,
/// counterclockwise; `None` if all are collinear.
pub fn first_triangle(points: &[Point2], mut order: impl Iterator<Item = u32>) -> Option<[u32; 3]> {
    let at = |v: u32| points[v as usize];
    let (a, b) = (order.next()?, order.next()?);
    order.find_map(|c| match orient2d(at(a), at(b), at(c)) {
        Sign::Positive => Some([a, b, c]),
        Sign::Negative => Some([b, a, c]),
        Sign::Zero => None,
    })
}
