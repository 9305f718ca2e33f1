//! Joins directed edges into lines and rings that never visit a point twice.
//!
//! The edges bound a region, which is to their left, except where the outline cuts them off. An
//! edge whose reverse is present as well bounds nothing, and both are dropped. Where several edges
//! meet, each incoming one continues with the next outgoing one clockwise from it: between the two
//! is a sector of the region. So regions that touch at a place get separate rings. A ring that
//! still visits a place twice surrounds, between the two visits, a part outside the region: it
//! is cut there into two rings.

use std::cmp::Ordering;

use delone_predicates::{Sign, lexicographic, orient2d};

use super::nodes::Nodes;
use crate::base::error::Result;
use crate::base::memory::{clear_with_room, filled, push};

const NONE: u32 = u32::MAX;

/// A directed edge between representatives, and a number of the caller.
#[derive(Clone, Copy)]
pub struct Edge {
    /// Where it starts.
    pub from: u32,
    /// Where it ends, elsewhere.
    pub to: u32,
    /// What the edge belongs to.
    pub owner: u32,
}

/// Joins the edges of one level or band after the other.
pub struct Linker {
    /// The last edge that leaves each place.
    leaving: Vec<u32>,
    /// Whether several edges leave or reach each place, and where it is in the current path.
    several: Vec<bool>,
    reached: Vec<u32>,
    at: Vec<u32>,
    // For each edge: the one that follows, whether another precedes it, and whether it is done.
    next: Vec<u32>,
    preceded: Vec<bool>,
    done: Vec<bool>,
    /// The owners of each edge that was dropped and its reverse, which are on the same side now.
    pub joined: Vec<[u32; 2]>,
}

impl Linker {
    /// Room for `places`.
    pub fn new(places: usize) -> Result<Self> {
        Ok(Self {
            leaving: filled(places, NONE)?,
            several: filled(places, false)?,
            reached: filled(places, NONE)?,
            at: filled(places, NONE)?,
            next: Vec::new(),
            preceded: Vec::new(),
            done: Vec::new(),
            joined: Vec::new(),
        })
    }

    /// Calls `line` with the places of each simple line, and with those of each simple ring, which
    /// ends where it starts; and with the owner of one of its edges.
    pub fn link(
        &mut self,
        nodes: &Nodes,
        edges: &[Edge],
        mut line: impl FnMut(&[u32], u32) -> Result<()>,
    ) -> Result<()> {
        clear_with_room(&mut self.next, edges.len())?;
        self.next.resize(edges.len(), NONE);
        clear_with_room(&mut self.preceded, edges.len())?;
        self.preceded.resize(edges.len(), false);
        clear_with_room(&mut self.done, edges.len())?;
        self.done.resize(edges.len(), false);
        self.follow(nodes, edges)?;
        let mut path = Vec::new();
        // Lines start where no edge precedes; the rest are rings.
        for rings in [false, true] {
            for e in 0..edges.len() {
                if !self.done[e] && (rings || !self.preceded[e]) {
                    self.trace(edges, e, &mut path, &mut line)?;
                }
            }
        }
        for edge in edges {
            for place in [edge.from, edge.to] {
                self.leaving[place as usize] = NONE;
                self.reached[place as usize] = NONE;
                self.several[place as usize] = false;
            }
        }
        Ok(())
    }

    /// Finds the edge that follows each edge.
    fn follow(&mut self, nodes: &Nodes, edges: &[Edge]) -> Result<()> {
        for (e, edge) in edges.iter().enumerate() {
            for (first, place) in [(&mut self.leaving, edge.from), (&mut self.reached, edge.to)] {
                let first = &mut first[place as usize];
                if *first != NONE {
                    self.several[place as usize] = true;
                }
                *first = e as u32;
            }
        }
        self.cancel(edges)?;
        for (e, edge) in edges.iter().enumerate() {
            if !self.done[e] && !self.several[edge.to as usize] {
                let next = self.leaving[edge.to as usize];
                if next != NONE && !self.done[next as usize] {
                    self.next[e] = next;
                    self.preceded[next as usize] = true;
                }
            }
        }
        self.follow_where_several_meet(nodes, edges)
    }

    /// Marks pairs of an edge and its reverse as done. Where one edge only leaves and reaches both
    /// ends, the pair is a ring of two places, which `trace` drops: the region surrounds it.
    fn cancel(&mut self, edges: &[Edge]) -> Result<()> {
        self.joined.clear();
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
                push(
                    &mut self.joined,
                    [a.3, b.3].map(|e| edges[e as usize].owner),
                )?;
            }
        }
        Ok(())
    }

    /// Pairs the edges at places where several meet.
    fn follow_where_several_meet(&mut self, nodes: &Nodes, edges: &[Edge]) -> Result<()> {
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
                .then_with(|| around(nodes, a.0, a.1, b.1))
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
        edges: &[Edge],
        e: usize,
        path: &mut Vec<u32>,
        line: &mut impl FnMut(&[u32], u32) -> Result<()>,
    ) -> Result<()> {
        let owner = edges[e].owner;
        path.clear();
        let mut visit = |this: &mut Self, place: u32| -> Result<()> {
            let before = this.at[place as usize];
            if before != NONE {
                let ring = &path[before as usize..];
                if ring.len() > 2 {
                    let mut ring = ring.to_vec();
                    ring.push(place);
                    line(&ring, owner)?;
                }
                for passed in path.drain(before as usize..) {
                    this.at[passed as usize] = NONE;
                }
            }
            this.at[place as usize] = path.len() as u32;
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
            self.at[passed as usize] = NONE;
        }
        if path.len() > 1 {
            line(path, owner)?;
        }
        Ok(())
    }
}

/// The order of two directions around a place, counterclockwise from that to the left.
fn around(nodes: &Nodes, place: u32, a: u32, b: u32) -> Ordering {
    let [o, p, q] = [place, a, b].map(|each| nodes.at(each));
    // Upper half: points that come after `o`, and so on.
    let half = |x| lexicographic(o, x) == Ordering::Less;
    half(p).cmp(&half(q)).then_with(|| match orient2d(o, p, q) {
        Sign::Positive => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Negative => Ordering::Greater,
    })
}

/// Whether a simple ring is counterclockwise: its first place is repeated at its end.
pub fn is_counterclockwise(nodes: &Nodes, ring: &[u32]) -> bool {
    let count = ring.len() - 1;
    let least = first_of(nodes, ring);
    let [a, b, c] = [least + count - 1, least, least + 1].map(|k| nodes.at(ring[k % count]));
    // The first place in lexicographic order is strictly convex.
    orient2d(a, b, c) == Sign::Positive
}

/// The position in a ring of the first place in lexicographic order.
pub fn first_of(nodes: &Nodes, ring: &[u32]) -> usize {
    let count = ring.len() - 1;
    (0..count)
        .min_by(|&i, &j| lexicographic(nodes.at(ring[i]), nodes.at(ring[j])))
        .unwrap_or(0)
}
