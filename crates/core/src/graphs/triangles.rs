//! Delaunay edges in 2-D that no opposite corner removes: Urquhart graphs, Gabriel graphs and
//! circle-based skeletons.
//!
//! R. B. Urquhart, in Electronics Letters 16 (1980). Only an edge that is strictly longer than the
//! two others is removed: the opposite corner is then inside its lune, so the relative neighborhood
//! graph keeps none of these. The disks of the other graphs are decided by the corners as well (see
//! `regions`).
//!
//! Each triangle is measured once, and then each edge looks up both of its triangles: no list of
//! edges or neighbors is needed.

use delone_predicates::proximity::{angle, arcs, shorter};
use delone_predicates::{Point2, Sign};

use super::edges::{SHARE, joined, sorted};
use super::regions::blocks;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::watch::Watch;

/// What removes an edge of a triangle.
#[derive(Clone, Copy)]
pub enum Rule {
    /// It is strictly longer than both others.
    Longest,
    /// The opposite corner is in the disk whose diameter it is, `closed` or open.
    Ball {
        /// Whether the circle belongs to the disk.
        closed: bool,
    },
    /// The opposite corner is in the union of two disks; the parameter is above 1, up to 2.
    Arcs {
        /// The parameter.
        beta: f64,
        /// Whether the outline belongs to the disks.
        closed: bool,
    },
}

/// The edges of triangles that remain.
pub fn of_triangles(
    points: &[Point2],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    rule: Rule,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    let found = filtered(simplices, neighbors, workers, watch, |corners| {
        let corners = corners.map(|v| points[v as usize]);
        match rule {
            Rule::Longest => longest(corners),
            Rule::Ball { closed } => wide(corners, closed),
            Rule::Arcs { beta, closed } => mask(|k| {
                let [a, b, p] = turned(corners, k);
                blocks(arcs(a, b, p, beta), closed)
            }),
        }
    })?;
    sorted(&found, points.len(), watch)
}

/// The ends of the edge opposite corner `k`, and the corner.
#[inline]
fn turned(corners: [Point2; 3], k: usize) -> [Point2; 3] {
    [corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k]]
}

/// The bits of edges, each numbered by its opposite corner.
#[inline]
fn mask(is_removed: impl Fn(usize) -> bool) -> u8 {
    (0..3).fold(0, |bits, k| bits | u8::from(is_removed(k)) << k)
}

/// The edge opposite an obtuse or, if `closed`, right angle; there is at most one.
fn wide(corners: [Point2; 3], closed: bool) -> u8 {
    let is_wide = |&k: &usize| {
        let [a, b, p] = turned(corners, k);
        blocks(-angle(a, p, b), closed)
    };
    (0..3).find(is_wide).map_or(0, |k| 1 << k)
}

/// The edge that is longer than both others.
fn longest(corners: [Point2; 3]) -> u8 {
    mask(|k| {
        let [a, b, p] = turned(corners, k);
        shorter(a, p, a, b) == Sign::Positive && shorter(b, p, a, b) == Sign::Positive
    })
}

/// The edges that neither of their triangles removes, the smaller row first, in no order. `removed`
/// gives a bit for the edge opposite each corner.
pub(super) fn filtered(
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    workers: usize,
    watch: &Watch,
    removed: impl Fn([i32; 3]) -> u8 + Sync,
) -> Result<Vec<[i32; 2]>> {
    let shares = simplices.chunks(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |share: &[[i32; 3]]| {
        let mut bits = with_room(share.len())?;
        bits.extend(share.iter().map(|&corners| removed(corners)));
        Ok(bits)
    })?;
    let bits = joined(&parts)?;
    let shares = (0..simplices.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let mut found = with_room(2 * SHARE)?;
        for t in first..simplices.len().min(first + SHARE) {
            for k in 0..3 {
                let other = neighbors[t][k];
                // An edge between two triangles belongs to the later one.
                if other >= t as i32 || bits[t] >> k & 1 != 0 {
                    continue;
                }
                if let Ok(other) = usize::try_from(other) {
                    let back = (0..3).find(|&j| neighbors[other][j] == t as i32);
                    if back.is_some_and(|j| bits[other] >> j & 1 != 0) {
                        continue;
                    }
                }
                let [a, b] = [1, 2].map(|i| simplices[t][(k + i) % 3]);
                push(&mut found, [a.min(b), a.max(b)])?;
            }
        }
        Ok(found)
    })?;
    joined(&parts)
}
