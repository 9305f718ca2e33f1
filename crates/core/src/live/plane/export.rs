//! The present triangulation as arrays, equal to those of a fresh build up to their order.

use delone_predicates::Point2;

use super::Plane;
use super::mesh::INFINITE;
use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};
use crate::live::rows::NONE;

/// Records, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// A triangulation as arrays.
#[derive(Debug, Default)]
pub struct Exported {
    /// The coordinates of each row that is there.
    pub points: Vec<Point2>,
    /// Their numbers, ascending.
    pub rows: Vec<i64>,
    /// Triangles, as positions in `rows`, and their neighbors.
    pub arrays: Arrays<3>,
    /// For each triangle and corner, whether the edge opposite is part of a segment; nothing if there
    /// are not segments.
    pub constrained: Vec<[bool; 3]>,
    /// `[position, first position of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

impl Plane {
    /// The rows that are there, ascending, and their coordinates.
    pub fn points(&self, watch: &Watch) -> Result<(Vec<i64>, Vec<Point2>)> {
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

    /// The present triangulation; without triangles if all points are on one line.
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
            constrained: self.constrained(watch)?,
            duplicates,
        })
    }

    /// The triangles by the ranks of rows.
    fn arrays(&self, ranks: &[i32], watch: &Watch) -> Result<Arrays<3>> {
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
            let [a, b, c, _, ab, bc, ca, _] = *record;
            arrays.simplices.push([a, b, c].map(|v| rank[v as usize]));
            let across = [ab, bc, ca].map(|e| number[(e >> 3) as usize]);
            arrays.neighbors.push(across);
        }
        debug_assert!(NONE as usize >= ranks.len());
        Ok(arrays)
    }

    /// Which edges of the triangles are marked.
    fn constrained(&self, watch: &Watch) -> Result<Vec<[bool; 3]>> {
        if !self.mesh.has_segments {
            return Ok(Vec::new());
        }
        let mut marked = with_room(self.triangles())?;
        let mut pace = Pace::new(watch, LOT);
        for t in 0..self.mesh.records.len() as u32 {
            pace.spend(1)?;
            if self.mesh.is_live(t) && !self.mesh.corners(t).contains(&INFINITE) {
                marked.push([0, 1, 2].map(|k| self.mesh.mark(8 * t + k) != 0));
            }
        }
        Ok(marked)
    }
}
