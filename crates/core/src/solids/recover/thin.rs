//! Removes free points that are not needed.

use super::mesh::Corners;
use super::work::Work;
use crate::base::error::Result;

impl Work<'_> {
    /// The free points that are in the mesh.
    pub fn free_points(&self) -> Vec<u32> {
        let all = self.given..self.mesh.points.len() as u32;
        all.filter(|&v| self.is_free(v) && self.mesh.at[v as usize] != super::mesh::NONE)
            .collect()
    }

    /// Removes free points until each that is left is needed where it is.
    pub fn thin(&mut self, from: u32) -> Result<()> {
        loop {
            let mut less = false;
            for v in self.free_points() {
                if v >= from && self.thin_one(v)? {
                    less = true;
                }
            }
            if !less {
                return Ok(());
            }
        }
    }

    /// Removes free points whose edges can be flipped until a vertex sees all faces around them.
    pub fn thin_by_flips(&mut self, depth: usize, out: &[bool]) -> Result<()> {
        let inside = |v: &u32| !out[self.mesh.at[*v as usize] as usize];
        let points: Vec<u32> = self.free_points().into_iter().filter(inside).collect();
        for v in points {
            while !self.thin_one(v)? {
                if !self.flip_off(v, depth)? {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Removes a free point if a vertex around it sees all faces around it.
    fn thin_one(&mut self, v: u32) -> Result<bool> {
        let star = self.mesh.star(v, usize::MAX);
        self.pace.spend(star.len())?;
        let faces = self.mesh.outer_faces(&star);
        let Some(w) = self.vertex_that_sees(&faces) else {
            return Ok(false);
        };
        let kept = faces.iter().filter(|f| !f.contains(&w));
        let new: Vec<Corners> = kept.map(|&[a, b, c]| [a, b, c, w]).collect();
        self.mesh.replace(&star, &new)?;
        self.alive -= 1;
        self.counts.thinned += 1;
        Ok(true)
    }
}
