//! The nearest vertex in 2-D or 3-D, by boxes over the vertices along the curve.
//!
//! A walk over the edges of a Delaunay triangulation finds it, too, but tests all neighbors of each
//! vertex: in 3-D 27 tetrahedra around each on the way, in 2-D any number of triangles. Boxes need
//! no triangulation, and test some twenty points.

use delone_predicates::Sign;

use super::boxes::{Boxes, length};
use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::order::order_of;

/// Tetrahedra between two checks for interruption.
const LOT: usize = 1 << 16;

/// The vertices of simplices sorted along the curve, and boxes over them.
#[derive(Debug)]
pub struct Sites<const D: usize> {
    rows: Vec<i32>,
    points: Vec<[f64; D]>,
    boxes: Boxes<D>,
}

impl<const D: usize> Sites<D> {
    /// The vertices of all simplices.
    pub fn of<const N: usize>(given: &Given<D, N>, watch: &Watch) -> Result<Self> {
        let mut used = filled(given.points.len(), false)?;
        for lot in given.simplices.chunks(LOT) {
            watch.check()?;
            for &v in lot.as_flattened() {
                used[v as usize] = true;
            }
        }
        watch.check()?;
        let count = used.iter().filter(|&&used| used).count();
        let mut vertices = with_room(count)?;
        vertices.extend(
            (0i32..)
                .zip(&used)
                .filter(|(_, used)| **used)
                .map(|(v, _)| v),
        );
        let mut points = with_room(count)?;
        points.extend(vertices.iter().map(|&v| given.point(v)));
        let order = order_of(&points, 1, watch)?.concat();
        let mut rows = with_room(count)?;
        rows.extend(order.iter().map(|&i| vertices[i as usize]));
        points.clear();
        points.extend(rows.iter().map(|&v| given.point(v)));
        let box_of = |i: usize| Extent::of([points[i]]);
        Ok(Self {
            boxes: Boxes::packed((0..count as u32).collect(), box_of, watch)?,
            rows,
            points,
        })
    }

    /// The vertex nearest to `q`, the first row of several; `last` is the answer for the previous
    /// query, which is nearby. `nearer` tells, exactly, whether the second point is nearer to the
    /// first than the third is.
    pub fn nearest(
        &self,
        q: [f64; D],
        last: &mut Option<usize>,
        nearer: impl Fn([f64; D], [f64; D], [f64; D]) -> Sign,
    ) -> i32 {
        let mut best: Option<usize> = None;
        let mut within = f64::INFINITY;
        self.boxes.toward(q, *last, |i, unit| {
            let before = |&other: &usize| match nearer(q, self.points[i], self.points[other]) {
                Sign::Positive => true,
                Sign::Zero => self.rows[i] < self.rows[other],
                Sign::Negative => false,
            };
            if best.as_ref().is_none_or(before) {
                best = Some(i);
                let away: [f64; D] =
                    std::array::from_fn(|k| self.points[i][k] * unit - q[k] * unit);
                // A little more, so that rounding excludes no box.
                within = length(away) * (1.0 + 1e-14) + f64::MIN_POSITIVE;
            }
            within
        });
        *last = best;
        best.map_or(-1, |i| self.rows[i])
    }
}
