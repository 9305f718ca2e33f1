//! Equal facets in lists: the rows of edges or triangles, and the neighbors of simplices.
//!
//! Facets are put into buckets by their first vertex, and each bucket is sorted: linear time, apart
//! from sorting the few facets of a vertex. A vertex of n facets takes O(n log n).

use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// Facets between two checks for interruption.
const LOT: usize = 1 << 14;

/// Facets of two or three vertices, at least 0, by their vertices.
pub struct Facets {
    /// The first entry of each first vertex, and the end.
    starts: Vec<u32>,
    /// The other vertices of each facet as one number, and its row; ascending in each bucket.
    entries: Vec<(u64, u32)>,
}

/// The vertices but the first as one number.
fn rest<const D: usize>(facet: [i32; D]) -> u64 {
    let digits = facet[1..].iter();
    digits.fold(0, |number, &v| number << 32 | u64::from(v as u32))
}

/// The vertices of a facet, ascending.
pub fn ascending<const D: usize>(facet: [i32; D]) -> [i32; D] {
    let mut facet = facet;
    facet.sort_unstable();
    facet
}

impl Facets {
    /// The rows of `facets`.
    pub fn of<const D: usize>(
        facets: impl ExactSizeIterator<Item = [i32; D]> + Clone,
        watch: &Watch,
    ) -> Result<Self> {
        if u32::try_from(facets.len()).is_err() {
            return Err(Error::Shape("there are more than 2**32 facets".into()));
        }
        let mut pace = Pace::new(watch, LOT);
        let vertices = facets.clone().map(|f| f[0] + 1).max().unwrap_or(0);
        // Counts are two places ahead, so that filling a bucket moves its start to where it belongs.
        let mut starts = filled(vertices as usize + 2, 0_u32)?;
        for facet in facets.clone() {
            pace.spend(1)?;
            starts[facet[0] as usize + 2] += 1;
        }
        for v in 2..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut entries = filled(facets.len(), (0, 0))?;
        for (row, facet) in (0..).zip(facets) {
            pace.spend(1)?;
            let at = &mut starts[facet[0] as usize + 1];
            entries[*at as usize] = (rest(facet), row);
            *at += 1;
        }
        for ends in starts.windows(2) {
            let bucket = &mut entries[ends[0] as usize..ends[1] as usize];
            pace.spend(bucket.len())?;
            bucket.sort_unstable();
        }
        Ok(Self { starts, entries })
    }

    /// The first row with these vertices in this order.
    pub fn row<const D: usize>(&self, facet: [i32; D]) -> Option<u32> {
        let first = usize::try_from(facet[0]).ok()?;
        let end = *self.starts.get(first + 1)?;
        let bucket = &self.entries[self.starts[first] as usize..end as usize];
        let wanted = rest(facet);
        let at = bucket.partition_point(|entry| entry.0 < wanted);
        let entry = bucket.get(at)?;
        (entry.0 == wanted).then_some(entry.1)
    }

    /// The rows of each facet, ascending.
    fn runs(&self) -> impl Iterator<Item = &[(u64, u32)]> {
        let bucket = |ends: &[u32]| &self.entries[ends[0] as usize..ends[1] as usize];
        let buckets = self.starts.windows(2).map(bucket);
        buckets.flat_map(|bucket| bucket.chunk_by(|a, b| a.0 == b.0))
    }
}

/// The first row of `facets` that is each of `wanted`, -1 where there is none; in the same order of
/// vertices, if facets are `directed`.
pub fn rows<const D: usize>(
    facets: &[[i32; D]],
    wanted: &[[i32; D]],
    directed: bool,
    watch: &Watch,
) -> Result<Vec<i32>> {
    let key = |facet: &[i32; D]| match directed {
        true => *facet,
        false => ascending(*facet),
    };
    let known = Facets::of(facets.iter().map(key), watch)?;
    let mut pace = Pace::new(watch, LOT);
    let mut found = with_room(wanted.len())?;
    for facet in wanted {
        pace.spend(1)?;
        found.push(known.row(key(facet)).map_or(-1, |row| row as i32));
    }
    Ok(found)
}

/// The triangle across the edge opposite each corner, -1 if there is none. Of several triangles with
/// the same directed edge, the first is the neighbor of others.
pub fn neighbors_of_triangles(triangles: &[[i32; 3]], watch: &Watch) -> Result<Vec<[i32; 3]>> {
    let edge = |side: usize| {
        let (corners, k) = (triangles[side / 3], side % 3);
        [corners[(k + 1) % 3], corners[(k + 2) % 3]]
    };
    let sides = 0..3 * triangles.len();
    let known = Facets::of(sides.map(|side| ascending(edge(side))), watch)?;
    let mut found = filled(triangles.len(), [-1; 3])?;
    let mut pace = Pace::new(watch, LOT);
    for run in known.runs() {
        pace.spend(run.len())?;
        let rises = |side: u32| {
            let [tail, head] = edge(side as usize);
            tail < head
        };
        let first = |rising: bool| run.iter().find(|entry| rises(entry.1) == rising);
        let first = [first(false), first(true)];
        for &(_, side) in run {
            if let Some(&(_, other)) = first[usize::from(!rises(side))] {
                found[side as usize / 3][side as usize % 3] = (other / 3) as i32;
            }
        }
    }
    Ok(found)
}

/// The tetrahedron across the face opposite each corner, -1 if there is none, whatever their
/// orientations. If more than two have a face, each is linked to the one before it.
pub fn neighbors_of_tetrahedra(tetrahedra: &[[i32; 4]], watch: &Watch) -> Result<Vec<[i32; 4]>> {
    let face = |side: usize| {
        let (corners, k) = (tetrahedra[side / 4], side % 4);
        ascending([1, 2, 3].map(|i| corners[(k + i) % 4]))
    };
    let known = Facets::of((0..4 * tetrahedra.len()).map(face), watch)?;
    let mut found = filled(tetrahedra.len(), [-1; 4])?;
    let mut pace = Pace::new(watch, LOT);
    for run in known.runs().filter(|run| run.len() > 1) {
        pace.spend(run.len())?;
        for (i, &(_, side)) in run.iter().enumerate() {
            let other = run[if i == 0 { 1 } else { i - 1 }].1;
            found[side as usize / 4][side as usize % 4] = (other / 4) as i32;
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_rows_is_found() {
        let facets = [[3, 1], [1, 3], [0, 7], [1, 3]];
        let wanted = [[1, 3], [3, 1], [7, 0], [9, 9], [-1, 3], [1, 2]];
        let watch = Watch::idle();
        let found = rows(&facets, &wanted, true, &watch).unwrap();
        assert_eq!(found, [1, 0, -1, -1, -1, -1]);
        let found = rows(&facets, &wanted, false, &watch).unwrap();
        assert_eq!(found, [0, 0, 2, -1, -1, -1]);
        assert_eq!(rows::<2>(&[], &wanted, true, &watch).unwrap(), [-1; 6]);
    }

    #[test]
    fn triangles_in_a_square_and_a_fold() {
        let watch = Watch::idle();
        let square = [[0, 1, 2], [0, 2, 3]];
        let found = neighbors_of_triangles(&square, &watch).unwrap();
        assert_eq!(found, [[-1, 1, -1], [-1, -1, 0]]);
        // Both triangles have the edge 1 to 2: neither is beyond it.
        let fold = [[0, 1, 2], [3, 1, 2]];
        let found = neighbors_of_triangles(&fold, &watch).unwrap();
        assert_eq!(found, [[-1; 3]; 2]);
    }

    #[test]
    fn tetrahedra_with_a_common_face() {
        let pair = [[0, 1, 2, 3], [4, 3, 2, 1]];
        let found = neighbors_of_tetrahedra(&pair, &Watch::idle()).unwrap();
        assert_eq!(found, [[1, -1, -1, -1], [0, -1, -1, -1]]);
    }
}
