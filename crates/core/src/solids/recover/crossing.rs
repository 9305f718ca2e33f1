//! What crosses a face or a segment of the input, exactly.

use std::collections::BTreeSet;

use delone_predicates::Sign;

use super::mesh::{NONE, PAIRS, Ring, internal, pair};
use super::work::{Work, number};
use crate::base::error::{Error, Result};

impl Work<'_> {
    /// Whether an edge crosses the interior of a face.
    pub fn pierces(&self, u: u32, v: u32, [a, b, c]: [u32; 3]) -> Result<bool> {
        if [a, b, c].contains(&u) || [a, b, c].contains(&v) {
            return Ok(false);
        }
        let below = self.orient(a, b, c, u);
        if below.is_zero() || self.orient(a, b, c, v) != -below {
            return Ok(false);
        }
        let signs = [(a, b), (b, c), (c, a)].map(|(p, q)| number(self.orient(u, v, p, q)));
        let (least, most) = (signs.iter().min(), signs.iter().max());
        match (least, most) {
            (Some(1), Some(1)) | (Some(-1), Some(-1)) => Ok(true),
            (Some(0), Some(1)) | (Some(-1), Some(0)) | (Some(0), Some(0)) => Err(Error::Shape(
                "an edge or a vertex meets the rim of a face".into(),
            )),
            _ => Ok(false),
        }
    }

    /// Whether two vertices of the plane of a face are joined counterclockwise with a third.
    pub fn turn(&self, (aside, side): (u32, Sign), [p, q, r]: [u32; 3]) -> Sign {
        self.orient(p, q, r, aside) * side
    }

    /// The vertices of the rim of a face, in order.
    pub fn rim(&self, f: u32) -> Vec<u32> {
        let [a, b, c] = self.faces[f as usize];
        let sides = self.sides[f as usize];
        let mut rim = Vec::with_capacity(3);
        for (from, to, s) in [(a, b, sides[2]), (b, c, sides[0]), (c, a, sides[1])] {
            rim.push(from);
            if let Some(chain) = self.chains.get(&s) {
                // Chains lead from the smaller vertex to the larger one.
                if from < to {
                    rim.extend(chain);
                } else {
                    rim.extend(chain.iter().rev());
                }
            }
        }
        rim
    }

    /// The ring of an edge that is in the mesh.
    pub fn ring_of(&mut self, a: u32, b: u32) -> Result<Ring> {
        let t = self.mesh.with_edge(a, b);
        let t = t.ok_or_else(|| internal("an edge is missing"))?;
        let ring = self.mesh.ring(t, a, b);
        ring.ok_or_else(|| internal("an edge is on the far hull"))
    }

    /// The edges that cross the interior of a face whose rim is in the mesh.
    pub fn piercings(&mut self, f: u32) -> Result<BTreeSet<[u32; 2]>> {
        let face = self.faces[f as usize];
        let mut found = BTreeSet::new();
        let mut tested = BTreeSet::new();
        let mut cells = Vec::new();
        let rim = self.rim(f);
        for i in 0..rim.len() {
            cells.extend(self.ring_of(rim[i], rim[(i + 1) % rim.len()])?.tetrahedra);
        }
        // All tetrahedra that cross the face and touch its rim are here; the others share a crossing edge
        // with one that is found before.
        while let Some(t) = cells.pop() {
            self.pace.spend(1)?;
            let v = self.mesh.corners[t as usize];
            for [i, j, ..] in PAIRS {
                let edge = pair(v[i], v[j]);
                if tested.insert(edge) && self.pierces(edge[0], edge[1], face)? {
                    found.insert(edge);
                    let ring = self.mesh.ring(t, edge[0], edge[1]);
                    let ring = ring.ok_or_else(|| internal("a face meets the far hull"))?;
                    cells.extend(ring.tetrahedra);
                }
            }
        }
        Ok(found)
    }

    /// Whether a segment crosses the interior of a triangle.
    pub fn stabs(&self, [a, b]: [u32; 2], [p, q, r]: [u32; 3]) -> bool {
        if [p, q, r].contains(&a) || [p, q, r].contains(&b) {
            return false;
        }
        if self.mesh.points.are_apart([a, b], [p, q, r]) {
            return false;
        }
        let side = self.orient(p, q, r, a);
        if side.is_zero() || self.orient(p, q, r, b) != -side {
            return false;
        }
        let first = self.orient(a, b, p, q);
        !first.is_zero() && self.orient(a, b, q, r) == first && self.orient(a, b, r, p) == first
    }

    /// Whether a segment and an edge cross in the interior of both.
    pub fn cuts(&self, [a, b]: [u32; 2], [p, q]: [u32; 2]) -> bool {
        if p == a || p == b || q == a || q == b || !self.orient(a, b, p, q).is_zero() {
            return false;
        }
        // A vertex off their plane tells sides within it.
        let aside = (self.far..self.far + 4)
            .find(|&v| !self.orient(a, b, p, v).is_zero() || !self.orient(a, b, q, v).is_zero());
        let Some(v) = aside else {
            return false;
        };
        self.orient(a, b, p, v) * self.orient(a, b, q, v) == Sign::Negative
            && self.orient(p, q, a, v) * self.orient(p, q, b, v) == Sign::Negative
    }

    /// All faces and edges that a missing segment crosses: a tetrahedron and a corner for each face,
    /// a tetrahedron and its ends for each edge.
    #[expect(clippy::type_complexity, reason = "two lists")]
    pub fn crossed(&mut self, s: [u32; 2]) -> Result<(Vec<(u32, usize)>, Vec<(u32, [u32; 2])>)> {
        let (mut faces, mut edges) = (Vec::new(), Vec::new());
        let mut tested = BTreeSet::new();
        let mut seen = BTreeSet::new();
        let mut cells = match self.step(s[0], s[1])? {
            super::segments::Step::Face(t, _) | super::segments::Step::Edge(t, ..) => vec![t],
        };
        while let Some(t) = cells.pop() {
            self.pace.spend(1)?;
            if !seen.insert(t) {
                continue;
            }
            // Through each face that the segment crosses, on to the tetrahedron behind it.
            for k in 0..4 {
                let u = self.mesh.across[t as usize][k];
                if u != NONE && !seen.contains(&u) && self.stabs(s, self.mesh.face(t, k)) {
                    faces.push((t, k));
                    cells.push(u);
                }
            }
            // Around each edge that it crosses, all tetrahedra: it leaves through one of them.
            let v = self.mesh.corners[t as usize];
            for [i, j, ..] in PAIRS {
                let edge = pair(v[i], v[j]);
                if tested.insert(edge)
                    && self.cuts(s, edge)
                    && let Some(ring) = self.mesh.ring(t, edge[0], edge[1])
                {
                    edges.push((t, edge));
                    cells.extend(ring.tetrahedra);
                }
            }
        }
        Ok((faces, edges))
    }
}
