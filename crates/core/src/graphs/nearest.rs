//! The k nearest neighbors of each point, by a tree of boxes; no triangulation is needed.
//!
//! Boxes are entered from the nearest on until the next one is farther than the k-th neighbor so
//! far (N. Roussopoulos, S. Kelley and F. Vincent, "Nearest neighbor queries", 1995); before that,
//! the points next on the curve are tried. Distances are compared by rounded squares where these
//! differ enough, else exactly; of equally near points the lexicographically smaller one is nearer.

use delone_predicates::Sign;
use delone_predicates::proximity::shorter;

use super::edges::{SHARE, joined, sorted};
use super::tree::{LEAF, Tree, certainly_above, squared, squared_gap};
use crate::base::boxes::Open;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};

/// Tests of points between two checks for interruption.
const LOT: usize = 1 << 14;

/// The neighbors of one point: squared distances and places, nearest first.
pub(crate) type Nearest = Vec<(f64, u32)>;

/// How edges to neighbors are listed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Neighbors {
    /// From each point to its neighbors.
    Directed,
    /// Each pair once if one of the two is a neighbor of the other.
    Either,
}

/// The edges between the points of a tree of `n` rows and their `k` nearest neighbors, fewer if
/// there are not as many.
pub fn nearest<const D: usize>(
    tree: &Tree<D>,
    k: usize,
    list: Neighbors,
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let parts = each(tree, k, workers, watch, |place, near, found| {
        let row = tree.rows[place] as i32;
        for &(_, other) in near {
            let other = tree.rows[other as usize] as i32;
            let pair = match list {
                Neighbors::Directed => [row, other],
                Neighbors::Either => [row.min(other), row.max(other)],
            };
            push(found, pair)?;
        }
        Ok(())
    })?;
    sorted(&parts, n, watch)
}

/// What `of` appends for each place and its `k` nearest neighbors.
pub(crate) fn each<const D: usize, T: Send + Copy>(
    tree: &Tree<D>,
    k: usize,
    workers: usize,
    watch: &Watch,
    of: impl Fn(usize, &Nearest, &mut Vec<T>) -> Result<()> + Sync,
) -> Result<Vec<T>> {
    let shares = (0..tree.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let mut found = Vec::new();
        let mut search = Search {
            tree,
            k,
            best: with_room(k + 1)?,
            open: Open::with_capacity(64),
            pace: Pace::new(watch, LOT),
        };
        for place in first..tree.len().min(first + SHARE) {
            search.from(place)?;
            of(place, &search.best, &mut found)?;
        }
        Ok(found)
    })?;
    joined(&parts)
}

/// Whether nothing at this squared distance can be among the `k` best.
#[inline]
fn excludes(best: &Nearest, k: usize, away: f64) -> bool {
    best.len() == k && certainly_above(away, best[k - 1].0)
}

/// The search for the neighbors of one place after another.
struct Search<'a, const D: usize> {
    tree: &'a Tree<D>,
    k: usize,
    best: Nearest,
    /// Boxes to enter, by squared distance.
    open: Open,
    pace: Pace<'a>,
}

impl<const D: usize> Search<'_, D> {
    /// Fills `best` with the neighbors of a place.
    fn from(&mut self, place: usize) -> Result<()> {
        let tree = self.tree;
        self.best.clear();
        if self.k == 0 {
            return Ok(());
        }
        // Whole leaves along the curve around the place.
        let first = place.saturating_sub(self.k / 2) / LEAF * LEAF;
        let end = ((place + self.k / 2) / LEAF * LEAF + LEAF).min(tree.len());
        (first..end).for_each(|other| self.offer(place, other));
        let q = tree.points[place];
        tree.boxes.open(&mut self.open, 0.0);
        while let Some((away, level, i)) = self.open.pop() {
            if self.excludes(away) {
                continue;
            }
            let (level, i) = (level as usize, i as usize);
            if level == 0 {
                let places = tree.boxes.items(0, i);
                self.pace.spend(places.len())?;
                if places.start < first || places.start >= end {
                    places.for_each(|other| self.offer(place, other));
                }
                continue;
            }
            let (best, k) = (&self.best, self.k);
            tree.boxes
                .open_below(&mut self.open, level, i, |extent, _| {
                    Some(squared_gap(extent, q)).filter(|&away| !excludes(best, k, away))
                });
        }
        Ok(())
    }

    /// Whether no point at this squared distance can be a neighbor.
    #[inline]
    fn excludes(&self, away: f64) -> bool {
        excludes(&self.best, self.k, away)
    }

    /// Puts a place among the best if it is one of them.
    #[inline]
    fn offer(&mut self, place: usize, other: usize) {
        let q = self.tree.points[place];
        let new = (squared(q, self.tree.points[other]), other as u32);
        if other == place || self.excludes(new.0) {
            return;
        }
        let at = self
            .best
            .partition_point(|&best| !self.is_nearer(q, new, best));
        if at < self.k {
            self.best.truncate(self.k - 1);
            self.best.insert(at, new);
        }
    }

    /// Whether one of two places is nearer to `q`, or as near and lexicographically smaller.
    #[inline]
    fn is_nearer(&self, q: [f64; D], one: (f64, u32), other: (f64, u32)) -> bool {
        if certainly_above(other.0, one.0) {
            return true;
        }
        if certainly_above(one.0, other.0) {
            return false;
        }
        let (a, b) = (
            self.tree.points[one.1 as usize],
            self.tree.points[other.1 as usize],
        );
        match shorter(q, a, q, b) {
            Sign::Positive => true,
            Sign::Zero => a < b,
            Sign::Negative => false,
        }
    }
}
