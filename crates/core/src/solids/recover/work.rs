//! The state of a recovery: the mesh, what is locked, and where added points lie.

use std::collections::HashMap;

use delone_predicates::Sign;
use num_bigint::BigInt;

use super::coordinates::Wide;
use super::locks::Locks;
use super::mesh::{Mesh, Ring, ascending, number as rank, pair};
use super::task::Counts;
use crate::base::error::{Densest, Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// Where an added point lies.
#[derive(Debug, Clone)]
pub enum Origin {
    /// On a segment.
    Segment(u32),
    /// On a face of the input.
    Face,
    /// Strictly between the faces: it may move.
    Free,
}

/// A position on a segment: `numerator / 2^bits` of the way.
#[derive(Debug, Clone)]
pub struct Dyadic {
    /// The numerator.
    pub numerator: BigInt,
    /// The binary digits after the point.
    pub bits: u64,
}

/// The edges of faces.
struct Edges {
    segments: Vec<[u32; 2]>,
    open_faces: Vec<u32>,
    sides: Vec<[u32; 3]>,
}

impl Edges {
    /// The edges of ascending faces.
    fn of(faces: &[[u32; 3]]) -> Result<Self> {
        let mut edges: Vec<u128> = with_room(3 * faces.len())?;
        for (f, &[a, b, c]) in (0..).zip(faces) {
            // Opposite the corners; faces are ascending, so these are, too.
            edges.extend([[b, c, f, 0], [a, c, f, 1], [a, b, f, 2]].map(rank));
        }
        edges.sort_unstable();
        let mut segments: Vec<[u32; 2]> = with_room(edges.len() / 2)?;
        let mut open_faces = with_room(edges.len() / 2)?;
        let mut sides = filled(faces.len(), [0; 3])?;
        for x in edges {
            let [a, b, f, corner] = [x >> 96, x >> 64, x >> 32, x].map(|v| v as u32);
            let edge = [a, b];
            if segments.last() != Some(&edge) {
                push(&mut segments, edge)?;
                push(&mut open_faces, 0)?;
            }
            let s = segments.len() - 1;
            open_faces[s] += 1;
            sides[f as usize][corner as usize] = s as u32;
        }
        Ok(Self {
            segments,
            open_faces,
            sides,
        })
    }
}

/// The state.
pub struct Work<'a> {
    /// The mesh.
    pub mesh: Mesh,
    /// Vertices of the input and the four far ones; those from here on were added.
    pub given: u32,
    /// A vertex far outside; three more follow it.
    pub far: u32,
    /// The faces of the input, vertices in ascending order of the faces.
    pub faces: Vec<[u32; 3]>,
    /// The edges of the faces, ascending.
    pub segments: Vec<[u32; 2]>,
    /// Faces not yet recovered, by segment.
    pub open_faces: Vec<u32>,
    /// The segments of each face, opposite its corners.
    pub sides: Vec<[u32; 3]>,
    /// Parts of segments, with the segment of each.
    pub locked_edges: Locks<2>,
    /// Parts of faces, with the face of each.
    pub locked_faces: Locks<3>,
    /// Points on segments, in order, where there are any.
    pub chains: HashMap<u32, Vec<u32>>,
    /// Where each added point lies.
    pub origin: Vec<Origin>,
    /// Added points that are in the mesh.
    pub alive: usize,
    /// The limit of these.
    pub limit: usize,
    /// Faces between which a point is needed and none was found; otherwise empty.
    pub stuck: Vec<u32>,
    /// What happened.
    pub counts: Counts,
    /// The pace of interruption.
    pub pace: Pace<'a>,
}

impl<'a> Work<'a> {
    /// The state before anything is recovered.
    pub fn new(
        mesh: Mesh,
        faces: Vec<[u32; 3]>,
        limit: usize,
        watch: &'a Watch<'a>,
    ) -> Result<Self> {
        let given = mesh.points.len() as u32;
        let Edges {
            segments,
            open_faces,
            sides,
        } = Edges::of(&faces)?;
        let locked_edges = Locks::new(&segments, mesh.points.len())?;
        let locked_faces = Locks::new(&faces, mesh.points.len())?;
        Ok(Self {
            mesh,
            given,
            far: given - 4,
            faces,
            segments,
            open_faces,
            sides,
            locked_edges,
            locked_faces,
            chains: HashMap::new(),
            origin: Vec::new(),
            alive: 0,
            limit,
            stuck: Vec::new(),
            counts: Counts::default(),
            pace: Pace::new(watch, 1 << 8),
        })
    }

    /// Starts again with other faces, sorted, on the same mesh: nothing is locked.
    pub fn restart(&mut self, faces: Vec<[u32; 3]>) -> Result<()> {
        let edges = Edges::of(&faces)?;
        let vertices = self.given as usize;
        self.locked_edges = Locks::new(&edges.segments, vertices)?;
        self.locked_faces = Locks::new(&faces, vertices)?;
        self.faces = faces;
        self.segments = edges.segments;
        self.open_faces = edges.open_faces;
        self.sides = edges.sides;
        self.chains.clear();
        Ok(())
    }

    /// Where an added point lies; `None` for a vertex of the input.
    pub fn origin(&self, v: u32) -> Option<&Origin> {
        self.origin.get(v.checked_sub(self.given)? as usize)
    }

    /// Whether a vertex is an added point that may move.
    pub fn is_free(&self, v: u32) -> bool {
        matches!(self.origin(v), Some(Origin::Free))
    }

    /// Adds a point, or returns `None` if it is beyond the range of doubles.
    pub fn add(&mut self, p: Wide, origin: Origin) -> Result<u32> {
        self.pace.spend(1)?;
        if self.alive >= self.limit {
            return Err(Error::Budget {
                what: "added points inside a surface",
                limit: self.limit,
                found: self.alive + 1,
                densest: Densest::default(),
            });
        }
        let v = self.mesh.add(p)?;
        let v = v.ok_or_else(|| Error::Shape("a coordinate is too large".into()))?;
        self.origin.push(origin);
        self.alive += 1;
        Ok(v)
    }

    /// Removes the point added last.
    pub fn drop_last(&mut self) {
        self.mesh.drop_last();
        self.origin.pop();
        self.alive -= 1;
    }

    /// The sign of det[b-a, c-a, d-a].
    #[inline]
    pub fn orient(&self, a: u32, b: u32, c: u32, d: u32) -> Sign {
        self.mesh.points.orient(a, b, c, d)
    }

    /// A far vertex that is not in the plane of a face, and on which side it is.
    pub fn aside(&self, [a, b, c]: [u32; 3]) -> Result<(u32, Sign)> {
        let mut far = self.far..self.far + 4;
        let found = far.find_map(|v| {
            let sign = self.orient(a, b, c, v);
            (!sign.is_zero()).then_some((v, sign))
        });
        found.ok_or_else(|| Error::Shape(format!("face {:?} is flat", [a, b, c])))
    }

    /// Whether a fan from `v` would be positive.
    pub fn sees(&self, faces: &[[u32; 3]], v: u32) -> bool {
        let sees = |&[a, b, c]: &[u32; 3]| self.mesh.points.positive([a, b, c, v]);
        faces.iter().all(sees)
    }

    /// Whether the edge of a ring or a face at it is locked.
    pub fn ring_is_locked(&self, ring: &Ring) -> bool {
        let [a, b] = ring.ends;
        let face = |&v: &u32| self.locked_faces.has(ascending([a, b, v]));
        self.locked_edges.has(pair(a, b)) || ring.vertices.iter().any(face)
    }
}

/// The sign as a number.
pub fn number(sign: Sign) -> i32 {
    match sign {
        Sign::Negative => -1,
        Sign::Zero => 0,
        Sign::Positive => 1,
    }
}
