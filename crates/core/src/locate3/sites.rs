//! The nearest vertex of any tetrahedra, by boxes over the vertices along the curve.
//!
//! A walk over the edges of a Delaunay triangulation finds it, too, but meets 27 tetrahedra around each
//! vertex on the way; boxes need no triangulation, and ask some twenty points.

use delone_predicates::{Point3, Sign, nearer3};

use super::tiling::Tetrahedra;
use crate::error::Result;
use crate::locate::{Boxes, length};
use crate::memory::{filled, with_room};
use crate::order::order_of;
use crate::points::Extent;

/// The vertices of tetrahedra along the curve, and boxes over them.
#[derive(Debug)]
pub struct Sites {
    rows: Vec<i32>,
    points: Vec<Point3>,
    boxes: Boxes<3>,
}

impl Sites {
    /// The vertices that tetrahedra have.
    pub fn of(given: &Tetrahedra) -> Result<Self> {
        let mut used = filled(given.points.len(), false)?;
        for &v in given.simplices.as_flattened() {
            used[v as usize] = true;
        }
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
        let order = order_of(&points, 1)?.concat();
        let mut rows = with_room(count)?;
        rows.extend(order.iter().map(|&i| vertices[i as usize]));
        points.clear();
        points.extend(rows.iter().map(|&v| given.point(v)));
        let box_of = |i: usize| Extent::of([points[i]]);
        Ok(Self {
            boxes: Boxes::packed((0..count as u32).collect(), box_of),
            rows,
            points,
        })
    }

    /// The nearest one to `q`, of several the first row; `last` is the one before, of a query near by.
    pub fn nearest(&self, q: Point3, last: &mut Option<usize>) -> i32 {
        let mut best: Option<usize> = None;
        let mut within = f64::INFINITY;
        self.boxes.toward(q, *last, |i, unit| {
            let nearer = |&other: &usize| match nearer3(q, self.points[i], self.points[other]) {
                Sign::Positive => true,
                Sign::Zero => self.rows[i] < self.rows[other],
                Sign::Negative => false,
            };
            if best.as_ref().is_none_or(nearer) {
                best = Some(i);
                let away = [0, 1, 2].map(|k| self.points[i][k] * unit - q[k] * unit);
                // A little more, so that no rounding leaves a box out.
                within = length(away) * (1.0 + 1e-14) + f64::MIN_POSITIVE;
            }
            within
        });
        *last = best;
        best.map_or(-1, |i| self.rows[i])
    }
}
