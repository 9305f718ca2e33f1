//! The Delaunay graph, and lists of edges.

use delone_predicates::Sign;
use delone_predicates::proximity::shorter;

use crate::base::error::Result;
use crate::base::memory::{copied, filled, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};

/// Edges, or vertices, per task.
pub(super) const SHARE: usize = 1 << 12;
/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;

/// The edges of a Delaunay triangulation, or of the chain of collinear points.
#[derive(Clone, Copy)]
pub struct Skeleton<'a, const D: usize> {
    /// Coordinates of all rows.
    pub points: &'a [[f64; D]],
    /// The smaller row first, ascending.
    pub edges: &'a [[i32; 2]],
    /// Where the neighbors of each row begin, plus the end.
    pub starts: &'a [i32],
    /// The neighbors of all rows.
    pub neighbors: &'a [i32],
}

impl<const D: usize> Skeleton<'_, D> {
    /// The point of a row.
    #[inline]
    pub(super) fn at(&self, row: i32) -> [f64; D] {
        self.points[row as usize]
    }

    /// The neighbors of a row.
    #[inline]
    pub(super) fn around(&self, row: i32) -> &[i32] {
        let (start, end) = (self.starts[row as usize], self.starts[row as usize + 1]);
        &self.neighbors[start as usize..end as usize]
    }

    /// The ends of an edge, the one with fewer neighbors first.
    #[inline]
    pub(super) fn by_degree(&self, [a, b]: [i32; 2]) -> [i32; 2] {
        if self.around(b).len() < self.around(a).len() {
            [b, a]
        } else {
            [a, b]
        }
    }

    /// What `of` makes of the edges, in their order.
    pub(super) fn map<T: Send + Copy>(
        &self,
        workers: usize,
        watch: &Watch,
        of: impl Fn([i32; 2]) -> Option<T> + Sync,
    ) -> Result<Vec<T>> {
        let shares = self.edges.chunks(SHARE).collect();
        let parts = parallel::map_watched(workers, shares, watch, |share: &[[i32; 2]]| {
            let mut found = with_room(share.len())?;
            found.extend(share.iter().filter_map(|&edge| of(edge)));
            Ok(found)
        })?;
        joined(&parts)
    }
}

/// The edges that are not longer than the one between two points.
pub fn not_longer<const D: usize>(
    points: &[[f64; D]],
    edges: &[[i32; 2]],
    [p, q]: [[f64; D]; 2],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let shares = edges.chunks(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |share: &[[i32; 2]]| {
        let mut found = with_room(share.len())?;
        let short = |&&[a, b]: &&[i32; 2]| {
            shorter(p, q, points[a as usize], points[b as usize]) != Sign::Positive
        };
        found.extend(share.iter().filter(short));
        Ok(found)
    })?;
    joined(&parts)
}

/// All items of all parts.
pub(super) fn joined<T: Copy>(parts: &[Vec<T>]) -> Result<Vec<T>> {
    let mut all = with_room(parts.iter().map(Vec::len).sum())?;
    for part in parts {
        all.extend_from_slice(part);
    }
    Ok(all)
}

/// Pairs of rows below `n`, ascending, each once: a counting sort by the first row, then a sort of
/// the few rows of each.
pub(super) fn sorted(pairs: &[[i32; 2]], n: usize, watch: &Watch) -> Result<Vec<[i32; 2]>> {
    let mut pace = Pace::new(watch, LOT);
    let mut starts = zeroed::<u32>(n + 1)?;
    for [a, _] in pairs {
        pace.spend(1)?;
        starts[*a as usize + 1] += 1;
    }
    for v in 0..n {
        starts[v + 1] += starts[v];
    }
    let mut next = copied(&starts)?;
    let mut seconds = filled(pairs.len(), 0)?;
    for &[a, b] in pairs {
        pace.spend(1)?;
        seconds[next[a as usize] as usize] = b;
        next[a as usize] += 1;
    }
    let mut found = with_room(pairs.len())?;
    for (a, w) in (0..).zip(starts.windows(2)) {
        let here = &mut seconds[w[0] as usize..w[1] as usize];
        pace.spend(here.len() + 1)?;
        here.sort_unstable();
        let fresh = (0..here.len()).filter(|&i| i == 0 || here[i] != here[i - 1]);
        found.extend(fresh.map(|i| [a, here[i]]));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_sorted_and_occur_once() {
        let pairs = [[3, 4], [0, 2], [3, 4], [0, 1], [1, 4], [0, 2]];
        let found = sorted(&pairs, 5, &Watch::idle()).unwrap();
        assert_eq!(found, [[0, 1], [0, 2], [1, 4], [3, 4]]);
        assert!(sorted(&[], 0, &Watch::idle()).unwrap().is_empty());
    }
}
