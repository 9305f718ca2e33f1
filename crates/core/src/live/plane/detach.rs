//! Removes segments from the mesh: those that are removed or moved, and those that cross them.
//!
//! Segments that cross are taken out together, with all that cross those, and so are their
//! crossings: a *component*. A crossing may be a point of the input, and then a segment that bends
//! there does so because of another one at the same point: these belong to one component as well.
//! What remains is triangulated as if they had never been there (see `constrained`), and `reinsert`
//! puts back those that stay.

use std::collections::BTreeSet;
use std::sync::Arc;

use delone_predicates::{lexicographic, orient2d};

use super::Plane;
use super::constrained::Outcome;
use super::marks::CROSSED;
use super::segments::{Crossed, Detached};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::live::store::Removed;

impl Plane {
    /// Takes a segment out of the mesh: edges that no other segment needs are unmarked.
    pub fn unlink_segment(&mut self, segment: u32, detached: &mut Detached) -> Result<Outcome> {
        let ends = self.segments.ends(i64::from(segment)).unwrap_or_default();
        let [a, b] = ends.map(|row| self.vertex(row));
        if a == b || self.mesh.is_flat() || detached.segments.contains(&segment) {
            return Ok(Outcome::Done);
        }
        let crossed = &self.segments.crossed.segments;
        if crossed.binary_search(&segment).is_ok() {
            return self.detach_crossing(&[segment], detached);
        }
        let Some(along) = self.straight_line(a, b, detached)? else {
            return Ok(Outcome::Rebuild);
        };
        let mut covers = self.covers(&along, detached)?;
        let own = covers.iter().position(|cover| cover.0 == segment);
        let [first, last] = match own {
            Some(i) => covers.swap_remove(i).1,
            None => return Err(Error::Internal("a segment has no edges".into())),
        };
        let needed = covered(along.len(), &covers)?;
        for i in (first..last).filter(|&i| !needed[i]) {
            self.mesh.remove_mark(along[i], along[i + 1])?;
        }
        Ok(Outcome::Done)
    }

    /// The segments that run along the marked edge from `u` to `v`, which are then straight; `None`
    /// if all must be triangulated again.
    pub fn owners(&mut self, u: u32, v: u32, detached: &mut Detached) -> Result<Option<Vec<u32>>> {
        let Some(along) = self.straight_line(u, v, detached)? else {
            return Ok(None);
        };
        let (Some(i), Some(j)) = (
            along.iter().position(|&w| w == u),
            along.iter().position(|&w| w == v),
        ) else {
            return Ok(None);
        };
        let covers = self.covers(&along, detached)?;
        let runs =
            |&&(_, [first, last]): &&(u32, [usize; 2])| first <= i.min(j) && i.max(j) <= last;
        Ok(Some(covers.iter().filter(runs).map(|c| c.0).collect()))
    }

    /// The vertices of the marked edges along the line of two, in order: those between them, and beyond
    /// as far as marked edges go. Tangled segments with an edge at one of them are taken out before.
    /// `None` if all must be triangulated again.
    fn straight_line(
        &mut self,
        a: u32,
        b: u32,
        detached: &mut Detached,
    ) -> Result<Option<Vec<u32>>> {
        let mut along = self.line_of(a, b)?;
        let mut touched = BTreeSet::new();
        for &v in &along {
            for (w, mark) in self.mesh.marked_at(v)? {
                if mark == CROSSED {
                    touched.extend(self.crossed_along(v, w));
                }
            }
        }
        if !touched.is_empty() {
            let touched: Vec<u32> = touched.into_iter().collect();
            if self.detach_crossing(&touched, detached)? == Outcome::Rebuild {
                return Ok(None);
            }
            along = self.line_of(a, b)?;
        }
        Ok(Some(along))
    }

    /// The crossed segments that have this edge.
    pub fn crossed_along(&self, u: u32, v: u32) -> Vec<u32> {
        let edges = self.segments.crossed.edges.iter();
        let here = edges.filter(|(_, ends)| *ends == [u, v] || *ends == [v, u]);
        here.map(|edge| edge.0).collect()
    }

    fn line_of(&self, a: u32, b: u32) -> Result<Vec<u32>> {
        let mut halves = Vec::new();
        for (from, to) in [(a, b), (b, a)] {
            // From one end past the other.
            let mut half = with_room(1)?;
            half.push(from);
            while let Some(next) = self.marked_beyond(half[half.len() - 1], from, to)? {
                push(&mut half, next)?;
            }
            push(&mut halves, half)?;
        }
        let (Some(back), Some(front)) = (halves.pop(), halves.pop()) else {
            return Ok(Vec::new());
        };
        // `back` runs from b past a: its part beyond a, reversed, comes first.
        let Some(i) = back.iter().position(|&v| v == a) else {
            return Err(Error::Internal("a segment has no edges".into()));
        };
        let mut along: Vec<u32> = with_room(back.len() - i + front.len())?;
        along.extend(back[i + 1..].iter().rev());
        along.extend(front);
        Ok(along)
    }

    /// The end of the marked edge at `v` that leads on in the direction from `a` to `b`.
    fn marked_beyond(&self, v: u32, a: u32, b: u32) -> Result<Option<u32>> {
        let [p, q, from] = [a, b, v].map(|v| self.mesh.at(v));
        let leads = |&(w, _): &(u32, u32)| {
            let to = self.mesh.at(w);
            orient2d(p, q, to).is_zero() && lexicographic(from, to) == lexicographic(p, q)
        };
        let marked = self.mesh.marked_at(v)?;
        Ok(marked.into_iter().find(leads).map(|(w, _)| w))
    }

    /// The segments in the mesh between vertices of a line, and the places of their ends in it.
    fn covers(&self, along: &[u32], detached: &Detached) -> Result<Vec<(u32, [usize; 2])>> {
        let mut places: Vec<(u32, usize)> = with_room(along.len())?;
        places.extend(along.iter().copied().zip(0..));
        places.sort_unstable();
        let place = |v: u32| {
            let found = places.binary_search_by_key(&v, |at| at.0);
            found.ok().map(|i| places[i].1)
        };
        let mut covers = Vec::new();
        for (i, &v) in along.iter().enumerate() {
            let head = self.mesh.sites[v as usize].head;
            for row in self.rows.at(head) {
                for (segment, other) in self.segments.at(row) {
                    let j = place(self.vertex(other)).filter(|&j| i < j);
                    if let Some(j) = j.filter(|_| !detached.segments.contains(&segment)) {
                        push(&mut covers, (segment, [i, j]))?;
                    }
                }
            }
        }
        Ok(covers)
    }

    /// Takes out crossed segments and all that cross them, with the crossings.
    pub fn detach_crossing(&mut self, seeds: &[u32], detached: &mut Detached) -> Result<Outcome> {
        let crossed = Arc::clone(&self.segments.crossed);
        let mut met = with_room(crossed.rows.len())?;
        met.extend(crossed.rows.iter().map(|&row| self.vertex(row)));
        met.sort_unstable();
        let is_met = |v: &u32| met.binary_search(v).is_ok();
        let part = component(&crossed, seeds, |segment, v| {
            is_met(&v) || self.bends(segment, v)
        })?;
        let own = crossed.edges.iter().filter(|e| part.contains(&e.0));
        let edges: BTreeSet<[u32; 2]> = own.map(|&(_, [u, v])| [u.min(v), u.max(v)]).collect();
        // Another segment may run along an edge between two points.
        if !edges.iter().all(|ends| ends.iter().any(is_met)) {
            return Ok(Outcome::Rebuild);
        }
        for &[u, v] in &edges {
            self.mesh.remove_mark(u, v)?;
        }
        let vertices: BTreeSet<u32> = edges.into_iter().flatten().filter(is_met).collect();
        let mut gone = BTreeSet::new();
        let mut outcome = Outcome::Done;
        for v in vertices {
            let row = self.mesh.sites[v as usize].head;
            push(&mut detached.places, (self.mesh.at(v), row))?;
            if self.mesh.unlink(v, false)? != Removed::Done {
                outcome = Outcome::Rebuild;
                break;
            }
            self.room()?;
            self.detach(row, v);
            self.mesh.free_site(v);
            gone.insert(row);
        }
        self.segments.crossed = Arc::new(remaining(&crossed, &part, &gone)?);
        detached.segments.extend(part);
        Ok(outcome)
    }

    /// Whether a vertex is not exactly on a segment that runs through it.
    fn bends(&self, segment: u32, v: u32) -> bool {
        let ends = self.segments.ends(i64::from(segment)).unwrap_or_default();
        let [a, b] = ends.map(|row| self.mesh.at(self.vertex(row)));
        !orient2d(a, b, self.mesh.at(v)).is_zero()
    }
}

/// Tangled segments, and all that depend on them, directly or not: `binds` tells whether a vertex makes
/// all segments at it depend on each other, because the given one would not be there without them.
fn component(
    crossed: &Crossed,
    seeds: &[u32],
    binds: impl Fn(u32, u32) -> bool,
) -> Result<BTreeSet<u32>> {
    let mut at: Vec<(u32, u32)> = Vec::new();
    let mut bound = BTreeSet::new();
    for &(segment, ends) in &crossed.edges {
        for v in ends {
            push(&mut at, (v, segment))?;
            if binds(segment, v) {
                bound.insert(v);
            }
        }
    }
    at.retain(|(v, _)| bound.contains(v));
    at.sort_unstable();
    at.dedup();
    let mut part: BTreeSet<u32> = seeds.iter().copied().collect();
    let mut waiting: Vec<u32> = part.iter().copied().collect();
    while let Some(segment) = waiting.pop() {
        let first = crossed.edges.partition_point(|e| e.0 < segment);
        let own = crossed.edges[first..].iter().take_while(|e| e.0 == segment);
        for v in own.flat_map(|e| e.1) {
            let first = at.partition_point(|other| other.0 < v);
            for &(_, other) in at[first..].iter().take_while(|other| other.0 == v) {
                if part.insert(other) {
                    push(&mut waiting, other)?;
                }
            }
        }
    }
    Ok(part)
}

/// A list of crossed segments without some segments and rows.
fn remaining(crossed: &Crossed, part: &BTreeSet<u32>, gone: &BTreeSet<u32>) -> Result<Crossed> {
    let mut left = Crossed {
        segments: with_room(crossed.segments.len())?,
        rows: with_room(crossed.rows.len())?,
        crossings: with_room(crossed.crossings.len())?,
        edges: with_room(crossed.edges.len())?,
    };
    let stays = |segment: &u32| !part.contains(segment);
    left.segments
        .extend(crossed.segments.iter().copied().filter(stays));
    left.rows
        .extend(crossed.rows.iter().filter(|row| !gone.contains(row)));
    left.crossings
        .extend(crossed.crossings.iter().filter(|c| stays(&c[0])));
    left.edges
        .extend(crossed.edges.iter().filter(|e| stays(&e.0)));
    Ok(left)
}

/// For each edge of a line of `count` vertices, whether one of some segments runs along it.
fn covered(count: usize, covers: &[(u32, [usize; 2])]) -> Result<Vec<bool>> {
    let mut change = filled(count + 1, 0i64)?;
    for &(_, [first, last]) in covers {
        change[first] += 1;
        change[last] -= 1;
    }
    let mut sum = 0;
    let mut needed = with_room(count)?;
    needed.extend(change.iter().take(count).map(|x| {
        sum += x;
        sum > 0
    }));
    Ok(needed)
}
