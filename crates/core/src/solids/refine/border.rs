//! Points on segments and facets, added for sizes, and for shapes that cannot be reached without.

use delone_predicates::Point3;

use super::cavity::{Encroached, Start};
use super::is_wall;
use super::judge::{EDGES, ROUNDING, circumcircle, distance, dot, excess_of_triangle, minus, plus};
use super::mesh::{NONE, Side, edge};
use super::place::{OnFacet, walk_on_facet};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::push;

/// Segments longer than this many sizes are split.
const LONG_SEGMENT: f64 = 1.5;

impl Work {
    /// Splits the longest segment or the largest wall of a tetrahedron if it is too large. Segments
    /// are split however near others are: they become short by that alone.
    pub fn split_border(&mut self, t: u32, size: f64, least: f64) -> Result<bool> {
        let v = self.mesh.corners[t as usize];
        let mut longest = (LONG_SEGMENT * size, None);
        for [i, j] in EDGES {
            let [p, q] = self.mesh.places_of([v[i], v[j]]);
            let length = distance(p, q);
            if length > longest.0 && self.mesh.is_segment(v[i], v[j]) {
                longest = (length, Some([v[i], v[j]]));
            }
        }
        if let Some(ends) = longest.1
            && self.split_segment(t, ends, 0.0)?
        {
            return Ok(true);
        }
        for k in 0..4 {
            if !is_wall(&self.mesh, t, k) {
                continue;
            }
            let corners = self.mesh.places_of(self.mesh.face((t, k)));
            if excess_of_triangle(corners, size) > 1.0 && self.split_wall((t, k), None, least)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Splits a segment of a tetrahedron whose diametral sphere contains another of its vertices, or
    /// a wall whose diametral sphere contains the vertex before it.
    pub fn split_encroached(&mut self, t: u32) -> Result<bool> {
        let places = self.mesh.places_of(self.mesh.corners[t as usize]);
        for (e, ends) in EDGES.into_iter().enumerate() {
            // The other two vertices: the edges are in such an order.
            let others = EDGES[5 - e].map(|i| places[i]);
            if others.iter().any(|&x| is_near(ends.map(|i| places[i]), x))
                && self.split_if_segment(t, ends)?
            {
                return Ok(true);
            }
        }
        for (k, &apex) in places.iter().enumerate() {
            if is_wall(&self.mesh, t, k)
                && self.is_before((t, k), apex)
                && self.split_wall((t, k), None, self.border.least)?
            {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Splits a segment or a wall of a tetrahedron whose diametral sphere contains a point.
    pub fn split_near(&mut self, t: u32, p: Point3) -> Result<bool> {
        let places = self.mesh.places_of(self.mesh.corners[t as usize]);
        for ends in EDGES {
            if is_near(ends.map(|i| places[i]), p) && self.split_if_segment(t, ends)? {
                return Ok(true);
            }
        }
        for k in 0..4 {
            if is_wall(&self.mesh, t, k)
                && self.is_before((t, k), p)
                && self.split_wall((t, k), Some(p), self.border.least)?
            {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the diametral sphere of a wall contains a point.
    pub fn is_before(&self, side: Side, p: Point3) -> bool {
        let (center, square) = circumcircle(self.mesh.places_of(self.mesh.face(side)));
        let from = minus(p, center);
        dot(from, from) < square * (1.0 - ROUNDING)
    }

    /// Splits the edge between two corners if it is a segment.
    fn split_if_segment(&mut self, t: u32, ends: [usize; 2]) -> Result<bool> {
        let [a, b] = ends.map(|i| self.mesh.corners[t as usize][i]);
        Ok(self.mesh.is_segment(a, b) && self.split_segment(t, [a, b], self.border.least)?)
    }

    /// Puts a point on a segment of a tetrahedron, at least a given distance from vertices.
    pub fn split_segment(&mut self, t: u32, ends: [u32; 2], least: f64) -> Result<bool> {
        let [a, b] = edge(ends[0], ends[1]);
        let [p, q] = self.mesh.places_of([a, b]);
        let length = distance(p, q);
        if length / 2.0 < least || self.mesh.pinched.contains(&[a, b]) {
            return Ok(false);
        }
        // From the end of a given segment, at a power of two: segments that meet at a sharp angle
        // are split at equal distances, and subsegments do not encroach upon each other.
        let is_given = |v: u32| (v as usize) < self.mesh.given;
        let share = match (is_given(a), is_given(b)) {
            (true, false) => shell(length),
            (false, true) => 1.0 - shell(length),
            _ => 0.5,
        };
        let root = self.root_of([a, b]);
        let done = self.split_at(t, [a, b], plus(p, share, minus(q, p)), least)?;
        self.counts.on_segments += usize::from(done);
        if done && let Some(new) = self.root.last_mut() {
            *new = root;
        }
        Ok(done)
    }

    /// The ends of the segment of the input that an edge is a part of.
    fn root_of(&self, ends: [u32; 2]) -> [u32; 2] {
        let roots = ends.map(|v| self.root[v as usize]);
        let found = roots.into_iter().find(|root| *root != [NONE; 2]);
        found.unwrap_or(ends)
    }

    /// Puts a point on an edge of a tetrahedron, at least a given distance from vertices.
    fn split_at(&mut self, t: u32, ends: [u32; 2], p: Point3, least: f64) -> Result<bool> {
        let [a, b] = ends;
        let mut start = Start {
            edge: Some(ends),
            ..Start::default()
        };
        self.mesh.around(t, ends, &mut start.cells)?;
        for &t in &start.cells {
            for k in 0..4 {
                let v = self.mesh.corners[t as usize][k];
                if v != a && v != b && is_wall(&self.mesh, t, k) {
                    push(&mut start.walls, (t, k))?;
                }
            }
        }
        Ok(self.cavity.build(&self.mesh, p, &start)?
            && self.cavity.clearance(&self.mesh, p) >= least
            && self.insert(p, &start)?)
    }

    /// Puts a point on the facet of a wall: at the circumcenter of the wall, or of the one nearest
    /// to a place; or on a segment that is in the way.
    pub fn split_wall(&mut self, side: Side, near: Option<Point3>, least: f64) -> Result<bool> {
        let side = match near.map(|p| walk_on_facet(&self.mesh, side, p)) {
            Some(OnFacet::Wall(found, _)) => found,
            _ => side,
        };
        let corners = self.mesh.places_of(self.mesh.face(side));
        let (center, radius) = circumcircle(corners);
        if !radius.is_finite() {
            return Ok(false);
        }
        let (side, place) = match walk_on_facet(&self.mesh, side, center) {
            OnFacet::Wall(side, place) => (side, place),
            OnFacet::Segment(side, ends) => return self.split_segment(side.0, ends, least),
            OnFacet::Nothing => return Ok(false),
        };
        let mut start = Start::default();
        push(&mut start.cells, side.0)?;
        push(&mut start.walls, side)?;
        if let Some(behind) = self.mesh.behind(side) {
            push(&mut start.cells, behind.0)?;
            push(&mut start.walls, behind)?;
        }
        if !self.cavity.build(&self.mesh, place, &start)? {
            return Ok(false);
        }
        if let Some(Encroached::Segment(t, ends)) = self.cavity.encroached(&self.mesh, place, false)
        {
            return self.split_segment(t, ends, least);
        }
        if self.cavity.clearance(&self.mesh, place) < least {
            return Ok(false);
        }
        let done = self.insert(place, &start)?;
        self.counts.on_facets += usize::from(done);
        Ok(done)
    }
}

/// The share of a length that is the power of two nearest to its half.
fn shell(length: f64) -> f64 {
    2.0_f64.powi((length / 2.0).log2().round() as i32) / length
}

/// Whether the diametral sphere of an edge contains a point.
fn is_near([p, q]: [Point3; 2], x: Point3) -> bool {
    let along = minus(q, p);
    dot(minus(p, x), minus(q, x)) < -ROUNDING * dot(along, along)
}
