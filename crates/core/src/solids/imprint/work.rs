//! The triangles between two rounds, their vertices and edges.

use delone_predicates::{Point3, lexicographic};

use super::near::{EDGES, square};
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::points::Extent;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::locate::Boxes;
use crate::order::{sort, sort_by};
use crate::solids::surface::NONE;

/// Items between two checks for interruption.
pub const LOT: usize = 1 << 12;

/// A triangle, as its vertices ascending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Face {
    /// The vertices, ascending.
    pub ids: [u32; 3],
    /// Whether it is oriented against that order.
    pub turned: bool,
    /// The face of the input that it is a part of.
    pub source: u32,
}

impl Face {
    /// From vertices in the order of the orientation; `None` if one is used twice.
    pub fn of(ids: [u32; 3], source: u32) -> Option<Self> {
        let [a, b, c] = ids;
        let turned = (a < b) ^ (b < c) ^ (c < a);
        let mut ids = ids;
        ids.sort_unstable();
        let distinct = ids[0] < ids[1] && ids[1] < ids[2];
        distinct.then_some(Self {
            ids,
            turned,
            source,
        })
    }

    /// The vertices in the order of the orientation.
    pub fn oriented(&self) -> [u32; 3] {
        let [a, b, c] = self.ids;
        if self.turned { [a, c, b] } else { [a, b, c] }
    }
}

/// Vertices and triangles. The vertices of the input come before others, both sorted by coordinates, so
/// that nothing depends on the order of rows.
#[derive(Debug, Clone)]
pub struct Work {
    /// Coordinates.
    pub at: Vec<Point3>,
    /// The row of each vertex in the input; [`NONE`] for others.
    pub row: Vec<u32>,
    /// The triangles, in the order of their sources.
    pub faces: Vec<Face>,
}

impl Work {
    /// Sorts vertices, drops those without triangles, and joins those within the tolerance: all
    /// become the first of them. Triangles that lose their area disappear. Returns the pairs of rows
    /// `[row, row of the vertex that replaces it]`.
    pub fn arranged(
        at: &[Point3],
        row: &[u32],
        faces: &[([u32; 3], u32)],
        tolerance: f64,
        watch: &Watch,
    ) -> Result<(Self, Vec<[u32; 2]>)> {
        let mut used = filled(at.len(), false)?;
        for (ids, _) in faces {
            ids.iter().for_each(|&v| used[v as usize] = true);
        }
        let mut order: Vec<u32> = with_room(at.len())?;
        order.extend((0..at.len() as u32).filter(|&v| used[v as usize]));
        sort_by(&mut order, watch, |&u, &v| {
            let key = |v: u32| (row[v as usize] == NONE, at[v as usize], row[v as usize]);
            let ((new_u, p, row_u), (new_v, q, row_v)) = (key(u), key(v));
            let by_place = new_u.cmp(&new_v).then(lexicographic(p, q));
            by_place.then(row_u.cmp(&row_v)).then(u.cmp(&v))
        })?;
        let mut made = Self {
            at: order.iter().map(|&v| at[v as usize]).collect(),
            row: order.iter().map(|&v| row[v as usize]).collect(),
            faces: with_room(faces.len())?,
        };
        let name = made.joined(tolerance, watch)?;
        let mut merged = Vec::new();
        for (v, &root) in name.iter().enumerate() {
            if root as usize != v && made.row[v] != NONE {
                push(&mut merged, [made.row[v], made.row[root as usize]])?;
            }
        }
        let mut place = filled(at.len(), NONE)?;
        for (&v, &root) in order.iter().zip(&name) {
            place[v as usize] = root;
        }
        let named = faces
            .iter()
            .filter_map(|&(ids, source)| Face::of(ids.map(|v| place[v as usize]), source));
        made.faces.extend(named);
        sort_by(&mut made.faces, watch, |f, g| {
            (f.source, f.ids, f.turned).cmp(&(g.source, g.ids, g.turned))
        })?;
        Ok((made, merged))
    }

    /// For each vertex the first of those that it is joined with.
    fn joined(&self, tolerance: f64, watch: &Watch) -> Result<Vec<u32>> {
        let mut sets = Sets::of(self.at.len())?;
        let tree = tree_of(&self.at, watch)?;
        let mut pace = Pace::new(watch, LOT);
        for (v, &p) in self.at.iter().enumerate() {
            pace.spend(1)?;
            tree.meeting(&around(p, tolerance), |u| {
                if u < v && square(p, self.at[u]) <= tolerance * tolerance {
                    sets.join(u as u32, v as u32);
                }
            });
        }
        Ok((0..self.at.len() as u32).map(|v| sets.root(v)).collect())
    }

    /// The coordinates of the corners.
    pub fn corners(&self, face: usize) -> [Point3; 3] {
        self.faces[face].ids.map(|v| self.at[v as usize])
    }
}

/// A tree of points.
pub fn tree_of(at: &[Point3], watch: &Watch) -> Result<Boxes<3>> {
    Boxes::over(at.len(), |v| around(at[v], 0.0), watch)
}

/// The box of all that is within `margin` of a point.
pub fn around(p: Point3, margin: f64) -> Extent<3> {
    Extent {
        min: p.map(|x| x - margin),
        max: p.map(|x| x + margin),
    }
}

/// The edges, each once.
#[derive(Debug)]
pub struct Edges {
    /// The ends of each, ascending.
    pub ends: Vec<[u32; 2]>,
    /// The edges of each triangle, in the order of [`EDGES`].
    pub of: Vec<[u32; 3]>,
}

impl Edges {
    /// The edges of triangles.
    pub fn of(faces: &[Face], watch: &Watch) -> Result<Self> {
        let all = |f: &Face| EDGES.map(|(i, j)| [f.ids[i].min(f.ids[j]), f.ids[i].max(f.ids[j])]);
        let mut ends: Vec<[u32; 2]> = with_room(3 * faces.len())?;
        ends.extend(faces.iter().flat_map(all));
        sort(&mut ends, watch)?;
        ends.dedup();
        let mut of = with_room(faces.len())?;
        let mut pace = Pace::new(watch, LOT);
        for face in faces {
            pace.spend(1)?;
            of.push(all(face).map(|e| ends.partition_point(|other| *other < e) as u32));
        }
        Ok(Self { ends, of })
    }
}
