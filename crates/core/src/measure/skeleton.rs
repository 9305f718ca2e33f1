//! Lists the edges and faces of simplices, each once, in lexicographic order, and the neighbors of
//! vertices.
//!
//! Topology only: no coordinates.
//!
//! Vertices are divided into ranges that fit the cache. A first pass over the simplices puts each
//! row in the bucket of the range of its smallest vertex; then each bucket is distributed to its
//! vertices by a counting sort, and the few rows of each vertex are sorted. In total O(m), in tasks
//! that share nothing.

use crate::base::error::{Error, Result};
use crate::base::memory::{Zero, copied, filled, push, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;
/// Simplices per task in the first pass.
const SHARE: usize = 1 << 16;
/// The fewest vertices per bucket.
const RANGE: usize = 1 << 12;
/// The most buckets, so that each gets many rows of a task.
const BUCKETS: usize = 256;

/// Every edge of triangles on `n` points once: the smaller vertex first, rows ascending. An edge
/// between two triangles is listed for the later one.
pub fn edges2(
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let rows_of = |t: usize, to: &mut Buckets<u32>| {
        let (corners, beyond) = (simplices[t], neighbors[t]);
        for k in 0..3 {
            if beyond[k] < t as i32 {
                let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                to.put(a.min(b), a.max(b) as u32)?;
            }
        }
        Ok(())
    };
    let row = |u: i32, v: u32| [u, v as i32];
    distinct::<true, _, _>(simplices.len(), n, workers, watch, rows_of, row)
}

/// Every edge of simplices on `n` points once, in three dimensions or more: the smaller vertex first,
/// rows ascending.
pub fn edges<const N: usize>(
    simplices: &[[i32; N]],
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let rows_of = |t: usize, to: &mut Buckets<u32>| {
        let corners = simplices[t];
        for j in 1..N {
            for i in 0..j {
                let (a, b) = (corners[i], corners[j]);
                to.put(a.min(b), a.max(b) as u32)?;
            }
        }
        Ok(())
    };
    let row = |u: i32, v: u32| [u, v as i32];
    distinct::<false, _, _>(simplices.len(), n, workers, watch, rows_of, row)
}

/// Every face of tetrahedra once: vertices and rows ascending. A face between two tetrahedra is
/// listed for the later one.
pub fn faces3(
    simplices: &[[i32; 4]],
    neighbors: &[[i32; 4]],
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 3]>> {
    let rows_of = |t: usize, to: &mut Buckets<u64>| {
        let (corners, beyond) = (simplices[t], neighbors[t]);
        for k in (0..4).filter(|&k| beyond[k] < t as i32) {
            let mut face = [0, 1, 2].map(|i| corners[i + usize::from(i >= k)]);
            face.sort_unstable();
            let [u, v, w] = face;
            to.put(u, u64::from(v as u32) << 32 | u64::from(w as u32))?;
        }
        Ok(())
    };
    let row = |u: i32, rest: u64| [u, (rest >> 32) as i32, rest as u32 as i32];
    distinct::<true, _, _>(simplices.len(), n, workers, watch, rows_of, row)
}

/// The neighbors of each of `n` vertices along `edges`, ascending: where they begin in the second
/// result, plus the end. Each edge must occur once, the smaller vertex first, rows ascending.
pub fn around(edges: &[[i32; 2]], n: usize, watch: &Watch) -> Result<(Vec<i32>, Vec<i32>)> {
    let wrong = || Error::Shape("edges must be sorted and unique".into());
    let mut pace = Pace::new(watch, LOT);
    let mut starts = zeroed::<i32>(n + 1)?;
    if edges.len() > i32::MAX as usize / 2 {
        return Err(wrong());
    }
    let mut last = [-1; 2];
    for &[u, v] in edges {
        pace.spend(1)?;
        if u < 0 || u >= v || v as usize >= n || [u, v] <= last {
            return Err(wrong());
        }
        last = [u, v];
        starts[u as usize + 1] += 1;
        starts[v as usize + 1] += 1;
    }
    for v in 0..n {
        starts[v + 1] += starts[v];
    }
    let mut next = copied(&starts)?;
    let mut found = zeroed(2 * edges.len())?;
    // First the smaller neighbors, which are already sorted, then the larger ones.
    for k in [0, 1] {
        for edge in edges {
            pace.spend(1)?;
            let slot = &mut next[edge[1 - k] as usize];
            found[*slot as usize] = edge[k];
            *slot += 1;
        }
    }
    Ok((starts, found))
}

/// The rows of some simplices, bucketed by the range of their first vertex.
pub(crate) struct Buckets<T> {
    /// A range has 2^bits vertices.
    bits: u32,
    rows: Vec<Vec<(i32, T)>>,
}

impl<T> Buckets<T> {
    fn new(n: usize, bits: u32) -> Result<Self> {
        let mut rows = with_room((n >> bits) + 1)?;
        rows.resize_with((n >> bits) + 1, Vec::new);
        Ok(Self { bits, rows })
    }

    #[inline]
    pub(crate) fn put(&mut self, u: i32, rest: T) -> Result<()> {
        push(&mut self.rows[u as usize >> self.bits], (u, rest))
    }
}

/// The rows of `count` simplices, sorted. A row is its first vertex, below `n`, and the rest. If
/// `UNIQUE`, no two rows are equal; otherwise, of equal rows one is kept.
pub(crate) fn distinct<const UNIQUE: bool, T, R>(
    count: usize,
    n: usize,
    workers: usize,
    watch: &Watch,
    rows_of: impl Fn(usize, &mut Buckets<T>) -> Result<()> + Sync,
    row: impl Fn(i32, T) -> R + Sync,
) -> Result<Vec<R>>
where
    T: Copy + Ord + Default + Send + Sync,
    R: Zero + Send + Sync,
{
    let bits = n.div_ceil(BUCKETS).max(RANGE).next_power_of_two().ilog2();
    // Distribute the rows of each share of simplices to buckets.
    let shares = (0..count).step_by(SHARE).collect();
    let dealt = parallel::map(workers, shares, |start| {
        watch.check()?;
        let mut buckets = Buckets::new(n, bits)?;
        for t in start..count.min(start + SHARE) {
            rows_of(t, &mut buckets)?;
        }
        Ok(buckets.rows)
    });
    let dealt = dealt.into_iter().collect::<Result<Vec<_>>>()?;
    let numbers = 0..(n >> bits) + 1;
    let bucket = |b: usize| {
        let parts = dealt.iter().map(|rows| rows[b].as_slice());
        Grouped::of(parts, (b << bits) as i32, 1 << bits)
    };
    if UNIQUE {
        let length = |b: usize| dealt.iter().map(|rows| rows[b].len()).sum();
        let mut found = zeroed(numbers.clone().map(length).sum())?;
        let tasks = numbers.clone().zip(split(&mut found, numbers.map(length))?);
        parallel::map_watched(workers, tasks.collect(), watch, |(b, own)| {
            let mut grouped = bucket(b)?;
            let rows = grouped
                .rows()
                .flat_map(|(u, rest)| rest.iter().map(move |&r| (u, r)));
            own.iter_mut()
                .zip(rows)
                .for_each(|(own, (u, rest))| *own = row(u, rest));
            Ok(())
        })?;
        return Ok(found);
    }
    let sorted = parallel::map(workers, numbers.collect(), |b| {
        watch.check()?;
        let mut grouped = bucket(b)?;
        let mut found = with_room(grouped.rest.len())?;
        for (u, rest) in grouped.rows() {
            let fresh = (0..rest.len()).filter(|&i| i == 0 || rest[i] != rest[i - 1]);
            found.extend(fresh.map(|i| row(u, rest[i])));
        }
        Ok(found)
    });
    drop(dealt);
    let sorted = sorted.into_iter().collect::<Result<Vec<_>>>()?;
    let mut found = zeroed(sorted.iter().map(Vec::len).sum())?;
    let parts = split(&mut found, sorted.iter().map(Vec::len))?;
    let tasks = parts.into_iter().zip(sorted).collect();
    parallel::map_watched(workers, tasks, watch, |(own, part): (&mut [R], Vec<R>)| {
        own.copy_from_slice(&part);
        Ok(())
    })?;
    Ok(found)
}

/// Consecutive parts of the given lengths.
fn split<T>(all: &mut [T], lengths: impl Iterator<Item = usize>) -> Result<Vec<&mut [T]>> {
    let mut left = all;
    let mut parts = with_room(lengths.size_hint().0)?;
    for length in lengths {
        let (own, later) = left.split_at_mut(length);
        push(&mut parts, own)?;
        left = later;
    }
    Ok(parts)
}

/// The rows of a bucket, grouped by their first vertex.
struct Grouped<T> {
    first: i32,
    /// Where the rows of each vertex end.
    ends: Vec<u32>,
    rest: Vec<T>,
}

impl<T: Copy + Ord + Default> Grouped<T> {
    /// Rows whose first vertices are the `range` ones from `first` on.
    fn of<'a>(
        parts: impl Iterator<Item = &'a [(i32, T)]> + Clone,
        first: i32,
        range: usize,
    ) -> Result<Self>
    where
        T: 'a,
    {
        let mut ends = filled(range + 1, 0u32)?;
        for &(u, _) in parts.clone().flatten() {
            ends[(u - first) as usize + 1] += 1;
        }
        for v in 0..range {
            ends[v + 1] += ends[v];
        }
        let mut rest = filled(ends[range] as usize, T::default())?;
        // This moves each entry from the start of its vertex to its end.
        for &(u, with) in parts.flatten() {
            let slot = &mut ends[(u - first) as usize];
            rest[*slot as usize] = with;
            *slot += 1;
        }
        ends.pop();
        Ok(Self { first, ends, rest })
    }

    /// Each vertex and its rows, sorted.
    fn rows(&mut self) -> impl Iterator<Item = (i32, &[T])> {
        let mut left = self.rest.as_mut_slice();
        let mut start = 0;
        (self.first..).zip(&self.ends).map(move |(u, &end)| {
            let (here, later) = std::mem::take(&mut left).split_at_mut((end - start) as usize);
            (start, left) = (end, later);
            here.sort_unstable();
            (u, &*here)
        })
    }
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
            let found = faces3(&simplices, &neighbors, 6, workers, &watch).unwrap();
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
            assert!(edges::<4>(&[], 0, workers, &watch).unwrap().is_empty());
        }
    }

    #[test]
    fn two_triangles_on_an_edge() {
        let watch = Watch::idle();
        let (simplices, neighbors) = ([[0, 1, 3], [1, 2, 3]], [[1, -1, -1], [-1, 0, -1]]);
        let found = edges2(&simplices, &neighbors, 5, 2, &watch).unwrap();
        assert_eq!(found, [[0, 1], [0, 3], [1, 2], [1, 3], [2, 3]]);
        let (starts, neighbors) = around(&found, 5, &watch).unwrap();
        assert_eq!(starts, [0, 2, 5, 7, 10, 10]);
        assert_eq!(neighbors, [1, 3, 0, 2, 3, 1, 3, 0, 1, 2]);
        for wrong in [&[[1, 0]][..], &[[0, 1], [0, 1]], &[[0, 5]], &[[-1, 0]]] {
            assert!(matches!(around(wrong, 5, &watch), Err(Error::Shape(_))));
        }
    }
}
