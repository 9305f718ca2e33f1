//! Insertion: the cavity of a point is emptied and filled with a star (see `delaunay::space::cavity`).

use super::mesh::Mesh;
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::watch::Pace;
use crate::mesh::space::tetrahedron;

impl Mesh {
    /// Inserts vertex `v`, whose place is in tetrahedron or ghost `seed`. On an error nothing has
    /// changed.
    pub fn insert(&mut self, v: u32, seed: u32, pace: &mut Pace) -> Result<()> {
        self.carve(v, seed, pace)?;
        self.open_rim()?;
        for i in 0..self.patch.rim.len() {
            let e = self.patch.rim[i];
            let [a, b, c] = self.facet(e);
            self.patch.add([b, a, c, v])?;
        }
        self.apply()?;
        self.counts.vertices += 1;
        Ok(())
    }

    /// Lists the tetrahedra and ghosts in conflict with `v`, and the facets around them.
    fn carve(&mut self, v: u32, seed: u32, pace: &mut Pace) -> Result<()> {
        let p = self.at(v);
        self.patch.clear();
        self.start_search()?;
        self.meet(seed, true);
        push(&mut self.patch.dead, seed)?;
        let mut next = 0;
        while let Some(&t) = self.patch.dead.get(next) {
            next += 1;
            pace.spend(1)?;
            for e in self.opposites(t) {
                let other = tetrahedron(e);
                let inside = match self.met(other) {
                    Some(inside) => inside,
                    None if self.conflicts(other, p) => {
                        self.meet(other, true);
                        push(&mut self.patch.dead, other)?;
                        true
                    }
                    None => {
                        self.meet(other, false);
                        false
                    }
                };
                if !inside {
                    push(&mut self.patch.rim, e)?;
                }
            }
        }
        self.work += next;
        Ok(())
    }
}
