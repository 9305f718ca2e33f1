//! Finds what is as close to a segment as its rounding error (compare `constrained::reroute`).

use std::collections::BTreeSet;

use delone_predicates::{Sign, orient2d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::points::Extent;
use crate::constrained::pairs::overlap;
use crate::constrained::{Band, in_direction, is_near, passes};
use crate::mesh::plane::{half_edge, next, prev, triangle};

impl Mesh {
    /// Whether a marked edge passes through the pixel of vertex `w`, at which none ends. It suffices to
    /// search from w across edges that are as near as a pixel.
    pub fn is_passed(&self, w: u32) -> Result<bool> {
        let p = self.at(w);
        let mut stack = self.corners_at(w)?;
        let mut seen = BTreeSet::new();
        while let Some(e) = stack.pop() {
            let ends = self.ends(e);
            if ends.contains(&INFINITE) || !seen.insert(e) {
                continue;
            }
            let [r, s] = ends.map(|v| self.at(v));
            if self.mark(e) != 0 {
                if passes(r, s, p) {
                    return Ok(true);
                }
            } else if is_near(r, s, p) {
                let o = self.opposite(e);
                push(&mut stack, next(o))?;
                push(&mut stack, prev(o))?;
            }
        }
        Ok(false)
    }

    /// The vertices on the segment from `a` to `b`, in order, with those in `meets`, which are ascending;
    /// `None` if it passes through the pixel of any other vertex.
    pub fn stops(&self, [a, b]: [u32; 2], meets: &[u32]) -> Result<Option<Vec<u32>>> {
        let [p, q] = [a, b].map(|v| self.at(v));
        let mut stops = Vec::new();
        let mut stack = Vec::new();
        for &v in [a, b].iter().chain(meets) {
            push(&mut stops, v)?;
            for corner in self.corners_at(v)? {
                push(&mut stack, triangle(corner))?;
            }
        }
        let band = Band::of(p, q);
        let mut seen = BTreeSet::new();
        while let Some(t) = stack.pop() {
            let corners = self.corners(t);
            if corners.contains(&INFINITE) || !seen.insert(t) {
                continue;
            }
            let at = corners.map(|v| self.at(v));
            if !overlap(&band.extent, &Extent::of(at)) {
                continue;
            }
            let sides = at.map(|x| band.side(x));
            for k in 0..3 {
                let is_own = [a, b].contains(&corners[k]) || meets.contains(&corners[k]);
                if is_own || !sides[k].is_zero() || !passes(p, q, at[k]) {
                    continue;
                }
                if !orient2d(p, q, at[k]).is_zero() {
                    return Ok(None);
                }
                push(&mut stops, corners[k])?;
            }
            // Continue across edges that come as near as a pixel.
            for k in 0..3 {
                let [u, v] = [sides[(k + 1) % 3], sides[(k + 2) % 3]];
                if u == Sign::Zero || u != v {
                    push(&mut stack, triangle(self.opposite(half_edge(t, k as u32))))?;
                }
            }
        }
        stops.sort_by(|&v, &w| in_direction([p, q], self.at(v), self.at(w)));
        stops.dedup();
        Ok(Some(stops))
    }

    /// The corners of a vertex.
    fn corners_at(&self, v: u32) -> Result<Vec<u32>> {
        let first = self.sites[v as usize].near;
        let mut corners = Vec::new();
        let mut corner = first;
        loop {
            push(&mut corners, corner)?;
            corner = self.turn(corner);
            if corner == first {
                return Ok(corners);
            }
        }
    }
}
