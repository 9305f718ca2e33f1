//! A triangulation with marked edges that grows: its points, its mesh, and a triangle of each vertex.
//! Marked edges stay; all others are Delaunay as far as the marked ones let them, ties by
//! coordinates, whenever no edit is under way.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use crate::delaunay2::walk::walk_within;
use crate::error::{Error, Result};
use crate::memory::{filled, make_room};
use crate::mesh2::{Code, Mesh2, Patch, next, prev, triangle};
use crate::watch::{IDLE, Watch};

/// Triangles, or segments, between two looks at the watch.
pub const LOT: u32 = 1 << 16;

/// Triangles that a walk to a new vertex meets before all triangles are searched, and for each of
/// them along the side of a square of all vertices some more: new vertices are near what they come
/// from, and a visibility walk may turn in circles where edges are marked.
const WALK: usize = 256;
const WALK_ACROSS: usize = 4;

/// The triangulation.
#[derive(Debug)]
pub struct Marked {
    /// The vertices, then NaN to the room of the mesh and once more for infinity.
    pub points: Vec<Point2>,
    /// The mesh, with room for more vertices.
    pub mesh: Mesh2,
    /// How many vertices there are.
    pub count: usize,
    /// For each vertex one of its corners.
    pub near: Vec<Code>,
    /// Edges that may have to be flipped, by a code of either side.
    pub stack: Vec<Code>,
}

/// The next corner of the same vertex, counter-clockwise.
#[inline]
pub fn turn(mesh: &Patch, corner: Code) -> Code {
    next(mesh.opposite(next(corner)))
}

impl Marked {
    /// From a mesh of all of its vertices and their points, which end with NaN.
    pub fn new(mut mesh: Mesh2, points: Vec<Point2>, watch: &Watch) -> Result<Self> {
        let count = mesh.vertices();
        let mut near = filled(count, 0)?;
        let used = 2 * count as u32 - 2;
        let patch = mesh.resume(used);
        for e in (0..used).flat_map(|t| 8 * t..8 * t + 3) {
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
            near,
            stack: Vec::new(),
        })
    }

    /// How many triangles there are, ghosts with them.
    #[inline]
    pub fn triangles(&self) -> u32 {
        2 * self.count as u32 - 2
    }

    /// The mesh for an edit.
    #[inline]
    pub fn patch(&mut self) -> Patch<'_> {
        let used = self.triangles();
        self.mesh.resume(used)
    }

    /// The point of a vertex.
    #[inline]
    pub fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    /// The room of the mesh shrinks to its vertices, for the way out. Returns one of the ghosts.
    pub fn close(&mut self, watch: &Watch) -> Result<Code> {
        let used = self.triangles();
        if self.mesh.vertices() != self.count {
            self.mesh.resize(self.count, used, watch)?;
        }
        let patch = self.mesh.resume(used);
        let mut corners = (0..used).flat_map(|t| 8 * t..8 * t + 3);
        corners
            .find(|&e| patch.vertex(e) == patch.infinite())
            .ok_or_else(|| Error::Internal("the mesh has no ghost".into()))
    }

    /// The vertex at `p`: one that is there, or a new one; and where that lies on a marked edge, the
    /// ends of the edge, both halves of which are marked now. The search starts at the edge `from`.
    pub fn vertex_at(&mut self, p: Point2, from: Code) -> Result<(u32, Option<[u32; 2]>)> {
        let home = self.find(p, triangle(from))?;
        let points = &self.points;
        let mesh = self.mesh.resume(2 * self.count as u32 - 2);
        let at = |v: u32| points[v as usize];
        if let Some(v) = mesh.corners(home).into_iter().find(|&v| at(v) == p) {
            return Ok((v, None));
        }
        let outside = mesh.corners(home).contains(&mesh.infinite());
        let on = (8 * home..8 * home + 3).find(|&e| {
            let [u, v] = [next(e), prev(e)].map(|c| at(mesh.vertex(c)));
            !outside && orient2d(u, v, p) == Sign::Zero
        });
        let parted = on.filter(|&e| mesh.is_marked(e));
        let parted = parted.map(|e| [next(e), prev(e)].map(|c| mesh.vertex(c)));
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
        for i in 0..self.stack.len() {
            self.touch(triangle(self.stack[i]));
        }
        self.legalise()?;
        Ok((v, parted))
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

    /// Room for one more vertex.
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

    /// The triangle whose closed area holds `p`, or a ghost whose hull edge has p strictly beyond.
    fn find(&mut self, p: Point2, from: u32) -> Result<u32> {
        let mesh = self.mesh.resume(2 * self.count as u32 - 2);
        let most = WALK + WALK_ACROSS * self.count.isqrt();
        if let Some((t, _)) = walk_within(&mesh, &self.points, from, p, most) {
            return Ok(t);
        }
        let at = |v: u32| self.points[v as usize];
        let holds = |t: u32| {
            (8 * t..8 * t + 3).all(|e| {
                let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
                match [mesh.vertex(e), u, v].contains(&mesh.infinite()) {
                    // Of a ghost the finite edge alone counts, and strictly.
                    true => {
                        mesh.vertex(e) != mesh.infinite()
                            || orient2d(at(u), at(v), p) == Sign::Positive
                    }
                    false => orient2d(at(u), at(v), p) != Sign::Negative,
                }
            })
        };
        let found = (0..2 * self.count as u32 - 2).find(|&t| holds(t));
        found.ok_or_else(|| Error::Internal(format!("no triangle holds {p:?}")))
    }

    /// Makes triangle `t` the one that each of its vertices is found by.
    #[inline]
    pub fn touch(&mut self, t: u32) {
        let corners = self.patch().corners(t);
        for (e, v) in (8 * t..).zip(corners) {
            if let Some(near) = self.near.get_mut(v as usize) {
                *near = e;
            }
        }
    }

    /// Flips what must be flipped, starting from the edges on the stack. Each flip lowers the lifted
    /// surface for good (see `delaunay2::lawson`; marked edges change nothing about that), so it
    /// ends.
    pub fn legalise(&mut self) -> Result<()> {
        self.legalise_with(|_, _| {})
    }

    /// The same, telling `flipped` the two triangles of each flip.
    pub fn legalise_with(&mut self, mut flipped: impl FnMut(u32, u32)) -> Result<()> {
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

    /// Whether the edge `e` must be flipped: it is not bound, and the circle of the triangle on one
    /// side holds the apex on the other; or it joins two ghosts one of whose apexes sees the
    /// other's hull edge.
    fn must_flip(&mut self, e: Code) -> Result<bool> {
        let mesh = self.mesh.resume(2 * self.count as u32 - 2);
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
        let turns = |a: u32, b: u32, c: u32| {
            let [a, b, c] = [a, b, c].map(|v| self.points[v as usize]);
            orient2d(a, b, c) == Sign::Positive
        };
        if p == inf || q == inf {
            return Ok(false);
        }
        if u == inf {
            return Ok(turns(q, v, p));
        }
        if v == inf {
            return Ok(turns(u, q, p));
        }
        let [a, b, c, d] = [u, v, p, q].map(|v| self.points[v as usize]);
        Ok(incircle_canonical(a, b, c, d) == Sign::Positive)
    }
}
