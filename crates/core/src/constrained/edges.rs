//! A lookup of a few edges among many subsegments.

use crate::base::error::Result;
use crate::base::memory::filled;

/// An edge, regardless of its direction.
pub fn edge([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

/// A sorted set of edges.
pub struct Edges {
    /// Ascending.
    pub all: Vec<[u32; 2]>,
    /// Whether a vertex is the smaller end of an edge: most lookups need no more.
    begins: Vec<bool>,
}

impl Edges {
    /// The set of the edges `all` of a mesh with this many `vertices`.
    pub fn of(mut all: Vec<[u32; 2]>, vertices: usize) -> Result<Self> {
        all.sort_unstable();
        all.dedup();
        let mut begins = filled(vertices, false)?;
        for e in &all {
            begins[e[0] as usize] = true;
        }
        Ok(Self { all, begins })
    }

    /// The index of an edge in the set.
    #[inline]
    pub fn place(&self, ends: [u32; 2]) -> Option<usize> {
        let e = edge(ends);
        let near = self.begins[e[0] as usize];
        near.then(|| self.all.binary_search(&e).ok()).flatten()
    }
}
