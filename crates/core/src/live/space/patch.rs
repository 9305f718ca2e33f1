//! The edit at hand: records to be replaced, those that replace them, and how these are sewn together.
//!
//! An edit is complete before anything in the mesh changes: each facet of a new tetrahedron has met
//! either another one or a facet around the hole. Then memory is reserved, and the rest cannot fail.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

use super::mesh::{INFINITE, Mesh, Record};
use crate::error::{Error, Result};
use crate::live::rows::NONE;
use crate::memory::push;
use crate::mesh3::{Code, FACETS, LIMIT, corner, tetrahedron};

/// A facet that waits for its other side.
#[derive(Debug, Clone, Copy)]
enum Side {
    /// A facet of the mesh outside of the hole.
    Outer(Code),
    /// A facet of a new tetrahedron: `4 i + k`, the corner k of the i-th.
    Made(Code),
}

/// The edit at hand.
#[derive(Debug, Default)]
pub struct Patch {
    /// Records to be replaced.
    pub dead: Vec<u32>,
    /// The facets around them, seen from outside.
    pub rim: Vec<Code>,
    /// New tetrahedra and ghosts; their opposite codes are filled last.
    made: Vec<[u32; 4]>,
    /// Facets of new tetrahedra that meet: both codes.
    seams: Vec<(Code, Code)>,
    /// Facets of new tetrahedra at the rim: the code, and that of the facet outside.
    hems: Vec<(Code, Code)>,
    /// Facets without their other side, by their corners in ascending order.
    open: HashMap<[u32; 3], Side, BuildHasherDefault<Mixer>>,
    /// Facets that have been opened and may be open still.
    front: Vec<[u32; 3]>,
    /// The numbers of the records of new tetrahedra.
    numbers: Vec<u32>,
}

impl Patch {
    /// Empties all lists.
    pub fn clear(&mut self) {
        self.dead.clear();
        self.rim.clear();
        self.made.clear();
        self.seams.clear();
        self.hems.clear();
        self.open.clear();
        self.front.clear();
    }

    /// The number of new tetrahedra and ghosts.
    pub fn made(&self) -> usize {
        self.made.len()
    }

    /// A facet without infinite corner that still needs a tetrahedron, positively oriented toward it.
    pub fn next_open(&mut self) -> Option<[u32; 3]> {
        while let Some(facet) = self.front.pop() {
            if self.open.contains_key(&sorted(facet)) {
                return Some(facet);
            }
        }
        None
    }

    /// Adds a tetrahedron and sews its facets to those that are open.
    pub fn add(&mut self, corners: [u32; 4]) -> Result<()> {
        let i = self.made.len() as u32;
        push(&mut self.made, corners)?;
        for (k, facet) in (0..).zip(FACETS) {
            // From outside of the tetrahedron.
            let [a, b, c] = facet.map(|j| corners[j]);
            self.meet([b, a, c], Side::Made(4 * i + k))?;
        }
        Ok(())
    }

    /// Sews a facet to its other side, or leaves it open; `facet` is oriented away from `side`.
    fn meet(&mut self, facet: [u32; 3], side: Side) -> Result<()> {
        if self.open.try_reserve(1).is_err() {
            let bytes = 2 * self.open.capacity() * size_of::<([u32; 3], Side)>();
            return Err(Error::Memory { bytes });
        }
        let entry = match self.open.entry(sorted(facet)) {
            Entry::Vacant(place) => {
                place.insert(side);
                if !facet.contains(&INFINITE) {
                    push(&mut self.front, facet)?;
                }
                return Ok(());
            }
            Entry::Occupied(entry) => entry.remove(),
        };
        match (entry, side) {
            (Side::Made(e), Side::Made(f)) => push(&mut self.seams, (e, f)),
            (Side::Outer(f), Side::Made(e)) | (Side::Made(e), Side::Outer(f)) => {
                push(&mut self.hems, (e, f))
            }
            (Side::Outer(e), Side::Outer(f)) => Err(Error::Internal(format!(
                "facets {e} and {f} around a hole are the same"
            ))),
        }
    }
}

impl Mesh {
    /// Opens the facets of the rim, seen from inside of the hole.
    pub fn open_rim(&mut self) -> Result<()> {
        for i in 0..self.patch.rim.len() {
            let e = self.patch.rim[i];
            let [a, b, c] = self.facet(e);
            self.patch.meet([b, a, c], Side::Outer(e))?;
        }
        Ok(())
    }

    /// Replaces the dead records by the new tetrahedra. On an error nothing has changed.
    pub fn apply(&mut self) -> Result<()> {
        if !self.patch.open.is_empty() {
            let message = format!("{} facets are open", self.patch.open.len());
            return Err(Error::Internal(message));
        }
        let mut patch = std::mem::take(&mut self.patch);
        let outcome = self.number(&mut patch);
        if outcome.is_ok() {
            self.sew(&patch);
        }
        self.patch = patch;
        outcome
    }

    /// Assigns a record to each new tetrahedron.
    fn number(&mut self, patch: &mut Patch) -> Result<()> {
        let more = patch.made.len().saturating_sub(patch.dead.len());
        if self.records.len() + more > LIMIT {
            return Err(Error::TooManyTetrahedra { limit: LIMIT });
        }
        self.records.reserve(more)?;
        patch.numbers.clear();
        crate::memory::make_room(&mut patch.numbers, patch.made.len())?;
        let reused = patch.dead.len().min(patch.made.len());
        patch.numbers.extend_from_slice(&patch.dead[..reused]);
        for _ in 0..more {
            patch.numbers.push(self.take_record()?);
        }
        Ok(())
    }

    /// Writes the new records, links them, and frees those that are left over.
    fn sew(&mut self, patch: &Patch) {
        for &t in &patch.dead {
            self.counts.tetrahedra -= u32::from(self.infinite_corner(t).is_none());
        }
        for (&corners, &t) in patch.made.iter().zip(&patch.numbers) {
            let [a, b, c, d] = corners;
            *self.records.get_mut(t as usize) = [a, b, c, d, NONE, NONE, NONE, NONE];
            self.counts.tetrahedra += u32::from(!corners.contains(&INFINITE));
            for v in corners {
                self.sites.get_mut(v as usize).near = t;
            }
        }
        let code = |e: Code| 4 * patch.numbers[tetrahedron(e) as usize] + (e & 3);
        for &(e, f) in &patch.seams {
            self.link(code(e), code(f));
        }
        for &(e, f) in &patch.hems {
            self.link(code(e), f);
        }
        for &t in patch.dead.get(patch.made.len()..).unwrap_or_default() {
            self.free_record(t);
        }
        if let Some(&t) = patch.numbers.first() {
            self.last = t;
        }
    }

    /// Makes `e` and `f` the two sides of one facet.
    pub fn link(&mut self, e: Code, f: Code) {
        let record: &mut Record = self.records.get_mut(tetrahedron(e) as usize);
        record[4 + corner(e)] = f;
        let record: &mut Record = self.records.get_mut(tetrahedron(f) as usize);
        record[4 + corner(f)] = e;
    }
}

/// Three vertices in ascending order.
fn sorted([a, b, c]: [u32; 3]) -> [u32; 3] {
    let (a, b) = (a.min(b), a.max(b));
    let (b, c) = (b.min(c), b.max(c));
    [a.min(b), a.max(b), c]
}

/// A hash of vertex numbers by multiplication.
#[derive(Debug, Default, Clone, Copy)]
pub struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 32
    }

    fn write(&mut self, bytes: &[u8]) {
        for word in bytes.chunks(4) {
            let word = word.first_chunk().map_or(0, |&w| u32::from_ne_bytes(w));
            self.0 = (self.0.rotate_left(23) ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }
}
