//! Checks that arrays of unknown origin are a mesh: neighbors agree, simplices are positively
//! oriented.
//!
//! Indices must be in range. Takes linear time and uses all workers. Whether the mesh is Delaunay
//! is checked by the `validate` modules.

use delone_predicates::{Sign, orient2d, orient3d};

use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::parallel;
use crate::base::watch::Watch;

/// Simplices that one task checks.
const SHARE: usize = 1 << 15;

/// The first fault that the check finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A simplex has a neighbor that does not list it, or not across the same side.
    Neighbors(usize),
    /// A simplex is flat or negatively oriented.
    Orientation(usize),
}

/// The first fault of triangles. If a triangle has several, the one of its neighbors is reported.
pub fn triangles(given: Given<2, 3>, workers: usize, watch: &Watch) -> Result<Option<Fault>> {
    first(given, workers, watch, |t| {
        let [a, b, c] = given.corners(t);
        orient2d(a, b, c)
    })
}

/// The first fault of tetrahedra.
pub fn tetrahedra(given: Given<3, 4>, workers: usize, watch: &Watch) -> Result<Option<Fault>> {
    first(given, workers, watch, |t| {
        let [a, b, c, d] = given.corners(t);
        orient3d(a, b, c, d)
    })
}

/// The first fault of simplices whose orientation is given.
pub fn first<const D: usize, const N: usize>(
    given: Given<D, N>,
    workers: usize,
    watch: &Watch,
    orientation: impl Fn(usize) -> Sign + Sync,
) -> Result<Option<Fault>> {
    let count = given.simplices.len();
    let shares = (0..count).step_by(SHARE).collect();
    let found = parallel::map(workers, shares, |start| {
        watch.check()?;
        for t in start..count.min(start + SHARE) {
            if !is_mutual(given, t) {
                return Ok(Some(Fault::Neighbors(t)));
            }
            if orientation(t) != Sign::Positive {
                return Ok(Some(Fault::Orientation(t)));
            }
        }
        Ok(None)
    });
    let found = found.into_iter().collect::<Result<Vec<_>>>()?;
    Ok(found.into_iter().flatten().next())
}

/// Whether each neighbor of simplex `t` lists `t` across the side that both share.
fn is_mutual<const D: usize, const N: usize>(given: Given<D, N>, t: usize) -> bool {
    let (corners, beyond) = (given.simplices[t], given.neighbors[t]);
    (0..N).filter(|&k| beyond[k] >= 0).all(|k| {
        let (theirs, back) = (
            given.simplices[beyond[k] as usize],
            given.neighbors[beyond[k] as usize],
        );
        (0..N).any(|j| back[j] == t as i32 && shares_side((corners, k), (theirs, j)))
    })
}

/// Whether the sides opposite corner `k` of one simplex and opposite corner `j` of another have the
/// same vertices. If both are positively oriented, they lie on different sides of it.
fn shares_side<const N: usize>((one, k): ([i32; N], usize), (other, j): ([i32; N], usize)) -> bool {
    if N == 3 {
        // Reversed: two positively oriented triangles traverse a shared edge in opposite
        // directions.
        return one[(k + 1) % N] == other[(j + 2) % N] && one[(k + 2) % N] == other[(j + 1) % N];
    }
    let is_there = |v: i32| (0..N).any(|i| i != j && other[i] == v);
    (0..N).filter(|&i| i != k).all(|i| is_there(one[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn fault(simplices: [[i32; 3]; 2], neighbors: [[i32; 3]; 2]) -> Option<Fault> {
        let given = Given {
            points: &POINTS,
            simplices: &simplices,
            neighbors: &neighbors,
        };
        triangles(given, 1, &Watch::idle()).unwrap()
    }

    #[test]
    fn faults_are_found() {
        let (right, beside) = ([[0, 1, 2], [0, 2, 3]], [[-1, 1, -1], [-1, -1, 0]]);
        assert_eq!(fault(right, beside), None);
        let alone = [[-1, 1, -1], [-1, -1, -1]];
        assert_eq!(fault(right, alone), Some(Fault::Neighbors(0)));
        let elsewhere = [[-1, 1, -1], [-1, 0, -1]];
        assert_eq!(fault(right, elsewhere), Some(Fault::Neighbors(0)));
        let turned = [[0, 1, 2], [0, 3, 2]];
        assert_eq!(fault(turned, [[-1; 3]; 2]), Some(Fault::Orientation(1)));
    }

    #[test]
    fn the_first_fault_of_many_simplices_is_named() {
        let mut simplices = vec![[0, 1, 2]; 3 * SHARE];
        simplices[2 * SHARE + 5] = [0, 2, 1];
        simplices[2 * SHARE + 9] = [0, 2, 1];
        let neighbors = vec![[-1; 3]; 3 * SHARE];
        let given = Given {
            points: &POINTS,
            simplices: &simplices,
            neighbors: &neighbors,
        };
        for workers in [1, 4] {
            let found = triangles(given, workers, &Watch::idle()).unwrap();
            assert_eq!(found, Some(Fault::Orientation(2 * SHARE + 5)));
        }
    }
}
