//! The edges and the faces of tetrahedra, each once, in lexicographic order. Topology alone: no coordinate.
//!
//! What is to be listed goes to its smallest vertex by a counting sort, and what comes there, a few dozen
//! rows, is sorted: in all O(m), where a sort of everything would go through memory again and again.

use crate::error::Result;
use crate::memory::{filled, with_room};
use crate::parallel;
use crate::watch::Watch;

/// The pairs of corners of a tetrahedron.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
/// Parts into which the vertices are divided for each thread.
const PARTS: usize = 8;

/// Every edge once, of tetrahedra on `n` points: the smaller vertex first, rows ascending.
pub fn edges(
    simplices: &[[i32; 4]],
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let all = || {
        simplices
            .iter()
            .flat_map(|t| EDGES.map(|[i, j]| (t[i].min(t[j]), t[i].max(t[j]))))
    };
    let row = |u: i32, v: i32| [u, v];
    distinct(all, n, workers, watch, row)
}

/// Every face once: vertices and rows ascending. Of a face between two tetrahedra the later one counts.
pub fn faces(
    simplices: &[[i32; 4]],
    neighbors: &[[i32; 4]],
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 3]>> {
    let all = || {
        let each = (0i32..).zip(simplices.iter().zip(neighbors));
        each.flat_map(|(t, (corners, beyond))| {
            let own = (0..4).filter(move |&k| beyond[k] < t);
            own.map(move |k| {
                let mut face = [0, 1, 2].map(|i| corners[i + usize::from(i >= k)]);
                face.sort_unstable();
                let [u, v, w] = face;
                (u, u64::from(v as u32) << 32 | u64::from(w as u32))
            })
        })
    };
    let row = |u: i32, rest: u64| [u, (rest >> 32) as i32, rest as u32 as i32];
    distinct(all, n, workers, watch, row)
}

/// The different ones of some pairs, whose first are below `n`, in order, each as a row.
fn distinct<T: Copy + Ord + Default + Send, R: Copy + Send, I: Iterator<Item = (i32, T)>>(
    all: impl Fn() -> I,
    n: usize,
    workers: usize,
    watch: &Watch,
    row: impl Fn(i32, T) -> R + Sync,
) -> Result<Vec<R>> {
    let mut starts = filled(n + 1, 0usize)?;
    for (u, _) in all() {
        starts[u as usize + 1] += 1;
    }
    for v in 0..n {
        starts[v + 1] += starts[v];
    }
    watch.check()?;
    let mut rest = filled(starts[n], T::default())?;
    let mut next = with_room(n)?;
    next.extend_from_slice(&starts[..n]);
    for (u, with) in all() {
        let slot = &mut next[u as usize];
        rest[*slot] = with;
        *slot += 1;
    }
    drop(next);
    watch.check()?;
    let share = n.div_ceil(PARTS * workers.max(1)).max(1);
    let mut tasks = Vec::new();
    let mut left = rest.as_mut_slice();
    for first in (0..n).step_by(share) {
        let bounds = &starts[first..=n.min(first + share)];
        let (own, later) = left.split_at_mut(bounds[bounds.len() - 1] - bounds[0]);
        tasks.push((first, bounds, own));
        left = later;
    }
    let parts = parallel::map(workers, tasks, |(first, bounds, own)| {
        let mut rows = Vec::new();
        let mut own = own;
        for (u, ends) in (first as i32..).zip(bounds.windows(2)) {
            let (here, later) = own.split_at_mut(ends[1] - ends[0]);
            own = later;
            here.sort_unstable();
            let fresh = (0..here.len()).filter(|&i| i == 0 || here[i] != here[i - 1]);
            rows.extend(fresh.map(|i| row(u, here[i])));
        }
        rows
    });
    drop(rest);
    let mut found = with_room(parts.iter().map(Vec::len).sum())?;
    parts.into_iter().for_each(|part| found.extend(part));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_on_a_face() {
        let simplices = [[0, 1, 2, 3], [4, 1, 3, 2]];
        let neighbors = [[1, -1, -1, -1], [0, -1, -1, -1]];
        for workers in [1, 3] {
            let watch = Watch::idle();
            let found = edges(&simplices, 6, workers, &watch).unwrap();
            let expected = [
                [0, 1],
                [0, 2],
                [0, 3],
                [1, 2],
                [1, 3],
                [1, 4],
                [2, 3],
                [2, 4],
                [3, 4],
            ];
            assert_eq!(found, expected);
            let found = faces(&simplices, &neighbors, 6, workers, &watch).unwrap();
            let expected = [
                [0, 1, 2],
                [0, 1, 3],
                [0, 2, 3],
                [1, 2, 3],
                [1, 2, 4],
                [1, 3, 4],
                [2, 3, 4],
            ];
            assert_eq!(found, expected);
            assert!(edges(&[], 0, workers, &watch).unwrap().is_empty());
        }
    }
}
