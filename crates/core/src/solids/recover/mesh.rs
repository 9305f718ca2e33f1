//! A mesh of tetrahedra that fill one large tetrahedron: corners, and the neighbor behind each face.
//!
//! Corner `k` of a tetrahedron lies on the positive side of its face [`FACES`]`[k]`.

use super::coordinates::Coordinates;
pub use crate::base::arrays::FACETS as FACES;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push};

/// No tetrahedron, or no vertex.
pub const NONE: u32 = u32::MAX;

/// Four vertices, positively oriented.
pub type Corners = [u32; 4];

/// A face with its vertices ascending, and the tetrahedron and the corner from which it is seen.
type Side = ([u32; 3], u32, u32);

/// The pairs of corners of a tetrahedron, each before the other two such that all are an even
/// permutation.
pub const PAIRS: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];

/// Two vertices, ascending.
pub fn pair(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Three vertices, ascending.
#[inline]
pub fn ascending([a, b, c]: [u32; 3]) -> [u32; 3] {
    let (low, high) = (a.min(b), a.max(b));
    [low.min(c), high.min(low.max(c)), high.max(c)]
}

/// Vertices as one number, which takes less time to sort.
pub fn number<const N: usize>(v: [u32; N]) -> u128 {
    v.iter().fold(0, |n, &x| n << 32 | u128::from(x))
}

/// The tetrahedra around an edge, in order.
#[derive(Debug, Default, Clone)]
pub struct Ring {
    /// The edge.
    pub ends: [u32; 2],
    /// The vertices around it: with the ends, two that follow one another are a tetrahedron,
    /// positively oriented.
    pub vertices: Vec<u32>,
    /// The tetrahedron of each vertex and the next one.
    pub tetrahedra: Vec<u32>,
}

/// Tetrahedra over points.
#[derive(Debug)]
pub struct Mesh {
    /// The points.
    pub points: Coordinates,
    /// The corners of each tetrahedron; [`NONE`] if it was removed.
    pub corners: Vec<Corners>,
    /// The tetrahedron behind each face, [`NONE`] outside.
    pub across: Vec<[u32; 4]>,
    /// A tetrahedron of each vertex, [`NONE`] if it has none.
    pub at: Vec<u32>,
    free: Vec<u32>,
    /// Marks of tetrahedra that the current search has visited.
    seen: Vec<u32>,
    search: u32,
    /// The tetrahedra of the search for an edge; kept for its memory.
    open: Vec<u32>,
    sides: Vec<Side>,
}

impl Mesh {
    /// A mesh of given tetrahedra and neighbors.
    pub fn new(points: Coordinates, corners: Vec<Corners>, across: Vec<[u32; 4]>) -> Result<Self> {
        let mut at = filled(points.len(), NONE)?;
        for (t, v) in (0..).zip(&corners) {
            for &v in v {
                at[v as usize] = t;
            }
        }
        let seen = filled(corners.len(), 0)?;
        Ok(Self {
            points,
            corners,
            across,
            at,
            free: Vec::new(),
            seen,
            search: 0,
            open: Vec::new(),
            sides: Vec::new(),
        })
    }

    /// Whether there is a tetrahedron in a slot.
    pub fn is_there(&self, t: u32) -> bool {
        self.corners[t as usize][0] != NONE
    }

    /// Which corner of a tetrahedron a vertex is.
    #[inline]
    pub fn corner(&self, t: u32, v: u32) -> Option<usize> {
        self.corners[t as usize].iter().position(|&x| x == v)
    }

    /// The face opposite a corner.
    #[inline]
    pub fn face(&self, t: u32, k: usize) -> [u32; 3] {
        FACES[k].map(|i| self.corners[t as usize][i])
    }

    /// The corner of the tetrahedron behind a face that is not on it.
    pub fn apex(&self, t: u32, k: usize) -> Option<(u32, u32)> {
        let u = self.across[t as usize][k];
        Some((u, self.corners[u as usize][self.back(t, k)?]))
    }

    /// Which corner of the tetrahedron behind a face is not on it.
    pub fn back(&self, t: u32, k: usize) -> Option<usize> {
        let u = self.across[t as usize][k];
        (u != NONE).then(|| (0..4).find(|&i| self.across[u as usize][i] == t))?
    }

    /// Starts a search that has visited nothing.
    pub fn new_search(&mut self) {
        if self.search == u32::MAX {
            self.seen.fill(0);
            self.search = 0;
        }
        self.search += 1;
    }

    /// Whether the current search visits a tetrahedron for the first time.
    pub fn is_new(&mut self, t: u32) -> bool {
        let fresh = self.seen[t as usize] != self.search;
        self.seen[t as usize] = self.search;
        fresh
    }

    /// The tetrahedra of a vertex, the first `most` of them if there are more.
    pub fn star(&mut self, v: u32, most: usize) -> Vec<u32> {
        let mut found = Vec::with_capacity(32);
        let start = self.at[v as usize];
        if start == NONE {
            return found;
        }
        self.new_search();
        self.is_new(start);
        found.push(start);
        let mut next = 0;
        while next < found.len() && found.len() < most {
            let t = found[next];
            next += 1;
            for k in 0..4 {
                let u = self.across[t as usize][k];
                if self.corners[t as usize][k] != v && u != NONE && self.is_new(u) {
                    found.push(u);
                }
            }
        }
        found
    }

    /// A tetrahedron with the edge between two vertices.
    pub fn with_edge(&mut self, a: u32, b: u32) -> Option<u32> {
        let mut most = 64;
        loop {
            for (from, to) in [(a, b), (b, a)] {
                let (count, found) = self.beside(from, to, most);
                if found.is_some() || count < most {
                    return found;
                }
            }
            most *= 8;
        }
    }

    /// The first tetrahedron of a vertex that also has another one, as `star` finds them, and the
    /// number of tetrahedra visited, about `most` at most.
    fn beside(&mut self, v: u32, other: u32, most: usize) -> (usize, Option<u32>) {
        let start = self.at[v as usize];
        let mut found = std::mem::take(&mut self.open);
        found.clear();
        let mut hit = None;
        if start != NONE {
            self.new_search();
            self.is_new(start);
            found.push(start);
            hit = Some(start).filter(|&t| self.corner(t, other).is_some());
        }
        let mut next = 0;
        while hit.is_none() && next < found.len() && found.len() < most {
            let t = found[next];
            next += 1;
            for k in 0..4 {
                let u = self.across[t as usize][k];
                if self.corners[t as usize][k] != v && u != NONE && self.is_new(u) {
                    found.push(u);
                    hit = hit.or(Some(u).filter(|&u| self.corner(u, other).is_some()));
                }
            }
        }
        let count = found.len();
        self.open = found;
        (count, hit)
    }

    /// The tetrahedra around an edge that one of them has; `None` if the edge is on the hull.
    pub fn ring(&self, t: u32, a: u32, b: u32) -> Option<Ring> {
        let (i, j) = (self.corner(t, a)?, self.corner(t, b)?);
        let (low, high) = (i.min(j), i.max(j));
        let order = PAIRS.iter().find(|p| p[0] == low && p[1] == high)?;
        let [mut p, mut q] = [order[2], order[3]].map(|k| self.corners[t as usize][k]);
        if i > j {
            std::mem::swap(&mut p, &mut q);
        }
        let mut ring = Ring {
            ends: [a, b],
            ..Ring::default()
        };
        let mut now = t;
        loop {
            ring.vertices.push(p);
            ring.tetrahedra.push(now);
            // Across the face of the edge and q.
            let u = self.across[now as usize][self.corner(now, p)?];
            if u == NONE {
                return None;
            }
            let sum = self.corners[u as usize].iter().fold(0, |s, v| s ^ v);
            (p, q) = (q, sum ^ a ^ b ^ q);
            now = u;
            if now == t {
                return Some(ring);
            }
        }
    }

    /// A tetrahedron with a face, and the corner opposite.
    pub fn side(&mut self, [a, b, c]: [u32; 3]) -> Option<(u32, usize)> {
        let t = self.with_edge(a, b)?;
        let ring = self.ring(t, a, b)?;
        let i = ring.vertices.iter().position(|&v| v == c)?;
        let t = ring.tetrahedra[i];
        let apex = |v: &u32| ![a, b, c].contains(v);
        let k = self.corners[t as usize].iter().position(apex)?;
        Some((t, k))
    }

    /// Whether three vertices are a face.
    pub fn has_face(&mut self, [a, b, c]: [u32; 3]) -> bool {
        let t = self.with_edge(a, b);
        let ring = t.and_then(|t| self.ring(t, a, b));
        ring.is_some_and(|ring| ring.vertices.contains(&c))
    }

    /// The outer faces of tetrahedra, each seen from inside.
    pub fn outer_faces(&mut self, cells: &[u32]) -> Vec<[u32; 3]> {
        let sides = self.outer_sides(cells);
        sides.into_iter().map(|(t, k)| self.face(t, k)).collect()
    }

    /// The tetrahedra and corners from which the outer faces of tetrahedra are seen.
    pub fn outer_sides(&mut self, cells: &[u32]) -> Vec<(u32, usize)> {
        self.new_search();
        for &t in cells {
            self.is_new(t);
        }
        let mut found = Vec::with_capacity(2 * cells.len() + 2);
        for &t in cells {
            for k in 0..4 {
                let u = self.across[t as usize][k];
                if u == NONE || self.seen[u as usize] != self.search {
                    found.push((t, k));
                }
            }
        }
        found
    }

    /// Joins the outer faces of cells to a vertex. The caller has checked that it sees all of them.
    pub fn fan(&mut self, cells: &[u32], faces: &[[u32; 3]], v: u32) -> Result<()> {
        let new: Vec<Corners> = faces.iter().map(|&[a, b, c]| [a, b, c, v]).collect();
        self.replace(cells, &new)
    }

    /// Adds a point.
    pub fn add(&mut self, p: super::coordinates::Wide) -> Result<Option<u32>> {
        let v = self.points.add(p)?;
        push(&mut self.at, NONE)?;
        Ok(v)
    }

    /// Removes the point added last, which is not in any tetrahedron.
    pub fn drop_last(&mut self) {
        self.points.drop_last();
        self.at.pop();
    }

    /// Replaces tetrahedra by others that fill the same region.
    pub fn replace(&mut self, old: &[u32], new: &[Corners]) -> Result<()> {
        let mut sides = std::mem::take(&mut self.sides);
        sides.clear();
        self.new_search();
        for &t in old {
            self.is_new(t);
        }
        for &t in old {
            for k in 0..4 {
                let u = self.across[t as usize][k];
                if u == NONE {
                    push(&mut sides, (ascending(self.face(t, k)), NONE, 0))?;
                } else if self.seen[u as usize] != self.search {
                    let back = (0..4).find(|&i| self.across[u as usize][i] == t);
                    let back = back.ok_or_else(|| internal("a neighbor does not link back"))?;
                    push(&mut sides, (ascending(self.face(t, k)), u, back as u32))?;
                }
            }
        }
        self.empty(old)?;
        for v in new {
            let t = self.slot()?;
            self.corners[t as usize] = *v;
            for (k, &x) in v.iter().enumerate() {
                self.at[x as usize] = t;
                push(&mut sides, (ascending(self.face(t, k)), t, k as u32))?;
            }
        }
        sides.sort_unstable();
        let joined = self.join(&sides);
        self.sides = sides;
        joined
    }

    /// Empties slots.
    fn empty(&mut self, old: &[u32]) -> Result<()> {
        for &t in old {
            for v in self.corners[t as usize] {
                if self.at[v as usize] == t {
                    self.at[v as usize] = NONE;
                }
            }
            self.corners[t as usize] = [NONE; 4];
            push(&mut self.free, t)?;
        }
        // A vertex that remains gets a new tetrahedron; a removed one has none.
        Ok(())
    }

    /// A slot for a tetrahedron.
    fn slot(&mut self) -> Result<u32> {
        if let Some(t) = self.free.pop() {
            return Ok(t);
        }
        push(&mut self.corners, [NONE; 4])?;
        push(&mut self.across, [NONE; 4])?;
        push(&mut self.seen, 0)?;
        Ok(self.corners.len() as u32 - 1)
    }

    /// Links the two sides of each face.
    fn join(&mut self, sides: &[Side]) -> Result<()> {
        for two in sides.chunks(2) {
            let &[(face, t, k), (other, u, i)] = two else {
                return Err(internal("a face has one side"));
            };
            if face != other {
                return Err(internal("a face has one side or three"));
            }
            if t != NONE {
                self.across[t as usize][k as usize] = u;
            }
            if u != NONE {
                self.across[u as usize][i as usize] = t;
            }
        }
        Ok(())
    }
}

/// The error of a violated invariant.
pub fn internal(what: &str) -> Error {
    Error::Internal(format!("recovery of faces: {what}"))
}
