//! All or nothing among segments, where the inverse of an edit may be large: what an edit replaces is
//! recorded, and an error puts it back (see `journal`). Where all is triangulated again, the mesh
//! before is kept instead.

use super::Plane;
use super::mesh::Mesh;
use crate::base::error::{Error, Result};
use crate::live::rows::Rows;

impl Plane {
    /// Runs an edit; on any error nothing has changed.
    pub(super) fn atomically<T>(&mut self, edit: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let made = self.begin().and_then(|()| {
            self.before.is_kept = true;
            edit(self)
        });
        let before = std::mem::take(&mut self.before);
        if made.is_err() && before.is_kept {
            if let Some(replaced) = before.replaced {
                (self.mesh, self.rows, self.line) = replaced;
            }
            if !(self.mesh.take_back() & self.rows.take_back() & self.segments.take_back()) {
                return Err(Error::Internal("an edit cannot be taken back".into()));
            }
            return made;
        }
        self.mesh.commit();
        self.rows.commit();
        self.segments.commit();
        made
    }

    fn begin(&mut self) -> Result<()> {
        self.mesh.begin()?;
        self.rows.begin()?;
        self.segments.begin()
    }

    /// Makes room for another step of such an edit.
    pub(super) fn room(&mut self) -> Result<()> {
        self.mesh.room(0)?;
        self.rows.room()?;
        self.segments.room()
    }

    /// Replaces the mesh, the rows, and the line.
    pub(super) fn substitute(&mut self, made: (Mesh, Rows, Vec<u32>)) {
        let old = (
            std::mem::replace(&mut self.mesh, made.0),
            std::mem::replace(&mut self.rows, made.1),
            std::mem::replace(&mut self.line, made.2),
        );
        if self.before.is_kept && self.before.replaced.is_none() {
            self.before.replaced = Some(old);
        }
    }
}
