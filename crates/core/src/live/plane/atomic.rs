//! Edits among segments take effect completely or not at all: what an edit replaces is recorded,
//! and restored after an error (see `journal`), because inverse edits may be large. Where all is
//! triangulated again, the mesh before is kept instead.

use super::Plane;
use super::mesh::Mesh;
use crate::base::error::{Error, Result};
use crate::live::kernel::Built;

impl Plane {
    /// Runs an edit; on any error nothing has changed.
    pub(super) fn atomically<T>(&mut self, edit: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let made = self.begin().and_then(|()| {
            self.before = Some(None);
            edit(self)
        });
        if let Some(replaced) = self.before.take()
            && made.is_err()
        {
            if let Some(replaced) = replaced {
                (self.mesh, self.rows, self.flat) = replaced;
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

    /// Replaces the mesh, the rows, and the line.
    pub(super) fn substitute(&mut self, made: Built<Mesh>) {
        let old = (
            std::mem::replace(&mut self.mesh, made.0),
            std::mem::replace(&mut self.rows, made.1),
            std::mem::replace(&mut self.flat, made.2),
        );
        if let Some(before @ None) = &mut self.before {
            *before = Some(old);
        }
    }
}
