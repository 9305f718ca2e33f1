//! The areas that cells of two grids share, on the sphere or in the plane: for conservative
//! regridding and areal interpolation.
//!
//! Cells are polygons with arcs of great circles as sides ([`Polygons`]), or between meridians and
//! parallels ([`Rows`]). Which parts there are is decided by exact signs without ties (`signs`),
//! and each area is right to a few units in its last place and 1e-24 steradians, whatever the size
//! of the cells: so sums over rows, over columns and over all cells are consistent, without any
//! exchange between cells (`meet`, `walk`).
//!
//! Polygons are prepared when they are needed, so that memory beyond input and output is that of
//! boxes and areas: some 60 bytes per cell.

mod bands;
mod cell;
mod convex;
mod exact;
mod gather;
mod meet;
mod outline;
mod pairs;
mod plane;
mod rows;
mod sides;
mod signs;
mod touch;
mod walk;

use crate::base::error::{Error, Result};
use crate::base::memory::{push, with_room};
use crate::base::parallel::map_watched;
use crate::base::points::scan;
use crate::base::watch::Watch;
use crate::sphere::directions::check as check_vectors;

pub use bands::Rows;
pub use gather::{Shared, overlaps, overlaps_plane};
pub use outline::Fault;

use bands::Block;
use cell::Cell;
use outline::Prepared;
use plane::Region;

/// Cells that are prepared together.
const LOT: usize = 1 << 10;

/// Cells with rings of corners: with arcs of great circles as sides, or in the plane.
#[derive(Clone, Copy)]
pub struct Polygons<'a, const D: usize = 3> {
    /// Corners, ring by ring.
    pub vectors: &'a [[f64; D]],
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

/// What is known about each cell.
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

impl<const D: usize> Polygons<'_, D> {
    /// The number of cells.
    pub fn len(&self) -> usize {
        self.cells.len().saturating_sub(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn check_parts(&self) -> Result<()> {
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
        Ok(())
    }

    /// A cell without faults, prepared.
    fn usable<C: Prepared<D>>(&self, i: usize) -> Option<C> {
        let (cell, fault) = self.cell(i);
        cell.filter(|_| fault.is_none())
    }

    /// The corners of a cell.
    fn corners(&self, i: usize) -> &[[f64; D]] {
        let [from, to] = [0, 1].map(|k| self.rings[self.cells[i + k] as usize] as usize);
        &self.vectors[from..to]
    }

    /// A cell, prepared, and what is wrong with it.
    fn cell<C: Prepared<D>>(&self, i: usize) -> (Option<C>, Option<Fault>) {
        let own = self.cells[i] as usize..self.cells[i + 1] as usize;
        let mut rings = own.map(|r| {
            let corners = self.rings[r] as usize..self.rings[r + 1] as usize;
            (self.holes[r], &self.vectors[corners])
        });
        C::of(&mut rings)
    }
}

impl Polygons<'_> {
    fn check(&self) -> Result<()> {
        self.check_parts()?;
        check_vectors(self.vectors)
    }
}

impl Polygons<'_, 2> {
    fn check(&self) -> Result<()> {
        self.check_parts()?;
        scan(self.vectors)
    }
}

/// Areas and faults of the cells of a grid. Sides that cross are only looked for if `crossing`.
pub fn check(grid: &Grid, crossing: bool, workers: usize, watch: &Watch) -> Result<Checked> {
    match grid {
        Grid::Polygons(cells) => {
            cells.check()?;
            check_cells::<Cell, 3>(cells, crossing, workers, watch)
        }
        Grid::Rows(rows) => check_rows(rows),
    }
}

/// The same for cells in the plane.
pub fn check_plane(
    cells: &Polygons<2>,
    crossing: bool,
    workers: usize,
    watch: &Watch,
) -> Result<Checked> {
    cells.check()?;
    check_cells::<Region, 2>(cells, crossing, workers, watch)
}

fn check_cells<C: Prepared<D>, const D: usize>(
    cells: &Polygons<D>,
    crossing: bool,
    workers: usize,
    watch: &Watch,
) -> Result<Checked> {
    let count = cells.len();
    let tasks: Vec<usize> = (0..count).step_by(LOT).collect();
    let parts = map_watched(workers, tasks, watch, |first| {
        let mut part = Checked::default();
        for i in first..(first + LOT).min(count) {
            let (cell, own) = cells.cell::<C>(i);
            let crossed = match &cell {
                Some(cell) => crossing && touch::crossing(cell, watch)?,
                None => false,
            };
            let fault = if crossed { Some(Fault::Crossing) } else { own };
            // What is known of a cell that has no area is not told, whether or not its sides cross.
            let cell = cell.filter(|_| own.is_none());
            push(&mut part.areas, cell.as_ref().map_or(0.0, C::area))?;
            push(&mut part.faults, fault.map_or(0, |fault| fault as u8))?;
            push(&mut part.turned, cell.as_ref().is_some_and(C::turned))?;
            push(
                &mut part.concave,
                cell.as_ref().is_some_and(|cell| !cell.convex()),
            )?;
            part.repeated += cell.map_or(0, |cell| cell.repeated());
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
    let mut areas = crate::base::memory::filled(rows.count, 0.0)?;
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
        faults: crate::base::memory::filled(count, 0)?,
        turned: crate::base::memory::filled(count, false)?,
        concave: crate::base::memory::filled(count, false)?,
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
