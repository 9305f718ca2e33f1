//! Union-find: sets that are joined (R. E. Tarjan, "Efficiency of a good but not linear set union
//! algorithm", 1975), and the connected components of a graph.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;

/// Disjoint sets of rows.
pub(crate) struct Sets {
    /// The parent of each row; a root is its own.
    parents: Vec<u32>,
}

impl Sets {
    /// A set for each of `n` rows.
    pub(crate) fn of(n: usize) -> Result<Self> {
        let mut parents = with_room(n)?;
        parents.extend(0..n as u32);
        Ok(Self { parents })
    }

    /// The root of a row; paths are halved.
    #[inline]
    pub(crate) fn root(&mut self, row: i32) -> u32 {
        let mut at = row as u32;
        loop {
            let above = self.parents[at as usize];
            if above == at {
                return at;
            }
            let next = self.parents[above as usize];
            self.parents[at as usize] = next;
            at = next;
        }
    }

    /// Joins the sets of two rows; whether they were two. The smaller root stays, so that roots
    /// are the first rows.
    #[inline]
    pub(crate) fn join(&mut self, a: i32, b: i32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }
}

/// The number of the component of each of `n` rows; components are numbered by their first rows.
pub fn components(edges: &[[i32; 2]], n: usize, watch: &Watch) -> Result<Vec<i32>> {
    let mut pace = Pace::new(watch, LOT);
    let mut sets = Sets::of(n)?;
    for &[a, b] in edges {
        pace.spend(1)?;
        sets.join(a, b);
    }
    let mut labels = filled(n, 0)?;
    let mut count = 0;
    for row in 0..n {
        pace.spend(1)?;
        let root = sets.root(row as i32) as usize;
        labels[row] = if root == row {
            count += 1;
            count - 1
        } else {
            labels[root]
        };
    }
    Ok(labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_are_numbered_by_their_first_rows() {
        let edges = [[1, 4], [2, 5], [4, 6], [5, 6]];
        let found = components(&edges, 8, &Watch::idle()).unwrap();
        assert_eq!(found, [0, 1, 1, 2, 1, 1, 1, 3]);
        assert!(components(&[], 0, &Watch::idle()).unwrap().is_empty());
    }
}
