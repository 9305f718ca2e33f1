//! All pairs of triangles that cross or touch otherwise than at shared vertices and edges.
//!
//! A tree of boxes finds the candidates for a few neighboring triangles at a time: linear time, up
//! to a logarithm, for surfaces whose triangles have few others in their boxes. Around a vertex of
//! k triangles, it is k^2.

use delone_predicates::Point3;

use super::contact::{Contact, KINDS, Kind, Triangle, contact};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::Boxes;
use crate::order::{order_of, sort};

/// Triangles that look for candidates together.
const GROUP: usize = 8;
/// Groups per task.
const SHARE: usize = 1 << 9;
/// Candidates between two checks for interruption.
const LOT: usize = 1 << 14;

/// A pair of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    /// Whether they do not cross: their contact is resolved by subdividing at vertices.
    pub touching: bool,
    /// Their rows, the smaller first.
    pub faces: [u32; 2],
    /// The kind of contact.
    pub kind: Kind,
}

/// The pairs found.
#[derive(Debug, Default)]
pub struct Pairs {
    /// The first pairs, those that cross before others, ascending; no more than the limit.
    pub first: Vec<Pair>,
    /// The number of pairs of each kind.
    pub counts: [u64; KINDS],
    /// The number of pairs that cross.
    pub crossing: u64,
    /// All pairs that touch, ascending; empty if some cross.
    pub touching: Vec<[u32; 2]>,
}

impl Pairs {
    /// Adds a pair, and reduces the list to the first ones if it is long.
    fn add(&mut self, faces: [u32; 2], found: &Contact, limit: usize) -> Result<()> {
        self.counts[found.kind as usize] += 1;
        if found.crossing {
            self.crossing += 1;
            self.touching = Vec::new();
        } else if self.crossing == 0 {
            push(&mut self.touching, faces)?;
        }
        let pair = Pair {
            touching: !found.crossing,
            faces,
            kind: found.kind,
        };
        push(&mut self.first, pair)?;
        if self.first.len() / 2 > limit.max(GROUP) {
            self.first.sort_unstable();
            self.first.truncate(limit);
        }
        Ok(())
    }

    /// The pairs of several parts.
    fn joined(parts: Vec<Self>, limit: usize, watch: &Watch) -> Result<Self> {
        let mut all = Self::default();
        for part in parts {
            all.crossing += part.crossing;
            (0..KINDS).for_each(|k| all.counts[k] += part.counts[k]);
            for pair in part.first {
                push(&mut all.first, pair)?;
            }
            for pair in part.touching {
                push(&mut all.touching, pair)?;
            }
            if all.crossing > 0 {
                all.touching = Vec::new();
            }
        }
        sort(&mut all.first, watch)?;
        all.first.truncate(limit);
        sort(&mut all.touching, watch)?;
        Ok(all)
    }
}

/// The triangles along the curve, with their boxes.
struct Along<'a> {
    points: &'a [Point3],
    faces: &'a [[u32; 3]],
    rows: Vec<u32>,
    boxes: Vec<Extent<3>>,
    tree: Boxes<3>,
}

/// All pairs of the triangles in `kept`, rows of `faces`; no two of them may have the same three
/// vertices, and none may be degenerate.
pub fn pairs(
    points: &[Point3],
    faces: &[[u32; 3]],
    kept: &[u32],
    limit: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Pairs> {
    let along = Along::of(points, faces, kept, workers, watch)?;
    let groups = kept.len().div_ceil(GROUP);
    let tasks = (0..groups).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, tasks, watch, |first: usize| {
        let mut found = Pairs::default();
        let mut near = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for group in first..(first + SHARE).min(groups) {
            along.pairs_of(group, limit, &mut near, &mut found, &mut pace)?;
        }
        Ok(found)
    })?;
    Pairs::joined(parts, limit, watch)
}

impl<'a> Along<'a> {
    fn of(
        points: &'a [Point3],
        faces: &'a [[u32; 3]],
        kept: &[u32],
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        let extent = |row: u32| Extent::of(faces[row as usize].map(|v| points[v as usize]));
        let mut middles = with_room(kept.len())?;
        let mut pace = Pace::new(watch, LOT);
        for &row in kept {
            pace.spend(1)?;
            let Extent { min, max } = extent(row);
            middles.push([0, 1, 2].map(|k| min[k] / 2.0 + max[k] / 2.0));
        }
        let mut rows = with_room(kept.len())?;
        for part in order_of(&middles, workers, watch)? {
            rows.extend(part.into_iter().map(|i| kept[i as usize]));
        }
        drop(middles);
        let mut boxes = with_room(rows.len())?;
        for &row in &rows {
            pace.spend(1)?;
            boxes.push(extent(row));
        }
        let mut order = with_room(rows.len())?;
        order.extend(0..rows.len() as u32);
        let tree = Boxes::packed(order, |i| boxes[i], watch)?;
        Ok(Self {
            points,
            faces,
            rows,
            boxes,
            tree,
        })
    }

    fn triangle(&self, place: usize) -> Triangle {
        let ids = self.faces[self.rows[place] as usize];
        let [a, b, c] = ids;
        let at = |v: u32| self.points[v as usize];
        Triangle {
            ids,
            at: [at(a), at(b), at(c)],
        }
    }

    /// Adds the pairs of the triangles of a group with each other and with those before.
    fn pairs_of(
        &self,
        group: usize,
        limit: usize,
        near: &mut Vec<u32>,
        found: &mut Pairs,
        pace: &mut Pace,
    ) -> Result<()> {
        let own = group * GROUP..((group + 1) * GROUP).min(self.rows.len());
        let around = Extent::of(self.boxes[own.clone()].iter().flat_map(|e| [e.min, e.max]));
        near.clear();
        let mut room = Ok(());
        self.tree.meeting(&around, |place| {
            if place < own.end && room.is_ok() {
                room = push(near, place as u32);
            }
        });
        room?;
        near.retain(|&place| meet(&around, &self.boxes[place as usize]));
        for place in own {
            pace.spend(near.len())?;
            let (a, box_a) = (self.triangle(place), self.boxes[place]);
            for &other in near.iter() {
                let other = other as usize;
                if other >= place || !meet(&box_a, &self.boxes[other]) {
                    continue;
                }
                if let Some(contact) = contact(&a, &self.triangle(other)) {
                    let rows = [self.rows[place], self.rows[other]];
                    let faces = [rows[0].min(rows[1]), rows[0].max(rows[1])];
                    found.add(faces, &contact, limit)?;
                }
            }
        }
        Ok(())
    }
}

/// Whether two boxes have a point in common.
#[inline]
fn meet(a: &Extent<3>, b: &Extent<3>) -> bool {
    (0..3).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
}
