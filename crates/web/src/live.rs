//! A triangulation that is edited in place: what a page requests while a point is dragged.

use delone_core::live::plane::Plane;
use delone_core::base::watch::Watch;
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, answer, pairs, repeats};

/// A live triangulation. An edit that fails changes nothing.
#[wasm_bindgen]
#[derive(Default)]
pub struct Live {
    plane: Option<Plane>,
}

#[wasm_bindgen]
impl Live {
    /// No points.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins with these points, whose rows are 0, 1, and so on.
    pub fn start(&mut self, xy: &[f64]) -> Answer {
        answer(|| {
            let mut plane = Plane::new(pairs(xy), 1, &Watch::idle())?;
            // The changes of the first edit are those since this moment.
            plane.changes(&Watch::idle())?;
            self.plane = Some(plane);
            Ok((vec![], vec![]))
        })
    }

    /// Whether there is a point with this row.
    pub fn has(&self, row: i32) -> bool {
        self.plane
            .as_ref()
            .is_some_and(|plane| plane.has(row.into()))
    }

    /// Moves a point. Integers: the triangles that went, and those that came.
    pub fn relocate(&mut self, row: i32, x: f64, y: f64) -> Answer {
        self.edited(|plane| plane.relocate(&[row.into()], &[[x, y]], 1, &Watch::idle()))
    }

    /// Adds points, whose rows are the next ones. Integers as for a move.
    pub fn insert(&mut self, xy: &[f64]) -> Answer {
        self.edited(|plane| {
            plane.insert(pairs(xy), 1, &Watch::idle())?;
            Ok(())
        })
    }

    /// Removes points, whose rows are not used again. Integers as for a move.
    pub fn remove(&mut self, rows: &[i32]) -> Answer {
        let rows: Vec<i64> = rows.iter().map(|&row| row.into()).collect();
        self.edited(|plane| plane.remove(&rows, 1, &Watch::idle()))
    }

    /// Integers: the rows that are there, ascending; triangles and neighbors; duplicates. Triangles
    /// and duplicates name points by their position among these rows. Numbers: the points.
    pub fn state(&self) -> Answer {
        answer(|| {
            let Some(plane) = &self.plane else {
                return Ok((vec![], vec![]));
            };
            let found = plane.export(&Watch::idle())?;
            let rows = found.rows.iter().map(|&row| row as i32).collect();
            let (triangles, neighbors) = (found.arrays.simplices, found.arrays.neighbors);
            let integers = vec![
                rows,
                triangles.into_flattened(),
                neighbors.into_flattened(),
                repeats(&found.duplicates),
            ];
            Ok((integers, vec![found.points.into_flattened()]))
        })
    }

    /// The triangles of rows that an edit takes and makes.
    fn edited(
        &mut self,
        edit: impl FnOnce(&mut Plane) -> delone_core::base::error::Result<()>,
    ) -> Answer {
        answer(|| {
            let Some(plane) = &mut self.plane else {
                return Ok((vec![], vec![]));
            };
            edit(plane)?;
            let changes = plane.changes(&Watch::idle())?;
            let flat =
                |list: Vec<[i64; 3]>| list.as_flattened().iter().map(|&v| v as i32).collect();
            Ok((vec![flat(changes.gone), flat(changes.new)], vec![]))
        })
    }
}
