//! The present triangulation as arrays, equal to those of a fresh build up to their order.

use delone_predicates::Point3;

use super::Space;
use super::mesh::INFINITE;
use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// Records, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// A triangulation as arrays.
#[derive(Debug, Default)]
pub struct Exported {
    /// The coordinates of each row that is there.
    pub points: Vec<Point3>,
    /// Their numbers, ascending.
    pub rows: Vec<i64>,
    /// Tetrahedra, as positions in `rows`, and their neighbors.
    pub arrays: Arrays<4>,
    /// `[position, first position of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

impl Space {
    /// The rows that are there, ascending, and their coordinates.
    pub fn points(&self, watch: &Watch) -> Result<(Vec<i64>, Vec<Point3>)> {
        let mut rows = with_room(self.len())?;
        let mut points = with_room(self.len())?;
        let mut pace = Pace::new(watch, LOT);
        for (row, v) in self.rows.iter() {
            pace.spend(1)?;
            rows.push(i64::from(row));
            points.push(self.mesh.at(v));
        }
        Ok((rows, points))
    }

    /// The present triangulation; without tetrahedra if all points are in one plane.
    pub fn export(&self, watch: &Watch) -> Result<Exported> {
        let (rows, points) = self.points(watch)?;
        let ranks = self.rows.ranks()?;
        let mut duplicates = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for (row, v) in self.rows.iter() {
            pace.spend(1)?;
            let head = self.mesh.sites[v as usize].head;
            if head != row {
                let pair = [row, head].map(|row| ranks[row as usize] as u32);
                crate::base::memory::push(&mut duplicates, pair)?;
            }
        }
        Ok(Exported {
            points,
            rows,
            arrays: self.arrays(&ranks, watch)?,
            duplicates,
        })
    }

    /// The tetrahedra by the ranks of rows.
    fn arrays(&self, ranks: &[i32], watch: &Watch) -> Result<Arrays<4>> {
        let records = self.mesh.records.items();
        let mut number = filled(records.len(), -1i32)?;
        let mut pace = Pace::new(watch, LOT);
        let mut count = 0;
        for (t, number) in (0u32..).zip(&mut number) {
            pace.spend(1)?;
            if self.mesh.is_live(t) && !self.mesh.corners(t).contains(&INFINITE) {
                *number = count;
                count += 1;
            }
        }
        let mut rank = with_room(self.mesh.sites.len())?;
        for site in self.mesh.sites.items() {
            rank.push(ranks.get(site.head as usize).copied().unwrap_or(-1));
        }
        let mut arrays = Arrays {
            simplices: with_room(count as usize)?,
            neighbors: with_room(count as usize)?,
        };
        for (record, _) in records.iter().zip(&number).filter(|(_, n)| **n >= 0) {
            pace.spend(1)?;
            let [a, b, c, d, e, f, g, h] = *record;
            let simplex = [a, b, c, d].map(|v| rank[v as usize]);
            arrays.simplices.push(simplex);
            let across = [e, f, g, h].map(|e| number[(e >> 2) as usize]);
            arrays.neighbors.push(across);
        }
        Ok(arrays)
    }
}
