//! Records of tetrahedra, in two arrays that are exported unchanged.

use crate::base::arrays::FACETS;
use crate::base::error::{Error, Result};
use crate::base::memory::zeroed;

/// A facet: `4 t + k`.
pub type Code = u32;

/// Records that codes of 32 bits can address.
pub const LIMIT: usize = 1 << 30;

/// The tetrahedron of a code.
#[inline(always)]
pub fn tetrahedron(e: Code) -> u32 {
    e >> 2
}

/// The corner opposite a facet.
#[inline(always)]
pub fn corner(e: Code) -> usize {
    (e & 3) as usize
}

/// Storage for the records of one mesh or of several side by side.
///
/// The arrays are of type `i32`, with the same bits as the `u32` they hold, since that is the type
/// of the export.
#[derive(Debug, Default)]
pub struct Records {
    /// Four vertices per tetrahedron.
    pub corners: Vec<[i32; 4]>,
    /// The codes of its facets as seen from the other sides.
    pub opposite: Vec<[i32; 4]>,
}

impl Records {
    /// Room for `n` records, which touches no page.
    pub fn with_room(n: usize) -> Result<Self> {
        Ok(Self {
            corners: zeroed(n)?,
            opposite: zeroed(n)?,
        })
    }

    /// The number of records that a mesh needs: a uniform point has 6.77 tetrahedra.
    pub fn room(vertices: usize) -> usize {
        7 * vertices + 64
    }

    /// Empty meshes side by side, each with its capacity and its number of vertices.
    pub fn meshes(&mut self, rooms: &[(usize, usize)]) -> Vec<Mesh3<'_>> {
        let (mut corners, mut opposite) = (&mut self.corners[..], &mut self.opposite[..]);
        let mut meshes = Vec::with_capacity(rooms.len());
        for &(room, vertices) in rooms {
            let (own_corners, rest_corners) = corners.split_at_mut(room);
            let (own_opposite, rest_opposite) = opposite.split_at_mut(room);
            meshes.push(Mesh3 {
                corners: own_corners,
                opposite: own_opposite,
                used: 0,
                free: Vec::new(),
                infinite: vertices as u32,
            });
            (corners, opposite) = (rest_corners, rest_opposite);
        }
        meshes
    }
}

/// A mesh of tetrahedra and ghosts.
#[derive(Debug)]
pub struct Mesh3<'a> {
    corners: &'a mut [[i32; 4]],
    opposite: &'a mut [[i32; 4]],
    used: usize,
    /// Unused records.
    free: Vec<u32>,
    infinite: u32,
}

impl Mesh3<'_> {
    /// The number of records, some of which may be free.
    #[inline]
    pub fn records(&self) -> usize {
        self.used
    }

    /// The capacity in records.
    pub fn room(&self) -> usize {
        self.corners.len()
    }

    /// The vertex at infinity.
    #[inline]
    pub fn infinite(&self) -> u32 {
        self.infinite
    }

    /// The corners of tetrahedron t.
    #[inline(always)]
    pub fn corners(&self, t: u32) -> [u32; 4] {
        let [a, b, c, d] = self.corners[t as usize];
        [a as u32, b as u32, c as u32, d as u32]
    }

    /// The corners of facet e, from the side of its tetrahedron.
    #[inline(always)]
    pub fn facet(&self, e: Code) -> [u32; 3] {
        let corners = &self.corners[tetrahedron(e) as usize];
        // The mask avoids a bounds check; `map` of an array may be a call.
        let [a, b, c] = FACETS[corner(e)];
        [
            corners[a & 3] as u32,
            corners[b & 3] as u32,
            corners[c & 3] as u32,
        ]
    }

    /// The corner opposite facet e.
    #[inline(always)]
    pub fn apex(&self, e: Code) -> u32 {
        self.corners[tetrahedron(e) as usize][corner(e)] as u32
    }

    /// The unused records.
    pub fn free(&self) -> &[u32] {
        &self.free
    }

    /// The codes of the facets of t as seen from the other sides.
    #[inline(always)]
    pub fn opposites(&self, t: u32) -> [Code; 4] {
        let [a, b, c, d] = self.opposite[t as usize];
        [a as Code, b as Code, c as Code, d as Code]
    }

    /// The facet `e` as seen from the other side.
    #[inline(always)]
    pub fn opposite(&self, e: Code) -> Code {
        self.opposite[tetrahedron(e) as usize][corner(e)] as Code
    }

    /// All corners and all codes, mutable.
    #[inline(always)]
    pub fn all_mut(&mut self) -> (&mut [[i32; 4]], &mut [[i32; 4]]) {
        (self.corners, self.opposite)
    }

    /// The corner of t that is infinite, if t is a ghost.
    #[inline]
    pub fn infinite_corner(&self, t: u32) -> Option<usize> {
        self.corners(t).iter().position(|&v| v == self.infinite)
    }

    /// Sets the corners of t.
    #[inline]
    pub fn set(&mut self, t: u32, corners: [u32; 4]) {
        self.corners[t as usize] = corners.map(|v| v as i32);
    }

    /// Fills record t.
    #[inline(always)]
    pub fn put(&mut self, t: u32, [a, b, c, d]: [u32; 4], [e, f, g, h]: [Code; 4]) {
        self.corners[t as usize] = [a as i32, b as i32, c as i32, d as i32];
        self.opposite[t as usize] = [e as i32, f as i32, g as i32, h as i32];
    }

    /// Sets the other side of facet `e` to `f`.
    #[inline(always)]
    pub fn point(&mut self, e: Code, f: Code) {
        self.opposite[tetrahedron(e) as usize][corner(e)] = f as i32;
    }

    /// Links facets `e` and `f` as the two sides of one.
    #[inline]
    pub fn link(&mut self, e: Code, f: Code) {
        self.opposite[tetrahedron(e) as usize][corner(e)] = f as i32;
        self.opposite[tetrahedron(f) as usize][corner(f)] = e as i32;
    }

    /// A record to be filled; `TooManyTetrahedra` if there is no room.
    #[inline(always)]
    pub fn fresh(&mut self) -> Result<u32> {
        if let Some(t) = self.free.pop() {
            return Ok(t);
        }
        let t = self.used;
        if t == self.corners.len() {
            return Err(Error::TooManyTetrahedra { limit: t });
        }
        self.used += 1;
        Ok(t as u32)
    }

    /// Frees record t.
    #[inline(always)]
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
            // Seen from outside, the facet has the opposite orientation.
            let [a, b, c] = FACETS[k].map(|i| corners[i]);
            self.set(all[k + 1], [b, a, c, self.infinite]);
            self.link(4 * all[0] + k as u32, 4 * all[k + 1] + 3);
        }
        for &s in &all[1..] {
            for k in 0..3 {
                // The other ghost at the two finite corners beside corner k.
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
        let mut records = Records::with_room(64).unwrap();
        let mesh = &mut records.meshes(&[(64, 4)])[0];
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
