//! Points on segments and facets, added for sizes.

use delone_predicates::Point3;

use super::cavity::{Encroached, Start};
use super::is_wall;
use super::judge::{circumcircle, distance, excess_of_triangle, minus, plus};
use super::mesh::{Side, edge};
use super::place::{OnFacet, walk_on_facet};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::push;

/// Segments longer than this many sizes are split.
const LONG_SEGMENT: f64 = 1.5;
/// The edges of a tetrahedron.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

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
        let done = self.split_at(t, [a, b], plus(p, share, minus(q, p)), least)?;
        self.counts.on_segments += usize::from(done);
        Ok(done)
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
