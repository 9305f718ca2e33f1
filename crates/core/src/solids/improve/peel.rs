//! Peeling: bad tetrahedra at the boundary are removed where it stays within a tolerance.
//!
//! ```text
//!          d                    d             One boundary face a b c: three faces at d take its place.
//!        /   \                /   \           Two, at the edge a b: the two faces at the edge c d.
//!      a ------- b    ->    a       b
//! ```
//!
//! # Why the boundary remains a surface
//!
//! With one boundary face, d is not on a wall before. With two, the edge c d is inside, which the ring
//! around it shows. So no vertex or edge of the new faces is on the boundary twice. All other faces of
//! the tetrahedron have a neighbor with the same label, so each corner keeps a tetrahedron.
//!
//! # Why it stays within the tolerance
//!
//! Each vertex has a *depth*, 0 at first. Two statements hold: each point of a boundary face is within the largest
//! depth of its corners of the original boundary; and each point of the original boundary is within the
//! largest depth of its corners of some boundary face. When a tetrahedron is removed, its old and new faces are
//! within its [`thickness`] of each other, and its four corners get their largest depth plus that. Where
//! coplanar faces are flipped or a vertex slides, all vertices of the tetrahedra concerned get their
//! largest depth, since points change to faces with other corners.

use delone_predicates::Point3;

use super::measure::{Shape, cross, dot, minus, rounding, shape};
use super::store::{Corners, FACES, NONE};
use super::work::{Work, deepen};
use crate::base::error::Result;
use crate::base::watch::{Pace, Watch};
use crate::solids::imprint::near::distance;

/// Tetrahedra between two checks for interruption.
const LOT: usize = 1 << 12;
/// A side is certain if it exceeds this share of the squared size, far above its rounding error.
const CLEAR: f64 = 1e-14;

/// An upper bound on the distance of each point of the boundary faces, those opposite the corners `open`,
/// from the other faces, and the other way round.
fn thickness(corners: [Point3; 4], open: &[usize]) -> f64 {
    let shape = shape(corners);
    across(corners, open, &shape).unwrap_or_else(|| farthest(corners, open) + rounding(&shape))
}

/// A bound on the extent in a direction in which lines enter by the other faces and leave by the boundary faces, so
/// that each point of one kind of face has one of the other kind on its line; `None` if the direction
/// tried is not like that.
fn across(corners: [Point3; 4], open: &[usize], shape: &Shape) -> Option<f64> {
    // Face vectors, outward.
    let normals = FACES.map(|face| {
        let [a, b, c] = face.map(|i| corners[i]);
        cross(minus(b, a), minus(c, a)).map(|x| -x)
    });
    let direction = match *open {
        [k] => normals[k],
        // Across both the edge between the two boundary faces and the opposite one.
        [i, j] => {
            let mut others = (0..4).filter(|k| !open.contains(k));
            let (k, l) = (others.next()?, others.next()?);
            let found = cross(minus(corners[l], corners[k]), minus(corners[j], corners[i]));
            let sign = dot(found, normals[i]).signum();
            found.map(|x| sign * x)
        }
        _ => return None,
    };
    let length = dot(direction, direction).sqrt();
    let size = corners.map(|p| dot(minus(p, corners[0]), minus(p, corners[0])));
    let clear = CLEAR * size.iter().fold(0.0_f64, |m, &s| m.max(s)) * length;
    let sides = normals.map(|n| dot(n, direction));
    let right = |k: usize| {
        if open.contains(&k) {
            sides[k] > clear
        } else {
            sides[k] < -clear
        }
    };
    if !(0..4).all(right) {
        return None;
    }
    // The height on the boundary face, or the distance between the lines of both edges. The volume is
    // known to many digits even if the tetrahedron is flat; the length, if the edges are not parallel.
    let largest = size.iter().fold(0.0_f64, |m, &s| m.max(s));
    let error = CLEAR * (1.0 + largest / length);
    Some((shape.volume.abs() + shape.error) / length * (1.0 + error))
}

/// A bound for any shape: the distance from a triangle is convex, so no point of a tetrahedron is farther
/// from a face than the opposite corner.
fn farthest(corners: [Point3; 4], open: &[usize]) -> f64 {
    let height = |k: usize| distance(corners[k], FACES[k].map(|i| corners[i]));
    let least = |kept: bool| {
        let all = (0..4).filter(|k| open.contains(k) != kept);
        all.map(height).fold(f64::INFINITY, f64::min)
    };
    let there = least(false);
    // From a single boundary face, the perpendicular leaves by another face.
    if open.len() == 1 {
        there
    } else {
        there.max(least(true))
    }
}

impl Work<'_> {
    /// Removes tetrahedra below the bound at the boundary, worst first, within the tolerance; returns how
    /// many.
    pub(super) fn peel_all(&mut self, watch: &Watch) -> Result<usize> {
        let mut pace = Pace::new(watch, LOT);
        let before = self.counts.peeled;
        for t in self.below(self.bound)? {
            pace.spend(1)?;
            if self.is_below(t, self.bound) && self.peel_one(t)? {
                self.counts.peeled += 1;
            }
        }
        Ok(self.counts.peeled - before)
    }

    /// Removes a tetrahedron if the boundary remains a surface within the tolerance.
    fn peel_one(&mut self, t: u32) -> Result<bool> {
        let store = &self.store;
        let corners: Corners = store.corners[t as usize];
        let is_open = |k: &usize| store.across[t as usize][*k] == NONE;
        let open: Vec<usize> = (0..4).filter(is_open).collect();
        let walled = (0..4).any(|k| !is_open(&k) && store.beyond(t, k).is_none());
        let surface = match open[..] {
            [k] => !store.rim[corners[k] as usize],
            [i, j] => store.is_inside(t, [i, j]),
            _ => false,
        };
        if walled || !surface {
            return Ok(false);
        }
        let depths = corners.map(|v| self.depth.get(v as usize).copied().unwrap_or(0.0));
        let deepest = depths.iter().fold(0.0_f64, |m, &d| m.max(d));
        let depth = deepest + thickness(store.places_of(corners), &open);
        if depth.is_nan() || depth > self.task.tolerance {
            return Ok(false);
        }
        self.store.remove(t)?;
        self.clock += 1;
        for v in corners.map(|v| v as usize) {
            self.touched[v] = self.clock;
            if v >= self.depth.len() {
                self.depth.resize(v + 1, 0.0);
            }
        }
        self.depth[corners[0] as usize] = depth;
        deepen(&mut self.depth, &corners);
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thickness_is_a_distance() {
        let flat = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [0.0, 4.0, 0.0],
            [1.0, 1.0, 0.25],
        ];
        assert!((thickness(flat, &[3]) - 0.25).abs() < 1e-12);
        // A sliver: a square with one diagonal raised.
        let sliver = [
            [0.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [2.0, 0.0, 0.5],
            [0.0, 2.0, 0.5],
        ];
        assert!((thickness(sliver, &[2, 3]) - 0.5).abs() < 1e-12);
        // The apex is far beyond the face: the distance counts, not the height.
        let beside = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [4.0, 0.0, 0.1],
        ];
        assert!((thickness(beside, &[3]) - 9.01_f64.sqrt()).abs() < 1e-10);
    }
}
