//! The records of the mesh and the arithmetic of half-edge codes.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::zeroed;
use crate::base::watch::Watch;

/// A half-edge: `8 t + k` for the edge opposite corner k of triangle t.
pub type Code = u32;

/// Words of a record.
pub const RECORD: usize = 8;
/// Numbers moved between two checks for interruption.
const LOT: usize = RECORD << 16;
/// Where the codes across begin in a record.
pub const OPPOSITE: usize = 4;

/// Records per vertex: a mesh of n vertices has 2 n - 2.
const PER_VERTEX: usize = 2;

/// The half-edge of triangle `t` opposite its corner `k`, which is also the code of that corner.
#[inline]
pub fn half_edge(t: u32, k: u32) -> Code {
    8 * t + k
}

/// The three half-edges of a triangle.
#[inline]
pub fn half_edges(t: u32) -> Range<Code> {
    8 * t..8 * t + 3
}

/// The half-edge that follows in its triangle, counterclockwise.
#[inline]
pub fn next(e: Code) -> Code {
    e + 1 - 3 * (e >> 1 & 1)
}

/// The previous half-edge of its triangle.
#[inline]
pub fn prev(e: Code) -> Code {
    e + 2 - 3 * u32::from(e & 3 != 0)
}

/// The triangle of a half-edge.
#[inline]
pub fn triangle(e: Code) -> u32 {
    e >> 3
}

/// The memory of a mesh over vertices `0..infinite`.
#[derive(Debug)]
pub struct Mesh2 {
    /// The words of the records, in threes: the export leaves the corners of triangles there.
    words: Vec<[u32; 3]>,
    infinite: u32,
}

impl Mesh2 {
    /// Capacity for the triangles of `vertices` vertices.
    pub fn with_vertices(vertices: usize) -> Result<Self> {
        Ok(Self {
            words: zeroed((RECORD * PER_VERTEX * vertices).div_ceil(3))?,
            infinite: vertices as u32,
        })
    }

    /// All records as one patch.
    pub fn patch(&mut self) -> Patch<'_> {
        Patch {
            records: self.words.as_flattened_mut(),
            base: 0,
            used: 0,
            infinite: self.infinite,
        }
    }

    /// All records as one patch, the first `used` of which are already triangles.
    #[inline]
    pub fn resume(&mut self, used: u32) -> Patch<'_> {
        Patch {
            used,
            ..self.patch()
        }
    }

    /// The words of the records, in threes.
    pub(super) fn into_words(self) -> Vec<[u32; 3]> {
        self.words
    }

    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.infinite as usize
    }

    /// Changes the capacity to `vertices` vertices, where the first `used` records are triangles:
    /// the number of the infinite vertex changes with it.
    pub fn resize(&mut self, vertices: usize, used: u32, watch: &Watch) -> Result<()> {
        let (before, after) = (self.infinite, vertices as u32);
        let mut words = zeroed((RECORD * PER_VERTEX * vertices).div_ceil(3))?;
        let kept = RECORD * used as usize;
        let lots = words.as_flattened_mut()[..kept]
            .chunks_mut(LOT)
            .zip(self.words.as_flattened()[..kept].chunks(LOT));
        for (lot, old) in lots {
            watch.check()?;
            lot.copy_from_slice(old);
            for r in lot.as_chunks_mut::<RECORD>().0 {
                for v in &mut r[..3] {
                    *v = if *v == before { after } else { *v };
                }
            }
        }
        (self.words, self.infinite) = (words, after);
        Ok(())
    }
}

/// The records of a contiguous block of vertices. Codes count from the start of the mesh.
#[derive(Debug)]
pub struct Patch<'a> {
    records: &'a mut [u32],
    base: Code,
    used: u32,
    infinite: u32,
}

impl<'a> Patch<'a> {
    /// The vertex at infinity, one past the last vertex of the mesh.
    #[inline]
    pub fn infinite(&self) -> u32 {
        self.infinite
    }

    /// The first record of the patch.
    #[inline]
    pub fn first(&self) -> u32 {
        triangle(self.base)
    }

    /// Splits the patch after its first `vertices` vertices.
    pub fn split_at(self, vertices: usize) -> (Patch<'a>, Patch<'a>) {
        let cut = RECORD * PER_VERTEX * vertices;
        let (left, right) = self.records.split_at_mut(cut);
        let base = self.base + cut as Code;
        let infinite = self.infinite;
        let left = Patch {
            records: left,
            base: self.base,
            used: 0,
            infinite,
        };
        (
            left,
            Patch {
                records: right,
                base,
                used: 0,
                infinite,
            },
        )
    }

    /// The same records for a shorter lifetime.
    pub fn reborrow(&mut self) -> Patch<'_> {
        Patch {
            records: self.records,
            base: self.base,
            used: self.used,
            infinite: self.infinite,
        }
    }

    /// The two records that a mesh of the first `vertices` vertices does not use.
    pub fn spare(&self, vertices: usize) -> [u32; 2] {
        let end = triangle(self.base) + (PER_VERTEX * vertices) as u32;
        [end - 2, end - 1]
    }

    #[inline]
    fn index(&self, e: Code) -> usize {
        (e - self.base) as usize
    }

    /// The corners of triangle `t`.
    #[inline]
    pub fn corners(&self, t: u32) -> [u32; 3] {
        let r = &self.records[self.index(8 * t)..][..3];
        [r[0], r[1], r[2]]
    }

    /// The codes across the three edges of triangle `t`.
    #[inline]
    pub fn opposites(&self, t: u32) -> [Code; 3] {
        let r = &self.records[self.index(8 * t) + OPPOSITE..][..3];
        [r[0], r[1], r[2]]
    }

    /// The vertex opposite the half-edge `e` in its triangle.
    #[inline]
    pub fn vertex(&self, e: Code) -> u32 {
        self.records[self.index(e)]
    }

    /// The half-edge on the other side of `e`.
    #[inline]
    pub fn opposite(&self, e: Code) -> Code {
        self.records[self.index(e) + OPPOSITE]
    }

    /// Triangle `t` as stored in memory: corners in words 0 to 2, the codes across in 4 to 6.
    #[inline]
    pub fn record(&self, t: u32) -> &[u32; RECORD] {
        &self.records.as_chunks().0[(t - triangle(self.base)) as usize]
    }

    /// The same, mutable.
    #[inline]
    pub fn record_mut(&mut self, t: u32) -> &mut [u32; RECORD] {
        &mut self.records.as_chunks_mut().0[(t - triangle(self.base)) as usize]
    }

    /// The same for `count` triangles from `t` on.
    #[inline]
    pub fn records_mut(&mut self, t: u32, count: usize) -> &mut [[u32; RECORD]] {
        &mut self.records.as_chunks_mut().0[(t - triangle(self.base)) as usize..][..count]
    }

    /// Takes the next unused record.
    #[inline]
    pub fn fresh(&mut self) -> u32 {
        let t = triangle(self.base) + self.used;
        self.used += 1;
        t
    }

    /// The records taken so far.
    pub fn taken(&self) -> Range<u32> {
        let start = triangle(self.base);
        start..start + self.used
    }

    /// Writes the corners of triangle `t`.
    #[inline]
    pub fn set(&mut self, t: u32, corners: [u32; 3]) {
        let i = self.index(8 * t);
        self.records[i..i + 3].copy_from_slice(&corners);
    }

    /// Sets the corner opposite `e` to `vertex`.
    #[inline]
    pub fn set_vertex(&mut self, e: Code, vertex: u32) {
        let i = self.index(e);
        self.records[i] = vertex;
    }

    /// Makes `e` and `f` the two sides of one edge.
    #[inline]
    pub fn link(&mut self, e: Code, f: Code) {
        let (i, j) = (self.index(e), self.index(f));
        self.records[i + OPPOSITE] = f;
        self.records[j + OPPOSITE] = e;
    }

    /// Sets the code across `e`, on this side only.
    #[inline]
    pub fn set_opposite(&mut self, e: Code, across: Code) {
        let i = self.index(e);
        self.records[i + OPPOSITE] = across;
    }

    /// Moves triangle `from` to record `to` and updates its neighbors, except those outside.
    pub(crate) fn relocate(&mut self, from: u32, to: u32) {
        self.set(to, self.corners(from));
        self.set_vertex(8 * to + 3, self.vertex(8 * from + 3));
        for k in 0..3 {
            let across = self.opposite(8 * from + k);
            self.set_opposite(8 * to + k, across);
            if self.records.get(across as usize).is_some() {
                self.set_opposite(across, 8 * to + k);
            }
        }
    }

    fn push(&mut self, corners: [u32; 3]) -> Code {
        let t = self.fresh();
        self.set(t, corners);
        8 * t
    }

    /// The mesh of the counterclockwise triangle `a b c` and its three ghosts. Returns a ghost.
    pub fn triangle(&mut self, [a, b, c]: [u32; 3]) -> Code {
        //        inf              Ghost k lies across edge k; seen from outside, its
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
            self.link(t + k as u32, ghosts[k]);
            // Ghost k ends where ghost k + 1 begins: they share the edge to corner k + 2.
            self.link(ghosts[k] + 2, ghosts[(k + 1) % 3] + 1);
        }
        ghosts[0]
    }

    /// The mesh of at least two collinear vertices, in order: ghosts on both sides of each edge.
    /// Returns a ghost.
    pub fn chain(&mut self, vertices: &[u32]) -> Code {
        //      upper 0   upper 1
        //    0 ------- 1 ------- 2        all to infinity
        //      lower 0   lower 1
        let inf = self.infinite;
        let (mut first, mut last) = (None, None::<[Code; 2]>);
        for pair in vertices.windows(2) {
            let lower = self.push([inf, pair[1], pair[0]]);
            let upper = self.push([inf, pair[0], pair[1]]);
            self.link(lower, upper);
            if let Some([lower_before, upper_before]) = last {
                self.link(lower_before + 2, lower + 1);
                self.link(upper + 2, upper_before + 1);
            }
            first = first.or(Some([lower, upper]));
            last = Some([lower, upper]);
        }
        let (Some([lower0, upper0]), Some([lower1, upper1])) = (first, last) else {
            return 0;
        };
        self.link(upper0 + 2, lower0 + 1);
        self.link(lower1 + 2, upper1 + 1);
        lower0
    }

    /// Checks for the first `triangles` records that opposite codes are mutual and that both sides
    /// name the same two vertices.
    pub fn check(&self, triangles: usize) -> std::result::Result<(), String> {
        let start = triangle(self.base);
        for t in start..start + triangles as u32 {
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
    fn codes_turn_around_their_triangle() {
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
    fn first_meshes_are_linked() {
        let mut mesh = Mesh2::with_vertices(7).unwrap();
        let (mut left, mut right) = mesh.patch().split_at(3);
        left.triangle([0, 1, 2]);
        left.check(4).unwrap();
        right.chain(&[3, 4, 5, 6]);
        right.check(6).unwrap();
    }
}
