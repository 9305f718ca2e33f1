//! The first of any triangles that holds a point, by a tree of their boxes: for arrays with holes or
//! a concave boundary, where a walk that leaves proves nothing.
//!
//! Triangles are taken along the curve, eight to a box, eight boxes to the next, and so on (as in an
//! R-tree packed along the Hilbert curve: I. Kamel and C. Faloutsos, 1993).

use delone_predicates::{Point2, Sign, orient2d};

use super::star::Place;
use crate::delaunay2::validate::Given;
use crate::error::Result;
use crate::memory::with_room;
use crate::order::curve;
use crate::points::Extent;

/// Boxes, or triangles, in a box.
const WIDTH: usize = 8;

/// The tree.
#[derive(Debug)]
pub struct Boxes {
    /// Triangles along the curve.
    order: Vec<u32>,
    /// The boxes of each level, from the triangles up to one.
    levels: Vec<Vec<Extent>>,
}

impl Boxes {
    /// A tree of all triangles.
    pub fn of(given: &Given) -> Result<Self> {
        let m = given.simplices.len();
        let mut middles = with_room(m)?;
        middles.extend((0..m).map(|t| {
            let [a, b, c] = given.corners(t);
            [0, 1].map(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0)
        }));
        let order = curve::order_of(&middles, 1)?.concat();
        let box_of = |run: &[u32]| Extent::of(run.iter().flat_map(|&t| given.corners(t as usize)));
        let mut level: Vec<Extent> = order.chunks(WIDTH).map(box_of).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let join = |run: &[Extent]| Extent::of(run.iter().flat_map(|e| [e.min, e.max]));
            let above = level.chunks(WIDTH).map(join).collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Ok(Self { order, levels })
    }

    /// The first triangle whose closed area has `q`.
    pub fn first(&self, given: &Given, q: Point2) -> Option<Place> {
        let mut best: Option<Place> = None;
        let mut open = vec![(self.levels.len() - 1, 0)];
        while let Some((level, i)) = open.pop() {
            let Some(extent) = self.levels[level].get(i) else {
                continue;
            };
            let within = |k: usize| extent.min[k] <= q[k] && q[k] <= extent.max[k];
            if !(within(0) && within(1)) {
                continue;
            }
            let children = i * WIDTH..(i + 1) * WIDTH;
            if level > 0 {
                open.extend(children.map(|child| (level - 1, child)));
                continue;
            }
            let end = children.end.min(self.order.len());
            for &t in &self.order[children.start..end] {
                let triangle = t as usize;
                if best.is_none_or(|b| triangle < b.triangle)
                    && let Some(on) = holds(given, triangle, q)
                {
                    best = Some(Place { triangle, on });
                }
            }
        }
        best
    }
}

/// On which edges `q` is, where the closed triangle has it.
fn holds(given: &Given, t: usize, q: Point2) -> Option<[bool; 3]> {
    let [a, b, c] = given.corners(t);
    let signs = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)];
    (!signs.contains(&Sign::Negative)).then(|| signs.map(|s| s == Sign::Zero))
}
