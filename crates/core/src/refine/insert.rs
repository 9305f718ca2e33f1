//! Inserts a vertex in the domain: empties its cavity, bounded by marked edges, and fills it with a
//! star.
//!
//! As in `delaunay::plane::cavity`; labels and limits on areas are inherited.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use crate::constrained::marked::Marked;
use crate::mesh::plane::{Code, half_edge, half_edges, next, prev, triangle};

/// The most triangles that a walk visits, because new vertices are close.
const WALK: usize = 4096;

/// The end of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// In the triangle that contains the point.
    Home(u32),
    /// At a marked edge that hides the point; its code on the side of the walk.
    Blocked(Code),
    /// Undecided: the walk was too long, or the point is a vertex.
    Lost,
}

/// A cavity, reused from insertion to insertion.
#[derive(Debug, Default)]
pub struct Cavity {
    /// Its triangles.
    pub triangles: Vec<u32>,
    /// Its boundary edges, counterclockwise, as codes of its own triangles.
    pub rim: Vec<Code>,
    stack: Vec<Code>,
    sides: Vec<Side>,
}

/// An edge of the cavity's boundary.
#[derive(Debug, Clone, Copy)]
struct Side {
    ends: [u32; 2],
    across: Code,
    marked: bool,
    cap: f64,
}

/// Walks from triangle `from` toward `p`, across edges that are not marked.
pub fn walk(marked: &mut Marked, from: u32, p: Point2) -> Walk {
    let triangles = marked.triangles();
    let mesh = marked.mesh.resume(triangles);
    let points = &marked.points;
    let mut t = from;
    let mut came = u32::MAX;
    for _ in 0..WALK {
        let beyond = half_edges(t).filter(|&e| e != came).find(|&e| {
            let [u, v] = [next(e), prev(e)].map(|c| points[mesh.vertex(c) as usize]);
            orient2d(u, v, p) == Sign::Negative
        });
        let Some(e) = beyond else {
            let is_vertex = mesh.corners(t).iter().any(|&v| points[v as usize] == p);
            return if is_vertex { Walk::Lost } else { Walk::Home(t) };
        };
        if mesh.is_marked(e) {
            return Walk::Blocked(e);
        }
        came = mesh.opposite(e);
        t = triangle(came);
    }
    Walk::Lost
}

impl Cavity {
    /// Finds the cavity of `p`, which triangle `home` contains. If it is not star-shaped, p lies on
    /// a marked edge, or one hides a part of the cavity from it; that edge is returned.
    pub fn find(&mut self, marked: &mut Marked, home: u32, p: Point2) -> Option<Code> {
        let triangles = marked.triangles();
        let mesh = marked.mesh.resume(triangles);
        let at = |v: u32| marked.points[v as usize];
        self.triangles.clear();
        self.rim.clear();
        self.triangles.push(home);
        self.stack.clear();
        self.stack
            .extend([half_edge(home, 2), half_edge(home, 1), half_edge(home, 0)]);
        // A depth-first search that visits the right child first finds the edges counterclockwise.
        // Each triangle is visited once, because a cavity without vertices inside is a tree of
        // triangles.
        while let Some(e) = self.stack.pop() {
            let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
            let o = mesh.opposite(e);
            let w = mesh.vertex(o);
            let open = !mesh.is_marked(e) && w != mesh.infinite();
            if open && incircle_canonical(at(v), at(u), at(w), p) == Sign::Positive {
                self.triangles.push(triangle(o));
                self.stack.extend([prev(o), next(o)]);
            } else if orient2d(at(u), at(v), p) == Sign::Positive {
                self.rim.push(e);
            } else {
                return Some(e);
            }
        }
        None
    }

    /// Fills the cavity with the star of a new vertex at `p`; there must be room for it. `caps` has
    /// the limit on twice the area of each triangle; a new triangle inherits that of the old one at
    /// its boundary edge. Inheriting the smallest limit would spread it from cavity to cavity.
    pub fn fill(&mut self, marked: &mut Marked, p: Point2, caps: &mut Vec<f64>) -> u32 {
        let v = marked.count as u32;
        marked.points[v as usize] = p;
        marked.count += 1;
        let triangles = marked.triangles();
        let mut mesh = marked.mesh.resume(triangles);
        let label = mesh.label(self.triangles[0]);
        self.sides.clear();
        self.sides.extend(self.rim.iter().map(|&e| Side {
            ends: [mesh.vertex(next(e)), mesh.vertex(prev(e))],
            across: mesh.opposite(e),
            marked: mesh.is_marked(e),
            cap: caps[triangle(e) as usize],
        }));
        self.triangles.extend([triangles - 2, triangles - 1]);
        caps.resize(triangles as usize, f64::INFINITY);
        for (&t, side) in self.triangles.iter().zip(&self.sides) {
            mesh.set(t, [v, side.ends[0], side.ends[1]]);
            mesh.set_marks(t, u32::from(side.marked));
            mesh.set_label(t, label);
            mesh.link(half_edge(t, 0), side.across);
            caps[t as usize] = side.cap;
        }
        let last = self.triangles[self.triangles.len() - 1];
        let before = std::iter::once(&last).chain(&self.triangles);
        for (&s, &t) in before.zip(&self.triangles) {
            mesh.link(half_edge(s, 1), half_edge(t, 2));
        }
        v
    }
}
