//! Regular triangulations of space by insertion: cavities, in which sites may disappear.
//!
//! A new site takes away all tetrahedra whose lifted planes it lies below, and is joined to the faces of
//! the hole; a site inside the hole is hidden from then on. A site above the plane of the tetrahedron
//! that holds it is hidden at once (A. Bowyer; D. F. Watson, both 1981; H. Edelsbrunner and N. R.
//! Shah, "Incremental topological flipping works for regular triangulations", 1996). Predicates are
//! exact and ties broken, as if no five lifted sites lay on one plane: the tetrahedra to go are
//! connected, their hole is star-shaped, and the result hangs on no order.
//!
//! Outside the hull ghosts take the part of tetrahedra: one for each face of the hull, with GHOST for
//! its fourth corner. A site in the plane of such a face is below the lifted plane of the three exactly
//! where it is below that of the tetrahedron behind them, ties included.

use std::collections::HashMap;

use delone_predicates::{Point3, Sign, orient3d};

use super::power::power_canonical;
use crate::arrays::Arrays;
use crate::error::{Error, Result};
use crate::locate3::FACES;
use crate::memory::{filled, with_room};
use crate::watch::Watch;

/// The vertex at infinity.
const GHOST: u32 = u32::MAX;
const NONE: u32 = u32::MAX;
/// Sites between two looks at the watch.
const WATCH_EVERY: u32 = 1 << 10;

/// Distinct points and their weights.
#[derive(Clone, Copy)]
pub struct Weighted<'a> {
    /// Coordinates.
    pub points: &'a [Point3],
    /// Weights.
    pub weights: &'a [f64],
}

/// Tetrahedra with ghosts.
struct Insertion<'a> {
    sites: Weighted<'a>,
    vertices: Vec<[u32; 4]>,
    neighbors: Vec<[u32; 4]>,
    free: Vec<u32>,
    /// The insertion in which a tetrahedron was last looked at, and whether it has to go.
    seen: Vec<(u32, bool)>,
    /// For each edge of the hole the new tetrahedron that waits there for its neighbour, and the
    /// corner opposite their face.
    open: HashMap<(u32, u32), (u32, usize)>,
    last: u32,
    stamp: u32,
}

/// Triangulates sites, inserted in their order after the first four given, which span space.
pub fn insert_all(sites: Weighted, first: [u32; 4], watch: &Watch) -> Result<Arrays<4>> {
    let mut mesh = Insertion::of(sites, first)?;
    for p in (0..sites.points.len() as u32).filter(|p| !first.contains(p)) {
        if p.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        mesh.insert(p)?;
    }
    mesh.export()
}

impl<'a> Insertion<'a> {
    fn of(sites: Weighted<'a>, first: [u32; 4]) -> Result<Self> {
        let n = sites.points.len();
        let mut mesh = Self {
            sites,
            vertices: with_room(8 * n)?,
            neighbors: with_room(8 * n)?,
            free: Vec::new(),
            seen: with_room(8 * n)?,
            open: HashMap::new(),
            last: 0,
            stamp: 0,
        };
        let [a, b, c, d] = first;
        let s = match mesh.turn(first) {
            Sign::Negative => [b, a, c, d],
            _ => first,
        };
        mesh.vertices.push(s);
        mesh.neighbors.push([1, 2, 3, 4]);
        // The ghost at face k has corner k for the ghost and two others exchanged: slots i and j.
        for k in 0..4 {
            let (i, j) = ((k + 1) % 4, (k + 2) % 4);
            let (mut corners, mut around) = (s, [1, 2, 3, 4]);
            corners[k] = GHOST;
            around[k] = 0;
            corners.swap(i, j);
            around.swap(i, j);
            mesh.vertices.push(corners);
            mesh.neighbors.push(around);
        }
        mesh.seen.resize(5, (0, false));
        Ok(mesh)
    }

    fn turn(&self, sites: [u32; 4]) -> Sign {
        let [a, b, c, d] = sites.map(|v| self.sites.points[v as usize]);
        orient3d(a, b, c, d)
    }

    fn insert(&mut self, p: u32) -> Result<()> {
        let start = self.locate(p)?;
        self.stamp += 1;
        if !self.must_go(start, p) {
            return Ok(()); // Hidden.
        }
        let mut stack = vec![start];
        let (mut hole, mut rim) = (Vec::new(), Vec::new());
        // Each tetrahedron is seen once in an insertion, and pushed then at most.
        while let Some(t) = stack.pop() {
            hole.push(t);
            for k in 0..4 {
                let other = self.neighbors[t as usize][k];
                let (stamp, goes) = self.seen[other as usize];
                if stamp == self.stamp {
                    if !goes {
                        rim.push((t, k));
                    }
                } else if self.must_go(other, p) {
                    stack.push(other);
                } else {
                    rim.push((t, k));
                }
            }
        }
        self.fill(p, &rim, &hole)
    }

    /// The tetrahedron that holds a site, boundary included; a ghost, outside the hull.
    fn locate(&self, p: u32) -> Result<u32> {
        let (mut t, mut from) = (self.last, NONE);
        // No walk in a regular triangulation comes back to a tetrahedron, so it has no more steps.
        for _ in 0..=self.vertices.len() {
            let corners = self.vertices[t as usize];
            let step = (0..4).find(|&k| {
                let [a, b, c] = FACES[k].map(|i| corners[i]);
                // Strictly beyond the face, which is counter-clockwise from there.
                self.neighbors[t as usize][k] != from && self.turn([a, b, c, p]) == Sign::Positive
            });
            let Some(k) = step else { return Ok(t) };
            (t, from) = (self.neighbors[t as usize][k], t);
            if self.vertices[t as usize].contains(&GHOST) {
                return Ok(t);
            }
        }
        Err(Error::Internal(format!(
            "the walk to site {p} does not end"
        )))
    }

    /// Whether a tetrahedron has to go for a site; remembered for this insertion.
    fn must_go(&mut self, t: u32, p: u32) -> bool {
        let corners = self.vertices[t as usize];
        let goes = match corners.iter().position(|&v| v == GHOST) {
            None => self.is_below(corners, p),
            Some(k) => {
                let [a, b, c] = FACES[k].map(|i| corners[i]);
                // From the ghost the face is counter-clockwise as seen from within the hull.
                match self.turn([a, b, c, p]) {
                    Sign::Zero => {
                        let behind = self.neighbors[t as usize][k];
                        self.is_below(self.vertices[behind as usize], p)
                    }
                    turn => turn == Sign::Negative,
                }
            }
        };
        self.seen[t as usize] = (self.stamp, goes);
        goes
    }

    fn is_below(&self, [a, b, c, d]: [u32; 4], p: u32) -> bool {
        let sites = [a, b, c, d, p].map(|v| v as usize);
        let points = sites.map(|v| self.sites.points[v]);
        power_canonical(points, sites.map(|v| self.sites.weights[v])) == Sign::Positive
    }

    /// Joins a site to the faces of the rim, which are counter-clockwise as seen from outside of the hole:
    /// each makes a tetrahedron with it, which is joined to the others at its edges.
    fn fill(&mut self, p: u32, rim: &[(u32, usize)], hole: &[u32]) -> Result<()> {
        let made: Vec<([u32; 4], u32, u32)> = rim
            .iter()
            .map(|&(t, k)| {
                let [a, b, c] = FACES[k].map(|i| self.vertices[t as usize][i]);
                ([p, a, b, c], self.neighbors[t as usize][k], t)
            })
            .collect();
        // All links to what stays are changed before any number is used again.
        let mut numbers = Vec::with_capacity(made.len());
        self.free.extend_from_slice(hole);
        let mut back = Vec::with_capacity(made.len());
        for &(_, outside, t) in &made {
            let place = self.neighbors[outside as usize]
                .iter()
                .position(|&x| x == t);
            back.push(place.ok_or_else(|| Error::Internal("a rim does not fit".into()))?);
        }
        for (&(corners, outside, _), &back) in made.iter().zip(&back) {
            let number = match self.free.pop() {
                Some(number) => number,
                None => {
                    self.vertices.push([0; 4]);
                    self.neighbors.push([NONE; 4]);
                    self.seen.push((0, false));
                    self.vertices.len() as u32 - 1
                }
            };
            numbers.push(number);
            self.vertices[number as usize] = corners;
            self.neighbors[number as usize] = [outside, NONE, NONE, NONE];
            self.neighbors[outside as usize][back] = number;
            self.seen[number as usize] = (0, false);
        }
        self.open.clear();
        for &number in &numbers {
            let [_, a, b, c] = self.vertices[number as usize];
            for (k, (u, v)) in [(1, (b, c)), (2, (c, a)), (3, (a, b))] {
                match self.open.remove(&(u.min(v), u.max(v))) {
                    Some((other, corner)) => {
                        self.neighbors[number as usize][k] = other;
                        self.neighbors[other as usize][corner] = number;
                    }
                    None => {
                        self.open.insert((u.min(v), u.max(v)), (number, k));
                    }
                }
            }
            if ![a, b, c].contains(&GHOST) {
                self.last = number;
            }
        }
        // Those that are left hold nothing that could be taken for a tetrahedron.
        let left = hole.len().saturating_sub(numbers.len());
        for &t in &self.free[self.free.len() - left..] {
            self.vertices[t as usize] = [GHOST; 4];
        }
        if self.open.is_empty() {
            return Ok(());
        }
        Err(Error::Internal("a rim is not closed".into()))
    }

    fn export(self) -> Result<Arrays<4>> {
        let mut number = filled(self.vertices.len(), -1)?;
        let mut count = 0;
        for (corners, number) in self.vertices.iter().zip(&mut number) {
            if !corners.contains(&GHOST) {
                *number = count;
                count += 1;
            }
        }
        let mut out = Arrays {
            simplices: with_room(count as usize)?,
            neighbors: with_room(count as usize)?,
        };
        for (t, corners) in self.vertices.iter().enumerate() {
            if number[t] >= 0 {
                out.simplices.push(corners.map(|v| v as i32));
                let around = self.neighbors[t];
                out.neighbors
                    .push(around.map(|other| number[other as usize]));
            }
        }
        Ok(out)
    }
}
