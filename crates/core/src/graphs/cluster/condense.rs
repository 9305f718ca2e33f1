//! The condensed tree of a hierarchy: clusters of a minimum size, and where their rows leave them.
//!
//! R. J. G. B. Campello, D. Moulavi, A. Zimek and J. Sander, "Hierarchical density estimates for
//! data clustering, visualization, and outlier detection" (2015). From the root down, each level
//! splits a component into several parts at once, since edges of equal weight are removed together.
//! If two parts or more are large enough, they are new clusters. If one is, the cluster continues
//! as it. The rows of all other parts leave the cluster here.
//!
//! A lambda is one over a distance. The stability of a cluster is the sum over its rows of the
//! lambda where they leave, minus the one where the cluster begins; it is summed by levels, so that
//! the order of rows does not change it.

use super::hierarchy::Hierarchy;
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};

/// Merges between two checks for interruption.
const LOT: usize = 1 << 14;
/// No cluster, level or row.
const NONE: u32 = u32::MAX;

/// Clusters, and the rows that leave them. Cluster 0 is the root; others follow in the order of the
/// lambda where they begin, then of their first rows.
pub struct Condensed {
    /// The cluster that each row leaves last.
    pub clusters: Vec<i32>,
    /// The level of the distance where it does.
    pub levels: Vec<i32>,
    /// The cluster that each cluster is split from, -1 for the root.
    pub parents: Vec<i32>,
    /// The level of this split, -1 for the root.
    pub births: Vec<i32>,
    /// The last level where rows or clusters leave each cluster.
    pub deaths: Vec<i32>,
    /// Number of rows of each cluster.
    pub sizes: Vec<i32>,
    /// Stability of each cluster, in a unit that is a power of two.
    pub stabilities: Vec<f64>,
}

/// Two merged nodes, rows or earlier merges, and what is below them.
struct Merge {
    parts: [u32; 2],
    level: u32,
    size: u32,
    /// The smallest row.
    first: u32,
    /// Parts of its level that are large enough: their number, and rows in all of them.
    large: [u32; 2],
}

/// What a merge does to its cluster, for all merges of one component and level.
#[derive(Clone, Copy)]
struct State {
    cluster: u32,
    /// The level where all rows have left, or `NONE`.
    left: u32,
    /// How many parts are large enough.
    large: u32,
}

/// The condensed tree of `n` rows, at least two; clusters have at least `least` rows.
pub fn condense(hierarchy: &Hierarchy, n: usize, least: usize, watch: &Watch) -> Result<Condensed> {
    let merges = merges(hierarchy, n, least.min(n + 1) as u32, watch)?;
    let mut work = Work {
        n: n as u32,
        least: least.min(n + 1) as u32,
        heights: &hierarchy.heights,
        unit: unit(&hierarchy.heights),
        merges: &merges,
        firsts: vec![0],
        found: Condensed {
            clusters: filled(n, 0)?,
            levels: filled(n, 0)?,
            parents: vec![-1],
            births: vec![-1],
            deaths: vec![-1],
            sizes: vec![n as i32],
            stabilities: vec![0.0],
        },
    };
    work.descend(watch)?;
    work.numbered()
}

/// A power of two, at most the first height above zero: one over a small height would overflow.
fn unit(heights: &[f64]) -> f64 {
    let first = heights.iter().copied().find(|&height| height > 0.0);
    let bits = first.unwrap_or(1.0).to_bits();
    match bits & f64::INFINITY.to_bits() {
        // Subnormal: the highest bit.
        0 => f64::from_bits(1 << bits.ilog2()),
        exponent => f64::from_bits(exponent),
    }
}

/// The merges of a hierarchy, those below before those above.
fn merges(hierarchy: &Hierarchy, n: usize, least: u32, watch: &Watch) -> Result<Vec<Merge>> {
    let mut sets = Sets::of(n)?;
    let mut nodes = with_room(n)?;
    nodes.extend(0..n as u32);
    let mut merges: Vec<Merge> = with_room(hierarchy.links.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (link, &level) in hierarchy.links.iter().zip(&hierarchy.levels) {
        pace.spend(1)?;
        let roots = link.ends.map(|row| sets.root(row));
        sets.join(link.ends[0], link.ends[1]);
        let parts = roots.map(|root| nodes[root as usize]);
        let mut merge = Merge {
            parts,
            level,
            size: 0,
            // Roots are first rows.
            first: roots[0].min(roots[1]),
            large: [0, 0],
        };
        for part in parts {
            let below = (part as usize).checked_sub(n).map(|i| &merges[i]);
            let size = below.map_or(1, |below| below.size);
            merge.size += size;
            let more = match below {
                Some(below) if below.level == level => below.large,
                _ if size >= least => [1, size],
                _ => [0, 0],
            };
            merge.large = [merge.large[0] + more[0], merge.large[1] + more[1]];
        }
        nodes[merge.first as usize] = (n + merges.len()) as u32;
        merges.push(merge);
    }
    Ok(merges)
}

/// The descent from the root.
struct Work<'a> {
    n: u32,
    least: u32,
    heights: &'a [f64],
    /// The numerator of lambdas.
    unit: f64,
    merges: &'a [Merge],
    /// The first row of each cluster.
    firsts: Vec<u32>,
    found: Condensed,
}

impl Work<'_> {
    /// Goes through all merges, those above before those below.
    fn descend(&mut self, watch: &Watch) -> Result<()> {
        let root = State {
            cluster: 0,
            left: NONE,
            large: NONE,
        };
        let mut states = filled(self.merges.len(), root)?;
        let mut pace = Pace::new(watch, LOT);
        for i in (0..self.merges.len()).rev() {
            pace.spend(1)?;
            let merge = &self.merges[i];
            let mut state = states[i];
            if state.large == NONE && state.left == NONE {
                // The uppermost merge of its level here.
                state.large = merge.large[0];
                self.leave(state.cluster, merge);
            }
            for part in merge.parts {
                let below = part.checked_sub(self.n).map(|i| &self.merges[i as usize]);
                let state = self.below(state, merge.level, below)?;
                match part.checked_sub(self.n) {
                    Some(i) => states[i as usize] = state,
                    None => {
                        self.found.clusters[part as usize] = state.cluster as i32;
                        self.found.levels[part as usize] = state.left as i32;
                    }
                }
            }
        }
        Ok(())
    }

    /// The state of a part of a merge, a row if `below` is `None`.
    fn below(&mut self, state: State, level: u32, below: Option<&Merge>) -> Result<State> {
        if state.left != NONE || below.is_some_and(|below| below.level == level) {
            return Ok(state);
        }
        let Some(below) = below.filter(|below| below.size >= self.least) else {
            return Ok(State {
                left: level,
                ..state
            });
        };
        let cluster = if state.large > 1 {
            self.split(state.cluster, level, below)?
        } else {
            state.cluster
        };
        Ok(State {
            cluster,
            left: NONE,
            large: NONE,
        })
    }

    /// Counts what leaves a cluster at a level.
    fn leave(&mut self, cluster: u32, merge: &Merge) {
        let [count, rows] = merge.large;
        let gone = if count == 1 {
            merge.size - rows
        } else {
            merge.size
        };
        let i = cluster as usize;
        let birth = match self.found.births[i] {
            -1 => 0.0,
            level => self.unit / self.heights[level as usize],
        };
        let lambda = self.unit / self.heights[merge.level as usize];
        if gone > 0 && lambda > birth {
            self.found.stabilities[i] += (lambda - birth) * f64::from(gone);
        }
        if gone > 0 {
            self.found.deaths[i] = merge.level as i32;
        }
    }

    /// A new cluster.
    fn split(&mut self, parent: u32, level: u32, merge: &Merge) -> Result<u32> {
        let found = &mut self.found;
        push(&mut found.parents, parent as i32)?;
        push(&mut found.births, level as i32)?;
        push(&mut found.deaths, -1)?;
        push(&mut found.sizes, merge.size as i32)?;
        push(&mut found.stabilities, 0.0)?;
        push(&mut self.firsts, merge.first)?;
        Ok(self.firsts.len() as u32 - 1)
    }

    /// The same with clusters in an order that does not depend on how the tree was built.
    fn numbered(self) -> Result<Condensed> {
        let found = self.found;
        let count = self.firsts.len();
        let mut order = with_room(count)?;
        order.extend(0..count);
        // The root is first; it is the only one without a level.
        order[1..].sort_unstable_by_key(|&i| (-found.births[i], self.firsts[i]));
        let mut numbers = filled(count, 0i32)?;
        for (number, &i) in (0..).zip(&order) {
            numbers[i] = number;
        }
        let number = |cluster: i32| match cluster {
            -1 => -1,
            _ => numbers[cluster as usize],
        };
        let ordered = |values: &[i32]| order.iter().map(|&i| values[i]).collect::<Vec<_>>();
        let parents = ordered(&found.parents);
        Ok(Condensed {
            clusters: found.clusters.into_iter().map(number).collect(),
            levels: found.levels,
            parents: parents.into_iter().map(number).collect(),
            births: ordered(&found.births),
            deaths: ordered(&found.deaths),
            sizes: ordered(&found.sizes),
            stabilities: order.iter().map(|&i| found.stabilities[i]).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graphs::cluster::{hierarchy, single_links};

    #[test]
    fn equal_weights_split_at_once() {
        // Two pairs and a single point at distance 2 from each other: the pairs are clusters.
        let points = [0.0, 1.0, 3.0, 5.0, 6.0].map(|x| [x, 0.0]);
        let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
        let idle = Watch::idle();
        let links = single_links(&points, &edges, &[], &idle).unwrap();
        let levels = hierarchy(&points, links, 1, &idle).unwrap();
        let found = condense(&levels, 5, 2, &idle).unwrap();
        assert_eq!(found.parents, [-1, 0, 0]);
        assert_eq!(found.births, [-1, 1, 1]);
        assert_eq!(found.sizes, [5, 2, 2]);
        assert_eq!(found.clusters, [1, 1, 0, 2, 2]);
        assert_eq!(found.levels, [0, 0, 1, 0, 0]);
        assert_eq!(found.stabilities, [2.5, 1.0, 1.0]);
        assert_eq!(found.deaths, [1, 0, 0]);
        assert_eq!(unit(&[0.0, 6.0, 7.0]), 4.0);
        assert_eq!(unit(&[1.75e-320]), f64::from_bits(2048));
    }
}
