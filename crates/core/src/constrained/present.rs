//! Marks the segments that are already edges of a triangulation, in one pass over the triangles.
//!
//! In a coastline most segments are. The pass visits the triangles in memory order without
//! data-dependent branches.
//!
//! Each vertex has two slots for the other ends of its segments, which suffice for a line or ring.
//! Segments that find both slots taken are inserted one by one later.

use super::marked::{LOT, Marked};
use super::sites::Sites;
use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::watch::{Pace, Watch};

/// An empty slot.
const NONE: u32 = u32::MAX;

/// The result of the pass.
#[derive(Debug)]
pub struct Present {
    slots: Vec<[u32; 2]>,
    /// A bit for each slot: whether its segment is an edge.
    hits: Vec<u8>,
    /// Whether a segment is a duplicate.
    pub repeated: bool,
}

impl Present {
    /// Whether the segment is an edge, which is then marked.
    #[inline]
    pub fn holds(&self, [u, v]: [u32; 2]) -> bool {
        bits(self.slots[u as usize], v) & self.hits[u as usize] != 0
    }
}

/// A bit for each slot that contains `v`.
#[inline]
fn bits(slots: [u32; 2], v: u32) -> u8 {
    u8::from(slots[0] == v) | u8::from(slots[1] == v) << 1
}

/// Marks the edges of triangles that are among the segments `ends`.
pub fn mark_present<S: Sites>(
    marked: &mut Marked<S>,
    ends: &[[u32; 2]],
    watch: &Watch,
) -> Result<Present> {
    let mut present = with_slots(ends, marked.count, watch)?;
    let (slots, hits) = (&present.slots, &mut present.hits);
    let triangles = marked.triangles();
    let mut mesh = marked.patch();
    for t in 0..triangles {
        if t.is_multiple_of(LOT) {
            watch.check()?;
        }
        let corners = mesh.corners(t);
        let mut marks = 0;
        for k in 0..3 {
            let [u, v] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            let found = bits(slots[u as usize], v);
            hits[u as usize] |= found;
            marks |= u32::from(found != 0) << k;
        }
        mesh.set_marks(t, marks);
    }
    Ok(present)
}

fn with_slots(ends: &[[u32; 2]], vertices: usize, watch: &Watch) -> Result<Present> {
    // One more for the infinite vertex.
    let mut slots = filled(vertices + 1, [NONE; 2])?;
    let mut repeated = false;
    let mut pace = Pace::new(watch, LOT as usize);
    for &[u, v] in ends.iter().filter(|e| e[0] != e[1]) {
        pace.spend(1)?;
        if bits(slots[u as usize], v) != 0 {
            repeated = true;
            continue;
        }
        let free = |slots: &[u32; 2]| slots.iter().position(|&s| s == NONE);
        if let (Some(i), Some(j)) = (free(&slots[u as usize]), free(&slots[v as usize])) {
            slots[u as usize][i] = v;
            slots[v as usize][j] = u;
        }
    }
    Ok(Present {
        slots,
        hits: filled(vertices + 1, 0)?,
        repeated,
    })
}
