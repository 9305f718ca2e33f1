//! A mutable tetrahedral mesh: corners, the neighbor across each face, one tetrahedron per vertex.
//!
//! Stores coordinates but does not use them.
//!
//! Corner `k` of a positively oriented tetrahedron lies on the positive side of its face [`FACES`]`[k]`.
//! A face is a *wall* if nothing lies behind it, or a tetrahedron with another label. Walls change only where
//! [`Store::replace`] flips two of them in one plane, and where [`Store::remove`] takes a tetrahedron away.

use delone_predicates::Point3;

pub use crate::base::arrays::FACETS as FACES;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};

/// No tetrahedron, or no vertex.
pub const NONE: u32 = u32::MAX;

/// Vertices of a tetrahedron, positively oriented.
pub type Corners = [u32; 4];

/// Tetrahedra over points.
#[derive(Debug)]
pub struct Store {
    /// Coordinates of the vertices.
    pub points: Vec<Point3>,
    /// The corners of each tetrahedron; [`NONE`] if it was removed.
    pub corners: Vec<Corners>,
    /// The tetrahedron across the face opposite each corner.
    pub across: Vec<[u32; 4]>,
    /// The label of each.
    pub label: Vec<i32>,
    /// A measure of each, maintained by the code that changes coordinates or requests a
    /// replacement.
    pub quality: Vec<f64>,
    /// A tetrahedron of each vertex.
    pub at: Vec<u32>,
    /// Vertices that do not move freely, those of walls included.
    pub fixed: Vec<bool>,
    /// Vertices of walls.
    pub rim: Vec<bool>,
    /// Vertices of walls that move if they are inside flat facets or straight edges.
    pub slides: Vec<bool>,
    /// Vertices whose tetrahedra are not all connected by faces: parts of the mesh touch there. Known only if
    /// the surface may change.
    pub pinched: Vec<bool>,
    free: Vec<u32>,
    faces: Vec<Side>,
}

/// A face with its vertices ascending, and the tetrahedron and corner from which it is seen.
type Side = ([u32; 3], u32, usize);

/// Three numbers, ascending.
fn ascending(mut v: [u32; 3]) -> [u32; 3] {
    v.sort_unstable();
    v
}

/// Whether three numbers are an even permutation of their ascending order.
fn is_even([a, b, c]: [u32; 3]) -> bool {
    (a < b) ^ (b < c) ^ (a < c)
}

impl Store {
    /// Links tetrahedra by their faces. Rejects a face with more than one of them on a side, by the rows of
    /// its vertices.
    pub fn new(
        points: Vec<Point3>,
        corners: Vec<Corners>,
        label: Vec<i32>,
        rows: &[u32],
    ) -> Result<Self> {
        let (n, m) = (points.len(), corners.len());
        let mut at = filled(n, NONE)?;
        let mut sides: Vec<Side> = with_room(4 * m)?;
        for (t, v) in (0..).zip(&corners) {
            for k in 0..4 {
                at[v[k] as usize] = t;
                sides.push((ascending(FACES[k].map(|i| v[i])), t, k));
            }
        }
        sides.sort_unstable();
        let mut across = filled(m, [NONE; 4])?;
        let mut fixed = filled(n, false)?;
        let mut rest = sides.as_slice();
        while let Some((&(face, t, k), others)) = rest.split_first() {
            // All sides of one face: two at most.
            let same = others.iter().take_while(|other| other.0 == face).count();
            let mut wall = true;
            let is_even = |t: u32, k: usize| is_even(FACES[k].map(|i| corners[t as usize][i]));
            match (same, others) {
                (0, _) => {}
                // From two sides, the corners go around in opposite directions.
                (1, [(_, u, i), ..]) if is_even(t, k) != is_even(*u, *i) => {
                    across[t as usize][k] = *u;
                    across[*u as usize][*i] = t;
                    wall = label[t as usize] != label[*u as usize];
                }
                _ => {
                    let [a, b, c] = ascending(face.map(|v| rows[v as usize]));
                    return Err(Error::Shape(format!(
                        "two tetrahedra are on the same side of the face of rows {a}, {b} and {c}: \
                         they overlap"
                    )));
                }
            }
            // Vertices of walls do not move.
            if wall {
                for v in face {
                    fixed[v as usize] = true;
                }
            }
            rest = &others[same..];
        }
        let quality = filled(m, 0.0)?;
        let mut rim = with_room(n)?;
        rim.extend_from_slice(&fixed);
        Ok(Self {
            slides: filled(n, false)?,
            pinched: filled(n, false)?,
            rim,
            points,
            corners,
            across,
            label,
            quality,
            at,
            fixed,
            free: Vec::new(),
            faces: Vec::new(),
        })
    }

    /// The number of slots for tetrahedra, including empty ones.
    pub fn places(&self) -> u32 {
        self.corners.len() as u32
    }

    /// Whether a slot contains a tetrahedron.
    #[inline]
    pub fn is_there(&self, t: u32) -> bool {
        self.corners[t as usize][0] != NONE
    }

    /// Whether a vertex is a corner of a tetrahedron.
    #[inline]
    pub fn is_used(&self, v: u32) -> bool {
        self.at[v as usize] != NONE
    }

    /// The coordinates of corners.
    #[inline]
    pub fn places_of(&self, v: Corners) -> [Point3; 4] {
        v.map(|v| self.points[v as usize])
    }

    /// Which corner of a tetrahedron a vertex is.
    #[inline]
    pub fn corner(&self, t: u32, v: u32) -> Option<usize> {
        self.corners[t as usize].iter().position(|&x| x == v)
    }

    /// The tetrahedron across the face opposite a corner, unless that is a wall.
    #[inline]
    pub fn beyond(&self, t: u32, k: usize) -> Option<u32> {
        let u = self.across[t as usize][k];
        (u != NONE && self.label[u as usize] == self.label[t as usize]).then_some(u)
    }

    /// Whether the edge of two corners of a tetrahedron is on no wall: the tetrahedra around it close.
    pub fn is_inside(&self, start: u32, [i, j]: [usize; 2]) -> bool {
        let [a, b] = [i, j].map(|k| self.corners[start as usize][k]);
        let others = (0..4).filter(|k| ![i, j].contains(k));
        let mut others = others.map(|k| self.corners[start as usize][k]);
        let (Some(mut behind), Some(mut ahead)) = (others.next(), others.next()) else {
            return false;
        };
        let mut t = start;
        // Across the face opposite the vertex behind, on and on: each vertex of the ring once.
        loop {
            let next = self.corner(t, behind).and_then(|k| self.beyond(t, k));
            match next {
                Some(u) if u == start => return true,
                Some(u) => {
                    let all = self.corners[u as usize].into_iter();
                    let apex = all.fold(0, |sum, v| sum ^ v) ^ a ^ b ^ ahead;
                    (t, behind, ahead) = (u, ahead, apex);
                }
                None => return false,
            }
        }
    }

    /// Collects the tetrahedra of a vertex that are connected to `at[v]` by faces that are not
    /// walls.
    pub fn star(&self, v: u32, found: &mut Vec<u32>) -> Result<()> {
        self.gather(v, found, |t, k| self.beyond(t, k))
    }

    /// Collects the tetrahedra of a vertex that are connected to `at[v]` by faces, walls included.
    pub fn whole_star(&self, v: u32, found: &mut Vec<u32>) -> Result<()> {
        self.gather(v, found, |t, k| {
            let u = self.across[t as usize][k];
            (u != NONE).then_some(u)
        })
    }

    /// Collects the tetrahedra of a vertex that `across` reaches from `at[v]`, given a tetrahedron and
    /// the corner opposite the face to cross.
    fn gather(
        &self,
        v: u32,
        found: &mut Vec<u32>,
        across: impl Fn(u32, usize) -> Option<u32>,
    ) -> Result<()> {
        found.clear();
        push(found, self.at[v as usize])?;
        let mut next = 0;
        while let Some(&t) = found.get(next) {
            next += 1;
            for k in 0..4 {
                if self.corners[t as usize][k] == v {
                    continue;
                }
                if let Some(u) = across(t, k)
                    && !found.contains(&u)
                {
                    push(found, u)?;
                }
            }
        }
        Ok(())
    }

    /// Replaces old tetrahedra of one label by new ones, and returns their numbers in `made`. Both
    /// fill the same region; with `turning`, two walls in one plane may differ.
    pub fn replace(
        &mut self,
        old: &[u32],
        new: &[Corners],
        turning: bool,
        made: &mut Vec<u32>,
    ) -> Result<()> {
        let mut faces = std::mem::take(&mut self.faces);
        faces.clear();
        // The outer faces of the old tetrahedra, as seen from the outside.
        for &t in old {
            for (k, corners) in FACES.iter().enumerate() {
                let u = self.across[t as usize][k];
                if u != NONE && old.contains(&u) {
                    continue;
                }
                let face = corners.map(|i| self.corners[t as usize][i]);
                let back = match u {
                    NONE => 0,
                    _ => (0..4)
                        .find(|&i| self.across[u as usize][i] == t)
                        .ok_or_else(|| {
                            Error::Internal("a face whose neighbor does not link back".into())
                        })?,
                };
                push(&mut faces, (ascending(face), u, back))?;
            }
        }
        // Reuse the old slots for the new tetrahedra and add all of their faces.
        let label = self.label[old[0] as usize];
        for &t in old {
            self.corners[t as usize] = [NONE; 4];
        }
        made.clear();
        for (i, &v) in new.iter().enumerate() {
            let t = self.place(old.get(i).copied())?;
            push(made, t)?;
            self.corners[t as usize] = v;
            self.label[t as usize] = label;
            for k in 0..4 {
                self.at[v[k] as usize] = t;
                push(&mut faces, (ascending(FACES[k].map(|i| v[i])), t, k))?;
            }
        }
        for &t in old.iter().skip(new.len()) {
            push(&mut self.free, t)?;
        }
        // Sorting brings the two sides of each face together.
        faces.sort_unstable();
        let joined = self.join(&faces, turning);
        self.faces = faces;
        joined
    }

    fn marks(&mut self) -> [&mut Vec<bool>; 4] {
        [
            &mut self.fixed,
            &mut self.rim,
            &mut self.slides,
            &mut self.pinched,
        ]
    }

    /// Adds a vertex that is not on a wall and has no tetrahedron yet.
    pub fn add(&mut self, place: Point3) -> Result<()> {
        push(&mut self.points, place)?;
        push(&mut self.at, NONE)?;
        for marks in self.marks() {
            push(marks, false)?;
        }
        Ok(())
    }

    /// Removes the last vertex, which has no tetrahedron.
    pub fn take_back(&mut self) {
        self.points.pop();
        self.at.pop();
        for marks in self.marks() {
            marks.pop();
        }
    }

    /// Removes a tetrahedron at the boundary, whose corners have others; all of its corners are on the
    /// boundary then.
    pub fn remove(&mut self, t: u32) -> Result<()> {
        let corners = self.corners[t as usize];
        for k in 0..4 {
            let u = self.across[t as usize][k];
            if u == NONE {
                continue;
            }
            for back in &mut self.across[u as usize] {
                if *back == t {
                    *back = NONE;
                }
            }
            for v in (0..4).filter(|&i| i != k).map(|i| corners[i]) {
                self.at[v as usize] = u;
            }
        }
        for v in corners {
            (self.fixed[v as usize], self.rim[v as usize]) = (true, true);
        }
        self.corners[t as usize] = [NONE; 4];
        push(&mut self.free, t)
    }

    /// A slot for a tetrahedron: the one offered, an empty one or a new one.
    fn place(&mut self, offered: Option<u32>) -> Result<u32> {
        if let Some(t) = offered.or_else(|| self.free.pop()) {
            return Ok(t);
        }
        push(&mut self.corners, [NONE; 4])?;
        push(&mut self.across, [NONE; 4])?;
        push(&mut self.label, 0)?;
        push(&mut self.quality, 0.0)?;
        Ok(self.places() - 1)
    }

    /// Links the sides of faces, sorted: two per face, or one if walls are flipped.
    fn join(&mut self, faces: &[Side], turning: bool) -> Result<()> {
        let mut rest = faces;
        while let Some((&(face, t, k), others)) = rest.split_first() {
            match others.first() {
                // Two sides, of which one may be outside: NONE.
                Some(&(other, u, i)) if other == face => {
                    if t != NONE {
                        self.across[t as usize][k] = u;
                    }
                    if u != NONE {
                        self.across[u as usize][i] = t;
                    }
                    rest = &others[1..];
                }
                // A single side of a wall that was flipped is on the boundary.
                _ if turning => {
                    if t != NONE {
                        self.across[t as usize][k] = NONE;
                    }
                    rest = others;
                }
                _ => return Err(Error::Internal("a face without a partner".into())),
            }
        }
        Ok(())
    }
}
