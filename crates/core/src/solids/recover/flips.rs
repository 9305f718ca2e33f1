//! Edges and faces by flips: an edge is removed, or two tetrahedra become three, where fewer
//! faces and edges cross what is missing.
//!
//! Each change lowers the number of crossings of one segment or face, so it ends. Parts that are
//! recovered do not change.

use delone_predicates::Sign;

use super::mesh::{Corners, Ring, ascending, pair};
use super::work::Work;
use crate::base::error::Result;

/// The longest ring that is tried.
const LONGEST: usize = 24;
/// The longest ring of edges that are removed to remove others.
const SHORT: usize = 9;
/// The most edges tried for one segment or face.
const TRIES: usize = 1000;

/// What is missing.
#[derive(Debug, Clone, Copy)]
pub enum Goal {
    /// A segment between two vertices.
    Segment([u32; 2]),
    /// A face.
    Face([u32; 3]),
    /// Fewer edges at a vertex.
    Vertex(u32),
    /// Fewer faces at an edge.
    Ring([u32; 2]),
}

/// The best triangulation of a part of a ring.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Crossings, or [`usize::MAX`] if there is none.
    cost: usize,
    /// The third vertex of its outermost triangle.
    apex: usize,
}

impl Work<'_> {
    /// Recovers segments by flips, and returns those that are still missing.
    pub fn flip_segments(&mut self, mut missing: Vec<u32>, depth: usize) -> Result<Vec<u32>> {
        loop {
            let before = missing.len();
            let mut rest = Vec::new();
            for &s in &missing {
                let [a, b] = self.segments[s as usize];
                if self.flip_segment([a, b], depth)? {
                    self.locked_edges.insert([a, b], s);
                    self.counts.flipped_edges += 1;
                } else {
                    rest.push(s);
                }
            }
            missing = rest;
            if missing.is_empty() || missing.len() == before {
                return Ok(missing);
            }
        }
    }

    /// Recovers one segment by flips, if that is possible.
    pub fn flip_segment(&mut self, s: [u32; 2], depth: usize) -> Result<bool> {
        let goal = Goal::Segment(s);
        let mut tries = TRIES;
        while self.mesh.with_edge(s[0], s[1]).is_none() {
            self.pace.spend(8)?;
            // What is in the way: edges are removed, faces are split.
            let (faces, edges) = self.crossed(s)?;
            let faces: Vec<[u32; 3]> = faces.iter().map(|&(t, k)| self.mesh.face(t, k)).collect();
            let mut around: Vec<[u32; 2]> = edges.iter().map(|&(_, e)| e).collect();
            let mut changed = self.remove_edges(&around, goal)?;
            for &face in &faces {
                changed |= self.split_face(face, goal)?;
            }
            // Then the edges of these faces: a face is removed with any of them.
            around.clear();
            for [u, v, w] in faces {
                around.extend([pair(u, v), pair(v, w), pair(w, u)]);
            }
            around.sort_unstable();
            around.dedup();
            changed |= self.remove_edges(&around, goal)?;
            // Last, remove each of these edges after flips around it, to a limited depth.
            if !changed && depth > 0 {
                around.extend(edges.iter().map(|&(_, e)| e));
                for &[p, q] in &around {
                    changed |= self.force([p, q], goal, (depth, 0), &mut tries)?;
                }
            }
            if !changed {
                // An abandoned attempt may have recovered the segment.
                return Ok(self.mesh.with_edge(s[0], s[1]).is_some());
            }
        }
        Ok(true)
    }

    /// Removes those edges whose removal lowers the crossings; true if there is one.
    fn remove_edges(&mut self, edges: &[[u32; 2]], goal: Goal) -> Result<bool> {
        let mut changed = false;
        for &[p, q] in edges {
            if let Some(t) = self.mesh.with_edge(p, q) {
                changed |= self.remove_edge(t, p, q, goal, 0)?;
            }
        }
        Ok(changed)
    }

    /// Recovers one face, whose edges are present, by flips, if that is possible.
    pub fn flip_face(&mut self, f: u32, depth: usize) -> Result<bool> {
        let face = self.faces[f as usize];
        let goal = Goal::Face(face);
        let mut tries = TRIES;
        while !self.mesh.has_face(face) {
            self.pace.spend(8)?;
            let piercings: Vec<[u32; 2]> = self.piercings(f)?.into_iter().collect();
            let mut changed = self.remove_edges(&piercings, goal)?;
            if !changed && depth > 0 {
                for &edge in &piercings {
                    changed |= self.force(edge, goal, (depth, 0), &mut tries)?;
                }
            }
            if !changed {
                return Ok(self.mesh.has_face(face));
            }
        }
        Ok(true)
    }

    /// Removes an edge of a vertex, so that it has one fewer, if that is possible.
    pub fn flip_off(&mut self, v: u32, depth: usize) -> Result<bool> {
        let star = self.mesh.star(v, usize::MAX);
        let mut link: Vec<u32> = star
            .iter()
            .flat_map(|&t| self.mesh.corners[t as usize])
            .collect();
        link.sort_unstable();
        link.dedup();
        let mut tries = TRIES;
        let mut changed = false;
        for w in link.into_iter().filter(|&w| w != v) {
            changed |= self.force([v, w], Goal::Vertex(v), (depth, 0), &mut tries)?;
        }
        Ok(changed)
    }

    /// Removes an edge from an end of another one to its ring, so that this has one face fewer, if
    /// that is possible.
    pub fn loosen(&mut self, edge: [u32; 2], tries: &mut usize) -> Result<bool> {
        let ring = self.ring_of(edge[0], edge[1])?;
        for v in ring.vertices {
            for end in edge {
                if self.force([end, v], Goal::Ring(edge), (1, 0), tries)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Removes an edge, if that leaves fewer crossings than the present number plus `slack`. Where
    /// its ring does not allow that, edges from its ends to the ring are removed first, `depth`
    /// times in turn.
    fn force(
        &mut self,
        [a, b]: [u32; 2],
        goal: Goal,
        (depth, slack): (usize, usize),
        tries: &mut usize,
    ) -> Result<bool> {
        if *tries == 0 || self.locked_edges.has(pair(a, b)) {
            return Ok(false);
        }
        *tries -= 1;
        let Some(t) = self.mesh.with_edge(a, b) else {
            return Ok(false);
        };
        if self.remove_edge(t, a, b, goal, slack)? {
            return Ok(true);
        }
        if depth == 0 {
            return Ok(false);
        }
        let Some(ring) = self.mesh.ring(t, a, b) else {
            return Ok(false);
        };
        if ring.vertices.len() > SHORT || self.ring_is_locked(&ring) {
            return Ok(false);
        }
        for &v in &ring.vertices {
            for end in [a, b] {
                if !self.force([end, v], goal, (depth - 1, 1), tries)? {
                    continue;
                }
                let Some(t) = self.mesh.with_edge(a, b) else {
                    return Ok(true);
                };
                if self.remove_edge(t, a, b, goal, slack)? {
                    return Ok(true);
                }
                break;
            }
        }
        Ok(false)
    }

    /// Crossings of an edge.
    fn edge_cost(&self, goal: Goal, p: u32, q: u32) -> usize {
        match goal {
            Goal::Segment(s) => usize::from(self.cuts(s, [p, q])),
            Goal::Face(f) => usize::from(self.pierces(p, q, f).unwrap_or(true)),
            Goal::Vertex(v) => usize::from(p == v || q == v),
            Goal::Ring(_) => 0,
        }
    }

    /// Crossings of a face.
    fn face_cost(&self, goal: Goal, face: [u32; 3]) -> usize {
        match goal {
            Goal::Segment(s) => usize::from(self.stabs(s, face)),
            Goal::Ring([a, b]) => usize::from(face.contains(&a) && face.contains(&b)),
            Goal::Face(_) | Goal::Vertex(_) => 0,
        }
    }

    /// Two tetrahedra at a face become three at an edge, if that lowers the crossings.
    fn split_face(&mut self, face: [u32; 3], goal: Goal) -> Result<bool> {
        let Some((t, k)) = self.mesh.side(face) else {
            return Ok(false);
        };
        let [u, v, w] = self.mesh.face(t, k);
        let a = self.mesh.corners[t as usize][k];
        let Some((below, b)) = self.mesh.apex(t, k) else {
            return Ok(false);
        };
        if self.locked_faces.has(ascending(face)) {
            return Ok(false);
        }
        let new = [[u, v, b, a], [v, w, b, a], [w, u, b, a]];
        let positive = new
            .iter()
            .all(|&t| self.mesh.points.positive([t[0], t[1], t[2], t[3]]));
        if !positive {
            return Ok(false);
        }
        let old = self.face_cost(goal, face);
        let cost: usize = [u, v, w]
            .iter()
            .map(|&x| self.face_cost(goal, [a, b, x]))
            .sum();
        if cost + self.edge_cost(goal, a, b) >= old {
            return Ok(false);
        }
        self.mesh.replace(&[t, below], &new)?;
        self.counts.flips += 1;
        Ok(true)
    }

    /// Removes an edge of a tetrahedron, if that leaves fewer crossings than now plus `slack`.
    fn remove_edge(&mut self, t: u32, a: u32, b: u32, goal: Goal, slack: usize) -> Result<bool> {
        let Some(ring) = self.mesh.ring(t, a, b) else {
            return Ok(false);
        };
        let longest = if slack == 0 { LONGEST } else { SHORT };
        if ring.vertices.len() > longest || self.ring_is_locked(&ring) {
            return Ok(false);
        }
        self.pace.spend(ring.vertices.len())?;
        let faces = ring
            .vertices
            .iter()
            .map(|&v| self.face_cost(goal, [a, b, v]));
        let old = faces.sum::<usize>() + self.edge_cost(goal, a, b);
        // No change has fewer crossings than none.
        if old + slack == 0 {
            return Ok(false);
        }
        let Some(new) = self.cheapest(&ring, goal, old + slack) else {
            return Ok(false);
        };
        self.mesh.replace(&ring.tetrahedra, &new)?;
        self.counts.flips += 1;
        Ok(true)
    }

    /// The triangulation of a ring with the fewest crossings, if these are fewer than `limit`.
    pub fn cheapest(&self, ring: &Ring, goal: Goal, limit: usize) -> Option<Vec<Corners>> {
        let [a, b] = ring.ends;
        let v = &ring.vertices;
        let n = v.len();
        let none = Part {
            cost: usize::MAX,
            apex: 0,
        };
        let mut best = vec![none; n * n];
        for i in 0..n - 1 {
            best[i * n + i + 1].cost = 0;
        }
        for width in 2..n {
            for i in 0..n - width {
                let j = i + width;
                for k in i + 1..j {
                    // The triangle i k j, with the best triangulations on both sides of it.
                    let (left, right) = (best[i * n + k].cost, best[k * n + j].cost);
                    if left == usize::MAX || right == usize::MAX {
                        continue;
                    }
                    let triangle = [v[i], v[k], v[j]];
                    let sides = left + right;
                    if sides >= limit.min(best[i * n + j].cost) || !self.fits(triangle, a, b) {
                        continue;
                    }
                    let cost = sides + self.face_cost(goal, triangle);
                    if cost < best[i * n + j].cost {
                        best[i * n + j] = Part { cost, apex: k };
                    }
                }
                // Each inner edge i j costs what it breaks, with its faces to both ends of the old edge.
                let whole = i == 0 && j == n - 1;
                if !whole && best[i * n + j].cost != usize::MAX {
                    best[i * n + j].cost += self.edge_cost(goal, v[i], v[j])
                        + self.face_cost(goal, [a, v[i], v[j]])
                        + self.face_cost(goal, [b, v[i], v[j]]);
                }
            }
        }
        if best[n - 1].cost >= limit {
            return None;
        }
        let mut new = Vec::with_capacity(2 * n);
        let mut open = vec![(0, n - 1)];
        while let Some((i, j)) = open.pop() {
            if j - i > 1 {
                let k = best[i * n + j].apex;
                new.push([v[i], v[k], v[j], b]);
                new.push([v[i], v[j], v[k], a]);
                open.extend([(i, k), (k, j)]);
            }
        }
        Some(new)
    }

    /// Whether a triangle of a ring has both ends strictly on its sides.
    fn fits(&self, [u, v, w]: [u32; 3], a: u32, b: u32) -> bool {
        self.orient(u, v, w, b) == Sign::Positive && self.orient(u, w, v, a) == Sign::Positive
    }
}
