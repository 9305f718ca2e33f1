//! The subsegments, each once, with the segments that cover it.

use std::collections::HashMap;

use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::{Pace, Watch};
use crate::order;

/// Subsegments in the order of the first segment that covers them and along it, directed as it is.
#[derive(Debug, Default)]
pub struct Subsegments {
    /// The two vertices of each.
    pub ends: Vec<[i32; 2]>,
    /// Where the segments of each begin in `source`, and the end.
    pub start: Vec<i64>,
    /// The segments that cover each, ascending.
    pub source: Vec<i32>,
    /// For each of those, whether it runs from the first of the two vertices to the second.
    pub forward: Vec<bool>,
}

impl Subsegments {
    /// From edges with the rows of their segments, ascending; each edge occurs once unless it is
    /// `repeated`.
    pub fn of(pieces: &[([u32; 2], u32)], repeated: bool, watch: &Watch) -> Result<Self> {
        if repeated {
            return Self::grouped(pieces, watch);
        }
        let mut out = Self::with_room(pieces.len())?;
        out.ends
            .extend(pieces.iter().map(|p| p.0.map(|v| v as i32)));
        out.start.extend(0..=pieces.len() as i64);
        out.source.extend(pieces.iter().map(|p| p.1 as i32));
        out.forward.resize(pieces.len(), true);
        Ok(out)
    }

    fn with_room(n: usize) -> Result<Self> {
        Ok(Self {
            ends: with_room(n)?,
            start: with_room(n + 1)?,
            source: with_room(n)?,
            forward: with_room(n)?,
        })
    }

    fn grouped(pieces: &[([u32; 2], u32)], watch: &Watch) -> Result<Self> {
        let mut out = Self::with_room(pieces.len())?;
        let mut place: HashMap<[u32; 2], u32> = HashMap::new();
        // Entries by subsegment and row.
        let mut entries: Vec<(u32, i32, bool)> = with_room(pieces.len())?;
        let mut pace = Pace::new(watch, 1 << 14);
        for &(ends, row) in pieces {
            pace.spend(1)?;
            let [u, v] = ends;
            let next = out.ends.len() as u32;
            if place.len() == place.capacity() {
                let bytes = 2 * size_of::<([u32; 2], u32)>() * place.len();
                let refused = |_| Error::Memory { bytes };
                place.try_reserve(1 + place.len()).map_err(refused)?;
            }
            let at = *place.entry([u.min(v), u.max(v)]).or_insert(next);
            if at == next {
                out.ends.push(ends.map(|v| v as i32));
            }
            let forward = out.ends[at as usize][0] == u as i32;
            entries.push((at, row as i32, forward));
        }
        order::sort_by(&mut entries, watch, |d, e| {
            (d.0, d.1, d.2).cmp(&(e.0, e.1, e.2))
        })?;
        entries.dedup_by_key(|e| (e.0, e.1));
        for (i, &(at, row, forward)) in entries.iter().enumerate() {
            if at as usize == out.start.len() {
                out.start.push(i as i64);
            }
            out.source.push(row);
            out.forward.push(forward);
        }
        out.start.push(entries.len() as i64);
        Ok(out)
    }
}
