//! Bulk triangulation by cavity insertion along the curve.
//!
//! The order is a biased randomised one in the sense of N. Amenta, S. Choi and G. Rote, "Incremental
//! constructions con BRIO" (2003), without the dice: every 16th point along the curve, then all. On
//! 10^5 uniform points one round takes 954 ns a point, these two 732.

use delone_predicates::{Point3, Sign, orient3d};

use super::cavity::{Kernel, Room};
use super::dispatch;
use crate::error::Result;
use crate::mesh3::Mesh3;
use crate::points::collinear;
use crate::watch::Watch;

/// Strides of the rounds.
const STRIDES: [u32; 2] = [16, 1];

/// Records met between two looks at the watch.
const WATCH_EVERY: usize = 1 << 16;

/// Fills the empty `mesh` with the triangulation of `points`, which end with NaN for infinity, and
/// returns it with its spheres in `room`; nothing where the points span no tetrahedron.
pub fn build<'a>(
    points: &'a [Point3],
    mesh: Mesh3<'a>,
    room: Room,
    watch: &Watch,
) -> Result<Option<(Mesh3<'a>, Room)>> {
    let n = points.len() as u32 - 1;
    let Some(first) = first_tetrahedron(&points[..n as usize]) else {
        return Ok(None);
    };
    let mut kernel = Kernel::start(points, mesh, room, first)?;
    dispatch::run(&mut kernel, points, first, watch)?;
    Ok(Some(kernel.finish()))
}

/// Inserts all points but `first`; compiled for each processor by `dispatch`.
#[inline(always)]
pub(super) fn insert_all(
    kernel: &mut Kernel,
    points: &[Point3],
    first: [u32; 4],
    watch: &Watch,
) -> Result<()> {
    let mut order = Rounds::over(points.len() as u32 - 1).filter(|v| !first.contains(v));
    let mut near = 0;
    let mut look_at = WATCH_EVERY;
    let mut next = order.next();
    while let Some(p) = next {
        next = order.next();
        near = kernel.insert(p, near, points[next.unwrap_or(p) as usize])?;
        if kernel.work() > look_at {
            watch.check()?;
            look_at = kernel.work() + WATCH_EVERY;
        }
    }
    Ok(())
}

/// Four vertices that span a tetrahedron, positively oriented, the first of each kind in the order of
/// insertion.
fn first_tetrahedron(points: &[Point3]) -> Option<[u32; 4]> {
    let n = points.len() as u32;
    let at = |v: u32| points[v as usize];
    let mut order = Rounds::over(n);
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

/// The numbers below n in rounds of falling stride, each once.
struct Rounds {
    n: u32,
    round: usize,
    at: u32,
}

impl Rounds {
    fn over(n: u32) -> Self {
        Self { n, round: 0, at: 0 }
    }
}

impl Iterator for Rounds {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        loop {
            let stride = *STRIDES.get(self.round)?;
            let i = self.at;
            if i >= self.n {
                self.round += 1;
                self.at = 0;
                continue;
            }
            self.at += stride;
            if self.round == 0 || !i.is_multiple_of(STRIDES[self.round - 1]) {
                return Some(i);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_name_each_number_once() {
        for n in [0, 1, 15, 16, 17, 1000] {
            let mut all: Vec<u32> = Rounds::over(n).collect();
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_tetrahedron_is_positive() {
        let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
        let cube: Vec<Point3> = (0..8).map(corner).collect();
        let [a, b, c, d] = first_tetrahedron(&cube).unwrap().map(|v| cube[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
        assert_eq!(first_tetrahedron(&cube[..4]), None);
    }
}
