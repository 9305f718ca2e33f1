//! 3-D regular triangulations by incremental insertion of cavities; sites may become hidden.
//!
//! A new site removes all tetrahedra whose lifted planes it lies below, and is joined to the faces
//! of the cavity; a site inside the cavity is hidden from then on. A site above the plane of the
//! tetrahedron that contains it is hidden at once (A. Bowyer; D. F. Watson, both 1981; H.
//! Edelsbrunner and N. R. Shah, "Incremental topological flipping works for regular
//! triangulations", 1996). Predicates are exact and ties broken as if no five lifted sites were on
//! one hyperplane: the tetrahedra to be removed are connected, their cavity is star-shaped, and the
//! result is independent of the order of insertion.
//!
//! Outside the hull, ghosts take the place of tetrahedra: one for each face of the hull, with GHOST
//! as its fourth corner. A site in the plane of such a face is below the lifted plane of the three
//! exactly if it is below that of the tetrahedron behind them, ties included.

use std::collections::HashMap;

use delone_predicates::{Sign, orient3d};

use super::power::power_canonical;
use crate::base::arrays::{Arrays, OUTWARD};
use crate::base::error::{Error, Result};
use crate::base::watch::Watch;
use crate::regular::{GHOST, NONE, Records, Weighted};

/// Sites inserted between two checks for interruption.
const WATCH_EVERY: u32 = 1 << 10;

/// Tetrahedra with ghosts.
struct Insertion<'a> {
    sites: Weighted<'a, 3>,
    mesh: Records<4>,
    /// For each edge of the cavity, the new tetrahedron that waits for its neighbor there, and the
    /// corner opposite their face.
    open: HashMap<(u32, u32), (u32, usize)>,
}

/// Triangulates sites, inserted in order after the first four given, which are affinely
/// independent.
pub fn insert_all(sites: Weighted<3>, first: [u32; 4], watch: &Watch) -> Result<Arrays<4>> {
    let mut insertion = Insertion::of(sites, first)?;
    for p in (0..sites.points.len() as u32).filter(|p| !first.contains(p)) {
        if p.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        insertion.insert(p)?;
    }
    insertion.mesh.export()
}

impl<'a> Insertion<'a> {
    fn of(sites: Weighted<'a, 3>, first: [u32; 4]) -> Result<Self> {
        let [a, b, c, d] = first;
        let s = match turn(sites, first) {
            Sign::Negative => [b, a, c, d],
            _ => first,
        };
        let mut mesh = Records::with_room(8 * sites.points.len())?;
        mesh.push(s, [1, 2, 3, 4]);
        // The ghost at face k has GHOST as corner k and two others swapped: slots i and j.
        for k in 0..4 {
            let (i, j) = ((k + 1) % 4, (k + 2) % 4);
            let (mut corners, mut around) = (s, [1, 2, 3, 4]);
            corners[k] = GHOST;
            around[k] = 0;
            corners.swap(i, j);
            around.swap(i, j);
            mesh.push(corners, around);
        }
        Ok(Self {
            sites,
            mesh,
            open: HashMap::new(),
        })
    }

    /// Inserts a site; nothing changes if it is hidden.
    fn insert(&mut self, p: u32) -> Result<()> {
        let sites = self.sites;
        let start = self.mesh.locate(p, |corners, k| {
            let [a, b, c] = OUTWARD[k].map(|i| corners[i]);
            // Strictly beyond the face, which is counterclockwise from there.
            turn(sites, [a, b, c, p]) == Sign::Positive
        })?;
        match self
            .mesh
            .hole(start, |mesh, t| conflicts(sites, mesh, t, p))
        {
            Some((hole, rim)) => self.fill(p, &rim, &hole),
            None => Ok(()),
        }
    }

    /// Joins a site to the boundary faces, which are counterclockwise as seen from outside the
    /// cavity: each forms a tetrahedron with it, which is linked to the others at its edges.
    fn fill(&mut self, p: u32, rim: &[(u32, usize)], hole: &[u32]) -> Result<()> {
        // The new tetrahedra, with what lies across their boundary faces.
        let made: Vec<([u32; 4], u32, u32)> = rim
            .iter()
            .map(|&(t, k)| {
                let [a, b, c] = OUTWARD[k].map(|i| self.mesh.vertices[t as usize][i]);
                ([p, a, b, c], self.mesh.neighbors[t as usize][k], t)
            })
            .collect();
        // Update all links to remaining tetrahedra before any number is reused.
        let mut numbers = Vec::with_capacity(made.len());
        self.mesh.release(hole);
        let mut back = Vec::with_capacity(made.len());
        for &(_, outside, t) in &made {
            let place = self.mesh.neighbors[outside as usize]
                .iter()
                .position(|&x| x == t);
            back.push(place.ok_or_else(|| {
                Error::Internal("the boundary of a cavity does not match its neighbors".into())
            })?);
        }
        for (&(corners, outside, _), &back) in made.iter().zip(&back) {
            let number = self.mesh.take();
            numbers.push(number);
            self.mesh.vertices[number as usize] = corners;
            self.mesh.neighbors[number as usize] = [outside, NONE, NONE, NONE];
            self.mesh.neighbors[outside as usize][back] = number;
        }
        // Link the new tetrahedra: each edge of the boundary belongs to two of its faces.
        self.open.clear();
        for &number in &numbers {
            let [_, a, b, c] = self.mesh.vertices[number as usize];
            for (k, (u, v)) in [(1, (b, c)), (2, (c, a)), (3, (a, b))] {
                match self.open.remove(&(u.min(v), u.max(v))) {
                    Some((other, corner)) => {
                        self.mesh.neighbors[number as usize][k] = other;
                        self.mesh.neighbors[other as usize][corner] = number;
                    }
                    None => {
                        self.open.insert((u.min(v), u.max(v)), (number, k));
                    }
                }
            }
            if ![a, b, c].contains(&GHOST) {
                self.mesh.last = number;
            }
        }
        self.mesh.empty(hole);
        if self.open.is_empty() {
            return Ok(());
        }
        Err(Error::Internal(
            "the boundary of a cavity is not closed".into(),
        ))
    }
}

fn turn(of: Weighted<3>, sites: [u32; 4]) -> Sign {
    let [a, b, c, d] = sites.map(|v| of.points[v as usize]);
    orient3d(a, b, c, d)
}

/// Whether a tetrahedron is in conflict with a site.
fn conflicts(sites: Weighted<3>, mesh: &Records<4>, t: u32, p: u32) -> bool {
    let corners = mesh.vertices[t as usize];
    let Some(k) = corners.iter().position(|&v| v == GHOST) else {
        return is_below(sites, corners, p);
    };
    let [a, b, c] = OUTWARD[k].map(|i| corners[i]);
    // From the ghost the face is counterclockwise as seen from inside the hull.
    match turn(sites, [a, b, c, p]) {
        Sign::Zero => {
            let behind = mesh.neighbors[t as usize][k];
            is_below(sites, mesh.vertices[behind as usize], p)
        }
        turn => turn == Sign::Negative,
    }
}

fn is_below(of: Weighted<3>, [a, b, c, d]: [u32; 4], p: u32) -> bool {
    let sites = [a, b, c, d, p].map(|v| v as usize);
    let points = sites.map(|v| of.points[v]);
    power_canonical(points, sites.map(|v| of.weights[v])) == Sign::Positive
}
