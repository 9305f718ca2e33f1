//! A few edges among many pieces: which pieces lie on them.

use crate::error::Result;
use crate::memory::filled;

/// An edge, whichever way it is directed.
pub fn edge([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

/// Edges, by which pieces are found.
pub struct Edges {
    /// Ascending.
    pub all: Vec<[u32; 2]>,
    /// Whether a vertex is the smaller end of one: most pieces need no more.
    begins: Vec<bool>,
}

impl Edges {
    /// Those of a mesh of so many `vertices`.
    pub fn of(mut all: Vec<[u32; 2]>, vertices: usize) -> Result<Self> {
        all.sort_unstable();
        all.dedup();
        let mut begins = filled(vertices, false)?;
        for e in &all {
            begins[e[0] as usize] = true;
        }
        Ok(Self { all, begins })
    }

    /// The place of an edge among them.
    #[inline]
    pub fn place(&self, ends: [u32; 2]) -> Option<usize> {
        let e = edge(ends);
        let near = self.begins[e[0] as usize];
        near.then(|| self.all.binary_search(&e).ok()).flatten()
    }
}
