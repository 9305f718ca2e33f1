//! Puts segments back into the mesh, and splits them where they cross.
//!
//! First, all segments that the detached ones cross are taken out as well, and those that these cross (see
//! `detach`), so that nothing in the mesh crosses one of them. Then their crossings become vertices, and
//! each runs through its own, as `constrained::reroute` does it. Where rounding makes a segment pass
//! through the pixel of any other vertex, or pieces cross, `constrained` triangulates everything again.

use std::collections::BTreeSet;
use std::sync::Arc;

use delone_predicates::{Point2, orient2d};

use super::Plane;
use super::constrained::{Outcome, are_apart};
use super::marks::{CROSSED, Reach};
use super::segments::{Crossed, Detached};
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::intersection::intersection;
use crate::constrained::pairs::crossing_pairs_above;
use crate::constrained::passes;
use crate::live::store::Place;
use crate::mesh::plane::half_edges;

/// With more segments than this, and one in so many, all are triangulated again; and so with more
/// pairs that cross than this for each of them.
const FEW: usize = 64;
const ONE_IN: usize = 8;
const PAIRS: usize = 16;

/// Crossings between two checks for interruption.
const LOT: usize = 1 << 6;

/// A segment to be put back: its number and its two vertices.
type Reinserted = (u32, [u32; 2]);

/// Edges, each with the place of its segment in a list.
type Edges = Vec<(u32, [u32; 2])>;

/// A crossing: two places in a list of segments, and the vertex.
type Crossing = ([u32; 2], u32);

impl Plane {
    /// Puts the detached segments back.
    pub fn reinsert_segments(&mut self, detached: &mut Detached, watch: &Watch) -> Result<Outcome> {
        if self.mesh.is_flat() || !self.clear_ways(detached, watch)? {
            return Ok(Outcome::Rebuild);
        }
        // The pairs that cross, from the ends alone: two rows of `points` for each segment.
        let inserted = self.inserted(detached)?;
        let (mut points, mut ends) = (Vec::new(), Vec::new());
        for (i, (_, pair)) in (0u32..).zip(&inserted) {
            push(&mut ends, [2 * i, 2 * i + 1])?;
            push(&mut points, self.mesh.at(pair[0]))?;
            push(&mut points, self.mesh.at(pair[1]))?;
        }
        let most = PAIRS * (inserted.len() + FEW);
        let pairs = crossing_pairs_above(&points, &ends, most, watch)?;
        if pairs.len() > most {
            return Ok(Outcome::Rebuild);
        }
        // Where they cross at a vertex of the mesh, both bend there anyway: the others need a vertex.
        let crossings = self.meetings(&points, pairs, watch)?;
        if !crossings.is_empty() && !self.splits_crossings() {
            return Err(Error::Crossing {
                pairs: crossings
                    .iter()
                    .map(|c| c.0.map(|i| inserted[i as usize].0))
                    .collect(),
                points: crossings.iter().map(|c| c.1).collect(),
            });
        }
        // Each crossing becomes a vertex, and each segment a chain of edges through its own.
        let mut fresh = BTreeSet::new();
        let met = self.tie(&crossings, detached, &mut fresh, watch)?;
        let edges = match &met {
            Some(met) => self.put_back(&inserted, met, &fresh)?,
            None => None,
        };
        // The list is replaced as a whole, so that a state that shares the old one is not changed.
        let mut crossed = copy(&self.segments.crossed)?;
        // Also if all are triangulated again: the new rows are not points.
        let rows = fresh.iter().map(|&v| self.mesh.sites[v as usize].head);
        crossed.rows.extend(rows);
        crossed.rows.sort_unstable();
        let outcome = match (met, edges) {
            (Some(met), Some(edges)) => {
                self.enlist(&mut crossed, &inserted, &met, &edges)?;
                Outcome::Done
            }
            _ => Outcome::Rebuild,
        };
        self.segments.crossed = Arc::new(crossed);
        detached.segments.clear();
        Ok(outcome)
    }

    /// Takes out all segments that the detached ones cross; whether they are few.
    fn clear_ways(&mut self, detached: &mut Detached, watch: &Watch) -> Result<bool> {
        let mut done = BTreeSet::new();
        while let Some(&segment) = detached.segments.iter().find(|s| !done.contains(*s)) {
            watch.check()?;
            done.insert(segment);
            let ends = self.segments.ends(i64::from(segment)).unwrap_or_default();
            let [a, b] = ends.map(|row| self.vertex(row));
            if a == b {
                continue;
            }
            // Crossed segments that this one crosses leave with all that cross them.
            let touched = self.touched(a, b);
            if !touched.is_empty() && self.detach_crossing(&touched, detached)? == Outcome::Rebuild
            {
                return Ok(false);
            }
            // Then edges of segments that still block the way: terminates, since each has fewer marks
            // after its owners are taken out.
            while let Some(e) = self.mesh.blocker(a, b)? {
                let [u, v] = self.mesh.ends(e);
                if self.mesh.mark(e) == CROSSED {
                    let crossed = self.crossed_along(u, v);
                    if crossed.is_empty()
                        || self.detach_crossing(&crossed, detached)? == Outcome::Rebuild
                    {
                        return Ok(false);
                    }
                    continue;
                }
                let Some(owners) = self.owners(u, v, detached)?.filter(|all| !all.is_empty())
                else {
                    return Ok(false);
                };
                for owner in owners {
                    if self.unlink_segment(owner, detached)? == Outcome::Rebuild {
                        return Ok(false);
                    }
                    detached.segments.insert(owner);
                }
            }
            // So many would not be faster than a triangulation of all.
            if detached.segments.len() > FEW + self.segments.live() / ONE_IN {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The crossed segments that cross the one from `a` to `b`, or have a crossing in its range of
    /// rounding.
    pub fn touched(&self, a: u32, b: u32) -> Vec<u32> {
        let [r, s] = [a, b].map(|v| self.mesh.at(v));
        let crossed = &self.segments.crossed;
        let crosses = |&other: &u32| {
            let ends = self.segments.ends(i64::from(other)).unwrap_or_default();
            let [p, q] = ends.map(|row| self.mesh.at(self.vertex(row)));
            are_apart(r, s, p, q) && are_apart(p, q, r, s)
        };
        let mut touched: Vec<u32> = crossed.segments.iter().copied().filter(crosses).collect();
        let near = crossed.rows.iter().map(|&row| self.vertex(row));
        let near: Vec<u32> = near.filter(|&v| passes(r, s, self.mesh.at(v))).collect();
        if !near.is_empty() {
            let at = crossed
                .edges
                .iter()
                .filter(|e| e.1.iter().any(|v| near.contains(v)));
            touched.extend(at.map(|e| e.0));
        }
        touched
    }

    /// The detached segments of positive length.
    fn inserted(&self, detached: &Detached) -> Result<Vec<Reinserted>> {
        let mut inserted = with_room(detached.segments.len())?;
        for &segment in &detached.segments {
            let ends = self.segments.ends(i64::from(segment)).unwrap_or_default();
            let [a, b] = ends.map(|row| self.vertex(row));
            if a != b {
                inserted.push((segment, [a, b]));
            }
        }
        Ok(inserted)
    }

    /// The places where pairs cross, but not those that cross exactly at a vertex.
    fn meetings(
        &mut self,
        points: &[Point2],
        pairs: Vec<[u32; 2]>,
        watch: &Watch,
    ) -> Result<Vec<([u32; 2], Point2)>> {
        let mut found = with_room(pairs.len())?;
        for pair in pairs {
            let [[a, b], [c, d]] =
                pair.map(|i| [points[2 * i as usize], points[2 * i as usize + 1]]);
            let x = intersection(a, b, c, d).map(|x| x + 0.0);
            let is_exact = orient2d(a, b, x).is_zero() && orient2d(c, d, x).is_zero();
            if !is_exact || !matches!(self.mesh.place(x, watch)?, Place::At(_)) {
                found.push((pair, x));
            }
        }
        Ok(found)
    }

    /// Makes crossings vertices, which go to `fresh`; `None` if one is at a vertex or on a segment, or a
    /// segment passes through its pixel.
    fn tie(
        &mut self,
        crossings: &[([u32; 2], Point2)],
        detached: &Detached,
        fresh: &mut BTreeSet<u32>,
        watch: &Watch,
    ) -> Result<Option<Vec<Crossing>>> {
        let mut met = with_room(crossings.len())?;
        let mut pace = Pace::new(watch, LOT);
        for &(pair, x) in crossings {
            pace.spend(1)?;
            let v = match self.mesh.place(x, watch)? {
                Place::At(v) if fresh.contains(&v) => v,
                Place::At(_) => return Ok(None),
                // A new vertex must be in the open triangle, away from every segment.
                Place::In(t) => {
                    let is_on = half_edges(t).any(|e| {
                        let [u, v] = self.mesh.ends(e);
                        self.mesh.mark(e) != 0
                            && orient2d(self.mesh.at(u), self.mesh.at(v), x).is_zero()
                    });
                    if is_on || self.is_near_crossing(x) {
                        return Ok(None);
                    }
                    // A crossing that was at this place before keeps its row.
                    let v = self.create(x, t, &mut pace)?;
                    let known = detached.places.iter().find(|place| place.0 == x);
                    let row = match known {
                        Some(place) => place.1,
                        None => self.rows.push()?,
                    };
                    self.room()?;
                    self.attach(row, v);
                    fresh.insert(v);
                    v
                }
            };
            met.push((pair, v));
        }
        // No segment of the mesh may pass through the pixel of a new vertex.
        for &v in fresh.iter() {
            if self.mesh.is_passed(v)? {
                return Ok(None);
            }
        }
        Ok(Some(met))
    }

    /// Marks the edges of segments, through their crossings. Returns the edges of those that cross, each
    /// with the place of its segment; `None` if they are not all edges, or if a segment passes through
    /// the pixel of another vertex.
    fn put_back(
        &mut self,
        inserted: &[Reinserted],
        met: &[Crossing],
        fresh: &BTreeSet<u32>,
    ) -> Result<Option<Edges>> {
        // The crossings of each segment, as ranges of one sorted list.
        let mut own: Vec<(u32, u32)> = with_room(2 * met.len())?;
        own.extend(met.iter().flat_map(|&([i, j], v)| [(i, v), (j, v)]));
        own.sort_unstable();
        own.dedup();
        // All routes are known before the first mark is set: straight, or through the crossings in their
        // order along the segment.
        let mut routes = with_room(inserted.len())?;
        for (i, &(_, [a, b])) in (0u32..).zip(inserted) {
            let first = own.partition_point(|o| o.0 < i);
            let meets = own[first..].iter().take_while(|o| o.0 == i).map(|o| o.1);
            let meets: Vec<u32> = meets.collect();
            let [r, s] = [a, b].map(|v| self.mesh.at(v));
            let passes_one = |v: &u32| !meets.contains(v) && passes(r, s, self.mesh.at(*v));
            if fresh.iter().any(passes_one) {
                return Ok(None);
            }
            match meets.is_empty() {
                true => routes.push(Vec::new()),
                false => match self.mesh.stops([a, b], &meets)? {
                    Some(stops) => routes.push(stops),
                    None => return Ok(None),
                },
            }
        }
        // Straight segments are linked like any other; pieces of the others must be edges.
        let mut edges = Vec::new();
        for ((i, &(_, [a, b])), stops) in (0u32..).zip(inserted).zip(routes) {
            if stops.is_empty() && self.link_vertices(a, b)? == Outcome::Rebuild {
                return Ok(None);
            }
            for pair in stops.windows(2) {
                if self.mesh.reach(pair[0], pair[1])? != Reach::Vertex(pair[1]) {
                    return Ok(None);
                }
                self.mesh.add_mark(pair[0], pair[1], CROSSED)?;
                push(&mut edges, (i, [pair[0], pair[1]]))?;
            }
        }
        Ok(Some(edges))
    }

    /// Lists segments that cross, with their crossings and edges.
    fn enlist(
        &self,
        crossed: &mut Crossed,
        inserted: &[Reinserted],
        met: &[Crossing],
        edges: &[(u32, [u32; 2])],
    ) -> Result<()> {
        let number = |i: u32| inserted[i as usize].0;
        for &([i, j], v) in met {
            push(&mut crossed.crossings, [number(i), number(j), v])?;
        }
        for &(i, ends) in edges {
            push(&mut crossed.segments, number(i))?;
            push(&mut crossed.edges, (number(i), ends))?;
        }
        crossed.crossings.sort_unstable();
        crossed.segments.sort_unstable();
        crossed.segments.dedup();
        crossed.edges.sort_unstable();
        Ok(())
    }
}

/// A copy of the list of crossed segments.
fn copy(crossed: &Crossed) -> Result<Crossed> {
    Ok(Crossed {
        segments: copied(&crossed.segments)?,
        rows: copied(&crossed.rows)?,
        crossings: copied(&crossed.crossings)?,
        edges: copied(&crossed.edges)?,
    })
}
