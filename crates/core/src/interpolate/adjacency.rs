//! Vertex adjacency: which vertices share an edge.

use crate::base::error::{Error, Result};

/// The neighbors of each vertex, in compressed rows.
#[derive(Debug, Clone, Copy)]
pub struct Adjacency<'a> {
    indptr: &'a [i32],
    pub(super) indices: &'a [i32],
}

impl<'a> Adjacency<'a> {
    /// Checks that the rows are those of `vertices` vertices.
    pub fn new(vertices: usize, indptr: &'a [i32], indices: &'a [i32]) -> Result<Self> {
        let n = indices.len();
        let fits = indptr.len() == vertices + 1
            && indptr.is_sorted()
            && indptr.first() == Some(&0)
            && indptr.last().is_some_and(|&end| end as usize == n);
        let inside = |&v: &i32| v >= 0 && (v as usize) < vertices;
        if !fits || !indices.iter().all(inside) {
            return Err(Error::Shape(format!(
                "indptr and indices are not compressed rows of {vertices} vertices"
            )));
        }
        Ok(Self { indptr, indices })
    }

    #[inline]
    pub(super) fn vertices(&self) -> usize {
        self.indptr.len() - 1
    }

    #[inline]
    pub(super) fn range(&self, v: usize) -> std::ops::Range<usize> {
        self.indptr[v] as usize..self.indptr[v + 1] as usize
    }

    /// The neighbors of a vertex.
    #[inline]
    pub fn neighbors(&self, v: usize) -> &'a [i32] {
        &self.indices[self.range(v)]
    }
}
