//! Removal: the star of a vertex is emptied, and the hole is filled from facet to facet.
//!
//! # Why this is right
//!
//! Let v be the vertex, and look at the lower hull of the other lifted points, ghosts included. Each
//! tetrahedron without the corner v stays: no point is below it. Each other one of the new hull has v
//! below it, and is in the cavity that an insertion of v would empty. All corners of a cavity are on
//! its boundary, which is the boundary of the star of v: so they are neighbors of v.
//!
//! The tetrahedron at a facet abc of the hole, or at a facet of one that has just been made, is the one
//! whose apex has no point below the plane of the lifted a, b, c and itself, among the points strictly
//! on the inner side of abc. It is a neighbor of v, so it is found among these: the planes through the
//! lifted a, b, c are ordered by their slopes, and one pass over the neighbors finds the lowest. By the
//! perturbation there is no tie. If no neighbor is on the inner side, abc is on the hull, and a ghost is
//! behind it. In this way the facets around the hole are facets of what fills it: nothing is sewn that
//! has not been computed from both sides.
//!
//! Ghosts are found from their finite facets only: at each facet with an infinite corner two ghosts
//! meet, or a ghost and one outside the hole. All of them are found, since each part of the hole in
//! which there are finite tetrahedra has a finite facet on its boundary: otherwise only ghosts would
//! be around that part, so it would be the whole triangulation, and there would be no tetrahedron at v.
//!
//! The cost is O(k m) tests for k neighbors and m new tetrahedra: about 15 and 20. Where that exceeds a
//! rebuild, the caller rebuilds.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use super::mesh::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::collinear;
use crate::base::watch::Pace;
use crate::live::rows::NONE;
use crate::live::store::Removed;

/// Tests for each vertex of the mesh that cost as much as a rebuild, and how many are always
/// allowed.
const HUB: usize = 64;
const HUB_LEAST: usize = 1 << 20;

impl Mesh {
    /// Removes vertex `v` from the mesh; its site stays. On an error nothing has changed. With
    /// `always`, high degrees are not a reason to refuse.
    pub fn unlink(&mut self, v: u32, always: bool, pace: &mut Pace) -> Result<Removed> {
        self.gather(v)?;
        let around = self.neighbors()?;
        if self.is_cone() && is_planar(&around) {
            return Ok(Removed::Flat);
        }
        let most = match always {
            true => usize::MAX,
            false => HUB * self.counts.vertices as usize + HUB_LEAST,
        };
        if !self.fill_hole(&around, most, pace)? {
            return Ok(Removed::Hub);
        }
        self.apply()?;
        self.sites.get_mut(v as usize).near = NONE;
        self.counts.vertices -= 1;
        Ok(Removed::Done)
    }

    /// The finite corners of the facets around the hole.
    fn neighbors(&self) -> Result<Vec<(u32, Point3)>> {
        let mut around = with_room(3 * self.patch.rim.len())?;
        for &e in &self.patch.rim {
            around.extend(self.facet(e).map(|v| (v, self.at(v))));
        }
        around.retain(|&(v, _)| v != INFINITE);
        around.sort_unstable_by_key(|&(v, _)| v);
        around.dedup_by_key(|&mut (v, _)| v);
        Ok(around)
    }

    /// Whether all tetrahedra are to be replaced.
    fn is_cone(&self) -> bool {
        let finite = |&&t: &&u32| self.infinite_corner(t).is_none();
        self.patch.dead.iter().filter(finite).count() == self.counts.simplices as usize
    }

    /// Fills the hole with tetrahedra of these corners and with ghosts; `false` if it takes more than
    /// `most` tests.
    fn fill_hole(
        &mut self,
        around: &[(u32, Point3)],
        most: usize,
        pace: &mut Pace,
    ) -> Result<bool> {
        self.open_rim()?;
        let mut tests = 0;
        while let Some([a, b, c]) = self.patch.next_open() {
            pace.spend(around.len())?;
            tests += around.len();
            if tests > most {
                return Ok(false);
            }
            let facet = [a, b, c].map(|v| self.at(v));
            let apex = lowest(facet, around).unwrap_or(INFINITE);
            self.patch.add([a, b, c, apex])?;
        }
        self.work += self.patch.made.len();
        Ok(true)
    }

    /// Moves vertex `v`, which is in the mesh, to `p` if the same tetrahedra remain right; otherwise
    /// nothing changes. Vertices of the hull do not move in this way.
    pub fn shift(&mut self, v: u32, p: Point3) -> Result<bool> {
        self.gather(v)?;
        let dead = &self.patch.dead;
        for &t in dead {
            let corners = self.corners(t);
            let moved = corners.map(|w| if w == v { p } else { self.at(w) });
            let [a, b, c, d] = moved;
            // At the vertex at infinity the orientation is zero.
            if orient3d(a, b, c, d) != Sign::Positive {
                return Ok(false);
            }
            for e in self.opposites(t) {
                let apex = self.apex(e);
                if apex == INFINITE {
                    continue;
                }
                if insphere_canonical(a, b, c, d, self.at(apex)) == Sign::Positive {
                    return Ok(false);
                }
            }
        }
        self.sites.get_mut(v as usize).at = p;
        Ok(true)
    }
}

/// Of the points strictly on the inner side of a facet, the one that spans the lowest plane with it.
fn lowest([a, b, c]: [Point3; 3], around: &[(u32, Point3)]) -> Option<u32> {
    let mut best: Option<(u32, Point3)> = None;
    for &(v, p) in around {
        if orient3d(a, b, c, p) != Sign::Positive {
            continue;
        }
        let lower = |&(_, q): &(u32, Point3)| insphere_canonical(a, b, c, q, p) == Sign::Positive;
        if best.as_ref().is_none_or(lower) {
            best = Some((v, p));
        }
    }
    best.map(|(v, _)| v)
}

/// Whether points are in one plane.
fn is_planar(points: &[(u32, Point3)]) -> bool {
    let Some(&(_, a)) = points.first() else {
        return true;
    };
    let Some(&(_, b)) = points.get(1) else {
        return true;
    };
    let rest = &points[2..];
    let Some(&(_, c)) = rest.iter().find(|q| !collinear(a, b, q.1)) else {
        return true;
    };
    rest.iter().all(|q| orient3d(a, b, c, q.1).is_zero())
}
