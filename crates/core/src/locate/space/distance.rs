//! Distances from triangles, segments and points, rounded.
//!
//! A segment is a triangle two of whose corners are one vertex, and a point one with a single
//! vertex. Each query is a search in a tree of boxes, independent of all others.

use delone_predicates::Point3;

use super::face::on_face;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel::map_watched;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::Boxes;
use crate::locate::boxes::bound_from;

/// Queries of one task.
const LOT: usize = 1 << 12;
/// Queries between two checks for interruption.
const FEW: usize = 64;

/// Triangles in a tree.
#[derive(Debug)]
pub struct Distances {
    corners: Vec<[Point3; 3]>,
    boxes: Boxes<3>,
}

impl Distances {
    /// The tree of triangles, of which there is at least one.
    pub fn over(corners: Vec<[Point3; 3]>, watch: &Watch) -> Result<Self> {
        let boxes = Boxes::over(corners.len(), |i| Extent::of(corners[i]), watch)?;
        Ok(Self { corners, boxes })
    }

    /// The distance of each query from the nearest triangle.
    pub fn of(&self, queries: &[Point3], workers: usize, watch: &Watch) -> Result<Vec<f64>> {
        let lots = map_watched(workers, queries.chunks(LOT).collect(), watch, |lot| {
            let mut found = with_room(lot.len())?;
            let mut pace = Pace::new(watch, FEW);
            for &q in lot {
                pace.spend(1)?;
                found.push(self.from(q));
            }
            Ok(found)
        })?;
        let mut all = with_room(queries.len())?;
        all.extend(lots.into_iter().flatten());
        Ok(all)
    }

    fn from(&self, q: Point3) -> f64 {
        let mut best = (f64::INFINITY, 1.0);
        self.boxes.toward(q, None, |i, unit| {
            let corners = self.corners[i];
            // The box of a triangle is much faster to measure than the triangle.
            if bound_from(&Extent::of(corners), q, unit) <= best.0 {
                let (away, _) = on_face(corners, q, unit);
                if away < best.0 {
                    best = (away, unit);
                }
            }
            best.0
        });
        best.0 / best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    /// Points on a grid, so that triangles become segments and points, too.
    fn sample(random: &mut impl FnMut() -> f64) -> Point3 {
        std::array::from_fn(|_| (random() * 9.0).floor() - 4.0)
    }

    #[test]
    fn as_by_brute_force_and_with_any_number_of_workers() {
        let random = &mut uniform(7);
        let mut corners: Vec<[Point3; 3]> = Vec::new();
        for i in 0..300 {
            let first = sample(random).map(|x| x * 30.0);
            let mut near = || sample(random).map(|x| x * 20.0);
            corners.push(if i < 200 {
                [near(), near(), near()]
            } else {
                [first; 3]
            });
        }
        let queries: Vec<Point3> = (0..9000)
            .map(|i| sample(&mut *random).map(|x| x * 33.0 + f64::from(i) / 977.0))
            .collect();
        let watch = Watch::idle();
        let tree = Distances::over(corners.clone(), &watch).unwrap();
        let found = tree.of(&queries, 1, &watch).unwrap();
        assert_eq!(found.len(), queries.len());
        for (q, away) in queries.iter().zip(&found) {
            let all = corners.iter().map(|&t| on_face(t, *q, 1.0).0);
            assert_eq!(*away, all.fold(f64::INFINITY, f64::min));
        }
        for workers in [2, 3] {
            assert_eq!(tree.of(&queries, workers, &watch).unwrap(), found);
        }
    }

    #[test]
    fn far_coordinates() {
        let watch = Watch::idle();
        let corners = vec![[[-1e308, 0.0, 0.0]; 3], [[1.5e308, 0.0, 0.0]; 3]];
        let tree = Distances::over(corners, &watch).unwrap();
        let found = tree.of(&[[1e308, 0.0, 0.0], [0.0; 3]], 1, &watch).unwrap();
        assert_eq!(found, [0.5e308, 1e308]);
    }
}
