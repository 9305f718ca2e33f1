//! Conforming triangulations: segments are split until the diametral circle of each subsegment is
//! empty.
//!
//! Then each subsegment is also an edge of the unconstrained Delaunay triangulation of all
//! vertices.
//!
//! J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", Journal
//! of Algorithms 18 (1995). It suffices to check the two triangles of a subsegment: if its
//! diametral circle contains a vertex that another segment hides, then the circle of some
//! subsegment in between contains a visible one.
//!
//! A subsegment is split at its midpoint. If one of its ends is a vertex of the input or a
//! crossing, it is split at a distance from that end that is a power of two. So subsegments that
//! meet at a sharp corner are split on common circles around it and stop encroaching upon each
//! other, which makes this terminate. A limit on vertices ends it in any case.
//!

use delone_predicates::{Point2, Sign, angle, lexicographic};

use super::split::Splitter;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::mesh::plane::{half_edges, next, prev};

impl Splitter<'_> {
    /// Splits subsegments until all diametral circles are empty, except between neighboring
    /// doubles.
    pub fn conform(&mut self) -> Result<()> {
        let corners = self.marked.count as u32;
        let mut parted = true;
        while std::mem::take(&mut parted) {
            for [u, v] in self.encroached()? {
                self.pace.spend(1)?;
                // An earlier split may have removed the subsegment or the encroaching vertex.
                if !self.is_piece([u, v]) {
                    continue;
                }
                let e = self.marked.edge(u, v)?;
                if self.encroaches(e) {
                    let x = self.cut(u, v, corners);
                    let w = self.split_piece([u, v], x, e)?;
                    parted |= w != u && w != v;
                    self.insert_queued()?;
                }
            }
        }
        Ok(())
    }

    /// The subsegments encroached by a visible vertex, in an order that depends on coordinates
    /// only.
    fn encroached(&mut self) -> Result<Vec<[u32; 2]>> {
        let mut found = with_room(64)?;
        for e in (0..self.marked.triangles()).flat_map(half_edges) {
            if e.is_multiple_of(8 << 14) {
                self.pace.watch().check()?;
            }
            let mesh = self.marked.patch();
            let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
            if u < v && mesh.is_marked(e) && self.encroaches(e) {
                found.push([u, v]);
            }
        }
        let at = |v: u32| self.marked.at(v);
        for ends in &mut found {
            ends.sort_by(|&u, &v| lexicographic(at(u), at(v)));
        }
        found.sort_by(|s, t| {
            let by = |k: usize| lexicographic(at(s[k]), at(t[k]));
            by(0).then_with(|| by(1))
        });
        Ok(found)
    }

    /// Whether the apex on one side of the edge `e` lies in its diametral circle.
    fn encroaches(&mut self, e: u32) -> bool {
        let mesh = self.marked.patch();
        let inf = mesh.infinite();
        let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
        let apexes = [e, mesh.opposite(e)].map(|c| mesh.vertex(c));
        let at = |v: u32| self.marked.points[v as usize];
        apexes
            .into_iter()
            .any(|p| p != inf && angle(at(u), at(p), at(v)) == Sign::Negative)
    }

    /// Where the subsegment u v is split. Vertices below `corners` are of the input or crossings.
    fn cut(&self, u: u32, v: u32, corners: u32) -> Point2 {
        let [u, v] = if u < corners { [u, v] } else { [v, u] };
        let sharp = u < corners && v >= corners;
        cut(self.marked.at(u), self.marked.at(v), sharp)
    }
}

/// Where a subsegment is split: at its midpoint, or, if its first end is a sharp corner, on a
/// circle around that corner whose radius is a power of two (J. Ruppert, 1995), so that the splits
/// of subsegments which meet there agree.
pub(crate) fn cut(p: Point2, q: Point2, sharp: bool) -> Point2 {
    let length = (q[0] - p[0]).hypot(q[1] - p[1]);
    let share = if sharp { shell(length) / length } else { 0.5 };
    // If lengths overflow, use one half; sums of halves never overflow.
    let share = if share.is_finite() { share } else { 0.5 };
    let between = |a: f64, b: f64| {
        let x = a * (1.0 - share) + b * share + 0.0;
        x.clamp(a.min(b), a.max(b))
    };
    [between(p[0], q[0]), between(p[1], q[1])]
}

/// The power of two between a third and two thirds of `length`.
fn shell(length: f64) -> f64 {
    let below = (length / 2.0).log2().floor().exp2();
    if below < length / 3.0 {
        2.0 * below
    } else {
        below
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_are_powers_of_two_in_the_middle_third() {
        for i in 1..2000 {
            let length = f64::from(i) * 0.37;
            let s = shell(length);
            assert!(s >= length / 3.0 && s <= length * 2.0 / 3.0);
            assert_eq!(s.log2().fract(), 0.0);
        }
        assert_eq!(cut([0.0, 0.0], [3.0, 0.0], true), [1.0, 0.0]);
        assert_eq!(cut([1e308, 0.0], [-1e308, 0.0], true), [0.0, 0.0]);
    }
}
