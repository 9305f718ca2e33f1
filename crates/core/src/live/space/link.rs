//! Links the new tetrahedra of an edit into the mesh.
//!
//! An edit is complete before anything in the mesh changes: each facet of a new tetrahedron has met
//! either another one or a facet around the hole. Then memory is reserved, and the rest cannot fail.

use super::mesh::{INFINITE, Mesh};
use super::patch::{Patch, Side};
use crate::base::error::{Error, Result};
use crate::live::rows::NONE;
use crate::live::store::Record;
use crate::mesh::space::{Code, LIMIT, corner, tetrahedron};

impl Mesh {
    /// Opens the facets of the rim, seen from inside the hole.
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
        crate::base::memory::make_room(&mut patch.numbers, patch.made.len())?;
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
            self.counts.simplices -= u32::from(self.infinite_corner(t).is_none());
        }
        for (&corners, &t) in patch.made.iter().zip(&patch.numbers) {
            let [a, b, c, d] = corners;
            *self.records.get_mut(t as usize) = [a, b, c, d, NONE, NONE, NONE, NONE];
            self.counts.simplices += u32::from(!corners.contains(&INFINITE));
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
