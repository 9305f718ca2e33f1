//! The beach line: arcs from bottom to top in a linked list, with a splay tree to find the arc at a
//! height.
//!
//! D. D. Sleator and R. E. Tarjan, "Self-adjusting binary search trees", Journal of the ACM 32
//! (1985): amortized O(log n) per search, with no balance to maintain.

use delone_predicates::sweep::front;
use delone_predicates::{Point2, Sign};

use crate::mesh::plane::Code;

/// A point and its number as a vertex.
pub type Site = (Point2, u32);

/// No arc.
pub const NONE: u32 = u32::MAX;

/// An arc, and the edge between its point and that of the arc above it.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    pub point: Point2,
    pub vertex: u32,
    pub below: u32,
    pub above: u32,
    parent: u32,
    child: [u32; 2],
    /// The half-edge on the left of the edge, if there is a triangle.
    pub across: Code,
    /// If there is none, the arc whose edge is the same in the other direction.
    pub twin: u32,
    /// The slot of its circle in the heap.
    pub slot: u32,
}

/// The arcs, in a tree whose in-order sequence is the list.
#[derive(Debug)]
pub struct Beach {
    pub arcs: Vec<Arc>,
    free: Vec<u32>,
    root: u32,
}

impl Default for Beach {
    fn default() -> Self {
        Self {
            arcs: Vec::new(),
            free: Vec::new(),
            root: NONE,
        }
    }
}

/// Whether `q`, which the line has just met, is at or above the boundary between a's arc and b's,
/// the next one above.
///
/// Of two parabolas the one whose point is nearer to the line is narrower and in front between
/// their two crossings, which enclose its own height. If that is b's, this is the lower crossing: q
/// is above it if it is above b or if b is in front at its height. If it is a's, this is the upper
/// crossing. If both points are equally near there is only one crossing.
fn beyond(a: Point2, b: Point2, q: Point2) -> bool {
    if a[0] < b[0] {
        q[1] >= b[1] || front(a, b, q) != Sign::Negative
    } else if a[0] > b[0] {
        q[1] > a[1] && front(a, b, q) != Sign::Negative
    } else {
        // If both points are on the line, their arcs are rays, below q.
        front(a, b, q) != Sign::Negative
    }
}

impl Beach {
    /// The lowest arc.
    pub fn lowest(&self) -> u32 {
        let mut arc = self.root;
        while let Some(a) = self.arcs.get(arc as usize)
            && a.child[0] != NONE
        {
            arc = a.child[0];
        }
        arc
    }

    /// The points of an arc and of its two neighbors, if it has both.
    pub fn triple(&self, arc: u32) -> Option<[Point2; 3]> {
        let at = |i: u32| self.arcs.get(i as usize);
        let arc = at(arc)?;
        Some([at(arc.below)?.point, arc.point, at(arc.above)?.point])
    }

    /// The arc at the height of `q`. Terminates because it descends a tree.
    pub fn find(&mut self, q: Point2) -> Option<u32> {
        let mut at = self.root;
        loop {
            let arc = self.arcs.get(at as usize)?;
            // The lowest and the highest arc extend to infinity.
            if let Some(below) = self.arcs.get(arc.below as usize)
                && !beyond(below.point, arc.point, q)
            {
                at = arc.child[0];
            } else if let Some(above) = self.arcs.get(arc.above as usize)
                && beyond(arc.point, above.point, q)
            {
                at = arc.child[1];
            } else {
                self.splay(at, NONE);
                return Some(at);
            }
        }
    }

    /// Inserts the arc of `site` above `below`, or as the only one.
    pub fn insert_after(&mut self, below: u32, site: Site) -> u32 {
        let mut arc = Arc {
            point: site.0,
            vertex: site.1,
            below,
            above: NONE,
            parent: NONE,
            child: [NONE; 2],
            across: 0,
            twin: NONE,
            slot: NONE,
        };
        let new = self.free.pop().unwrap_or(self.arcs.len() as u32);
        if below != NONE {
            //       below                new
            //      /     \     ->       /    \
            //     L       R        below      R
            //                      /
            //                     L
            self.splay(below, NONE);
            let old = &mut self.arcs[below as usize];
            (arc.above, arc.child) = (old.above, [below, old.child[1]]);
            (old.above, old.child[1], old.parent) = (new, NONE, new);
            for (i, after) in [(arc.above, false), (arc.child[1], true)] {
                if i == NONE {
                    continue;
                }
                let other = &mut self.arcs[i as usize];
                *(if after {
                    &mut other.parent
                } else {
                    &mut other.below
                }) = new;
            }
        }
        self.root = new;
        if new as usize == self.arcs.len() {
            self.arcs.push(arc);
        } else {
            self.arcs[new as usize] = arc;
        }
        new
    }

    /// Splits `arc` by that of `site`. Returns the two pieces beside it.
    pub fn split(&mut self, arc: u32, site: Site) -> [u32; 2] {
        let old = self.arcs[arc as usize];
        let new = self.insert_after(arc, site);
        let upper = self.insert_after(new, (old.point, old.vertex));
        // The edge above moves to the upper piece; the edge to the new point is traversed twice.
        let part = &mut self.arcs[upper as usize];
        (part.across, part.twin) = (old.across, old.twin);
        if old.twin != NONE {
            self.arcs[old.twin as usize].twin = upper;
        }
        self.arcs[arc as usize].twin = new;
        self.arcs[new as usize].twin = arc;
        [arc, upper]
    }

    /// Removes an arc that has a neighbor on either side.
    pub fn remove(&mut self, arc: u32) {
        let Arc { below, above, .. } = self.arcs[arc as usize];
        //      below               below
        //     /     \             /     \        Consecutive arcs meet at the root, with
        //    L      arc     ->   L       R       nothing between them.
        //              \
        //               R
        self.splay(below, NONE);
        self.splay(arc, below);
        let rest = self.arcs[arc as usize].child[1];
        self.arcs[below as usize].child[1] = rest;
        if rest != NONE {
            self.arcs[rest as usize].parent = below;
        }
        self.arcs[below as usize].above = above;
        self.arcs[above as usize].below = below;
        self.free.push(arc);
    }

    /// Rotates `arc` up until its parent is `top`, by two levels where possible.
    fn splay(&mut self, arc: u32, top: u32) {
        loop {
            let parent = self.arcs[arc as usize].parent;
            if parent == top {
                return;
            }
            let grand = self.arcs[parent as usize].parent;
            if grand != top {
                let aligned = self.side(arc, parent) == self.side(parent, grand);
                self.rotate(if aligned { parent } else { arc });
            }
            self.rotate(arc);
        }
    }

    fn side(&self, child: u32, parent: u32) -> usize {
        usize::from(self.arcs[parent as usize].child[1] == child)
    }

    /// Rotates an arc into the place of its parent.
    fn rotate(&mut self, arc: u32) {
        //       parent            arc
        //       /    \           /   \          or mirrored
        //     arc     C   ->    A   parent
        //    /   \                  /    \
        //   A     B                B      C
        let parent = self.arcs[arc as usize].parent;
        let grand = self.arcs[parent as usize].parent;
        let side = self.side(arc, parent);
        let inner = self.arcs[arc as usize].child[1 - side];
        self.arcs[parent as usize].child[side] = inner;
        if inner != NONE {
            self.arcs[inner as usize].parent = parent;
        }
        if grand == NONE {
            self.root = arc;
        } else {
            let place = self.side(parent, grand);
            self.arcs[grand as usize].child[place] = arc;
        }
        let a = &mut self.arcs[arc as usize];
        (a.child[1 - side], a.parent) = (parent, grand);
        self.arcs[parent as usize].parent = arc;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(beach: &Beach) -> Vec<u32> {
        let mut arcs = Vec::new();
        let mut arc = beach.lowest();
        while arc != NONE {
            arcs.push(beach.arcs[arc as usize].vertex);
            arc = beach.arcs[arc as usize].above;
        }
        arcs
    }

    #[test]
    fn arcs_stay_in_order() {
        let mut beach = Beach::default();
        let first = beach.insert_after(NONE, ([0.0, 0.0], 0));
        let [lower, upper] = beach.split(first, ([1.0, 0.0], 1));
        assert_eq!(listed(&beach), [0, 1, 0]);
        assert_eq!(beach.find([2.0, 0.5]), Some(1));
        assert_eq!(beach.find([2.0, 9.0]), Some(upper));
        assert_eq!(beach.find([2.0, -9.0]), Some(lower));
        beach.split(upper, ([2.0, 9.0], 2));
        assert_eq!(listed(&beach), [0, 1, 0, 2, 0]);
        beach.remove(upper);
        assert_eq!(listed(&beach), [0, 1, 2, 0]);
        beach.insert_after(lower, ([3.0, -1.0], 3));
        assert_eq!(listed(&beach), [0, 3, 1, 2, 0]);
    }
}
