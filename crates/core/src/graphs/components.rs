//! The connected components of a graph.

use crate::base::error::Result;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;

/// The number of the component of each of `n` rows; components are numbered by their first rows.
pub fn components(edges: &[[i32; 2]], n: usize, watch: &Watch) -> Result<Vec<i32>> {
    let mut pace = Pace::new(watch, LOT);
    let mut sets = Sets::of(n)?;
    for &[a, b] in edges {
        pace.spend(1)?;
        sets.join(a as u32, b as u32);
    }
    Ok(sets.numbered(|_| true)?.0)
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
