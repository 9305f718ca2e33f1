//! Tetrahedra that have given triangles as faces, bit for bit: exact recovery of a boundary.
//!
//! Points are added only strictly between the faces, and all end up in doubles.
//!
//! # Why it ends
//!
//! The Delaunay triangulation of the vertices and four far ones fills a region with tetrahedra.
//! Let e be a face or an edge inside it, K the tetrahedra around e, and x a point inside e. Each
//! outer face of K leaves out exactly one vertex of e, so the points from which K can be fanned are
//! an open set that contains x. Fanning removes only what contains e.
//!
//! 1. Flips (`flips`): each lowers the number of crossings of what is missing, or keeps it and is one
//!    of a limited number.
//! 2. Segments (`segments`): each point leaves fewer open tetrahedra on the rest of the segment.
//! 3. Faces (`facets`): each point leaves one crossing edge fewer.
//!    Where faces of one plane are missing, its Delaunay triangulation is recovered first (`planes`);
//!    flips in the plane then bring those of the input back, with points on its sides where tetrahedra
//!    do not allow them (`swap`): each leaves an edge of the input one crossing fewer.
//! 4. Points on the boundary are suppressed (`suppress`): each is replaced by one point in each
//!    sector between faces; then free points are removed (`thin`) where a neighbor sees all, also
//!    after flips that leave them fewer edges.
//! 5. Coordinates are exact (`coordinates`) until doubles are found (`place`); where no double sees
//!    all faces around a point, they are divided among two or three (`divide`).
//!
//! What is locked contains no e: it would cross the segment or face, which valid input excludes.
//!
//! # Determinism
//!
//! Vertices and faces are sorted first, and only the Delaunay triangulation runs in threads: the
//! result is independent of the order of the rows and of the number of workers.

mod center;
mod coordinates;
mod crossing;
mod divide;
mod export;
mod facets;
mod flips;
mod input;
mod locks;
mod mesh;
mod place;
mod planes;
mod segments;
mod suppress;
mod swap;
mod task;
mod thin;
mod work;

pub use task::{Counts, Recovered, Task};

use crate::base::error::{Error, Result};
use crate::base::memory::filled;
use crate::base::watch::Watch;
use export::Rows;
use mesh::{NONE, PAIRS, ascending, pair};
use place::Near;
use work::{Origin, Work};

/// Sweeps that look for doubles.
const SWEEPS: usize = 8;

/// How many of these divide faces between two points.
const DIVISIONS: usize = 2;

/// The depth of edge removals to remove points. There are few of these, so depth costs little.
const DEEPEST: usize = 3;

/// The depth of edge removals to recover segments and faces. Points that a greater depth would save
/// are removed later at less cost.
const DEPTH: usize = 1;

/// Recovers faces. Returns the tetrahedra that cannot be reached from far outside without crossing
/// a face: none, if the faces close nothing.
pub fn recover(task: Task, watch: &Watch) -> Result<Recovered> {
    let made = attempt(task, task.flips, watch);
    match &made {
        // If planes keep their triangles, other points are needed, and these may have places.
        Ok(made) if !made.crowded.is_empty() && task.flips => attempt(task, false, watch),
        Err(Error::Budget { .. }) if task.flips => attempt(task, false, watch),
        _ => made,
    }
}

/// Recovers faces; if `planes`, with other triangles first in planes where some are missing.
fn attempt(task: Task, planes: bool, watch: &Watch) -> Result<Recovered> {
    let imported = input::import(task, watch)?;
    let mut work = Work::new(imported.mesh, imported.faces, task.max_points, watch)?;
    let rows = Rows {
        points: &imported.rows,
        faces: &imported.face_rows,
    };
    match work.recovered(task.flips, planes) {
        Ok(()) => {}
        Err(_) if !work.stuck.is_empty() => {
            let stuck = std::mem::take(&mut work.stuck);
            return Ok(rows.crowded(work.counts, stuck));
        }
        Err(e) => return Err(e),
    }
    let walls = work.walls()?;
    let out = work.outside(&walls)?;
    let crowded = work.crowded(&out);
    if !crowded.is_empty() {
        return Ok(rows.crowded(work.counts, crowded));
    }
    work.verify(&walls, &out)?;
    work.export(task, rows, &walls, &out)
}

impl Work<'_> {
    /// Recovers all segments and faces, and moves added points to doubles where these fit.
    fn recovered(&mut self, flips: bool, planes: bool) -> Result<()> {
        let (mut segments, mut faces) = self.missing()?;
        self.counts.missing_edges = segments.len();
        self.counts.missing_faces = faces.len();
        let mut parts = Vec::new();
        let mut given = Vec::new();
        if planes && !faces.is_empty() {
            let (mut first, found) = self.planes(&segments, &faces)?;
            parts = found;
            if !parts.is_empty() {
                given.clone_from(&self.faces);
                first.sort_unstable();
                self.restart(first)?;
                (segments, faces) = self.missing()?;
            }
        }
        if flips {
            for depth in 0..=DEPTH {
                segments = self.flip_segments(segments, depth)?;
            }
        }
        self.split_segments(&segments, flips)?;
        if flips {
            for depth in 0..=DEPTH {
                faces = self.flip_faces(faces, depth)?;
            }
        }
        self.cut_faces(&faces)?;
        if !parts.is_empty() {
            self.swap_back(&parts)?;
            self.restart(given)?;
            if self.missing()? != (Vec::new(), Vec::new()) {
                return Err(mesh::internal("a face of a plane is missing"));
            }
        }
        self.thin(self.given)?;
        self.finish(flips)
    }

    /// Segments and faces that the mesh lacks; locks the others.
    fn missing(&mut self) -> Result<(Vec<u32>, Vec<u32>)> {
        let mut there = filled(self.segments.len(), false)?;
        for v in &self.mesh.corners {
            self.pace.spend(1)?;
            for [i, j, ..] in PAIRS {
                if let Some(s) = self.locked_edges.row(pair(v[i], v[j])) {
                    there[s as usize] = true;
                }
            }
        }
        let mut segments = Vec::new();
        for (s, &edge) in (0..).zip(&self.segments) {
            if there[s as usize] {
                self.locked_edges.insert(edge, s);
            } else {
                segments.push(s);
            }
        }
        let there = self.faces_there()?;
        let mut faces = Vec::new();
        for f in 0..self.faces.len() as u32 {
            if there[f as usize] {
                self.locked_faces.insert(self.faces[f as usize], f);
                self.close(f);
            } else {
                faces.push(f);
            }
        }
        Ok((segments, faces))
    }

    /// Which faces of the input are faces of the mesh.
    fn faces_there(&mut self) -> Result<Vec<bool>> {
        let mut there = filled(self.faces.len(), false)?;
        for t in 0..self.mesh.corners.len() as u32 {
            self.pace.spend(1)?;
            for k in 0..4 {
                // From one of both sides.
                let u = self.mesh.across[t as usize][k];
                if !self.mesh.is_there(t) || (u != NONE && u < t) {
                    continue;
                }
                if let Some(f) = self.locked_faces.row(ascending(self.mesh.face(t, k))) {
                    there[f as usize] = true;
                }
            }
        }
        Ok(there)
    }

    /// Notes that a face is recovered.
    fn close(&mut self, f: u32) {
        for s in self.sides[f as usize] {
            self.open_faces[s as usize] -= 1;
        }
    }

    /// Recovers faces with whole edges by flips, and returns those that are still missing.
    fn flip_faces(&mut self, faces: Vec<u32>, depth: usize) -> Result<Vec<u32>> {
        let mut missing = faces;
        loop {
            let before = missing.len();
            let mut rest = Vec::new();
            for &f in &missing {
                let whole = self.rim(f).len() == 3;
                if whole && self.flip_face(f, depth)? {
                    self.locked_faces.insert(self.faces[f as usize], f);
                    self.close(f);
                    self.counts.flipped_faces += 1;
                } else {
                    rest.push(f);
                }
            }
            missing = rest;
            if missing.is_empty() || missing.len() == before {
                return Ok(missing);
            }
        }
    }

    /// Recovers faces one after another, and removes points of the boundary as soon as possible.
    fn cut_faces(&mut self, faces: &[u32]) -> Result<()> {
        for &f in faces {
            let first = self.mesh.points.len() as u32;
            self.cut_face(f)?;
            self.close(f);
            let last = self.mesh.points.len() as u32;
            for s in first..last {
                if matches!(self.origin(s), Some(Origin::Face)) {
                    self.suppress(s)?;
                }
            }
            for segment in self.sides[f as usize] {
                self.suppress_segment(segment)?;
            }
            self.thin(first)?;
        }
        // Segments all of whose faces were there.
        for segment in 0..self.segments.len() as u32 {
            self.suppress_segment(segment)?;
        }
        Ok(())
    }

    /// Suppresses the points of a segment whose faces are all recovered.
    fn suppress_segment(&mut self, segment: u32) -> Result<()> {
        if self.open_faces[segment as usize] > 0 {
            return Ok(());
        }
        while let Some(&s) = self.chains.get(&segment).and_then(|chain| chain.last()) {
            self.suppress(s)?;
        }
        Ok(())
    }

    /// Moves free points to doubles and removes those that are not needed.
    fn finish(&mut self, flips: bool) -> Result<()> {
        for sweep in 0..SWEEPS {
            let before = self.free_points().len();
            if before == 0 {
                break;
            }
            // First, points that flips can remove without a move.
            if flips {
                let walls = self.walls()?;
                let out = self.outside(&walls)?;
                self.thin_by_flips(sweep.min(DEEPEST), &out)?;
            }
            // Then those that are no longer needed when all are well placed.
            for v in self.free_points() {
                self.pace.spend(32)?;
                self.center_free(v, Near::One);
            }
            self.thin(self.given)?;
            let after = self.free_points().len();
            // Another sweep is worthwhile if this one removed more than a twentieth.
            if before.saturating_sub(after) * 20 <= before && sweep >= DEEPEST {
                break;
            }
        }
        let mut divisions = DIVISIONS;
        for _ in 0..SWEEPS {
            let double = |v| self.mesh.points.is_double(v);
            if self.free_points().into_iter().all(double) {
                break;
            }
            // Points that have no place in doubles get one with another point beside them.
            let walls = self.walls()?;
            let out = self.outside(&walls)?;
            let wide = self.wide_inside(&out);
            if wide.is_empty() {
                break;
            }
            for v in wide {
                // If one point has no place, the places of others are useless.
                if divisions == 0 || !self.divide(v)? {
                    divisions = 1;
                    break;
                }
            }
            divisions -= divisions.min(1);
            for v in self.free_points() {
                self.pace.spend(32)?;
                self.center_free(v, Near::One);
            }
            self.thin(self.given)?;
        }
        Ok(())
    }

    /// Points inside that are not doubles.
    fn wide_inside(&self, out: &[bool]) -> Vec<u32> {
        let inside = |v: &u32| !out[self.mesh.at[*v as usize] as usize];
        let free = self.free_points().into_iter();
        free.filter(|v| !self.mesh.points.is_double(*v) && inside(v))
            .collect()
    }

    /// Faces next to points inside that are not doubles.
    fn crowded(&mut self, out: &[bool]) -> Vec<u32> {
        let mut found = std::collections::BTreeSet::new();
        for v in self.wide_inside(out) {
            for t in self.mesh.star(v, usize::MAX) {
                for w in self.mesh.corners[t as usize] {
                    for u in self.mesh.star(w, 1 << 10) {
                        for k in 0..4 {
                            let face = ascending(self.mesh.face(u, k));
                            let near = face.contains(&w) && self.mesh.across[u as usize][k] != NONE;
                            if let Some(f) = self.locked_faces.get(face).filter(|_| near) {
                                found.insert(f);
                            }
                        }
                    }
                }
            }
        }
        found.into_iter().collect()
    }
}
