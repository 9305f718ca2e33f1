//! If faces in one plane are missing, recovers other triangles first: those of the plane's
//! constrained Delaunay triangulation.
//!
//! Edges of Delaunay triangulations in 3-D are also Delaunay in each plane, so fewer of these
//! triangles must be recovered than of others. Those of the input are restored later (`swap`).
//!
//! Edges are flipped until none is wrong (C. L. Lawson, "Software for C1 surface interpolation", 1977).
//! This terminates because each flip lowers the lifted surface; where four vertices are on a
//! circle, the edge at the smallest vertex is correct, as if that vertex were lifted a little less.

use std::collections::HashMap;

use delone_predicates::{Point3, Sign, insphere, orient3d};

use super::mesh::{NONE, ascending, pair};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::{copied, filled, push, room_for_one};
use crate::base::sets::Sets;

/// Triangles that fill a part of a plane, twice.
#[derive(Debug)]
pub struct Part {
    /// Those that are recovered first.
    pub first: Vec<[u32; 3]>,
    /// Those of the input.
    pub last: Vec<[u32; 3]>,
}

/// Faces at an edge; [`NONE`] where there is none.
type Two = [u32; 2];

impl Work<'_> {
    /// Parts of planes where segments or faces are missing, and all faces with other triangles there.
    pub fn planes(
        &mut self,
        segments: &[u32],
        faces: &[u32],
    ) -> Result<(Vec<[u32; 3]>, Vec<Part>)> {
        let soft = self.soft()?;
        let joined = (0..).zip(&soft).filter(|(_, two)| two[0] != NONE);
        let mut sets = Sets::of(self.faces.len())?;
        for (_, &[t, u]) in joined {
            sets.join(t, u);
        }
        let mut lacks = filled(self.faces.len(), false)?;
        let at_segments = segments.iter().map(|&s| soft[s as usize][0]);
        for f in at_segments
            .filter(|&f| f != NONE)
            .chain(faces.iter().copied())
        {
            lacks[sets.root(f) as usize] = true;
        }
        let mut edges = HashMap::new();
        let mut open = Vec::new();
        for (&edge, &two) in self.segments.iter().zip(&soft) {
            if two[0] != NONE && lacks[sets.root(two[0]) as usize] {
                room_for_one(&mut edges)?;
                edges.insert(edge, two);
                push(&mut open, edge)?;
            }
        }
        let first = self.delaunay_in_planes(edges, open)?;
        let mut place = filled(self.faces.len(), NONE)?;
        let mut parts: Vec<Part> = Vec::new();
        for (f, (&new, &old)) in (0..).zip(first.iter().zip(&self.faces)) {
            let group = sets.root(f) as usize;
            if !lacks[group] {
                continue;
            }
            if place[group] == NONE {
                place[group] = parts.len() as u32;
                let part = Part {
                    first: Vec::new(),
                    last: Vec::new(),
                };
                push(&mut parts, part)?;
            }
            let part = &mut parts[place[group] as usize];
            push(&mut part.first, new)?;
            push(&mut part.last, old)?;
        }
        parts.retain(|part| part.first != part.last);
        Ok((first, parts))
    }

    /// The faces of each segment that has exactly two, in one plane and on both sides of it.
    fn soft(&mut self) -> Result<Vec<Two>> {
        let mut found = filled(self.segments.len(), [NONE; 2])?;
        let mut count = filled(self.segments.len(), 0_u8)?;
        for (f, sides) in (0..).zip(&self.sides) {
            for &s in sides {
                let n = &mut count[s as usize];
                if let Some(slot) = found[s as usize].get_mut(usize::from(*n)) {
                    *slot = f;
                }
                *n = n.saturating_add(1);
            }
        }
        for s in 0..found.len() {
            self.pace.spend(1)?;
            if count[s] != 2 || !self.is_flat(self.segments[s], found[s])? {
                found[s] = [NONE; 2];
            }
        }
        Ok(found)
    }

    /// Whether two faces are in one plane and on both sides of their edge.
    fn is_flat(&self, [a, b]: [u32; 2], [t, u]: Two) -> Result<bool> {
        let c = apex(self.faces[t as usize], [a, b]);
        let d = apex(self.faces[u as usize], [a, b]);
        if !self.orient(a, b, c, d).is_zero() {
            return Ok(false);
        }
        let aside = self.aside(self.faces[t as usize])?;
        Ok(self.turn(aside, [a, b, c]) == -self.turn(aside, [a, b, d]))
    }

    /// All faces after flips of those edges in planes that are wrong.
    fn delaunay_in_planes(
        &mut self,
        mut edges: HashMap<[u32; 2], Two>,
        mut open: Vec<[u32; 2]>,
    ) -> Result<Vec<[u32; 3]>> {
        let mut faces = copied(&self.faces)?;
        while let Some([a, b]) = open.pop() {
            self.pace.spend(1)?;
            let Some(&[t, u]) = edges.get(&[a, b]) else {
                continue;
            };
            // The edge a b between c and d is flipped if it is wrong.
            let c = apex(faces[t as usize], [a, b]);
            let d = apex(faces[u as usize], [a, b]);
            if !self.is_wrong([a, b], c, d) {
                continue;
            }
            faces[t as usize] = ascending([a, c, d]);
            faces[u as usize] = ascending([b, c, d]);
            edges.remove(&[a, b]);
            edges.insert(pair(c, d), [t, u]);
            // Two of the outer edges change their faces; all four may be wrong now.
            for (edge, from, to) in [(pair(a, d), u, t), (pair(b, c), t, u)] {
                if let Some(two) = edges.get_mut(&edge) {
                    *two = two.map(|f| if f == from { to } else { f });
                }
            }
            open.extend([pair(a, c), pair(a, d), pair(b, c), pair(b, d)]);
        }
        Ok(faces)
    }

    /// Whether the edge between c and d belongs in their plane, not that between a and b.
    fn is_wrong(&self, [a, b]: [u32; 2], c: u32, d: u32) -> bool {
        let [p, q, r, s] = [a, b, c, d].map(|v| self.mesh.points.near(v));
        let beside = beside(p, q, r).unwrap_or_else(|| {
            let far = (self.far..self.far + 4).find(|&v| !self.orient(a, b, c, v).is_zero());
            self.mesh.points.near(far.unwrap_or(self.far))
        });
        // The sphere through a point beside the plane meets it in the circle.
        match insphere(p, q, r, beside, s) * orient3d(p, q, r, beside) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => c.min(d) < a.min(b),
        }
    }
}

/// A point beside the plane of a triangle, about as far as this is large.
fn beside(a: Point3, b: Point3, c: Point3) -> Option<Point3> {
    let size = (0..3).fold(0.0_f64, |m, k| {
        m.max((b[k] - a[k]).abs()).max((c[k] - a[k]).abs())
    });
    (0..3).find_map(|k| {
        let mut p = a;
        // Toward zero, where there is no overflow.
        p[k] -= size.copysign(a[k]);
        let finite = p[k].is_finite();
        (finite && !orient3d(a, b, c, p).is_zero()).then_some(p)
    })
}

/// The vertex of a face that is not on an edge of it.
fn apex(face: [u32; 3], edge: [u32; 2]) -> u32 {
    let other = face.into_iter().find(|v| !edge.contains(v));
    other.unwrap_or(NONE)
}
