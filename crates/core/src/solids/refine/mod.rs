//! Refines tetrahedral meshes: points are added until no tetrahedron is too large or too far from
//! regular in shape.
//!
//! J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 14th Symposium on
//! Computational Geometry (1998); G. L. Miller, S. E. Pav and N. J. Walkington, "When and why
//! Delaunay refinement algorithms work", International Journal of Computational Geometry &
//! Applications 15 (2005), for the rule that a point may not be nearer to others than the shortest
//! edge of the element that requested it.
//!
//! # Terms
//!
//! A *wall* is a face that must stay: of the boundary, between labels, or inside. Walls in one
//! plane, exactly or within a tolerance, form a *facet*; a *segment* is an edge where facets end.
//! The *cavity* of a point is the set of tetrahedra that its insertion replaces.
//!
//! # Invariants
//!
//! Tetrahedra are positively oriented, exactly. An insertion replaces a cavity that its point sees
//! completely, by the exact sign of each outer face, so old and new tetrahedra fill the same region
//! and cover it once. Points inside never change walls. Points on facets and segments, which are
//! rounded to doubles, replace the walls of one facet by others between the same edges.
//!
//! What is inserted, and where, is decided by measures in doubles: the mesh stays valid whatever
//! they are.
//!
//! # Why it terminates
//!
//! A point is inserted only if all vertices of its cavity are at least as far as a length that goes
//! with the request: the shortest edge of a tetrahedron of bad shape, or half of the size of one
//! that is too large. So no new edge is shorter than the shortest edge of the input and half of the
//! smallest size, and where cavities contain the nearest vertex, as they do in Delaunay meshes,
//! balls around the points are disjoint. The limit on points ends it in any case.
//!
//! A point on the boundary for a shape may be nearer: each vertex of the input has a *floor*, a share of
//! its shortest edge and of the heights of walls there, and a new vertex gets that of the tetrahedron
//! that requests it: the floor of an end of its shortest edge. So there are only finitely many floors,
//! all positive, and edges are at least as long as the smallest. Where walls or segments meet at sharp
//! angles, points would request others ever closer to the corner: the floors stop them, and at segments
//! that are split at equal distances from their common end, the edge between them requests none.
//!
//! # Determinism
//!
//! Vertices and tetrahedra are sorted by coordinates first, and requests by urgency and age.

mod border;
mod cavity;
mod facet;
mod judge;
mod mesh;
mod near;
mod order;
mod place;
#[cfg(test)]
mod tests;
mod work;

use delone_predicates::Point3;

pub use order::{Given, Refined};

use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::watch::Watch;
use mesh::Mesh;
use work::Work;

/// Called from time to time with the number of points added so far; an error ends the work.
pub type Tell<'a> = &'a mut dyn FnMut(usize) -> Result<()>;

/// Numbers of points added.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// On segments.
    pub on_segments: usize,
    /// On facets.
    pub on_facets: usize,
    /// Between the walls, for shapes.
    pub for_shapes: usize,
    /// Between the walls, for sizes.
    pub for_sizes: usize,
}

impl Counts {
    /// All of them.
    pub fn total(&self) -> usize {
        self.on_segments + self.on_facets + self.for_shapes + self.for_sizes
    }
}

/// A refinement in rounds, between which sizes are asked for.
#[derive(Debug)]
pub struct Rounds {
    work: Work,
    order: order::Order,
}

impl Rounds {
    /// Sorts and checks a mesh.
    pub fn new(given: &Given) -> Result<Self> {
        if given.radius_edge.is_nan() || given.radius_edge <= 0.0 {
            return Err(Error::Shape("radius_edge must be above 0".into()));
        }
        let (mesh, order) = order::import(given)?;
        Ok(Self {
            work: Work::new(mesh, given.split, given.radius_edge)?,
            order,
        })
    }

    /// The tetrahedra whose sizes are not known, with their corners and labels.
    pub fn fresh(&self) -> Result<(Vec<[Point3; 4]>, Vec<i32>)> {
        let mesh = &self.work.mesh;
        let all = (0..mesh.places()).filter(|&t| mesh.is_there(t) && !mesh.known[t as usize]);
        let count = all.clone().count();
        let (mut places, mut labels) = (with_room(count)?, with_room(count)?);
        let scale = self.order.scale;
        for t in all {
            let corners = mesh.places_of(mesh.corners[t as usize]);
            places.push(corners.map(|p| p.map(|x| x / scale)));
            labels.push(mesh.label[t as usize]);
        }
        Ok((places, labels))
    }

    /// Sets the sizes of the tetrahedra that `fresh` returned; true if none of these is too large.
    ///
    /// With `gradual`, no tetrahedron is asked to have edges below half of its longest in the next
    /// round, so that a small size at one position does not spread over a large tetrahedron.
    pub fn comply(&mut self, sizes: &[f64], gradual: bool) -> Result<bool> {
        let (mesh, scale) = (&mut self.work.mesh, self.order.scale);
        let mut given = sizes.iter();
        let mut complies = true;
        for t in 0..mesh.places() {
            if !mesh.is_there(t) || mesh.known[t as usize] {
                continue;
            }
            let size = given.next().ok_or_else(|| short(sizes.len()))? * scale;
            let shape = judge::Shape::of(mesh.places_of(mesh.corners[t as usize]));
            complies &= !shape.is_larger_than(size);
            let least = if gradual { shape.longest / 2.0 } else { 0.0 };
            mesh.size[t as usize] = size.max(least);
            mesh.known[t as usize] = true;
        }
        match given.next() {
            None => Ok(complies),
            Some(_) => Err(short(sizes.len())),
        }
    }

    /// Adds points, `limit` at most; true if nothing more is to be done at these sizes.
    pub fn refine(&mut self, limit: usize, watch: &Watch, tell: Tell) -> Result<bool> {
        self.work.run(limit, watch, tell)
    }

    /// The points added so far.
    pub fn counts(&self) -> Counts {
        self.work.counts
    }

    /// The mesh in rows of the input, followed by the added points.
    pub fn export(&self) -> Result<Refined> {
        order::export(&self.work, &self.order)
    }
}

fn short(count: usize) -> Error {
    Error::Shape(format!("{count} sizes are not one for each tetrahedron"))
}

/// A vector of `n` equal items, for the files of this folder.
fn repeated<T: Clone>(n: usize, x: T) -> Result<Vec<T>> {
    filled(n, x)
}

/// What lies across a face is on the other side of a wall, or there is nothing.
fn is_wall(mesh: &Mesh, t: u32, k: usize) -> bool {
    mesh.wall[t as usize][k] != mesh::NONE
}
