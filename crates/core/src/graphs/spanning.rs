//! The Euclidean minimum spanning tree: Kruskal's algorithm on Delaunay edges.
//!
//! J. B. Kruskal, "On the shortest spanning subtree of a graph and the traveling salesman problem"
//! (1956). Equal lengths are ordered by the coordinates of the smaller and then of the larger end.
//! That is a strict order of all pairs, so there is one tree, whatever the rows. It is inside the
//! relative neighborhood graph: where p is in the lune of a b, a p and p b are shorter and replace
//! a b. So edges that a neighbor shows not to be in that graph, by rounded lengths that differ
//! enough, are left out first.
//!
//! Edges are sorted by rounded squares. Where these are too near to each other, the run is put in
//! order exactly.

use std::cmp::Ordering;

use delone_predicates::proximity::shorter;
use delone_predicates::{Point2, Sign};

use super::edges::{SHARE, Skeleton, sorted};
use super::tree::{certainly_above, squared};
use super::triangles::filtered;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::order::{sort_by, sort_shared};

/// Edges between two checks for interruption.
const LOT: usize = 1 << 16;
/// The longest run whose edges are ordered without numbers for the order of points.
const SHORT: usize = 64;

/// A squared length, rounded, and the number of an edge.
type Item = (f64, u32);

/// The edges of the tree, or of the forest if the skeleton is not connected.
pub fn spanning_tree<const D: usize>(
    skeleton: &Skeleton<D>,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let edges = skeleton.map(workers, watch, |edge| may_be_in_tree(skeleton, edge))?;
    let chosen = kruskal(skeleton.points, &edges, workers, watch)?;
    let mut found = with_room(chosen.iter().filter(|&&chosen| chosen).count())?;
    let kept = edges.iter().zip(&chosen).filter(|(_, chosen)| **chosen);
    found.extend(kept.map(|(&edge, _)| edge));
    Ok(found)
}

/// The same for the triangles of a 2-D triangulation, of which no list of edges is needed.
pub fn spanning_tree_of_triangles(
    points: &[Point2],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let edges = filtered(simplices, neighbors, workers, watch, |corners| {
        let [a, b, c] = corners.map(|v| points[v as usize]);
        let lengths = [squared(b, c), squared(c, a), squared(a, b)];
        let is_longest = |&k: &usize| {
            let others = [lengths[(k + 1) % 3], lengths[(k + 2) % 3]];
            others.iter().all(|&x| certainly_above(lengths[k], x))
        };
        (0..3).find(is_longest).map_or(0, |k| 1 << k)
    })?;
    let chosen = kruskal(points, &edges, workers, watch)?;
    let kept = edges.iter().zip(&chosen).filter(|(_, chosen)| **chosen);
    let mut found = with_room(points.len())?;
    found.extend(kept.map(|(&edge, _)| edge));
    sorted(&found, points.len(), watch)
}

/// Which edges are in the tree.
fn kruskal<const D: usize>(
    points: &[[f64; D]],
    edges: &[[i32; 2]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<bool>> {
    let mut items = by_length(points, edges, workers, watch)?;
    settle(points, edges, &mut items, watch)?;
    let mut sets = Sets::of(points.len())?;
    let mut chosen = filled(edges.len(), false)?;
    let mut pace = Pace::new(watch, LOT);
    for &(_, i) in &items {
        pace.spend(1)?;
        let [a, b] = edges[i as usize];
        chosen[i as usize] = sets.join(a as u32, b as u32);
    }
    Ok(chosen)
}

/// The edge, unless a neighbor of one end is certainly in its lune.
fn may_be_in_tree<const D: usize>(skeleton: &Skeleton<D>, edge: [i32; 2]) -> Option<[i32; 2]> {
    let [i, j] = skeleton.by_degree(edge);
    let (a, b) = (skeleton.at(i), skeleton.at(j));
    let length = squared(a, b);
    let in_lune = |&v: &i32| {
        let p = skeleton.at(v);
        certainly_above(length, squared(a, p)) && certainly_above(length, squared(b, p))
    };
    (!skeleton.around(i).iter().any(in_lune)).then_some(edge)
}

/// The edges sorted by rounded lengths.
fn by_length<const D: usize>(
    points: &[[f64; D]],
    edges: &[[i32; 2]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Item>> {
    let mut items: Vec<Item> = filled(edges.len(), (0.0, 0))?;
    let shares = (0..).step_by(SHARE).zip(items.chunks_mut(SHARE)).collect();
    parallel::map_watched(
        workers,
        shares,
        watch,
        |(first, share): (u32, &mut [Item])| {
            for (i, item) in (first..).zip(share) {
                let [a, b] = edges[i as usize];
                *item = (squared(points[a as usize], points[b as usize]), i);
            }
            Ok(())
        },
    )?;
    sort_shared(&mut items, workers, watch, by_item)?;
    Ok(items)
}

fn by_item(one: &Item, other: &Item) -> Ordering {
    one.0.total_cmp(&other.0).then(one.1.cmp(&other.1))
}

/// Puts the edges in order whose rounded lengths are too near to decide.
fn settle<const D: usize>(
    points: &[[f64; D]],
    edges: &[[i32; 2]],
    items: &mut [Item],
    watch: &Watch,
) -> Result<()> {
    let point = |v: i32| points[v as usize];
    let mut pace = Pace::new(watch, LOT);
    let mut numbers: Option<Vec<u32>> = None;
    let near = |one: &Item, next: &Item| !certainly_above(next.0, one.0);
    for run in items.chunk_by_mut(near) {
        pace.spend(run.len())?;
        if run.len() == 1 {
            continue;
        }
        if run.len() > SHORT && numbers.is_none() {
            numbers = Some(numbers_of(points, watch)?);
        }
        let ends = |item: &Item| {
            let [a, b] = edges[item.1 as usize];
            if point(a) <= point(b) { [a, b] } else { [b, a] }
        };
        let by_ends = |one: &Item, other: &Item| {
            let (one, other) = (ends(one), ends(other));
            if let Some(numbers) = &numbers {
                let number = |v: i32| numbers[v as usize];
                return one.map(number).cmp(&other.map(number));
            }
            let at = |ends: [i32; 2]| ends.map(point);
            at(one).partial_cmp(&at(other)).unwrap_or(Ordering::Equal)
        };
        let by_length = |one: &Item, other: &Item| {
            let ([a, b], [c, d]) = (edges[one.1 as usize], edges[other.1 as usize]);
            match shorter(point(a), point(b), point(c), point(d)) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => Ordering::Equal,
                Sign::Negative => Ordering::Greater,
            }
        };
        // Mostly all lengths are equal, and to find that takes linear time.
        let mut equal = true;
        for pair in run.windows(2) {
            pace.spend(1)?;
            equal = equal && by_length(&pair[0], &pair[1]).is_eq();
        }
        if equal {
            sort_by(run, watch, by_ends)?;
        } else {
            sort_by(run, watch, |one, other| {
                by_length(one, other).then_with(|| by_ends(one, other))
            })?;
        }
    }
    Ok(())
}

/// The number of each row in the lexicographic order of points; equal points have several, but only
/// one of them has edges.
fn numbers_of<const D: usize>(points: &[[f64; D]], watch: &Watch) -> Result<Vec<u32>> {
    let mut order = with_room(points.len())?;
    order.extend(0..points.len() as u32);
    let at = |i: &u32| points[*i as usize];
    sort_by(&mut order, watch, |i, j| {
        at(i).partial_cmp(&at(j)).unwrap_or(Ordering::Equal)
    })?;
    let mut numbers = filled(points.len(), 0)?;
    for (number, &row) in (0..).zip(&order) {
        numbers[row as usize] = number;
    }
    Ok(numbers)
}
