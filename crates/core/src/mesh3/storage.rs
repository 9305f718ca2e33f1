//! Records of tetrahedra, in two arrays that the export hands out as they are.

use crate::error::{Error, Result};
use crate::memory::{push, with_room};

/// A facet: `4 t + k`.
pub type Code = u32;

/// Records that codes of 32 bits can address.
pub const LIMIT: usize = 1 << 30;

/// The corners of the facet opposite each corner, from the side of that corner: a facet and its
/// corner, in this order, are positively oriented when the tetrahedron is.
pub const FACETS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// The tetrahedron of a code.
#[inline]
pub fn tetrahedron(e: Code) -> u32 {
    e >> 2
}

/// The corner that a facet is opposite to.
#[inline]
pub fn corner(e: Code) -> usize {
    (e & 3) as usize
}

/// A mesh of tetrahedra and ghosts.
///
/// The arrays are of `i32`, bit by bit the `u32` that they hold, since that is what leaves the core.
#[derive(Debug)]
pub struct Mesh3 {
    pub(super) corners: Vec<[i32; 4]>,
    pub(super) opposite: Vec<[i32; 4]>,
    /// Records that hold nothing.
    pub(super) free: Vec<u32>,
    infinite: u32,
}

impl Mesh3 {
    /// An empty mesh for `vertices` vertices, with room for as many tetrahedra as scattered points have.
    pub fn with_vertices(vertices: usize) -> Result<Self> {
        // A uniform point has 6.77 tetrahedra.
        let room = (7 * vertices + 64).min(LIMIT);
        Ok(Self {
            corners: with_room(room)?,
            opposite: with_room(room)?,
            free: Vec::new(),
            infinite: vertices as u32,
        })
    }

    /// The number of records, of which some may be free.
    #[inline]
    pub fn records(&self) -> usize {
        self.corners.len()
    }

    /// The vertex at infinity.
    #[inline]
    pub fn infinite(&self) -> u32 {
        self.infinite
    }

    /// The corners of tetrahedron t.
    #[inline]
    pub fn corners(&self, t: u32) -> [u32; 4] {
        self.corners[t as usize].map(|v| v as u32)
    }

    /// The codes of its facets as seen from the other sides.
    #[inline]
    pub fn opposites(&self, t: u32) -> [Code; 4] {
        self.opposite[t as usize].map(|e| e as Code)
    }

    /// The facet `e` as seen from the other side.
    #[inline]
    pub fn opposite(&self, e: Code) -> Code {
        self.opposite[tetrahedron(e) as usize][corner(e)] as Code
    }

    /// The corner of t that is infinite, for ghosts.
    #[inline]
    pub fn infinite_corner(&self, t: u32) -> Option<usize> {
        self.corners(t).iter().position(|&v| v == self.infinite)
    }

    /// Puts the corners of t in place.
    #[inline]
    pub fn set(&mut self, t: u32, corners: [u32; 4]) {
        self.corners[t as usize] = corners.map(|v| v as i32);
    }

    /// Makes facets `e` and `f` two sides of one.
    #[inline]
    pub fn link(&mut self, e: Code, f: Code) {
        self.opposite[tetrahedron(e) as usize][corner(e)] = f as i32;
        self.opposite[tetrahedron(f) as usize][corner(f)] = e as i32;
    }

    /// A record to be filled.
    #[inline]
    pub fn fresh(&mut self) -> Result<u32> {
        if let Some(t) = self.free.pop() {
            return Ok(t);
        }
        let t = self.corners.len();
        if t == LIMIT {
            return Err(Error::TooManyTetrahedra { limit: LIMIT });
        }
        push(&mut self.corners, [0; 4])?;
        push(&mut self.opposite, [0; 4])?;
        Ok(t as u32)
    }

    /// Gives a record back.
    #[inline]
    pub fn release(&mut self, t: u32) {
        self.free.push(t);
    }

    /// The first tetrahedron, positively oriented, in an empty mesh, with its four ghosts.
    pub fn first(&mut self, corners: [u32; 4]) -> Result<u32> {
        let mut all = [0; 5];
        for t in &mut all {
            *t = self.fresh()?;
        }
        self.set(all[0], corners);
        for k in 0..4 {
            // Seen from outside, the facet turns the other way.
            let [a, b, c] = FACETS[k].map(|i| corners[i]);
            self.set(all[k + 1], [b, a, c, self.infinite]);
            self.link(4 * all[0] + k as u32, 4 * all[k + 1] + 3);
        }
        for &s in &all[1..] {
            for k in 0..3 {
                // The other ghost of the two finite corners beside corner k.
                let ends = [(k + 1) % 3, (k + 2) % 3].map(|i| self.corners(s)[i]);
                for &t in &all[1..] {
                    let third = self.corners(t)[..3].iter().position(|v| !ends.contains(v));
                    if s != t && ends.iter().all(|v| self.corners(t).contains(v)) {
                        self.link(4 * s + k as u32, 4 * t + third.unwrap_or(0) as u32);
                    }
                }
            }
        }
        Ok(all[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_and_their_corners_are_even_permutations() {
        for (k, f) in FACETS.iter().enumerate() {
            let order = [f[0], f[1], f[2], k];
            let odd = (0..4)
                .flat_map(|i| (0..i).map(move |j| (j, i)))
                .filter(|&(j, i)| order[j] > order[i])
                .count();
            assert_eq!(odd % 2, 0, "{order:?}");
        }
    }

    #[test]
    fn the_first_tetrahedron_is_closed() {
        let mut mesh = Mesh3::with_vertices(4).unwrap();
        mesh.first([2, 0, 3, 1]).unwrap();
        for e in 0..20 {
            let f = mesh.opposite(e);
            assert_eq!(mesh.opposite(f), e);
            let facet = |e: Code| {
                let all = mesh.corners(tetrahedron(e));
                FACETS[corner(e)].map(|i| all[i])
            };
            let [a, b, c] = facet(e);
            let other = facet(f);
            assert!([[b, a, c], [a, c, b], [c, b, a]].contains(&other), "{e}");
        }
    }
}
