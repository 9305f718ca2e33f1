//! The result of inserting segments: subsegments, vertices on segments, crossings.

use super::marked::Marked;
use super::present::mark_present;
use super::segment::{Cavity, Step};
use super::sites::Sites;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::watch::{Pace, Watch};

/// Segments between two checks for interruption.
const WATCH_EVERY: usize = 1 << 10;
/// Crossed triangles that take as long as the rest of the insertion of a segment.
const TRIANGLES: usize = 8;

/// The result of inserting segments, in vertices of the mesh.
#[derive(Debug, Default)]
pub struct Inserted {
    /// Subsegments as pairs of vertices, each with a row that covers it and directed as that row;
    /// an edge occurs once for each of its rows.
    pub pieces: Vec<([u32; 2], u32)>,
    /// Whether they are sorted by row and along it.
    pub sorted: bool,
    /// Whether an edge may occur more than once.
    pub repeated: bool,
    /// Segment and vertex: the segment passes through the vertex, which is not one of its ends.
    pub through: Vec<[u32; 2]>,
    /// Two segments and the vertex where they cross.
    pub crossings: Vec<[u32; 3]>,
}

/// Marks the segments that are edges, and inserts the others row by row. Returns the rows that
/// cross segments inserted before them, which are postponed; `None` if there are more than
/// `few`.
pub fn insert_all<S: Sites>(
    marked: &mut Marked<S>,
    ends: &[[u32; 2]],
    few: usize,
    watch: &Watch,
) -> Result<Option<(Inserted, Vec<u32>)>> {
    let present = mark_present(marked, ends, watch)?;
    let mut inserted = Inserted {
        pieces: with_room(ends.len())?,
        repeated: present.repeated,
        sorted: true,
        ..Inserted::default()
    };
    let mut waiting = Vec::new();
    let mut cavity = Cavity::default();
    let mut pace = Pace::new(watch, WATCH_EVERY * TRIANGLES);
    for (row, &[mut a, mut b]) in (0u32..).zip(ends) {
        pace.spend(1)?;
        if present.holds([a, b]) {
            push(&mut inserted.pieces, ([a, b], row))?;
            continue;
        }
        // The segment is inserted from both ends; pieces from the end `b` are collected in
        // `back`.
        let mut back = Vec::new();
        while a != b {
            let step = marked.join(a, b, &mut cavity)?;
            pace.spend(TRIANGLES + cavity.size())?;
            let Step::Joined { from, to, again } = step else {
                // Blocked by a segment that was inserted before.
                waiting.push(row);
                break;
            };
            inserted.repeated |= again;
            // `a ^ b ^ from` is the other end: any other vertex lies on the segment.
            if to != a ^ b ^ from {
                push(&mut inserted.through, [row, to])?;
            }
            if from == a {
                push(&mut inserted.pieces, ([a, to], row))?;
                a = to;
            } else {
                push(&mut back, ([to, b], row))?;
                b = to;
            }
        }
        for piece in back.into_iter().rev() {
            push(&mut inserted.pieces, piece)?;
        }
        if waiting.len() > few {
            return Ok(None);
        }
    }
    Ok(Some((inserted, waiting)))
}
