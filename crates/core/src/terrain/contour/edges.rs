//! The edges of each level or band, collected from all triangles; each has its own numbers of places.

use super::link::Edge;
use super::nodes::{Nodes, SHARE};
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::parallel::map_watched;
use crate::base::watch::Watch;
use delone_predicates::Point2;

/// Shares of the triangles times groups is at most this: each share has a start for each group.
const STARTS: usize = 1 << 24;

/// The places of a group are numbered by bits of all places if one in this many words has a bit;
/// otherwise they are sorted.
const SPARSE: usize = 16;

/// The edges of a share of the triangles.
struct Share {
    /// The first group that has edges.
    lowest: u32,
    /// The start of each group in the edges, and the end of the last.
    starts: Vec<u32>,
    edges: Vec<Edge>,
}

/// The edges of all triangles by group, which is a level or a band.
pub struct Edges(Vec<Share>);

impl Edges {
    /// Collects the edges that `each` returns for a triangle, with their groups.
    pub fn collect(
        nodes: &Nodes,
        groups: usize,
        (workers, watch): (usize, &Watch),
        each: impl Fn(usize, &mut dyn FnMut(u32, Edge)) + Sync,
    ) -> Result<Self> {
        let size = SHARE.max((nodes.triangles() / STARTS).saturating_mul(groups));
        let found = map_watched(workers, nodes.shares(size), watch, |share| {
            let mut found = Vec::new();
            let mut ended = Ok(());
            for t in share {
                if t.is_multiple_of(SHARE) {
                    watch.check()?;
                }
                each(t, &mut |group, edge| {
                    if ended.is_ok() {
                        ended = push(&mut found, (group, edge));
                    }
                });
            }
            ended?;
            Share::sorted(&found)
        })?;
        Ok(Self(found))
    }

    /// The edges of a group, in the order of their triangles.
    pub fn group(&self, group: u32) -> Result<Vec<Edge>> {
        let runs = || self.0.iter().map(|share| share.group(group));
        let mut found = with_room(runs().map(<[Edge]>::len).sum())?;
        runs().for_each(|run| found.extend_from_slice(run));
        Ok(found)
    }
}

impl Share {
    /// Sorts edges by group; those of a group keep their order.
    fn sorted(found: &[(u32, Edge)]) -> Result<Self> {
        let groups = || found.iter().map(|&(group, _)| group);
        let lowest = groups().min().unwrap_or(0);
        let count = groups()
            .max()
            .map_or(0, |highest| (highest - lowest) as usize + 1);
        // After the sums, each start is that of its group, and moves on with each edge to that of the next.
        let mut starts: Vec<u32> = filled(count + 1, 0)?;
        for group in groups() {
            starts[(group - lowest) as usize + 1] += 1;
        }
        for group in 0..count {
            starts[group + 1] += starts[group];
        }
        let none = Edge {
            from: 0,
            to: 0,
            owner: 0,
        };
        let mut edges = filled(found.len(), none)?;
        for &(group, edge) in found {
            let next = &mut starts[(group - lowest) as usize];
            edges[*next as usize] = edge;
            *next += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
        Ok(Self {
            lowest,
            starts,
            edges,
        })
    }

    /// The edges of a group.
    fn group(&self, group: u32) -> &[Edge] {
        let range = group.checked_sub(self.lowest).and_then(|group| {
            let group = group as usize;
            Some(*self.starts.get(group)? as usize..*self.starts.get(group + 1)? as usize)
        });
        range.map_or(&[], |range| &self.edges[range])
    }
}

/// The places of the edges of a group, numbered from 0 on in their order.
pub struct Local {
    /// The place of each number.
    pub places: Vec<u32>,
    /// Its position.
    pub at: Vec<Point2>,
}

impl Local {
    /// Numbers the places of edges, and changes these to the numbers.
    pub fn of(nodes: &Nodes, edges: &mut [Edge]) -> Result<Self> {
        let words = nodes.len().div_ceil(64);
        let places = if edges.len() < words / SPARSE {
            by_sorting(edges)?
        } else {
            by_bits(edges, words)?
        };
        let mut at = with_room(places.len())?;
        at.extend(places.iter().map(|&place| nodes.at(place)));
        Ok(Self { places, at })
    }
}

/// Numbers places by their order; returns them.
fn by_sorting(edges: &mut [Edge]) -> Result<Vec<u32>> {
    let mut places = with_room(2 * edges.len())?;
    places.extend(edges.iter().flat_map(|edge| [edge.from, edge.to]));
    places.sort_unstable();
    places.dedup();
    for edge in edges {
        for end in [&mut edge.from, &mut edge.to] {
            *end = places.partition_point(|place| place < end) as u32;
        }
    }
    Ok(places)
}

/// The same with a bit for each place, and the number of bits before each word.
fn by_bits(edges: &mut [Edge], words: usize) -> Result<Vec<u32>> {
    let mut bits = filled(words, (0_u64, 0_u32))?;
    let split = |place: u32| (place as usize / 64, place % 64);
    for edge in edges.iter() {
        for (word, bit) in [edge.from, edge.to].map(split) {
            bits[word].0 |= 1 << bit;
        }
    }
    let mut places = Vec::new();
    make_room(
        &mut places,
        bits.iter().map(|word| word.0.count_ones() as usize).sum(),
    )?;
    for (number, word) in bits.iter_mut().enumerate() {
        word.1 = places.len() as u32;
        let mut left = word.0;
        while left != 0 {
            places.push(64 * number as u32 + left.trailing_zeros());
            left &= left - 1;
        }
    }
    for edge in edges {
        for end in [&mut edge.from, &mut edge.to] {
            let (word, bit) = split(*end);
            let (all, before) = bits[word];
            *end = before + (all & ((1 << bit) - 1)).count_ones();
        }
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(count: u32, places: u32) -> Vec<Edge> {
        let number = |k: u32| k.wrapping_mul(2_654_435_761) % places;
        (0..count)
            .map(|k| Edge {
                from: number(k),
                to: number(k ^ 0x5555),
                owner: k,
            })
            .collect()
    }

    #[test]
    fn both_ways_to_number_places_agree() {
        for (count, places) in [(0, 1), (1, 64), (40, 65), (1_000, 900), (300, 1 << 20)] {
            let given = edges(count, places);
            let (mut sorted, mut by_bit) = (given.clone(), given.clone());
            let numbered = by_sorting(&mut sorted).unwrap();
            let words = (places as usize).div_ceil(64);
            assert_eq!(by_bits(&mut by_bit, words).unwrap(), numbered);
            assert!(numbered.is_sorted_by(|a, b| a < b));
            let ends = |edge: &Edge| [edge.from, edge.to];
            for ((a, b), given) in sorted.iter().zip(&by_bit).zip(&given) {
                assert_eq!(ends(a), ends(b));
                assert_eq!(ends(a).map(|k| numbered[k as usize]), ends(given));
            }
        }
    }

    #[test]
    fn edges_of_a_group_keep_their_order() {
        let found: Vec<(u32, Edge)> = edges(500, 70)
            .into_iter()
            .map(|edge| (7 + edge.from % 11, edge))
            .collect();
        let share = Share::sorted(&found).unwrap();
        for group in 0..40 {
            let want: Vec<u32> = found
                .iter()
                .filter(|each| each.0 == group)
                .map(|each| each.1.owner)
                .collect();
            let owners: Vec<u32> = share.group(group).iter().map(|edge| edge.owner).collect();
            assert_eq!(owners, want);
        }
    }
}
