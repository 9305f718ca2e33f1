//! All pairs of triangles that cross, or touch except at shared vertices and edges.
//!
//! [`meeting`] finds the candidates.

use delone_predicates::Point3;

use super::contact::{Contact, KINDS, Kind, contact};
use super::meeting::meeting;
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::watch::Watch;
use crate::order::sort;

/// The shortest list of pairs that is reduced.
const SHORT: usize = 8;

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
        if self.first.len() / 2 > limit.max(SHORT) {
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
    let parts = meeting(
        points,
        faces,
        kept,
        0.0,
        workers,
        watch,
        |rows, [a, b], found: &mut Pairs| match contact(a, b) {
            Some(contact) => found.add(
                [rows[0].min(rows[1]), rows[0].max(rows[1])],
                &contact,
                limit,
            ),
            None => Ok(()),
        },
    )?;
    Pairs::joined(parts, limit, watch)
}
