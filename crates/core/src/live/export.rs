//! The current triangulation as arrays, equal to those of a new build up to their order.

use super::Live;
use super::kernel::Kernel;
use super::store::{INFINITE, corners, opposites};
use crate::base::arrays::Arrays;
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// Records, or rows, between two checks for interruption.
const LOT: usize = 1 << 16;

/// A triangulation as arrays.
#[derive(Debug, Default)]
pub struct Exported<const D: usize, const N: usize> {
    /// The coordinates of each present row.
    pub points: Vec<[f64; D]>,
    /// Their numbers, ascending.
    pub rows: Vec<i64>,
    /// Simplices, as positions in `rows`, and their neighbors.
    pub arrays: Arrays<N>,
    /// For each simplex and corner, whether the facet opposite is part of a segment; empty if there
    /// are no segments.
    pub constrained: Vec<[bool; N]>,
    /// `[position, first position of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> Live<K, D, N> {
    /// The present rows, ascending, and their coordinates.
    pub fn points(&self, watch: &Watch) -> Result<(Vec<i64>, Vec<[f64; D]>)> {
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

    /// The present triangulation; without simplices if all points are in one line or plane.
    pub fn export(&self, watch: &Watch) -> Result<Exported<D, N>> {
        let (rows, points) = self.points(watch)?;
        let ranks = self.rows.ranks()?;
        let mut duplicates = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for (row, v) in self.rows.iter() {
            pace.spend(1)?;
            let head = self.mesh.sites[v as usize].head;
            if head != row {
                let pair = [row, head].map(|row| ranks[row as usize] as u32);
                push(&mut duplicates, pair)?;
            }
        }
        Ok(Exported {
            points,
            rows,
            arrays: self.arrays(&ranks, watch)?,
            constrained: self.mesh.constrained(watch)?,
            duplicates,
        })
    }

    /// The simplices by the ranks of rows.
    fn arrays(&self, ranks: &[i32], watch: &Watch) -> Result<Arrays<N>> {
        let records = self.mesh.records.items();
        let mut number = filled(records.len(), -1i32)?;
        let mut pace = Pace::new(watch, LOT);
        let mut count = 0;
        for (t, number) in (0u32..).zip(&mut number) {
            pace.spend(1)?;
            let own: [u32; N] = corners(&records[t as usize]);
            if self.mesh.is_live(t) && !own.contains(&INFINITE) {
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
            let simplex = corners(record).map(|v| rank[v as usize]);
            arrays.simplices.push(simplex);
            let across = opposites(record).map(|e| number[K::record_of(e) as usize]);
            arrays.neighbors.push(across);
        }
        Ok(arrays)
    }
}
