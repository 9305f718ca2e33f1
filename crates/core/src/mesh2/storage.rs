//! The records of the mesh and the arithmetic of half-edge codes.

use crate::error::Result;
use crate::memory::{prefetch, with_room};

/// A half-edge: `8 t + k` for the edge opposite corner k of triangle t.
pub type Code = u32;

const RECORD: usize = 8;
const OPPOSITE: usize = 4;

/// The half-edge that follows in its triangle, counter-clockwise.
#[inline]
pub fn next(e: Code) -> Code {
    e + 1 - 3 * (e >> 1 & 1)
}

/// The half-edge before, counter-clockwise.
#[inline]
pub fn prev(e: Code) -> Code {
    e + 2 - 3 * u32::from(e & 3 != 0)
}

/// The triangle of a half-edge.
#[inline]
pub fn triangle(e: Code) -> u32 {
    e >> 3
}

/// Triangles with ghosts over vertices `0..infinite`.
#[derive(Debug)]
pub struct Mesh2 {
    records: Vec<u32>,
    infinite: u32,
}

impl Mesh2 {
    /// An empty mesh with room for the triangles of `vertices` vertices.
    pub fn with_vertices(vertices: usize) -> Result<Self> {
        let room = RECORD * (2 * vertices).saturating_sub(2);
        Ok(Self {
            records: with_room(room)?,
            infinite: vertices as u32,
        })
    }

    /// The vertex at infinity, one past the last finite vertex.
    #[inline]
    pub fn infinite(&self) -> u32 {
        self.infinite
    }

    /// Triangles in the mesh, ghosts included.
    pub fn len(&self) -> usize {
        self.records.len() / RECORD
    }

    /// Whether the mesh holds no triangle.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The corners of triangle `t`.
    #[inline]
    pub fn corners(&self, t: u32) -> [u32; 3] {
        let r = &self.records[RECORD * t as usize..][..3];
        [r[0], r[1], r[2]]
    }

    /// The codes across the three edges of triangle `t`.
    #[inline]
    pub fn opposites(&self, t: u32) -> [Code; 3] {
        let r = &self.records[RECORD * t as usize + OPPOSITE..][..3];
        [r[0], r[1], r[2]]
    }

    /// The vertex opposite the half-edge `e` in its triangle.
    #[inline]
    pub fn vertex(&self, e: Code) -> u32 {
        self.records[e as usize]
    }

    /// The half-edge on the other side of `e`.
    #[inline]
    pub fn opposite(&self, e: Code) -> Code {
        self.records[e as usize + OPPOSITE]
    }

    /// Whether triangle `t` touches infinity.
    #[inline]
    pub fn is_ghost(&self, t: u32) -> bool {
        self.corners(t).contains(&self.infinite)
    }

    /// Begins to load triangle `t` into the cache.
    #[inline(always)]
    pub fn prefetch(&self, t: u32) {
        prefetch(&self.records, RECORD * t as usize);
    }

    /// Appends a triangle that is not linked yet.
    #[inline]
    pub fn push(&mut self, corners: [u32; 3]) -> u32 {
        let t = (self.records.len() / RECORD) as u32;
        let [a, b, c] = corners;
        self.records.extend_from_slice(&[a, b, c, 0, 0, 0, 0, 0]);
        t
    }

    /// Writes the corners of triangle `t` and what lies across its edge 0.
    #[inline]
    pub fn set(&mut self, t: u32, corners: [u32; 3], across0: Code) {
        let r = &mut self.records[RECORD * t as usize..][..RECORD];
        r[..3].copy_from_slice(&corners);
        r[OPPOSITE] = across0;
    }

    /// Makes `e` and `f` the two sides of one edge.
    #[inline]
    pub fn link(&mut self, e: Code, f: Code) {
        self.records[e as usize + OPPOSITE] = f;
        self.records[f as usize + OPPOSITE] = e;
    }

    /// The first mesh: triangle `a b c`, counter-clockwise, and its three ghosts.
    pub fn start(&mut self, [a, b, c]: [u32; 3]) {
        //        inf              Ghost k lies across edge k; seen from outside its
        //     c ----- b           finite edge runs the other way.
        //   inf \   / inf
        //         a
        let inf = self.infinite;
        let t = self.push([a, b, c]);
        let ghosts = [
            self.push([inf, c, b]),
            self.push([inf, a, c]),
            self.push([inf, b, a]),
        ];
        for k in 0..3 {
            self.link(8 * t + k, 8 * ghosts[k as usize]);
            // Ghost k ends where ghost k + 1 begins: they share the edge to corner k + 2.
            let after = ghosts[(k as usize + 1) % 3];
            self.link(8 * ghosts[k as usize] + 2, 8 * after + 1);
        }
    }

    /// Checks that opposite codes are mutual and that both sides name the same two vertices.
    pub fn check(&self) -> std::result::Result<(), String> {
        for t in 0..self.len() as u32 {
            for e in 8 * t..8 * t + 3 {
                let o = self.opposite(e);
                let ends = [self.vertex(next(e)), self.vertex(prev(e))];
                if self.opposite(o) != e || [self.vertex(prev(o)), self.vertex(next(o))] != ends {
                    return Err(format!("half-edge {e} and its opposite {o} disagree"));
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_turn_round_their_triangle() {
        for t in [0, 5] {
            assert_eq!(
                [0, 1, 2].map(|k| next(8 * t + k)),
                [1, 2, 0].map(|k| 8 * t + k)
            );
            assert_eq!(
                [0, 1, 2].map(|k| prev(8 * t + k)),
                [2, 0, 1].map(|k| 8 * t + k)
            );
        }
    }

    #[test]
    fn the_first_mesh_is_linked() {
        let mut mesh = Mesh2::with_vertices(3).unwrap();
        mesh.start([0, 1, 2]);
        mesh.check().unwrap();
        assert_eq!(mesh.len(), 4);
    }
}
