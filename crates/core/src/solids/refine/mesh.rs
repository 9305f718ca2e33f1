//! A mutable tetrahedral mesh whose faces may be walls.

use std::collections::HashSet;

use delone_predicates::Point3;

pub use crate::base::arrays::FACETS as FACES;
use crate::base::error::Result;
use crate::base::memory::push;

/// No tetrahedron, vertex or wall.
pub const NONE: u32 = u32::MAX;

/// Vertices of a tetrahedron, positively oriented.
pub type Corners = [u32; 4];

/// Tetrahedra over points. Coordinates are stored and not used.
#[derive(Debug)]
pub struct Mesh {
    /// Coordinates of the vertices: those of the input, then those added.
    pub points: Vec<Point3>,
    /// Number of vertices of the input.
    pub given: usize,
    /// The corners of each tetrahedron; [`NONE`] if it was removed.
    pub corners: Vec<Corners>,
    /// The tetrahedron across the face opposite each corner, or [`NONE`].
    pub across: Vec<[u32; 4]>,
    /// The number of the input face that this face is or lies in the facet of, or [`NONE`].
    pub wall: Vec<[u32; 4]>,
    /// The label of each tetrahedron.
    pub label: Vec<i32>,
    /// The size requested for each, and whether it was requested for itself or inherited from the
    /// one before.
    pub size: Vec<f64>,
    pub known: Vec<bool>,
    /// The facet of each input face: the smallest number of a face in it.
    pub facet: Vec<u32>,
    /// The edges where facets end, ascending pairs. Empty unless facets may be split.
    pub segments: HashSet<[u32; 2]>,
    /// The segments at which parts of the boundary touch: more than two walls have nothing behind.
    /// They are never split, as tetrahedra there are not all connected.
    pub pinched: HashSet<[u32; 2]>,
    pub free: Vec<u32>,
}

/// A face as seen from a tetrahedron.
pub type Side = (u32, usize);

/// A pair, ascending.
#[inline]
pub fn edge(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

impl Mesh {
    /// The number of slots for tetrahedra, including empty ones.
    pub fn places(&self) -> u32 {
        self.corners.len() as u32
    }

    /// Whether a slot contains a tetrahedron.
    #[inline]
    pub fn is_there(&self, t: u32) -> bool {
        self.corners[t as usize][0] != NONE
    }

    /// The coordinates of corners.
    #[inline]
    pub fn places_of<const N: usize>(&self, v: [u32; N]) -> [Point3; N] {
        v.map(|v| self.points[v as usize])
    }

    /// Which corner of a tetrahedron a vertex is.
    #[inline]
    pub fn corner(&self, t: u32, v: u32) -> Option<usize> {
        self.corners[t as usize].iter().position(|&x| x == v)
    }

    /// The vertices of a face, from the inside of its tetrahedron.
    #[inline]
    pub fn face(&self, (t, k): Side) -> [u32; 3] {
        FACES[k].map(|i| self.corners[t as usize][i])
    }

    /// The facet of a wall.
    #[inline]
    pub fn facet_of(&self, (t, k): Side) -> u32 {
        self.facet[self.wall[t as usize][k] as usize]
    }

    /// The same face seen from the other side.
    pub fn behind(&self, (t, k): Side) -> Option<Side> {
        let u = self.across[t as usize][k];
        if u == NONE {
            return None;
        }
        let face = self.face((t, k));
        let other = self.corners[u as usize]
            .iter()
            .position(|v| !face.contains(v));
        other.map(|i| (u, i))
    }

    /// The wall on this side that follows a wall around one of its edges, which may be itself.
    pub fn next_wall(&self, (t, k): Side, [a, b]: [u32; 2]) -> Option<Side> {
        // Leave each tetrahedron through the face that has the edge and was not entered.
        let mut at = t;
        let mut opposite = k;
        loop {
            let exit = (0..4).find(|&i| {
                let v = self.corners[at as usize][i];
                i != opposite && v != a && v != b
            })?;
            if self.wall[at as usize][exit] != NONE {
                return Some((at, exit));
            }
            (at, opposite) = self.behind((at, exit))?;
        }
    }

    /// Collects the tetrahedra around an edge of one of them, walls or not.
    pub fn around(&self, t: u32, [a, b]: [u32; 2], found: &mut Vec<u32>) -> Result<()> {
        found.clear();
        push(found, t)?;
        let mut next = 0;
        while let Some(&t) = found.get(next) {
            next += 1;
            for k in 0..4 {
                let v = self.corners[t as usize][k];
                let u = self.across[t as usize][k];
                if v != a && v != b && u != NONE && !found.contains(&u) {
                    push(found, u)?;
                }
            }
        }
        Ok(())
    }

    /// Whether an edge is a segment.
    #[inline]
    pub fn is_segment(&self, a: u32, b: u32) -> bool {
        !self.segments.is_empty() && self.segments.contains(&edge(a, b))
    }

    /// A slot for a new tetrahedron: the one offered, an empty one or a new one.
    pub fn slot(&mut self, offered: Option<u32>) -> Result<u32> {
        if let Some(t) = offered.or_else(|| self.free.pop()) {
            return Ok(t);
        }
        push(&mut self.corners, [NONE; 4])?;
        push(&mut self.across, [NONE; 4])?;
        push(&mut self.wall, [NONE; 4])?;
        push(&mut self.label, 0)?;
        push(&mut self.size, f64::INFINITY)?;
        push(&mut self.known, false)?;
        Ok(self.places() - 1)
    }
}
