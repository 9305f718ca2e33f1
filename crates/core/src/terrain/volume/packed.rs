//! Copies of surfaces with points in the order in which triangles need them: what is needed
//! together is adjacent in memory, whatever the order of the rows of points.

use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::{copied, filled, with_room};
use crate::base::watch::{Pace, Watch};
use delone_predicates::Point2;

use super::parts::Surface;

/// Triangles between two checks for interruption.
const LOT: usize = 1 << 16;

/// A surface with other numbers of vertices; rows of triangles are the same.
pub struct Packed {
    points: Vec<Point2>,
    heights: Vec<f64>,
    simplices: Vec<[i32; 3]>,
}

impl Packed {
    /// A copy, where triangles are needed in an order.
    pub fn of(
        surface: &Surface,
        order: impl Iterator<Item = usize>,
        watch: &Watch,
    ) -> Result<Self> {
        let given = surface.given;
        let mut number = filled(given.points.len(), -1)?;
        let mut simplices = copied(given.simplices)?;
        let mut points = with_room(given.points.len())?;
        let mut heights = with_room(given.points.len())?;
        let mut pace = Pace::new(watch, LOT);
        for t in order {
            pace.spend(1)?;
            for v in &mut simplices[t] {
                let row = *v as usize;
                if number[row] < 0 {
                    number[row] = points.len() as i32;
                    points.push(given.points[row]);
                    heights.push(surface.heights[row]);
                }
                *v = number[row];
            }
        }
        Ok(Self {
            points,
            heights,
            simplices,
        })
    }

    /// The surface, with the neighbors of what was copied.
    pub fn surface<'a>(&'a self, neighbors: &'a [[i32; 3]]) -> Surface<'a> {
        Surface {
            given: Triangles {
                points: &self.points,
                simplices: &self.simplices,
                neighbors,
            },
            heights: &self.heights,
        }
    }
}
