//! The edit at hand: records to be replaced, those that replace them, and the facets where these meet.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

use crate::base::error::{Error, Result};
use crate::base::memory::push;
use crate::live::store::INFINITE;
use crate::mesh::space::{Code, FACETS};

/// A facet that waits for its other side.
#[derive(Debug, Clone, Copy)]
pub enum Side {
    /// A facet of the mesh outside the hole.
    Outer(Code),
    /// A facet of a new tetrahedron: `4 i + k`, the corner k of the i-th.
    Made(Code),
}

/// The current edit.
#[derive(Debug, Default)]
pub struct Patch {
    /// Records to be replaced.
    pub dead: Vec<u32>,
    /// The facets around them, seen from outside.
    pub rim: Vec<Code>,
    /// New tetrahedra and ghosts; their opposite codes are filled last.
    pub made: Vec<[u32; 4]>,
    /// Facets of new tetrahedra that meet: both codes.
    pub seams: Vec<(Code, Code)>,
    /// Facets of new tetrahedra at the rim: the code, and that of the facet outside.
    pub hems: Vec<(Code, Code)>,
    /// Facets without their other side, by their corners in ascending order.
    pub open: HashMap<[u32; 3], Side, BuildHasherDefault<Mixer>>,
    /// Facets that have been opened and may be open still.
    front: Vec<[u32; 3]>,
    /// The numbers of the records of new tetrahedra.
    pub numbers: Vec<u32>,
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
            // From outside the tetrahedron.
            let [a, b, c] = facet.map(|j| corners[j]);
            self.meet([b, a, c], Side::Made(4 * i + k))?;
        }
        Ok(())
    }

    /// Sews a facet to its other side, or leaves it open; `facet` is oriented away from `side`.
    pub fn meet(&mut self, facet: [u32; 3], side: Side) -> Result<()> {
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
