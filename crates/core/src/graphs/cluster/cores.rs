//! Core distances: how far the k-th nearest row is, including the row of the point itself.

use super::link::Span;
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::Watch;
use crate::graphs::{Tree, each};

/// The core distance of each distinct point, by places in a tree.
pub struct Cores {
    /// Squares, rounded.
    pub squares: Vec<f64>,
    /// The points at these distances.
    pub far: Vec<u32>,
}

impl Cores {
    /// The core distance of a place.
    #[inline]
    pub(super) fn span(&self, place: usize) -> Span {
        Span {
            square: self.squares[place],
            between: [place as u32, self.far[place]],
        }
    }
}

/// How many of `n` rows are at each place of a tree.
pub(super) fn multiplicities<const D: usize>(tree: &Tree<D>, n: usize) -> Result<Vec<u32>> {
    let mut counts = filled(tree.len(), 1u32)?;
    if tree.duplicates.is_empty() {
        return Ok(counts);
    }
    let mut places = filled(n, 0u32)?;
    for (place, &row) in (0..).zip(&tree.rows) {
        places[row as usize] = place;
    }
    for &[_, first] in &tree.duplicates {
        counts[places[first as usize] as usize] += 1;
    }
    Ok(counts)
}

/// The distance to the k-th nearest of `n` rows, each counted; `k` is from 1 to `n`.
pub fn cores<const D: usize>(
    tree: &Tree<D>,
    k: usize,
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Cores> {
    let counts = multiplicities(tree, n)?;
    let found = each(tree, k - 1, workers, watch, |place, near, found| {
        let mut rows = counts[place] as usize;
        let mut last = (0.0, place as u32);
        for &next in near {
            if rows >= k {
                break;
            }
            rows += counts[next.1 as usize] as usize;
            last = next;
        }
        push(found, last)
    })?;
    let mut squares = crate::base::memory::with_room(found.len())?;
    let mut far = crate::base::memory::with_room(found.len())?;
    for (square, place) in found {
        squares.push(square);
        far.push(place);
    }
    Ok(Cores { squares, far })
}
