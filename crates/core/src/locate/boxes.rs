//! The first of any triangles that holds a point, and the nearest of any edges, by a tree of boxes:
//! for arrays with holes or a concave boundary, where a walk that leaves proves nothing.
//!
//! Items are taken along the curve, eight to a box, eight boxes to the next, and so on (as in an
//! R-tree packed along the Hilbert curve: I. Kamel and C. Faloutsos, 1993).

use delone_predicates::{Point2, Sign, orient2d};

use super::star::Place;
use crate::delaunay2::validate::Given;
use crate::error::Result;
use crate::memory::with_room;
use crate::order::curve;
use crate::points::Extent;

/// Boxes, or items, in a box.
const WIDTH: usize = 8;

/// The tree.
#[derive(Debug)]
pub struct Boxes {
    /// Items along the curve.
    order: Vec<u32>,
    /// The boxes of each level, from the items up to one.
    levels: Vec<Vec<Extent>>,
}

impl Boxes {
    /// A tree of all triangles.
    pub fn of(given: &Given) -> Result<Self> {
        Self::over(given.simplices.len(), |t| Extent::of(given.corners(t)))
    }

    /// A tree of items, by the box of each.
    pub fn over(count: usize, box_of: impl Fn(usize) -> Extent) -> Result<Self> {
        let mut middles = with_room(count)?;
        middles.extend((0..count).map(|i| {
            let Extent { min, max } = box_of(i);
            [0, 1].map(|k| min[k] / 2.0 + max[k] / 2.0)
        }));
        let order = curve::order_of(&middles, 1)?.concat();
        let ends = |e: Extent| [e.min, e.max];
        let join_items =
            |run: &[u32]| Extent::of(run.iter().flat_map(|&i| ends(box_of(i as usize))));
        let mut level: Vec<Extent> = order.chunks(WIDTH).map(join_items).collect();
        let mut levels = Vec::new();
        while level.len() > 1 {
            let join = |run: &[Extent]| Extent::of(run.iter().flat_map(|e| [e.min, e.max]));
            let above = level.chunks(WIDTH).map(join).collect();
            levels.push(std::mem::replace(&mut level, above));
        }
        levels.push(level);
        Ok(Self { order, levels })
    }

    /// The item of least distance from `q`, of several the first, with that distance. No item may be
    /// nearer than its box, but for rounding.
    pub fn nearest(&self, q: Point2, distance: impl Fn(usize) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let mut open = vec![(0.0, self.levels.len() - 1, 0)];
        while let Some((bound, level, i)) = open.pop() {
            if best.is_some_and(|(_, least)| bound > least) || i >= self.levels[level].len() {
                continue;
            }
            let children = i * WIDTH..(i + 1) * WIDTH;
            if level > 0 {
                let end = children.end.min(self.levels[level - 1].len());
                let from = open.len();
                open.extend((children.start..end).map(|child| {
                    let away = bound_from(&self.levels[level - 1][child], q);
                    (away, level - 1, child)
                }));
                // The nearest box comes last, that is, next.
                open[from..].sort_by(|a, b| b.0.total_cmp(&a.0));
                continue;
            }
            let end = children.end.min(self.order.len());
            for &item in &self.order[children.start..end] {
                let here = (item as usize, distance(item as usize));
                let before = |(item, least): (usize, f64)| {
                    here.1.total_cmp(&least).then(here.0.cmp(&item)).is_lt()
                };
                if best.is_none_or(before) {
                    best = Some(here);
                }
            }
        }
        best
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

/// A distance that nothing in the box falls short of, roundings of both allowed for.
fn bound_from(extent: &Extent, q: Point2) -> f64 {
    let gap = |k: usize| (extent.min[k] - q[k]).max(q[k] - extent.max[k]).max(0.0);
    gap(0).hypot(gap(1)) * (1.0 - 1e-14)
}

/// On which edges `q` is, where the closed triangle has it.
fn holds(given: &Given, t: usize, q: Point2) -> Option<[bool; 3]> {
    let [a, b, c] = given.corners(t);
    let signs = [orient2d(b, c, q), orient2d(c, a, q), orient2d(a, b, q)];
    (!signs.contains(&Sign::Negative)).then(|| signs.map(|s| s == Sign::Zero))
}
