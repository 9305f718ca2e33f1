//! The cavity of a point: what its insertion replaces, and the insertion.
//!
//! ```text
//!      .-------.                .-------.
//!     / \     / \              / \     / \      The tetrahedra whose circumspheres contain p, as
//!    /   \   /   \            /    \ /    \     far as they are connected without walls; without
//!   .-----.-------.    ->    .------p------.    those of which p does not see an outer face. Each
//!    \   /  p    /            \   / | \   /     outer face and p make a new one.
//!     \ /     \ /              \ /  |  \ /
//!      .-------.                .---.---.
//! ```
//!
//! A point on a facet opens its walls: those of one plane that lie between tetrahedra of the cavity
//! are replaced by the triangles of the point and the edges around them, the *rim*.

use delone_predicates::{Point3, Sign, insphere, orient3d};

use super::facet::insert;
use super::judge::{circumcircle, cross, distance, dot, minus};
use super::mesh::{Corners, Mesh, NONE, Side, edge};
use crate::base::error::Result;
use crate::base::memory::{make_room, push};

/// More tetrahedra than this are not replaced at once.
const LARGEST: usize = 1 << 20;

/// New tetrahedra have at least this share of the cube of their longest edge at a corner, six times.
const FLAT: f64 = 1e-6;

/// Where the point is.
#[derive(Debug, Default)]
pub struct Start {
    /// The tetrahedra that contain it: one, those beside a wall, or those around an edge.
    pub cells: Vec<u32>,
    /// The walls that contain it, from each side that has a tetrahedron.
    pub walls: Vec<Side>,
    /// The edge that contains it.
    pub edge: Option<[u32; 2]>,
}

/// What a point would be too close to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encroached {
    Segment(u32, [u32; 2]),
    Wall(Side),
}

/// The corner of a new tetrahedron opposite a face that has the point and an edge: the edge, the
/// number of the tetrahedron, the corner.
type Link = ([u32; 2], u32, usize);

/// A cavity and the buffers for it.
#[derive(Debug, Default)]
pub struct Cavity {
    pub cells: Vec<u32>,
    /// The faces around it, from its tetrahedra.
    pub outer: Vec<Side>,
    /// The walls that are replaced, from each side.
    open: Vec<Side>,
    /// The number of the cavity for tetrahedra in it; each round of exclusions has a different one.
    mark: Vec<u32>,
    number: u32,
    links: Vec<Link>,
    /// The edges of open walls, with the walls.
    rim: Vec<([u32; 2], u32)>,
    vertices: Vec<u32>,
    made: Vec<Made>,
    wrong: Vec<u32>,
}

/// A new tetrahedron before it has a slot.
#[derive(Debug, Clone, Copy)]
struct Made {
    corners: Corners,
    /// The face that it keeps: its corner, what lies behind it, and the wall there.
    kept: usize,
    behind: Option<Side>,
    across: [u32; 4],
    wall: [u32; 4],
    label: i32,
    size: f64,
}

impl Cavity {
    fn has(&self, t: u32) -> bool {
        self.mark[t as usize] == self.number
    }

    /// Whether a tetrahedron is in the cavity that was built last.
    pub fn contains(&self, t: u32) -> bool {
        self.cells.contains(&t)
    }

    /// Builds the cavity of a point; false if there is none that it sees completely.
    pub fn build(&mut self, mesh: &Mesh, p: Point3, start: &Start) -> Result<bool> {
        let places = mesh.corners.len();
        let missing = places.saturating_sub(self.mark.len());
        make_room(&mut self.mark, missing)?;
        self.mark.resize(self.mark.len() + missing, 0);
        // Well below the maximum, as the rounds below count as well.
        if self.number >= u32::MAX / 2 {
            self.mark.fill(0);
            self.number = 0;
        }
        let sees = |u: u32| {
            let [a, b, c, d] = mesh.places_of(mesh.corners[u as usize]);
            insphere(a, b, c, d, p) == Sign::Positive
        };
        if !self.flood(mesh, start, |_, u| sees(u))? {
            return Ok(false);
        }
        // Each round excludes tetrahedra, so this terminates.
        loop {
            self.open_walls(mesh, start)?;
            self.bound(mesh)?;
            self.find_wrong(mesh, p, start)?;
            if self.wrong.is_empty() {
                return Ok(true);
            }
            for i in 0..self.wrong.len() {
                let t = self.wrong[i];
                if start.cells.contains(&t) {
                    return Ok(false);
                }
                self.mark[t as usize] = 0;
            }
            // Some are no longer connected.
            let before = self.number;
            self.flood(mesh, start, |mark, _| mark == before)?;
        }
    }

    /// Collects the tetrahedra that are connected to the first ones without walls and are admitted,
    /// by their marks and numbers; false if there are too many.
    fn flood(
        &mut self,
        mesh: &Mesh,
        start: &Start,
        admits: impl Fn(u32, u32) -> bool,
    ) -> Result<bool> {
        self.number += 1;
        self.cells.clear();
        for &t in &start.cells {
            self.mark[t as usize] = self.number;
            push(&mut self.cells, t)?;
        }
        let mut next = 0;
        while let Some(&t) = self.cells.get(next) {
            next += 1;
            for k in 0..4 {
                let u = mesh.across[t as usize][k];
                if mesh.wall[t as usize][k] != NONE || u == NONE || self.has(u) {
                    continue;
                }
                if admits(self.mark[u as usize], u) {
                    self.mark[u as usize] = self.number;
                    push(&mut self.cells, u)?;
                }
            }
            if self.cells.len() > LARGEST {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Collects the walls to be replaced: those connected in a facet to the ones that contain the
    /// point, with the cavity on each side where there are tetrahedra.
    fn open_walls(&mut self, mesh: &Mesh, start: &Start) -> Result<()> {
        self.open.clear();
        for &side in &start.walls {
            push(&mut self.open, side)?;
        }
        let mut next = 0;
        while let Some(&side) = self.open.get(next) {
            next += 1;
            // Across the edges of the wall that are not segments, to its neighbors in the facet.
            let [a, b, c] = mesh.face(side);
            for [x, y] in [[a, b], [b, c], [c, a]] {
                if mesh.is_segment(x, y) {
                    continue;
                }
                let Some(other) = mesh.next_wall(side, [x, y]) else {
                    continue;
                };
                // Facets meet at segments, so this one is of the same.
                if self.open.contains(&other) || !self.has(other.0) {
                    continue;
                }
                let behind = mesh.behind(other);
                if behind.is_some_and(|b| !self.has(b.0)) {
                    continue;
                }
                push(&mut self.open, other)?;
                if let Some(behind) = behind {
                    push(&mut self.open, behind)?;
                }
            }
        }
        Ok(())
    }

    /// Collects the outer faces.
    fn bound(&mut self, mesh: &Mesh) -> Result<()> {
        self.outer.clear();
        for &t in &self.cells {
            for k in 0..4 {
                let u = mesh.across[t as usize][k];
                let wall = mesh.wall[t as usize][k] != NONE;
                let inner = if wall {
                    self.open.contains(&(t, k))
                } else {
                    u != NONE && self.has(u)
                };
                if !inner {
                    push(&mut self.outer, (t, k))?;
                }
            }
        }
        Ok(())
    }

    /// Collects tetrahedra that must not be replaced: the point does not see one of their outer
    /// faces well, or one of their vertices would be lost.
    fn find_wrong(&mut self, mesh: &Mesh, p: Point3, start: &Start) -> Result<()> {
        self.wrong.clear();
        self.vertices.clear();
        for &(t, k) in &self.outer {
            let face = mesh.face((t, k));
            let [a, b, c] = mesh.places_of(face);
            if orient3d(a, b, c, p) != Sign::Positive || is_flat([a, b, c], p) {
                push(&mut self.wrong, t)?;
            }
            for v in face {
                push(&mut self.vertices, v)?;
            }
        }
        if !self.wrong.is_empty() {
            return Ok(());
        }
        self.vertices.sort_unstable();
        self.vertices.dedup();
        for &t in &self.cells {
            for v in mesh.corners[t as usize] {
                if self.vertices.binary_search(&v).is_err() {
                    let has = |t: &&u32| mesh.corner(**t, v).is_some();
                    let mut others = self.cells.iter().filter(has);
                    let other = others.find(|t| !start.cells.contains(t));
                    return push(&mut self.wrong, other.copied().unwrap_or(t));
                }
            }
        }
        Ok(())
    }

    /// The smallest distance of the point to a vertex of the cavity.
    pub fn clearance(&self, mesh: &Mesh, p: Point3) -> f64 {
        let all = self.vertices.iter().map(|&v| mesh.points[v as usize]);
        all.map(|q| distance(p, q)).fold(f64::INFINITY, f64::min)
    }

    /// The smallest height of the point above an outer wall.
    pub fn height(&self, mesh: &Mesh, p: Point3) -> f64 {
        let walls = self.outer.iter().filter(|s| super::is_wall(mesh, s.0, s.1));
        let heights = walls.map(|&side| {
            let [a, b, c] = mesh.places_of(mesh.face(side));
            let normal = cross(minus(b, a), minus(c, a));
            dot(normal, minus(p, a)).abs() / dot(normal, normal).sqrt()
        });
        heights.fold(f64::INFINITY, f64::min)
    }

    /// The segment, or with `walls` the wall, of the outer faces whose diametral sphere contains the
    /// point, and most deeply.
    pub fn encroached(&self, mesh: &Mesh, p: Point3, walls: bool) -> Option<Encroached> {
        let mut best = (0.0, None);
        for &(t, k) in &self.outer {
            let [a, b, c] = mesh.face((t, k));
            for [x, y] in [[a, b], [b, c], [c, a]] {
                if !mesh.is_segment(x, y) {
                    continue;
                }
                let [s, e] = mesh.places_of([x, y]);
                // The cosine of the angle at the point: -1 on the segment.
                let (from, to) = (minus(s, p), minus(e, p));
                let cosine = dot(from, to) / (dot(from, from) * dot(to, to)).sqrt();
                if cosine < best.0 {
                    best = (cosine, Some(Encroached::Segment(t, edge(x, y))));
                }
            }
        }
        if best.1.is_some() || !walls {
            return best.1;
        }
        for &side in self.outer.iter().filter(|s| super::is_wall(mesh, s.0, s.1)) {
            let (center, radius) = circumcircle(mesh.places_of(mesh.face(side)));
            let from = minus(p, center);
            let depth = dot(from, from) / radius - 1.0;
            if depth < best.0 {
                best = (depth, Some(Encroached::Wall(side)));
            }
        }
        best.1
    }

    /// Replaces the tetrahedra of the cavity by those of the point; their numbers go to `made`.
    /// False, without a change, if walls or segments would be lost.
    pub fn insert(
        &mut self,
        mesh: &mut Mesh,
        p: Point3,
        start: &Start,
        made: &mut Vec<u32>,
    ) -> Result<bool> {
        let vertex = mesh.points.len() as u32;
        if !self.plan(mesh, vertex)? || !self.link(mesh, start)? {
            return Ok(false);
        }
        push(&mut mesh.points, p)?;
        if let Some([a, b]) = start.edge
            && mesh.is_segment(a, b)
        {
            insert(&mut mesh.segments, edge(a, vertex))?;
            insert(&mut mesh.segments, edge(vertex, b))?;
            mesh.segments.remove(&edge(a, b));
        }
        // Slots first: links are numbers among the new tetrahedra.
        for &t in &self.cells {
            mesh.corners[t as usize] = [NONE; 4];
        }
        made.clear();
        for i in 0..self.made.len() {
            let t = mesh.slot(self.cells.get(i).copied())?;
            push(made, t)?;
        }
        for &t in self.cells.iter().skip(self.made.len()) {
            push(&mut mesh.free, t)?;
        }
        for (new, &t) in self.made.iter().zip(&*made) {
            let at = t as usize;
            mesh.corners[at] = new.corners;
            mesh.wall[at] = new.wall;
            mesh.label[at] = new.label;
            mesh.size[at] = new.size;
            mesh.known[at] = false;
            mesh.across[at] = new
                .across
                .map(|i| made.get(i as usize).copied().unwrap_or(NONE));
            mesh.across[at][new.kept] = match new.behind {
                Some((u, k)) => {
                    mesh.across[u as usize][k] = t;
                    u
                }
                None => NONE,
            };
        }
        Ok(true)
    }

    /// The new tetrahedra, without links among them.
    fn plan(&mut self, mesh: &Mesh, vertex: u32) -> Result<bool> {
        self.made.clear();
        self.links.clear();
        for (i, &(t, k)) in (0..).zip(&self.outer) {
            // The cone from the vertex to a face of the cavity keeps the wall there.
            let mut corners = mesh.corners[t as usize];
            corners[k] = vertex;
            let mut wall = [NONE; 4];
            wall[k] = mesh.wall[t as usize][k];
            let behind = mesh.behind((t, k));
            if behind.is_some_and(|(u, _)| self.has(u)) {
                return Ok(false);
            }
            push(
                &mut self.made,
                Made {
                    corners,
                    kept: k,
                    behind,
                    across: [NONE; 4],
                    wall,
                    label: mesh.label[t as usize],
                    size: mesh.size[t as usize],
                },
            )?;
            for j in (0..4).filter(|&j| j != k) {
                // The face opposite corner j has the new vertex and the other two corners.
                let mut ends = (0..4).filter(|&x| x != j && x != k).map(|x| corners[x]);
                if let (Some(a), Some(b)) = (ends.next(), ends.next()) {
                    push(&mut self.links, (edge(a, b), i, j))?;
                }
            }
        }
        self.links.sort_unstable();
        Ok(true)
    }

    /// Links new tetrahedra by their common faces; those of the point and the rim are walls.
    fn link(&mut self, mesh: &Mesh, start: &Start) -> Result<bool> {
        if !self.rim(mesh, start)? {
            return Ok(false);
        }
        let mut used = 0;
        let mut rest = self.links.as_slice();
        while let Some((&(ends, i, j), others)) = rest.split_first() {
            // The face of the vertex and this edge is a wall if the edge is on the rim.
            let wall = match self.rim.binary_search_by(|r| r.0.cmp(&ends)) {
                Ok(found) => {
                    used += 1;
                    self.rim[found].1
                }
                Err(_) => NONE,
            };
            // Two new tetrahedra share it, or one if nothing is behind.
            let same = others.iter().take_while(|other| other.0 == ends).count();
            self.made[i as usize].wall[j] = wall;
            match same {
                // Nothing lies behind a wall of the boundary.
                0 if wall != NONE => {}
                1 => {
                    let (_, u, k) = others[0];
                    self.made[u as usize].wall[k] = wall;
                    self.made[i as usize].across[j] = u;
                    self.made[u as usize].across[k] = i;
                }
                _ => return Ok(false),
            }
            rest = &others[same..];
        }
        Ok(used == self.rim.len())
    }

    /// Collects the edges around the open walls; false if a segment among them would be lost.
    fn rim(&mut self, mesh: &Mesh, start: &Start) -> Result<bool> {
        self.rim.clear();
        for &side in &self.open {
            // Each wall from one side.
            if mesh.behind(side).is_some_and(|other| other < side) {
                continue;
            }
            let [a, b, c] = mesh.face(side);
            for [x, y] in [[a, b], [b, c], [c, a]] {
                if start.edge != Some(edge(x, y)) {
                    push(
                        &mut self.rim,
                        (edge(x, y), mesh.wall[side.0 as usize][side.1]),
                    )?;
                }
            }
        }
        self.rim.sort_unstable();
        let mut kept = 0;
        let mut at = 0;
        while at < self.rim.len() {
            let ends = self.rim[at].0;
            let same = self.rim[at..].iter().take_while(|r| r.0 == ends).count();
            match same {
                1 => {
                    self.rim[kept] = self.rim[at];
                    kept += 1;
                }
                // An edge between two open walls of a facet is removed.
                2 if !mesh.is_segment(ends[0], ends[1]) => {}
                _ => return Ok(false),
            }
            at += same;
        }
        self.rim.truncate(kept);
        Ok(true)
    }
}

/// Whether a face and a point are nearly in one plane: a tetrahedron between them would be as thin as
/// the rounding of points on facets.
fn is_flat([a, b, c]: [Point3; 3], p: Point3) -> bool {
    let (x, y, z) = (minus(b, a), minus(c, a), minus(p, a));
    let longest = [x, y, z].map(|e| dot(e, e)).into_iter().fold(0.0, f64::max);
    dot(cross(x, y), z).abs() < FLAT * longest * longest.sqrt()
}
