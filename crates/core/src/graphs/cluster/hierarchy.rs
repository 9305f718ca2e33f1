//! The edges of a spanning tree in the order of their weights, and the merges that they represent.
//!
//! J. C. Gower and G. J. S. Ross, "Minimum spanning trees and single linkage cluster analysis"
//! (1969). Edges are sorted by rounded squares; runs that are too near to each other are then put
//! in order exactly. Edges of equal weight are one level.

use std::cmp::Ordering;

use super::link::{Link, Span};
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::graphs::certainly_above;
use crate::order::{sort_by, sort_shared};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 14;

/// The edges of a spanning tree by weight.
pub struct Hierarchy {
    /// The edges; of equal weight, by the coordinates of the smaller and then of the larger end,
    /// then by rows.
    pub links: Vec<Link>,
    /// The level of each edge: equal weights have the same, larger ones the next.
    pub levels: Vec<u32>,
    /// The weight of each level, correctly rounded.
    pub heights: Vec<f64>,
}

impl Hierarchy {
    /// The number of levels that are below a number, and of those that are not above it.
    pub fn levels_below<const D: usize>(&self, number: f64, points: &[[f64; D]]) -> [usize; 2] {
        let order = |link: &Link| link.span.compare_number(number, points);
        let level = |edges: usize| {
            let next = self.levels.get(edges);
            next.map_or(self.heights.len(), |&level| level as usize)
        };
        [
            level(self.links.partition_point(|link| order(link).is_lt())),
            level(self.links.partition_point(|link| order(link).is_le())),
        ]
    }
}

/// The links of a Euclidean spanning tree, and of length zero from duplicates to first rows.
pub fn single_links<const D: usize>(
    points: &[[f64; D]],
    edges: &[[i32; 2]],
    duplicates: &[[i32; 2]],
    watch: &Watch,
) -> Result<Vec<Link>> {
    let mut links = with_room(edges.len() + duplicates.len())?;
    let mut pace = Pace::new(watch, LOT);
    for &[a, b] in duplicates.iter().chain(edges) {
        pace.spend(1)?;
        let ends = [a as u32, b as u32];
        let span = Span::of(points, ends[0], ends[1]);
        links.push(Link { ends, span });
    }
    Ok(links)
}

/// The hierarchy of the edges of a spanning tree.
pub fn hierarchy<const D: usize>(
    points: &[[f64; D]],
    mut links: Vec<Link>,
    workers: usize,
    watch: &Watch,
) -> Result<Hierarchy> {
    sort_shared(&mut links, workers, watch, |one, other| {
        one.span.square.total_cmp(&other.span.square)
    })?;
    let mut pace = Pace::new(watch, LOT);
    let near = |one: &Link, next: &Link| !certainly_above(next.span.square, one.span.square);
    let by_weight = |one: &Link, other: &Link| one.span.compare(&other.span, points);
    let by_ends = |one: &Link, other: &Link| compare_ends(points, one.ends, other.ends);
    for run in links.chunk_by_mut(near) {
        pace.spend(run.len())?;
        if run.len() == 1 {
            continue;
        }
        // Mostly all are equal, and to find that takes linear time.
        let mut equal = true;
        for pair in run.windows(2) {
            pace.spend(1)?;
            equal = equal && by_weight(&pair[0], &pair[1]).is_eq();
        }
        if equal {
            sort_by(run, watch, by_ends)?;
        } else {
            sort_by(run, watch, |one, other| {
                by_weight(one, other).then_with(|| by_ends(one, other))
            })?;
        }
    }
    let mut levels = with_room(links.len())?;
    let mut heights: Vec<f64> = Vec::new();
    for (i, link) in links.iter().enumerate() {
        pace.spend(1)?;
        if i == 0 || by_weight(&links[i - 1], link).is_lt() {
            crate::base::memory::push(&mut heights, link.span.length(points))?;
        }
        levels.push(heights.len() as u32 - 1);
    }
    Ok(Hierarchy {
        links,
        levels,
        heights,
    })
}

/// By the coordinates of the smaller and of the larger end, then by rows.
fn compare_ends<const D: usize>(points: &[[f64; D]], one: [u32; 2], other: [u32; 2]) -> Ordering {
    let at = |v: u32| points[v as usize];
    let sorted = |[a, b]: [u32; 2]| if at(a) <= at(b) { [a, b] } else { [b, a] };
    let (one, other) = (sorted(one), sorted(other));
    let coordinates = one.map(at).partial_cmp(&other.map(at));
    coordinates.unwrap_or(Ordering::Equal).then(one.cmp(&other))
}

/// The merges as SciPy has them: two clusters, the smaller number first, their distance, and the
/// size of both. Rows are clusters 0 to n - 1, and merge i makes cluster n + i.
pub fn linkage(hierarchy: &Hierarchy, n: usize, watch: &Watch) -> Result<Vec<[f64; 4]>> {
    let mut sets = Sets::of(n)?;
    let mut clusters = with_room(n)?;
    clusters.extend(0..n as u32);
    let mut sizes = filled(n, 1u32)?;
    let mut merges = with_room(hierarchy.links.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (i, (link, &level)) in hierarchy.links.iter().zip(&hierarchy.levels).enumerate() {
        pace.spend(1)?;
        let roots = link.ends.map(|v| sets.root(v) as usize);
        sets.join(link.ends[0], link.ends[1]);
        let root = roots[0].min(roots[1]);
        let [a, b] = roots.map(|root| clusters[root]);
        let size = sizes[roots[0]] + sizes[roots[1]];
        (clusters[root], sizes[root]) = ((n + i) as u32, size);
        let height = hierarchy.heights[level as usize];
        merges.push([
            f64::from(a.min(b)),
            f64::from(a.max(b)),
            height,
            f64::from(size),
        ]);
    }
    Ok(merges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merges_are_in_the_order_of_length() {
        let points = [[0.0, 0.0], [7.0, 4.0], [1.0, 8.0], [0.0, 0.0], [7.0, 5.0]];
        let edges = [[0, 1], [0, 2], [1, 4]];
        let idle = Watch::idle();
        let links = single_links(&points, &edges, &[[3, 0]], &idle).unwrap();
        let found = hierarchy(&points, links, 2, &idle).unwrap();
        // 65 = 1 + 64 = 49 + 16.
        assert_eq!(found.levels, [0, 1, 2, 2]);
        assert_eq!(found.heights, [0.0, 1.0, 65f64.sqrt()]);
        assert_eq!(found.levels_below(1.0, &points), [1, 2]);
        assert_eq!(found.levels_below(65f64.sqrt(), &points), [2, 2]);
        assert_eq!(found.levels_below(9.0, &points), [3, 3]);
        let root = 65f64.sqrt();
        let expected = [
            [0.0, 3.0, 0.0, 2.0],
            [1.0, 4.0, 1.0, 2.0],
            [2.0, 5.0, root, 3.0],
            [6.0, 7.0, root, 5.0],
        ];
        assert_eq!(linkage(&found, 5, &idle).unwrap(), expected);
    }
}
