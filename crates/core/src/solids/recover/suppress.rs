//! Points on faces and edges move into the inside, one in each sector.
//!
//! A point on the boundary has a sector of tetrahedra between each two faces that meet there. In
//! each face the polygon around the point is cut into triangles, which all sectors use; each sector
//! is closed by them and joined to one of its vertices that sees all of it, or to a new point
//! inside.

use std::collections::{BTreeMap, BTreeSet};

use delone_predicates::Sign;

use super::coordinates::cross;
use super::mesh::{Corners, NONE, ascending, internal, pair};
use super::work::{Origin, Work};
use crate::base::error::{Error, Result};

/// The tetrahedra of a point between faces.
struct Sector {
    /// The faces around them, seen from inside.
    faces: Vec<[u32; 3]>,
    /// The sum of the unit normals of the faces of the input, inward.
    inward: [f64; 3],
    /// The sum of the unit vectors from the point into these faces.
    along: [f64; 3],
}

impl Work<'_> {
    /// Removes a point of the boundary. Returns true if that was possible.
    pub fn suppress(&mut self, s: u32) -> Result<bool> {
        self.pace.spend(8)?;
        let star = self.mesh.star(s, usize::MAX);
        let polygons = self.polygons(s, &star)?;
        let mut triangles = BTreeMap::new();
        for (&f, polygon) in &polygons {
            triangles.insert(f, self.ears(f, polygon)?);
        }
        let sectors = self.sectors(s, &star, &triangles)?;
        let mut new: Vec<Corners> = Vec::new();
        let mut made = Vec::new();
        for sector in &sectors {
            // A vertex of the sector that sees all of its faces, or a new point that does.
            let (v, is_new) = match self.vertex_that_sees(&sector.faces) {
                Some(v) => (v, false),
                None => {
                    let v = self.point_in(s, &sector.faces, [sector.inward, sector.along])?;
                    match v {
                        Some(v) => (v, true),
                        None => {
                            self.stuck = polygons.keys().copied().collect();
                            return Err(internal("a sector has no point"));
                        }
                    }
                }
            };
            if is_new {
                self.counts.suppressed += 1;
                made.push(v);
            } else {
                self.counts.joined += 1;
            }
            // The sector becomes the cone from it to the faces.
            let kept = sector.faces.iter().filter(|f| !f.contains(&v));
            new.extend(kept.map(|&[a, b, c]| [a, b, c, v]));
        }
        self.mesh.replace(&star, &new)?;
        self.alive -= 1;
        self.relock(s, &polygons, &triangles);
        Ok(true)
    }

    /// The polygon around a point in each locked face, counterclockwise. If the point is on a segment,
    /// the polygon begins and ends on that segment.
    fn polygons(&mut self, s: u32, star: &[u32]) -> Result<BTreeMap<u32, Vec<u32>>> {
        let mut next: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
        let mut asides = BTreeMap::new();
        for &t in star {
            for k in 0..4 {
                let face = ascending(self.mesh.face(t, k));
                let Some(i) = face.iter().position(|&v| v == s) else {
                    continue;
                };
                let Some(f) = self.locked_faces.get(face) else {
                    continue;
                };
                if let std::collections::btree_map::Entry::Vacant(entry) = asides.entry(f) {
                    entry.insert(self.aside(self.faces[f as usize])?);
                }
                let (p, q) = (face[(i + 1) % 3], face[(i + 2) % 3]);
                let turned = self.turn(asides[&f], [s, p, q]) == Sign::Positive;
                let (p, q) = if turned { (p, q) } else { (q, p) };
                next.entry(f).or_default().insert(p, q);
            }
        }
        let mut all = BTreeMap::new();
        for (f, next) in next {
            let ends: BTreeSet<u32> = next.values().copied().collect();
            let first = next.keys().find(|p| !ends.contains(p));
            let first = first.or(next.keys().next()).copied();
            let mut polygon: Vec<u32> = first.into_iter().collect();
            while let Some(&q) = polygon.last().and_then(|p| next.get(p)) {
                if Some(q) == first || polygon.len() > next.len() {
                    break;
                }
                polygon.push(q);
            }
            let closed = ends.len() == next.len() && polygon.len() == next.len();
            if !closed && polygon.len() != next.len() + 1 {
                return Err(internal("a face is not whole around a point"));
            }
            all.insert(f, polygon);
        }
        Ok(all)
    }

    /// Triangles of a polygon in the plane of a face, by ear clipping.
    fn ears(&mut self, f: u32, polygon: &[u32]) -> Result<Vec<[u32; 3]>> {
        let aside = self.aside(self.faces[f as usize])?;
        let turn = |t: [u32; 3]| self.turn(aside, t);
        let mut rest = polygon.to_vec();
        let mut found = Vec::with_capacity(rest.len());
        while rest.len() > 3 {
            let mut best: Option<(f64, usize)> = None;
            for j in 0..rest.len() {
                let ear = [before(&rest, j), rest[j], after(&rest, j)];
                if turn(ear) != Sign::Positive || !self.is_ear(&rest, j, &turn) {
                    continue;
                }
                let d = self.mesh.points.difference(ear[0], ear[2], 0);
                let length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if best.is_none_or(|(least, _)| length < least) {
                    best = Some((length, j));
                }
            }
            let (_, j) = best.ok_or_else(|| internal("a polygon has no ear"))?;
            found.push([before(&rest, j), rest[j], after(&rest, j)]);
            rest.remove(j);
        }
        match rest.as_slice() {
            &[a, b, c] if turn([a, b, c]) == Sign::Positive => found.push([a, b, c]),
            _ => return Err(internal("a polygon is flat")),
        }
        Ok(found)
    }

    /// Whether no other vertex is in the closed triangle of a corner, and the others are not on a
    /// line.
    fn is_ear(&self, rest: &[u32], j: usize, turn: &impl Fn([u32; 3]) -> Sign) -> bool {
        let [u, v, w] = [before(rest, j), rest[j], after(rest, j)];
        let inside = |&x: &u32| {
            ![u, v, w].contains(&x)
                && [[u, v, x], [v, w, x], [w, u, x]]
                    .iter()
                    .all(|&t| turn(t) != Sign::Negative)
        };
        let others: Vec<u32> = rest.iter().copied().filter(|&x| x != v).collect();
        let flat = others[2..]
            .iter()
            .all(|&x| turn([others[0], others[1], x]).is_zero());
        !flat && !rest.iter().any(inside)
    }

    /// The sectors of a point, closed by the triangles in its faces.
    fn sectors(
        &mut self,
        s: u32,
        star: &[u32],
        triangles: &BTreeMap<u32, Vec<[u32; 3]>>,
    ) -> Result<Vec<Sector>> {
        let mut left: BTreeSet<u32> = star.iter().copied().collect();
        let mut found = Vec::new();
        for &start in star {
            if !left.remove(&start) {
                continue;
            }
            // One sector: from tetrahedron to tetrahedron, but not through given faces.
            let mut cells = vec![start];
            let mut sides: BTreeMap<u32, Sign> = BTreeMap::new();
            let mut outer = Vec::new();
            let mut next = 0;
            while let Some(&t) = cells.get(next) {
                next += 1;
                for k in 0..4 {
                    let face = self.mesh.face(t, k);
                    // A face opposite the point bounds the sector.
                    if !face.contains(&s) {
                        outer.push(face);
                        continue;
                    }
                    // A given face does, too: the sector is on one side of it.
                    if let Some(f) = self.locked_faces.get(ascending(face)) {
                        let [a, b, c] = self.faces[f as usize];
                        let apex = self.mesh.corners[t as usize][k];
                        let side = self.orient(a, b, c, apex);
                        if sides.insert(f, side).is_some_and(|other| other != side) {
                            return Err(Error::Shape(format!(
                                "an edge of face {f} has no other face"
                            )));
                        }
                        continue;
                    }
                    let u = self.mesh.across[t as usize][k];
                    if u != NONE && left.remove(&u) {
                        cells.push(u);
                    }
                }
            }
            found.push(self.closed(s, outer, &sides, triangles));
        }
        Ok(found)
    }

    /// A sector closed by triangles.
    fn closed(
        &self,
        s: u32,
        mut faces: Vec<[u32; 3]>,
        sides: &BTreeMap<u32, Sign>,
        triangles: &BTreeMap<u32, Vec<[u32; 3]>>,
    ) -> Sector {
        let (mut inward, mut along) = ([0.0; 3], [0.0; 3]);
        let corners = sides.keys().flat_map(|&f| self.faces[f as usize]);
        let lift = self.mesh.points.lift(s, corners);
        for (f, &side) in sides {
            let [a, b, c] = self.faces[*f as usize];
            let points = &self.mesh.points;
            let normal = cross(
                unit(points.difference(a, b, lift)),
                unit(points.difference(a, c, lift)),
            );
            let sign = if side == Sign::Positive { 1.0 } else { -1.0 };
            let normal = unit(normal).map(|x| x * sign);
            // Its triangles without the point, oriented toward the sector.
            for &[p, q, r] in &triangles[f] {
                faces.push(if side == Sign::Positive {
                    [p, q, r]
                } else {
                    [p, r, q]
                });
            }
            // Directions into the sector, and along its faces.
            let middle = [a, b, c].iter().fold([0.0; 3], |m, &v| {
                let d = points.difference(s, v, lift);
                [0, 1, 2].map(|k| m[k] + d[k] / 3.0)
            });
            let middle = unit(middle);
            for k in 0..3 {
                inward[k] += normal[k];
                along[k] += middle[k];
            }
        }
        Sector {
            faces,
            inward,
            along,
        }
    }

    /// A vertex of these faces that sees all others of them.
    pub fn vertex_that_sees(&self, faces: &[[u32; 3]]) -> Option<u32> {
        let vertices: BTreeSet<u32> = faces.as_flattened().iter().copied().collect();
        vertices.into_iter().find(|&v| {
            let mut others = faces.iter().filter(|f| !f.contains(&v));
            others.all(|&[a, b, c]| self.mesh.points.positive([a, b, c, v]))
        })
    }

    /// Locks the triangles that replace the faces at a point.
    fn relock(
        &mut self,
        s: u32,
        polygons: &BTreeMap<u32, Vec<u32>>,
        triangles: &BTreeMap<u32, Vec<[u32; 3]>>,
    ) {
        for (&f, polygon) in polygons {
            for i in 0..polygon.len() {
                let [p, q] = [polygon[i], after(polygon, i)];
                self.locked_faces.remove(ascending([s, p, q]));
            }
            for &triangle in &triangles[&f] {
                self.locked_faces.insert(ascending(triangle), f);
            }
        }
        if let Some(&Origin::Segment(segment)) = self.origin(s) {
            let [a, b] = self.segments[segment as usize];
            let chain = self.chains.entry(segment).or_default();
            let i = chain.iter().position(|&v| v == s).unwrap_or(0);
            let p = if i == 0 { a } else { chain[i - 1] };
            let q = chain.get(i + 1).copied().unwrap_or(b);
            chain.remove(i);
            self.locked_edges.remove(pair(p, s));
            self.locked_edges.remove(pair(s, q));
            self.locked_edges.insert(pair(p, q), segment);
        }
    }
}

/// The vertex before another one of a polygon.
fn before(polygon: &[u32], j: usize) -> u32 {
    polygon[(j + polygon.len() - 1) % polygon.len()]
}

/// The vertex after another one.
fn after(polygon: &[u32], j: usize) -> u32 {
    polygon[(j + 1) % polygon.len()]
}

/// A vector of length 1 in the same direction.
pub fn unit(v: [f64; 3]) -> [f64; 3] {
    let most = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if most == 0.0 || !most.is_finite() {
        return [0.0; 3];
    }
    // Twice, as the length may be out of range and the quotient of subnormals is coarse.
    let w = v.map(|x| x / most);
    let length = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
    w.map(|x| x / length)
}
