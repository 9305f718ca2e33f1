//! Voronoi cells as polygons.

use delone_core::error::Result;
use delone_core::memory::copied;
use delone_core::voronoi::{Measures, Polygons};

use crate::Point2;

/// Voronoi cells cut to a box; made by [`Voronoi::clip`](crate::Voronoi::clip).
///
/// Cells are numbered as the points are. A row that repeats a point has an empty cell.
#[derive(Debug)]
pub struct Cells {
    /// The polygon of each point, or -1.
    of_point: Vec<i32>,
    polygons: Polygons,
    measures: Measures,
}

impl Cells {
    pub(crate) fn of(of_point: &[i32], polygons: Polygons, measures: Measures) -> Result<Self> {
        Ok(Self {
            of_point: copied(of_point)?,
            polygons,
            measures,
        })
    }

    fn number(&self, row: usize) -> Option<usize> {
        usize::try_from(*self.of_point.get(row)?).ok()
    }

    /// The corners of the cell of a point, counter-clockwise; none if the cell is empty.
    pub fn polygon(&self, row: usize) -> &[Point2] {
        self.number(row).map_or(&[], |cell| {
            let starts = &self.polygons.starts;
            &self.polygons.points[starts[cell] as usize..starts[cell + 1] as usize]
        })
    }

    /// The area of the cell of a point.
    pub fn area(&self, row: usize) -> f64 {
        self.number(row)
            .map_or(0.0, |cell| self.measures.areas[cell])
    }

    /// The centroid of the cell of a point; `None` if the cell is empty.
    pub fn centroid(&self, row: usize) -> Option<Point2> {
        let centroid = self.measures.centroids[self.number(row)?];
        centroid.iter().all(|x| x.is_finite()).then_some(centroid)
    }
}
