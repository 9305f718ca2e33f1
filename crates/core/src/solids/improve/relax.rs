//! Coarsening and smoothing: changes that need not improve the worst tetrahedron, as long as it stays
//! above a bound.
//!
//! The *optimal Delaunay* position of a vertex, the mean of the circumcenters of its tetrahedra weighted by
//! their volumes, is from L. Chen and J. Xu, "Optimal Delaunay triangulations", Journal of Computational Mathematics 22 (2004);
//! P. Alliez, D. Cohen-Steiner, M. Yvinec and M. Desbrun, "Variational tetrahedral meshing", ACM
//! Transactions on Graphics 24 (2005).
//!
//! # Why angles stay
//!
//! A change is made only if the bounds of `measure` prove that the worst quality and the smallest acute
//! angle of the tetrahedra concerned are at least the bound, or what they were before if that is
//! less. So an angle above the bound stays above it, and the smallest one below it does not decrease.

use delone_predicates::Point3;

use super::contract;
use super::measure::{Bounds, Vector, cross, dot, minus, plus};
use super::store::{FACES, Store};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::target::Target;
use crate::base::watch::{Pace, Watch};

/// Tetrahedra between two checks for interruption.
const LOT: usize = 1 << 12;
/// How often a move is halved before it is given up.
const HALVINGS: usize = 4;
/// A change is tried if its computed quality is at least this times the bound; the proof comes later.
const SLACK: f64 = 1.0 - 1e-9;

impl Bounds {
    /// Whether these are certainly at least `bound`, or what they were before if that is less.
    fn keep(self, before: Self, bound: f64) -> bool {
        let kept = |now: [f64; 2], then: [f64; 2]| now[0] >= bound.min(then[1]);
        kept(self.least, before.least) && kept(self.acute, before.acute)
    }
}

impl Work<'_> {
    /// Removes vertices, no two of which are neighbors, where the bound allows it.
    pub fn coarsen(&mut self, watch: &Watch) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        let mut held = filled(self.store.points.len(), false)?;
        for v in 0..held.len() as u32 {
            if held[v as usize] || !self.may_vanish(v) {
                continue;
            }
            self.store.star(v, &mut self.around)?;
            pace.spend(self.around.len())?;
            let qualities = self.around.iter().map(|&t| self.store.quality[t as usize]);
            let floor = qualities.fold(self.bound, f64::min);
            let plan = contract::remove(&self.store, v, &self.around, SLACK * floor);
            let Some(plan) = plan else {
                continue;
            };
            // Its neighbors are not removed in this round.
            for &t in &self.around {
                for w in self.store.corners[t as usize] {
                    held[w as usize] = true;
                }
            }
            let bound = self.bound;
            if self.carry_out(&plan, |now, before| now.keep(before, bound))? {
                self.vanished(v);
            } else {
                self.counts.refused += 1;
            }
        }
        Ok(())
    }

    /// Moves vertices to their targets, or as far as the bound allows; false if none moved.
    pub fn relax(&mut self, target: Target, watch: &Watch) -> Result<bool> {
        let mut pace = Pace::new(watch, LOT);
        let before = self.counts.moves;
        for v in 0..self.store.points.len() as u32 {
            if self.store.fixed[v as usize] || !self.store.is_used(v) {
                continue;
            }
            self.store.star(v, &mut self.around)?;
            pace.spend(self.around.len())?;
            let here = self.store.points[v as usize];
            let Some(there) = place(&self.store, v, &self.around, target) else {
                continue;
            };
            let bound = self.bound;
            let mut share = 1.0;
            for _ in 0..=HALVINGS {
                let x = plus(here, share, minus(there, here));
                if x == here {
                    break;
                }
                if self.try_move(v, x, |now, before| now.keep(before, bound)) {
                    self.counts.moves += 1;
                    break;
                }
                share *= 0.5;
            }
        }
        self.counts.passes += 1;
        Ok(self.counts.moves > before)
    }
}

/// The target of a vertex; `None` if it is not finite.
fn place(store: &Store, v: u32, star: &[u32], target: Target) -> Option<Point3> {
    let here = store.points[v as usize];
    let (mut weight, mut sum) = (0.0, [0.0; 3]);
    if target == Target::Laplace {
        let corners = star.iter().flat_map(|&t| store.corners[t as usize]);
        let mut neighbors: Vec<u32> = corners.filter(|&u| u != v).collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        weight = neighbors.len() as f64;
        for u in neighbors {
            sum = plus(sum, 1.0, minus(store.points[u as usize], here));
        }
    } else {
        for &t in star {
            // The other corners, counterclockwise as seen from the vertex's side of their face.
            let corners = store.corners[t as usize];
            let k = corners.iter().position(|&u| u == v)?;
            let others = FACES[k].map(|i| minus(store.points[corners[i] as usize], here));
            let (part, moment) = match target {
                Target::Lloyd => covered(others),
                _ => centered(others),
            };
            weight += part;
            sum = plus(sum, 1.0, moment);
        }
    }
    let found = plus(here, 1.0 / weight, sum);
    found.iter().all(|x| x.is_finite()).then_some(found)
}

/// Six times the volume of a tetrahedron with a corner at the origin, and its circumcenter multiplied by
/// it, which is finite for flat tetrahedra, too.
fn centered([b, c, d]: [Vector; 3]) -> (f64, Vector) {
    let mut moment = [0.0; 3];
    for (e, normal) in [(b, cross(d, c)), (c, cross(b, d)), (d, cross(c, b))] {
        moment = plus(moment, 0.5 * dot(e, e), normal);
    }
    (dot(cross(c, b), d), moment)
}

/// The part of a tetrahedron in the Voronoi cell of its corner at the origin: six times its volume, and
/// its centroid multiplied by it.
///
/// It is the sum of six signed tetrahedra. The corners of each are this corner, the midpoint of an edge,
/// the circumcenter of a face at the edge, and that of the tetrahedron.
fn covered([b, c, d]: [Vector; 3]) -> (f64, Vector) {
    let (volume, moment) = centered([b, c, d]);
    let center = moment.map(|x| x / volume);
    let (mut part, mut sum) = (0.0, [0.0; 3]);
    for (e, f) in [(b, c), (c, d), (d, b)] {
        let normal = cross(e, f);
        let both = plus(
            cross(normal, e).map(|x| x * dot(f, f)),
            dot(e, e),
            cross(f, normal),
        );
        let face = both.map(|x| x / (2.0 * dot(normal, normal)));
        for (edge, sign) in [(e, -1.0), (f, 1.0)] {
            let middle = edge.map(|x| 0.5 * x);
            let signed = sign * dot(cross(middle, face), center);
            let corners = plus(plus(middle, 1.0, face), 1.0, center);
            part += signed;
            sum = plus(sum, 0.25 * signed, corners);
        }
    }
    (part, sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A corner of a cube: its circumcenter is the center of the cube, which is beyond the face.
    const CORNER: [Vector; 3] = [[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]];

    #[test]
    fn both_measures_are_kept() {
        let bounds = |least: f64, acute: f64| Bounds {
            least: [least; 2],
            acute: [acute; 2],
        };
        let before = bounds(0.2, 0.3);
        for (least, acute, kept) in [
            (0.2, 0.3, true),
            (0.19, 0.3, false),
            (0.2, 0.25, false),
            (0.5, 0.5, true),
        ] {
            assert_eq!(bounds(least, acute).keep(before, 0.4), kept);
        }
        // Above the bound, anything is allowed.
        assert!(bounds(0.1, 0.1).keep(before, 0.1));
    }

    #[test]
    fn a_circumcenter_is_multiplied_by_the_volume() {
        let (volume, moment) = centered(CORNER);
        assert_eq!((volume, moment), (8.0, [8.0; 3]));
    }

    #[test]
    fn the_parts_of_the_corners_make_up_the_tetrahedron() {
        let points: [Point3; 4] = [
            [0.0, 0.0, 0.0],
            [3.0, 0.2, 0.0],
            [0.3, 4.0, 0.1],
            [1.0, 1.5, 3.0],
        ];
        let (mut volume, mut sum) = (0.0, [0.0; 3]);
        for (k, face) in FACES.iter().enumerate() {
            let corner = points[k];
            let (part, moment) = covered(face.map(|i| minus(points[i], corner)));
            volume += part;
            sum = plus(plus(sum, 1.0, moment), part, corner);
        }
        let [b, c, d] = [1, 2, 3].map(|i| minus(points[i], points[0]));
        let whole = dot(cross(b, c), d);
        assert!((volume - whole).abs() < 1e-12, "{volume} {whole}");
        for k in 0..3 {
            let mean = points.iter().map(|p| p[k]).sum::<f64>() / 4.0;
            assert!((sum[k] / volume - mean).abs() < 1e-12);
        }
        // At the corner of a cube, the part is a cube of half its side, as a sum with signs.
        assert_eq!(covered(CORNER), (6.0, [3.0; 3]));
    }
}
