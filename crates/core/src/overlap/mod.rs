//! The areas that cells of two grids on the sphere share: for conservative regridding.
//!
//! Cells are polygons with arcs of great circles as sides ([`Polygons`]), or between meridians and
//! parallels ([`Rows`]). Which parts there are is decided by exact signs without ties (`signs`),
//! and each area is right to a few units in its last place and 1e-24 steradians, whatever the size
//! of the cells: so sums over rows, columns and all are right together, without any exchange
//! between cells (`meet`, `walk`).
//!
//! Polygons are prepared when they are needed, so that memory beyond input and output is that of
//! boxes and areas: some 60 bytes per cell.

mod bands;
mod cell;
mod exact;
mod gather;
mod meet;
mod pairs;
mod rows;
mod signs;
mod walk;

use delone_predicates::Point3;

use crate::error::{Error, Result};
use crate::memory::{push, with_room};
use crate::parallel::map_watched;
use crate::sphere::directions::check as check_vectors;
use crate::watch::Watch;

pub use bands::Rows;
pub use cell::Fault;
pub use gather::{Shared, overlaps};

use bands::Block;
use cell::Cell;

/// Cells that are prepared together.
const LOT: usize = 1 << 10;

/// Cells with arcs of great circles as sides.
#[derive(Clone, Copy)]
pub struct Polygons<'a> {
    /// Corners, ring by ring.
    pub vectors: &'a [Point3],
    /// Where the corners of each ring start, and their number.
    pub rings: &'a [i64],
    /// Where the rings of each cell start, and their number.
    pub cells: &'a [i64],
    /// Whether each ring is a hole.
    pub holes: &'a [bool],
}

/// The cells of a grid.
pub enum Grid<'a> {
    /// Polygons.
    Polygons(Polygons<'a>),
    /// Cells between meridians and parallels.
    Rows(Rows<'a>),
}

impl Grid<'_> {
    /// The number of cells.
    pub fn len(&self) -> usize {
        match self {
            Grid::Polygons(cells) => cells.len(),
            Grid::Rows(rows) => rows.count,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What is known of each cell.
#[derive(Debug, Default)]
pub struct Checked {
    /// The areas, 0 of cells that have none.
    pub areas: Vec<f64>,
    /// 0, or a [`Fault`].
    pub faults: Vec<u8>,
    /// Whether outer rings were clockwise.
    pub turned: Vec<bool>,
    /// Whether a cell is concave, or has several rings.
    pub concave: Vec<bool>,
    /// How many corners repeat the one before.
    pub repeated: usize,
}

impl<'a> Polygons<'a> {
    /// The number of cells.
    pub fn len(&self) -> usize {
        self.cells.len().saturating_sub(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn check(&self) -> Result<()> {
        let parts = |starts: &[i64], count: usize| {
            starts.first() == Some(&0)
                && starts.last() == Some(&(count as i64))
                && starts.is_sorted()
        };
        let rings = self.rings.len().saturating_sub(1);
        let right = parts(self.rings, self.vectors.len())
            && parts(self.cells, rings)
            && self.holes.len() == rings;
        if !right {
            return Err(Error::Shape(
                "starts of rings and cells do not partition corners".into(),
            ));
        }
        if self.len() >= i32::MAX as usize {
            return Err(Error::Shape("a grid has more than 2^31 cells".into()));
        }
        check_vectors(self.vectors)
    }

    /// A cell, prepared.
    fn cell(&self, i: usize) -> (Option<Cell>, Option<Fault>) {
        let own = self.cells[i] as usize..self.cells[i + 1] as usize;
        let mut rings = own.map(|r| {
            let corners = self.rings[r] as usize..self.rings[r + 1] as usize;
            (self.holes[r], &self.vectors[corners])
        });
        Cell::of(&mut rings)
    }
}

/// Areas and faults of the cells of a grid. Sides that cross are only looked for if `crossing`.
pub fn check(grid: &Grid, crossing: bool, workers: usize, watch: &Watch) -> Result<Checked> {
    match grid {
        Grid::Polygons(cells) => check_polygons(cells, crossing, workers, watch),
        Grid::Rows(rows) => check_rows(rows),
    }
}

fn check_polygons(
    cells: &Polygons,
    crossing: bool,
    workers: usize,
    watch: &Watch,
) -> Result<Checked> {
    cells.check()?;
    let count = cells.len();
    let tasks: Vec<usize> = (0..count).step_by(LOT).collect();
    let parts = map_watched(workers, tasks, watch, |first| {
        let mut part = Checked::default();
        for i in first..(first + LOT).min(count) {
            let (cell, mut fault) = cells.cell(i);
            let crosses = |cell: &Cell| crossing && cell.crossing().is_some();
            if cell.as_ref().is_some_and(crosses) {
                fault = Some(Fault::Crossing);
            }
            push(&mut part.areas, cell.as_ref().map_or(0.0, |cell| cell.area))?;
            push(&mut part.faults, fault.map_or(0, |fault| fault as u8))?;
            push(
                &mut part.turned,
                cell.as_ref().is_some_and(|cell| cell.turned),
            )?;
            push(
                &mut part.concave,
                cell.as_ref().is_some_and(|cell| !cell.convex),
            )?;
            part.repeated += cell.map_or(0, |cell| cell.repeated);
        }
        Ok(part)
    })?;
    let mut all = Checked {
        areas: with_room(count)?,
        faults: with_room(count)?,
        turned: with_room(count)?,
        concave: with_room(count)?,
        repeated: 0,
    };
    for part in parts {
        all.areas.extend(part.areas);
        all.faults.extend(part.faults);
        all.turned.extend(part.turned);
        all.concave.extend(part.concave);
        all.repeated += part.repeated;
    }
    Ok(all)
}

fn check_rows(rows: &Rows) -> Result<Checked> {
    let mut areas = crate::memory::filled(rows.count, 0.0)?;
    for block in rows.checked()? {
        for row in 0..block.rows() {
            for column in 0..block.columns() {
                let number = block.number(row, column);
                if number >= 0 {
                    areas[number as usize] += block.area(row, column);
                }
            }
        }
    }
    let count = rows.count;
    Ok(Checked {
        areas,
        faults: crate::memory::filled(count, 0)?,
        turned: crate::memory::filled(count, false)?,
        concave: crate::memory::filled(count, false)?,
        repeated: 0,
    })
}

impl Rows<'_> {
    /// The blocks of valid input.
    fn checked(&self) -> Result<Vec<Block>> {
        let count = self.meridians.len();
        let right = self.starts.len() == self.tangents.len() + 1
            && self.starts.first() == Some(&0)
            && self.starts.last() == Some(&(count as i64))
            && self.starts.is_sorted()
            && self.numbers.len() == count;
        if !right {
            return Err(Error::Shape(
                "starts of rows do not partition meridians".into(),
            ));
        }
        let usable = |m: &[f64; 2]| m.iter().all(|x| x.is_finite()) && *m != [0.0; 2];
        if !self.meridians.iter().all(usable) || self.tangents.iter().flatten().any(|t| t.is_nan())
        {
            return Err(Error::Shape(
                "a meridian or parallel is not a number".into(),
            ));
        }
        if self
            .numbers
            .iter()
            .any(|&n| n >= 0 && n as usize >= self.count)
        {
            return Err(Error::Shape("the number of a cell is out of range".into()));
        }
        self.blocks()
    }
}
