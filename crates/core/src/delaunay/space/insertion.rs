//! Bowyer-Watson insertion of points along the Hilbert curve.

use delone_predicates::{Point3, Sign, orient3d};

use super::cavity::{Kernel, Room};
use super::dispatch;
use super::rounds::STRIDES;
use super::sphere::Sphere;
use crate::base::error::Result;
use crate::base::points::collinear;
use crate::base::watch::Watch;
use crate::mesh::space::Mesh3;
use crate::order::Rounds;

/// Fills the empty `mesh` with the triangulation of `points`, which end with NaN for infinity, and
/// returns it with the sphere of each record, in the memory of `spheres`; `None` if the points span
/// no tetrahedron.
pub fn build<'a>(
    points: &'a [Point3],
    mesh: Mesh3<'a>,
    room: Room,
    spheres: Vec<Sphere>,
    watch: &Watch,
) -> Result<Option<(Mesh3<'a>, Vec<Sphere>)>> {
    let n = points.len() as u32 - 1;
    let Some(first) = first_tetrahedron(&points[..n as usize]) else {
        return Ok(None);
    };
    let mut kernel = Kernel::start(points, mesh, room, spheres, first)?;
    dispatch::run(&mut kernel, points, first, watch)?;
    Ok(Some(kernel.finish()))
}

/// Four vertices that span a tetrahedron, positively oriented: the first in the order of insertion
/// that extend a segment, a triangle, a tetrahedron.
fn first_tetrahedron(points: &[Point3]) -> Option<[u32; 4]> {
    let n = points.len() as u32;
    let at = |v: u32| points[v as usize];
    let mut order = Rounds::over(n, STRIDES);
    let (a, b) = (order.next()?, order.next()?);
    let c = order.find(|&c| !collinear(at(a), at(b), at(c)))?;
    for d in order {
        match orient3d(at(a), at(b), at(c), at(d)) {
            Sign::Positive => return Some([a, b, c, d]),
            Sign::Negative => return Some([b, a, c, d]),
            Sign::Zero => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_tetrahedron_is_positive() {
        let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
        let cube: Vec<Point3> = (0..8).map(corner).collect();
        let [a, b, c, d] = first_tetrahedron(&cube).unwrap().map(|v| cube[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
        assert_eq!(first_tetrahedron(&cube[..4]), None);
    }
}
