//! An incremental constrained Delaunay triangulation: points, mesh with marked edges, one corner
//! per vertex; of points in the plane, or of directions (see `sites`).
//!
//! Marked edges are constrained. Between edits all others are constrained Delaunay, with ties
//! broken by coordinates.

use delone_predicates::{Point2, Sign, orient2d};

use super::sites::Sites;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room};
use crate::base::watch::{IDLE, Watch};
use crate::delaunay::plane::walk::walk_within;
use crate::mesh::plane::{Code, Mesh2, Patch, half_edge, half_edges, next, prev, triangle};

/// Triangles, or segments, between two checks for interruption.
pub const LOT: u32 = 1 << 16;

/// Triangles that a walk to a new vertex may visit before all triangles are searched, and how many
/// more for each vertex along the side of a square that holds all vertices. New vertices are near
/// the elements that they come from, and a visibility walk may cycle around marked edges.
const WALK: usize = 256;
const WALK_ACROSS: usize = 4;

/// A constrained Delaunay triangulation; in the plane it can grow.
#[derive(Debug)]
pub struct Marked<S = Vec<Point2>> {
    /// The vertices, then NaN up to the capacity of the mesh, plus one NaN for infinity.
    pub points: S,
    /// The mesh, with capacity for more vertices.
    pub mesh: Mesh2,
    /// The number of vertices.
    pub count: usize,
    /// How many records are fewer than in a mesh with a hull: none in the plane.
    lack: u32,
    /// One corner of each vertex.
    pub near: Vec<Code>,
    /// Edges that may have to be flipped, each as a code of either side.
    pub stack: Vec<Code>,
}

/// The next corner of the same vertex, counterclockwise.
#[inline]
pub fn turn(mesh: &Patch, corner: Code) -> Code {
    next(mesh.opposite(next(corner)))
}

impl<S: Sites> Marked<S> {
    /// Builds it from a mesh of all of its vertices and their points, which end with NaN.
    pub fn new(mesh: Mesh2, points: S, watch: &Watch) -> Result<Self> {
        let used = 2 * mesh.vertices() as u32 - 2;
        Self::with_records(mesh, points, used, watch)
    }

    /// The same for a mesh that may lack vertices, or a hull, and has this many records.
    pub fn with_records(mut mesh: Mesh2, points: S, used: u32, watch: &Watch) -> Result<Self> {
        let count = mesh.vertices();
        let mut near = filled(count, 0)?;
        let patch = mesh.resume(used);
        for e in (0..used).flat_map(half_edges) {
            if e.is_multiple_of(8 * LOT) {
                watch.check()?;
            }
            if let Some(near) = near.get_mut(patch.vertex(e) as usize) {
                *near = e;
            }
        }
        Ok(Self {
            points,
            mesh,
            count,
            lack: 2 * count as u32 - 2 - used,
            near,
            stack: Vec::new(),
        })
    }

    /// The number of triangles, ghosts included.
    #[inline]
    pub fn triangles(&self) -> u32 {
        2 * self.count as u32 - 2 - self.lack
    }

    /// The mesh for an edit.
    #[inline]
    pub fn patch(&mut self) -> Patch<'_> {
        let used = self.triangles();
        self.mesh.resume(used)
    }

    /// The edge from `u` to `v`, in the triangle on its left.
    pub fn edge(&mut self, u: u32, v: u32) -> Result<Code> {
        let start = self.near[u as usize];
        let mesh = self.patch();
        let mut corner = start;
        while mesh.vertex(next(corner)) != v {
            corner = turn(&mesh, corner);
            if corner == start {
                return Err(Error::Internal(format!("no edge joins {u} {v}")));
            }
        }
        Ok(prev(corner))
    }

    /// Records `t` as the triangle by which each of its vertices is found.
    #[inline]
    pub fn touch(&mut self, t: u32) {
        let corners = self.patch().corners(t);
        for (e, v) in (half_edge(t, 0)..).zip(corners) {
            if let Some(near) = self.near.get_mut(v as usize) {
                *near = e;
            }
        }
    }

    /// Legalizes: flips edges, starting from those on the stack, until all are legal. Terminates
    /// because each flip lowers the lifted surface (see `delaunay::plane::lawson`; marked edges
    /// do not change that).
    pub fn legalize(&mut self) -> Result<()> {
        self.legalize_with(|_, _| {})
    }

    /// The same; calls `flipped` with the two triangles of each flip.
    pub fn legalize_with(&mut self, mut flipped: impl FnMut(u32, u32)) -> Result<()> {
        while let Some(e) = self.stack.pop() {
            if self.must_flip(e)? {
                let mut mesh = self.patch();
                let other = mesh.flip_marked(e);
                self.stack.extend([e, prev(e), other, next(other)]);
                self.touch(triangle(e));
                self.touch(triangle(other));
                flipped(triangle(e), triangle(other));
            }
        }
        Ok(())
    }

    /// Whether the edge `e` must be flipped: it is not marked, and the circumcircle of the triangle
    /// on one side contains the apex on the other; or it joins two ghosts, one of whose apexes sees
    /// the other's hull edge.
    fn must_flip(&mut self, e: Code) -> Result<bool> {
        let used = self.triangles();
        let mesh = self.mesh.resume(used);
        let o = mesh.opposite(e);
        if mesh.is_bound(e) || mesh.is_bound(o) {
            return Ok(false);
        }
        //        p
        //      /   \
        //     u --- v
        //      \   /
        //        q
        let inf = mesh.infinite();
        let [p, q, u, v] = [e, o, next(e), prev(e)].map(|c| mesh.vertex(c));
        let turns = |a: u32, b: u32, c: u32| self.points.orient([a, b, c]) == Sign::Positive;
        if p == inf || q == inf {
            return Ok(false);
        }
        if u == inf {
            return Ok(turns(q, v, p));
        }
        if v == inf {
            return Ok(turns(u, q, p));
        }
        Ok(self.points.in_circle([u, v, p, q]))
    }
}

impl Marked {
    /// The point of a vertex.
    #[inline]
    pub fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    /// Shrinks the capacity of the mesh to its vertices before export. Returns one of the ghosts.
    pub fn close(&mut self, watch: &Watch) -> Result<Code> {
        let used = self.triangles();
        if self.mesh.vertices() != self.count {
            self.mesh.resize(self.count, used, watch)?;
        }
        let patch = self.mesh.resume(used);
        let mut corners = (0..used).flat_map(half_edges);
        corners
            .find(|&e| patch.vertex(e) == patch.infinite())
            .ok_or_else(|| Error::Internal("the mesh has no ghost".into()))
    }

    /// The vertex at `p`, existing or new. If a new one lies on a marked edge, also the ends of
    /// that edge, both halves of which are then marked. The search starts at the edge `from`.
    pub fn vertex_at(&mut self, p: Point2, from: Code) -> Result<(u32, Option<[u32; 2]>)> {
        let home = self.find(p, triangle(from))?;
        let points = &self.points;
        let mesh = self.mesh.resume(2 * self.count as u32 - 2);
        let at = |v: u32| points[v as usize];
        if let Some(v) = mesh.corners(home).into_iter().find(|&v| at(v) == p) {
            return Ok((v, None));
        }
        let outside = mesh.corners(home).contains(&mesh.infinite());
        let on = half_edges(home).find(|&e| {
            let [u, v] = [next(e), prev(e)].map(|c| at(mesh.vertex(c)));
            !outside && orient2d(u, v, p) == Sign::Zero
        });
        let parted = on.filter(|&e| mesh.is_marked(e));
        let parted = parted.map(|e| [next(e), prev(e)].map(|c| mesh.vertex(c)));
        let v = self.split_at(p, home, on)?;
        Ok((v, parted))
    }

    /// A new vertex at `p` in triangle `home`, or on its edge `on`.
    pub fn split_at(&mut self, p: Point2, home: u32, on: Option<Code>) -> Result<u32> {
        let v = self.begin_at(p, home, on)?;
        for i in 0..self.stack.len() {
            self.touch(triangle(self.stack[i]));
        }
        self.legalize()?;
        Ok(v)
    }

    /// The same, faster, and returns a corner of the new vertex; `near` is not kept, so that nothing may
    /// follow that needs it. Only edges opposite the vertex can be illegal.
    pub fn star_at(&mut self, p: Point2, home: u32, on: Option<Code>) -> Result<Code> {
        self.begin_at(p, home, on)?;
        let corner = self.stack[0];
        while let Some(e) = self.stack.pop() {
            if self.must_flip(e)? {
                let other = self.patch().flip_marked(e);
                self.stack.extend([e, other]);
            }
        }
        Ok(corner)
    }

    /// A new vertex whose opposite edges, on the stack, may be illegal.
    fn begin_at(&mut self, p: Point2, home: u32, on: Option<Code>) -> Result<u32> {
        self.grow()?;
        let v = self.count as u32;
        self.points[v as usize] = p;
        let mut mesh = self.mesh.resume(2 * self.count as u32 - 2);
        self.stack.clear();
        match on {
            None => self.stack.extend(mesh.split_marked_triangle(home, v)),
            Some(e) => self.stack.extend(mesh.split_marked_edge(e, v)),
        }
        self.count += 1;
        self.near.push(0);
        Ok(v)
    }

    /// Makes room for one more vertex.
    pub fn grow(&mut self) -> Result<()> {
        let room = self.mesh.vertices();
        if self.count < room {
            return Ok(());
        }
        let used = self.triangles();
        let more = room + room / 2 + 1024;
        self.mesh.resize(more, used, &IDLE)?;
        let rest = more + 1 - self.points.len();
        make_room(&mut self.points, rest)?;
        self.points.resize(more + 1, [f64::NAN; 2]);
        Ok(())
    }

    /// The triangle whose closed area contains `p`, or a ghost whose hull edge has p strictly
    /// outside.
    pub fn find(&mut self, p: Point2, from: u32) -> Result<u32> {
        let mesh = self.mesh.resume(2 * self.count as u32 - 2);
        let most = WALK + WALK_ACROSS * self.count.isqrt();
        if let Some((t, _)) = walk_within(&mesh, &self.points, from, p, most) {
            return Ok(t);
        }
        let at = |v: u32| self.points[v as usize];
        let holds = |t: u32| {
            half_edges(t).all(|e| {
                let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
                match [mesh.vertex(e), u, v].contains(&mesh.infinite()) {
                    // For a ghost only the finite edge counts, and strictly.
                    true => {
                        mesh.vertex(e) != mesh.infinite()
                            || orient2d(at(u), at(v), p) == Sign::Positive
                    }
                    false => orient2d(at(u), at(v), p) != Sign::Negative,
                }
            })
        };
        let found = (0..2 * self.count as u32 - 2).find(|&t| holds(t));
        found.ok_or_else(|| Error::Internal(format!("no triangle contains {p:?}")))
    }
}
