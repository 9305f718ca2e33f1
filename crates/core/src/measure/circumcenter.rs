//! The circumcenters of triangles and tetrahedra.

use super::batch::each;
use super::center::{Center, Centered};
use super::{circle, sphere};
use crate::base::error::Result;
use crate::base::watch::Watch;

/// The circumcenters of triangles, each coordinate within 4 units in the last place; infinite if
/// out of range.
pub fn circumcenters2(
    points: &[[f64; 2]],
    simplices: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; 2]>> {
    each(
        points,
        simplices,
        workers,
        watch,
        at::<circle::Corners, 2, 3>,
    )
}

/// The circumcenters of tetrahedra.
pub fn circumcenters3(
    points: &[[f64; 3]],
    simplices: &[[i32; 4]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; 3]>> {
    each(
        points,
        simplices,
        workers,
        watch,
        at::<sphere::Corners, 3, 4>,
    )
}

fn at<C: Centered<D, N>, const D: usize, const N: usize>(corners: [[f64; D]; N]) -> [f64; D] {
    let corners = C::new(corners, [0.0; N]);
    match corners.center() {
        Center::At(at) => at,
        Center::Beyond(_) => corners.coordinates(),
    }
}
