//! Faces of the input in planes, by flips in these from the triangles that were recovered first.
//!
//! A flip in a plane replaces an edge between two faces by the other diagonal of both. In the mesh,
//! the tetrahedra around that edge are replaced on each side of the plane: by those on a triangulation
//! of the half of its ring, or by the fan of a vertex nearby, with what hides faces from that vertex;
//! if there is neither, by the fan of a new point. That always exists: the inside
//! of the edge sees all other faces of its ring, so points next to it do, on each side of the plane.
//!
//! # Why it ends
//!
//! An edge of the input crosses only edges that are not of the input. If a flip of one of these
//! gives an edge that does not cross it, one crossing fewer is left. Otherwise let v be the vertex
//! of the crossing edges that is farthest on its side. The vertices on the other side to which v is
//! joined form a chain whose ends are higher, so at one of them the two triangles of v are convex:
//! this flip leaves v one edge fewer, and when only one is left, its flip removes a crossing.

use std::collections::{HashMap, HashSet};

use delone_predicates::Sign;

use super::coordinates::{Wide, cross};
use super::flips::Goal;
use super::mesh::{Corners, NONE, Ring, ascending, internal, pair};
use super::planes::Part;
use super::work::{Origin, Work};
use crate::base::error::Result;

/// The longest half of a ring that is triangulated.
const LONGEST: usize = 40;

/// The most tetrahedra that are replaced on one side of a plane.
const LARGEST: usize = 200;

/// How far vertices are from a ring that are joined to its faces.
const ROUNDS: usize = 2;

/// The most edges tried to shorten rings, for one edge of the input.
const TRIES: usize = 200;

/// The triangles of a part of a plane.
struct Sheet {
    /// A vertex beside the plane, and on which side.
    aside: (u32, Sign),
    /// The third vertices of the triangles at each edge; [`NONE`] where there is none.
    apexes: HashMap<[u32; 2], [u32; 2]>,
    /// The edges opposite each vertex.
    around: HashMap<u32, Vec<[u32; 2]>>,
}

impl Sheet {
    /// Triangles of a plane.
    fn new(aside: (u32, Sign), faces: &[[u32; 3]]) -> Self {
        let mut sheet = Self {
            aside,
            apexes: HashMap::new(),
            around: HashMap::new(),
        };
        for &face in faces {
            sheet.insert(face);
        }
        sheet
    }

    /// Adds a triangle.
    fn insert(&mut self, [a, b, c]: [u32; 3]) {
        for (v, edge) in [(a, pair(b, c)), (b, pair(a, c)), (c, pair(a, b))] {
            self.around.entry(v).or_default().push(edge);
            let two = self.apexes.entry(edge).or_insert([NONE; 2]);
            two[usize::from(two[0] != NONE)] = v;
        }
    }

    /// Removes a triangle.
    fn remove(&mut self, [a, b, c]: [u32; 3]) {
        for (v, edge) in [(a, pair(b, c)), (b, pair(a, c)), (c, pair(a, b))] {
            if let Some(edges) = self.around.get_mut(&v) {
                edges.retain(|e| *e != edge);
            }
            if let Some(two) = self.apexes.get_mut(&edge) {
                let other = if two[0] == v { two[1] } else { two[0] };
                *two = [other, NONE];
                if other == NONE {
                    self.apexes.remove(&edge);
                }
            }
        }
    }

    /// The third vertices at an edge between two triangles.
    fn both(&self, edge: [u32; 2]) -> Option<[u32; 2]> {
        self.apexes.get(&edge).copied().filter(|two| two[1] != NONE)
    }
}

/// An edge between two triangles of a sheet that crosses an edge of the input.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    /// The vertex on the left.
    left: u32,
    /// The vertex on the right.
    right: u32,
}

impl Work<'_> {
    /// Brings the faces of the input back in parts of planes.
    pub fn swap_back(&mut self, parts: &[Part]) -> Result<()> {
        for part in parts {
            let Some(&face) = part.first.first() else {
                continue;
            };
            let mut sheet = Sheet::new(self.aside(face)?, &part.first);
            let mut missing = Vec::new();
            let mut seen = HashSet::new();
            for &[a, b, c] in &part.last {
                for edge in [[a, b], [a, c], [b, c]] {
                    if !sheet.apexes.contains_key(&edge) && seen.insert(edge) {
                        missing.push((self.crossings(&sheet, edge)?.len(), edge));
                    }
                }
            }
            missing.sort_unstable();
            let missing = missing.into_iter().map(|(_, edge)| edge).collect();
            self.swap_in(&mut sheet, missing)?;
        }
        Ok(())
    }

    /// Brings edges back in one part: without points where that is possible, then the others.
    fn swap_in(&mut self, sheet: &mut Sheet, missing: Vec<[u32; 2]>) -> Result<()> {
        let mut rest = Vec::new();
        for edge in missing {
            if !self.swap_one(sheet, edge, false)? {
                rest.push(edge);
            }
        }
        for edge in rest {
            if !self.swap_one(sheet, edge, true)? {
                return Err(internal("an edge of a plane has no flip"));
            }
        }
        Ok(())
    }

    /// Brings an edge back. If not `points`, that may not be possible.
    fn swap_one(&mut self, sheet: &mut Sheet, edge: [u32; 2], points: bool) -> Result<bool> {
        let mut tries = TRIES;
        while !sheet.apexes.contains_key(&edge) {
            self.pace.spend(8)?;
            let crossings = self.crossings(sheet, edge)?;
            // Flip edges that leave fewer crossings, if there are such.
            let [fewer, others] = self.flippable(sheet, edge, &crossings)?;
            let candidates = if fewer.is_empty() { &others } else { &fewer };
            let mut changed = false;
            for &e in candidates {
                changed = changed || self.swap_edge(sheet, e, false)?;
            }
            // Otherwise make the tetrahedra around one of them fewer, until it flips.
            for &e in candidates {
                while !changed && self.loosen(e, &mut tries)? {
                    changed = self.swap_edge(sheet, e, false)?;
                }
            }
            // As a last resort, points may be added.
            if let (false, true, Some(&e)) = (changed, points, candidates.first()) {
                changed = self.swap_edge(sheet, e, true)?;
            }
            if !changed {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The edges of a sheet that a missing one crosses, from its first vertex to its second.
    fn crossings(&self, sheet: &Sheet, [p, q]: [u32; 2]) -> Result<Vec<Crossing>> {
        let turn = |t: [u32; 3]| self.turn(sheet.aside, t);
        let around = sheet.around.get(&p).map_or(&[][..], Vec::as_slice);
        let first = around.iter().find_map(|&[u, v]| {
            let [u, v] = match turn([p, u, v]) {
                Sign::Positive => [u, v],
                _ => [v, u],
            };
            // Counterclockwise from u to v, less than half a turn.
            let between = turn([p, u, q]) == Sign::Positive && turn([p, q, v]) == Sign::Positive;
            between.then_some(Crossing { left: v, right: u })
        });
        let mut now = first.ok_or_else(|| internal("an edge leaves no triangle"))?;
        let mut behind = p;
        let mut found = Vec::new();
        loop {
            found.push(now);
            let edge = pair(now.left, now.right);
            // On to the triangle behind the edge, whose corner is left or right of the line to q.
            let two = sheet.both(edge);
            let two = two.ok_or_else(|| internal("an edge leaves its plane"))?;
            let next = if two[0] == behind { two[1] } else { two[0] };
            if next == q {
                return Ok(found);
            }
            match turn([p, q, next]) {
                Sign::Positive => {
                    behind = now.left;
                    now.left = next;
                }
                Sign::Negative => {
                    behind = now.right;
                    now.right = next;
                }
                Sign::Zero => return Err(internal("an edge meets a vertex")),
            }
        }
    }

    /// Which crossing edges may be flipped: those that leave fewer crossings, and, in case there are none,
    /// those at the farthest vertex on the left.
    fn flippable(
        &self,
        sheet: &Sheet,
        [p, q]: [u32; 2],
        crossings: &[Crossing],
    ) -> Result<[Vec<[u32; 2]>; 2]> {
        let turn = |t: [u32; 3]| self.turn(sheet.aside, t);
        let (mut fewer, mut others) = (Vec::new(), Vec::new());
        for crossing in crossings {
            let Crossing { left, right } = *crossing;
            let edge = pair(left, right);
            let two = sheet.both(edge);
            let [c, d] = two.ok_or_else(|| internal("an edge leaves its plane"))?;
            let convex = turn([c, d, left]) * turn([c, d, right]) == Sign::Negative;
            if !convex {
                continue;
            }
            let sides = turn([p, q, c]) * turn([p, q, d]);
            if sides == Sign::Negative {
                others.push((left, edge));
            } else {
                fewer.push(edge);
            }
        }
        // Heights above the edge, exactly: which of two vertices is farther.
        let mut best: Option<u32> = None;
        for &Crossing { left, .. } in crossings {
            if best.is_none_or(|v| v != left && self.is_farther([p, q], left, v)) {
                best = Some(left);
            }
        }
        let others = others.into_iter().filter(|(left, _)| Some(*left) == best);
        Ok([fewer, others.map(|(_, edge)| edge).collect()])
    }

    /// Whether u is farther from the line through p and q than v is, all in one plane.
    fn is_farther(&self, [p, q]: [u32; 2], u: u32, v: u32) -> bool {
        let (at, _) = self.mesh.points.integers(&[p, q, u, v]);
        let from = |i: usize| [0, 1, 2].map(|k| &at[i][k] - &at[0][k]);
        let (along, first, second) = (from(1), from(2), from(3));
        // The cross products with the edge are parallel, so any component that is not zero decides.
        [(0, 1), (1, 2), (2, 0)].into_iter().any(|(i, j)| {
            let area = |x: &[num_bigint::BigInt; 3]| &along[i] * &x[j] - &along[j] * &x[i];
            area(&first).magnitude() > area(&second).magnitude()
        })
    }

    /// Flips an edge between two faces of a plane. If not `points`, that may not be possible.
    fn swap_edge(&mut self, sheet: &mut Sheet, [a, b]: [u32; 2], points: bool) -> Result<bool> {
        let two = sheet.both([a, b]);
        let [c, d] = two.ok_or_else(|| internal("an edge of a plane has one face"))?;
        let mut ring = self.ring_of(a, b)?;
        self.pace.spend(ring.vertices.len())?;
        let at = |ring: &Ring, v: u32| ring.vertices.iter().position(|&x| x == v);
        let start = at(&ring, c).ok_or_else(|| internal("a face of a plane is missing"))?;
        ring.vertices.rotate_left(start);
        ring.tetrahedra.rotate_left(start);
        let middle = at(&ring, d).ok_or_else(|| internal("a face of a plane is missing"))?;
        let mut second = ring.vertices[middle..].to_vec();
        second.push(c);
        let halves = [
            (
                ring.vertices[..=middle].to_vec(),
                &ring.tetrahedra[..middle],
            ),
            (second, &ring.tetrahedra[middle..]),
        ];
        let mut old: Vec<u32> = Vec::new();
        let mut new: Vec<Corners> = Vec::new();
        let mut fans = Vec::new();
        let other = [halves[1].1, halves[0].1];
        for ((vertices, cells), other) in halves.into_iter().zip(other) {
            if let Some(made) = self.half([a, b], vertices.clone()) {
                new.extend(made);
                old.extend(cells);
                continue;
            }
            // Around the rim of a sheet, what is in the way may be on its other side.
            let taken = [&old[..], other].concat();
            if let Some((region, made)) = self.region([a, b], &vertices, cells, &taken) {
                new.extend(made);
                old.extend(region);
            } else if points {
                fans.push((vertices, cells));
                old.extend(cells);
            } else {
                return Ok(false);
            }
        }
        if old.iter().collect::<HashSet<_>>().len() < old.len() {
            return Err(internal("both sides of a plane are one"));
        }
        if !fans.is_empty() {
            let start = self.middle_of(a, b)?;
            for (vertices, cells) in fans {
                new.extend(self.fan_of_half(start, [a, b], &vertices, cells)?);
            }
            // It is not in the mesh.
            self.alive -= 1;
        }
        self.mesh.replace(&old, &new)?;
        self.counts.flips += 1;
        for v in [c, d] {
            self.locked_faces.remove(ascending([a, b, v]));
            sheet.remove(ascending([a, b, v]));
        }
        self.locked_edges.remove([a, b]);
        self.locked_edges.insert(pair(c, d), 0);
        for v in [a, b] {
            self.locked_faces.insert(ascending([c, d, v]), 0);
            sheet.insert(ascending([c, d, v]));
        }
        Ok(true)
    }

    /// Tetrahedra that fill a half of the ring of an edge without it.
    fn half(&self, ends: [u32; 2], vertices: Vec<u32>) -> Option<Vec<Corners>> {
        if vertices.len() > LONGEST {
            return None;
        }
        let half = Ring {
            ends,
            vertices,
            tetrahedra: Vec::new(),
        };
        self.cheapest(&half, Goal::Vertex(NONE), usize::MAX)
    }

    /// Tetrahedra at one vertex that fill a half of the ring of an edge and what is in the way,
    /// and what they replace: nothing of `taken`.
    fn region(
        &mut self,
        [a, b]: [u32; 2],
        half: &[u32],
        cells: &[u32],
        taken: &[u32],
    ) -> Option<(Vec<u32>, Vec<Corners>)> {
        let (c, d) = (half[0], half[half.len() - 1]);
        let inner = &half[1..half.len() - 1];
        for rounds in 1..=ROUNDS {
            let mut best: Option<(Vec<u32>, Vec<Corners>)> = None;
            for w in self.apexes([a, b, c, d], inner, cells, rounds) {
                let most = best.as_ref().map_or(LARGEST, |(old, _)| old.len() - 1);
                let Some((old, mut faces)) = self.seen_from(w, [a, b, c, d], cells, most) else {
                    continue;
                };
                faces.extend([[c, d, b], [d, c, a]]);
                let apart = old.iter().all(|t| !taken.contains(t));
                if apart && self.is_closed(&old, &faces, w) {
                    let kept = faces.iter().filter(|f| !f.contains(&w));
                    let new = kept.map(|&[x, y, z]| [x, y, z, w]).collect();
                    best = Some((old, new));
                }
            }
            if best.is_some() {
                return best;
            }
        }
        None
    }

    /// Vertices that see both new faces at the edge between c and d: those of the half of a ring, and
    /// those behind its cells, after so many rounds.
    fn apexes(
        &mut self,
        [a, b, c, d]: [u32; 4],
        inner: &[u32],
        cells: &[u32],
        rounds: usize,
    ) -> Vec<u32> {
        let mut found = inner.to_vec();
        let mut cells = cells.to_vec();
        for _ in 0..rounds {
            let mut next = Vec::new();
            for (t, k) in self.mesh.outer_sides(&cells) {
                let locked = self.locked_faces.has(ascending(self.mesh.face(t, k)));
                if let Some((u, v)) = self.mesh.apex(t, k).filter(|_| !locked) {
                    if !next.contains(&u) {
                        next.push(u);
                    }
                    if !found.contains(&v) && self.sees(&[[c, d, b], [d, c, a]], v) {
                        found.push(v);
                    }
                }
            }
            cells.extend(next);
        }
        found
    }

    /// Cells and what else hides the faces around them from a vertex, and these faces, but not those of a
    /// plane.
    fn seen_from(
        &mut self,
        w: u32,
        [a, b, c, d]: [u32; 4],
        cells: &[u32],
        most: usize,
    ) -> Option<(Vec<u32>, Vec<[u32; 3]>)> {
        let flat = [ascending([a, b, c]), ascending([a, b, d])];
        let mut region = cells.to_vec();
        // Each round but the last adds a tetrahedron.
        while region.len() <= most {
            let mut faces = Vec::new();
            let mut hidden = Vec::new();
            for (t, k) in self.mesh.outer_sides(&region) {
                let face = self.mesh.face(t, k);
                let sorted = ascending(face);
                if flat.contains(&sorted) {
                    continue;
                }
                // A side that w sees stays; behind one that it does not see, the tetrahedron joins.
                let [x, y, z] = face;
                if face.contains(&w) || self.mesh.points.positive([x, y, z, w]) {
                    faces.push(face);
                    continue;
                }
                let u = self.mesh.across[t as usize][k];
                if u == NONE || self.locked_faces.has(sorted) {
                    return None;
                }
                if !hidden.contains(&u) {
                    hidden.push(u);
                }
            }
            if hidden.is_empty() {
                return Some((region, faces));
            }
            region.extend(hidden);
        }
        None
    }

    /// Whether a region has no locked face inside and no vertices but those of its faces, which a
    /// vertex joins without a gap.
    fn is_closed(&self, region: &[u32], faces: &[[u32; 3]], w: u32) -> bool {
        let on_faces: HashSet<u32> = faces.as_flattened().iter().copied().collect();
        for &t in region {
            for k in 0..4 {
                let v = self.mesh.corners[t as usize][k];
                if v != w && !on_faces.contains(&v) {
                    return false;
                }
                let inside = region.contains(&self.mesh.across[t as usize][k]);
                if inside && self.locked_faces.has(ascending(self.mesh.face(t, k))) {
                    return false;
                }
            }
        }
        // Each side of the new tetrahedra has another one, or is a face around the region.
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for face in faces {
            let [x, y, z] = *face;
            let edges = if face.contains(&w) {
                let far: Vec<u32> = face.iter().copied().filter(|&v| v != w).collect();
                vec![pair(far[0], far[1])]
            } else {
                vec![pair(x, y), pair(y, z), pair(z, x)]
            };
            for edge in edges.into_iter().filter(|e| !e.contains(&w)) {
                *sides.entry(edge).or_default() += 1;
            }
        }
        sides.values().all(|&n| n == 2)
    }

    /// The middle of an edge, as a point on a face.
    fn middle_of(&mut self, a: u32, b: u32) -> Result<u32> {
        let (p, low) = self.mesh.points.integers(&[a, b]);
        let at = [0, 1, 2].map(|k| &p[0][k] + &p[1][k]);
        let exponent = low - 1;
        self.add(Wide { at, exponent }, Origin::Face)
    }

    /// The fan of a new point that fills a half of the ring of an edge.
    fn fan_of_half(
        &mut self,
        start: u32,
        [a, b]: [u32; 2],
        vertices: &[u32],
        cells: &[u32],
    ) -> Result<Vec<Corners>> {
        let (c, d) = (vertices[0], vertices[vertices.len() - 1]);
        let old = [ascending([a, b, c]), ascending([a, b, d])];
        let mut faces = self.mesh.outer_faces(cells);
        faces.retain(|&f| !old.contains(&ascending(f)));
        faces.extend([[c, d, b], [d, c, a]]);
        let points = &self.mesh.points;
        let lift = points.lift(start, [a, b, c, d].into_iter());
        let inward = cross(
            super::suppress::unit(points.difference(c, d, lift)),
            super::suppress::unit(points.difference(c, b, lift)),
        );
        match self.point_in(start, &faces, [inward, [0.0; 3]])? {
            Some(v) => {
                self.counts.suppressed += 1;
                Ok(faces.iter().map(|&[x, y, z]| [x, y, z, v]).collect())
            }
            None => {
                self.stuck = self.faces_with(&[a, b, c, d]);
                Err(internal("a side of a plane has no point"))
            }
        }
    }

    /// Faces with a vertex of these.
    fn faces_with(&self, vertices: &[u32]) -> Vec<u32> {
        let has = |f: &[u32; 3]| f.iter().any(|v| vertices.contains(v));
        let rows = (0..).zip(&self.faces).filter(|(_, f)| has(f));
        rows.map(|(f, _)| f).collect()
    }
}
