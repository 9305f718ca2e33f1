//! Joins directed edges into lines and rings that never visit a point twice.
//!
//! The edges bound a region, which is to their left, except where the outline cuts them off. An
//! edge whose reverse is present as well bounds nothing, and both are dropped. Where several edges
//! meet, each incoming one continues with the next outgoing one clockwise from it: between the two
//! is a sector of the region. So regions that touch at a place get separate rings. A ring that
//! still visits a place twice surrounds, between the two visits, a part outside the region: it
//! is cut there into two rings.

use std::cmp::Ordering;

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use crate::base::error::Result;
use crate::base::memory::{filled, push};

const NONE: u32 = u32::MAX;

/// A directed edge between places, and a number of the caller.
#[derive(Clone, Copy)]
pub struct Edge {
    /// Where it starts.
    pub from: u32,
    /// Where it ends, elsewhere.
    pub to: u32,
    /// What the edge belongs to.
    pub owner: u32,
}

/// The edges of one level or band, and what is known about them.
struct Linker<'a> {
    /// The positions of the places.
    at: &'a [Point2],
    edges: &'a [Edge],
    /// The last edge that leaves or reaches each place, and whether there are several.
    leaving: Vec<u32>,
    reached: Vec<u32>,
    several: Vec<bool>,
    /// Where each place is in the current path.
    visited: Vec<u32>,
    // For each edge: the one that follows, whether another precedes it, and whether it is done.
    next: Vec<u32>,
    preceded: Vec<bool>,
    done: Vec<bool>,
}

/// Joins edges between places with the positions `at`. Calls `line` with the places of each simple line,
/// and with those of each simple ring, which ends where it starts; and with the owner of one of its edges.
///
/// Returns the owners of each edge that is dropped and its reverse, which are on the same side then.
pub fn link(
    at: &[Point2],
    edges: &[Edge],
    mut line: impl FnMut(&[u32], u32) -> Result<()>,
) -> Result<Vec<[u32; 2]>> {
    let mut linker = Linker {
        at,
        edges,
        leaving: filled(at.len(), NONE)?,
        reached: filled(at.len(), NONE)?,
        several: filled(at.len(), false)?,
        visited: filled(at.len(), NONE)?,
        next: filled(edges.len(), NONE)?,
        preceded: filled(edges.len(), false)?,
        done: filled(edges.len(), false)?,
    };
    let joined = linker.follow()?;
    let mut path = Vec::new();
    // Lines start where no edge precedes; the rest are rings.
    for rings in [false, true] {
        for e in 0..edges.len() {
            if !linker.done[e] && (rings || !linker.preceded[e]) {
                linker.trace(e, &mut path, &mut line)?;
            }
        }
    }
    Ok(joined)
}

impl Linker<'_> {
    /// Finds the edge that follows each edge; returns what `cancel` does.
    fn follow(&mut self) -> Result<Vec<[u32; 2]>> {
        let edges = self.edges;
        for (e, edge) in edges.iter().enumerate() {
            for (first, place) in [(&mut self.leaving, edge.from), (&mut self.reached, edge.to)] {
                let first = &mut first[place as usize];
                if *first != NONE {
                    self.several[place as usize] = true;
                }
                *first = e as u32;
            }
        }
        let joined = self.cancel()?;
        for (e, edge) in edges.iter().enumerate() {
            if !self.done[e] && !self.several[edge.to as usize] {
                let next = self.leaving[edge.to as usize];
                if next != NONE && !self.done[next as usize] {
                    self.next[e] = next;
                    self.preceded[next as usize] = true;
                }
            }
        }
        self.follow_where_several_meet()?;
        Ok(joined)
    }

    /// Marks pairs of an edge and its reverse as done. Where one edge only leaves and reaches both
    /// ends, the pair is a ring of two places, which `trace` drops: the region surrounds it. Returns
    /// their owners.
    fn cancel(&mut self) -> Result<Vec<[u32; 2]>> {
        let edges = self.edges;
        let mut joined = Vec::new();
        let mut found: Vec<(u32, u32, bool, u32)> = Vec::new();
        for (e, edge) in edges.iter().enumerate() {
            let (low, high) = (edge.from.min(edge.to), edge.from.max(edge.to));
            if self.several[low as usize] || self.several[high as usize] {
                push(&mut found, (low, high, edge.from == low, e as u32))?;
            }
        }
        found.sort_unstable();
        for group in found.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let backward = group.partition_point(|each| !each.2);
            let (back, forth) = group.split_at(backward);
            for (a, b) in back.iter().zip(forth) {
                self.done[a.3 as usize] = true;
                self.done[b.3 as usize] = true;
                push(&mut joined, [a.3, b.3].map(|e| edges[e as usize].owner))?;
            }
        }
        Ok(joined)
    }

    /// Pairs the edges at places where several meet.
    fn follow_where_several_meet(&mut self) -> Result<()> {
        let (at, edges) = (self.at, self.edges);
        // Place, the other end, whether the edge leaves, the edge.
        let mut rays: Vec<(u32, u32, bool, u32)> = Vec::new();
        for (e, edge) in edges.iter().enumerate() {
            if self.done[e] {
                continue;
            }
            if self.several[edge.from as usize] {
                push(&mut rays, (edge.from, edge.to, true, e as u32))?;
            }
            if self.several[edge.to as usize] {
                push(&mut rays, (edge.to, edge.from, false, e as u32))?;
            }
        }
        rays.sort_unstable_by(|a, b| {
            a.0.cmp(&b.0)
                .then_with(|| around(at, a.0, a.1, b.1))
                .then_with(|| a.cmp(b))
        });
        let mut open = Vec::new();
        for rays in rays.chunk_by(|a, b| a.0 == b.0) {
            open.clear();
            // The second round pairs those on both sides of the start.
            for &(_, _, leaves, e) in rays.iter().chain(rays) {
                if leaves {
                    if !self.preceded[e as usize] {
                        push(&mut open, e)?;
                    }
                } else if self.next[e as usize] == NONE {
                    while let Some(next) = open.pop() {
                        if !self.preceded[next as usize] {
                            self.next[e as usize] = next;
                            self.preceded[next as usize] = true;
                            break;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Follows the edges from `e`, and cuts off a ring where a place is reached again.
    fn trace(
        &mut self,
        e: usize,
        path: &mut Vec<u32>,
        line: &mut impl FnMut(&[u32], u32) -> Result<()>,
    ) -> Result<()> {
        let edges = self.edges;
        let owner = edges[e].owner;
        path.clear();
        let mut visit = |this: &mut Self, place: u32| -> Result<()> {
            let before = this.visited[place as usize];
            if before != NONE {
                let ring = &path[before as usize..];
                if ring.len() > 2 {
                    let mut ring = ring.to_vec();
                    ring.push(place);
                    line(&ring, owner)?;
                }
                for passed in path.drain(before as usize..) {
                    this.visited[passed as usize] = NONE;
                }
            }
            this.visited[place as usize] = path.len() as u32;
            push(path, place)
        };
        visit(self, edges[e].from)?;
        let mut e = e as u32;
        while e != NONE && !self.done[e as usize] {
            self.done[e as usize] = true;
            visit(self, edges[e as usize].to)?;
            e = self.next[e as usize];
        }
        for &passed in path.iter() {
            self.visited[passed as usize] = NONE;
        }
        if path.len() > 1 {
            line(path, owner)?;
        }
        Ok(())
    }
}

/// The order of two directions around a place, counterclockwise from that to the left.
fn around(at: &[Point2], place: u32, a: u32, b: u32) -> Ordering {
    let [o, p, q] = [place, a, b].map(|each| at[each as usize]);
    // Upper half: points that come after `o`, and so on.
    let half = |x| lexicographic(o, x) == Ordering::Less;
    half(p).cmp(&half(q)).then_with(|| match orient2d(o, p, q) {
        Sign::Positive => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Negative => Ordering::Greater,
    })
}

/// Whether a simple ring is counterclockwise: its first place is repeated at its end.
pub fn is_counterclockwise(at: &[Point2], ring: &[u32]) -> bool {
    let count = ring.len() - 1;
    let least = first_of(at, ring);
    let [a, b, c] = [least + count - 1, least, least + 1].map(|k| at[ring[k % count] as usize]);
    // The first place in lexicographic order is strictly convex.
    orient2d(a, b, c) == Sign::Positive
}

/// The position in a ring of the first place in lexicographic order.
fn first_of(at: &[Point2], ring: &[u32]) -> usize {
    let count = ring.len() - 1;
    (0..count)
        .min_by(|&i, &j| lexicographic(at[ring[i] as usize], at[ring[j] as usize]))
        .unwrap_or(0)
}

/// Lets a ring start at its first place in lexicographic order.
pub fn rotate(at: &[Point2], ring: &mut [u32]) {
    let first = first_of(at, ring);
    let count = ring.len() - 1;
    ring[..count].rotate_left(first);
    ring[count] = ring[0];
}
