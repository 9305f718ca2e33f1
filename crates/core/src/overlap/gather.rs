//! All pairs of cells that share area, as compressed rows.

use std::collections::HashMap;

use delone_predicates::arithmetic::Pair;

use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::parallel::map_watched;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::boxes::Boxes;
use crate::order::order_of;

use super::bands::Block;
use super::cell::{Cell, bounds};
use super::meet;
use super::outline::{Outline, Work};
use super::plane::{self, Region};
use super::rows;
use super::walk;
use super::{Grid, Polygons};

/// Cells per task.
const LOT: usize = 256;
/// Cells that a task keeps prepared.
const KEPT: usize = 1 << 12;
/// Corners times corners between two checks for interruption.
const PACE: usize = 1 << 18;
/// Smaller parts, in steradians, cannot be distinguished from cells that only touch: sums err by
/// less.
pub const TINY: f64 = 1e-30;

/// What each cell of the first grid shares with cells of the second one, as compressed rows.
#[derive(Debug, Default)]
pub struct Shared {
    /// Where the entries of each cell of the first grid start, and their number.
    pub starts: Vec<i64>,
    /// Cells of the second grid, ascending in each row.
    pub cells: Vec<i32>,
    /// Areas of the shared parts in steradians.
    pub areas: Vec<f64>,
    /// Sums of the areas over each cell of the first grid, correctly rounded up to an error of some
    /// 2^-100 of them.
    pub first: Vec<f64>,
    /// The same for the second grid.
    pub second: Vec<f64>,
}

/// A cell of each grid and an area.
type Part = (u32, u32, f64);

/// What all pairs of cells of two grids share; cells with faults share nothing.
pub fn overlaps(p: &Grid, q: &Grid, workers: usize, watch: &Watch) -> Result<Shared> {
    let size = (p.len(), q.len());
    match (p, q) {
        (Grid::Polygons(p), Grid::Polygons(q)) => {
            gathered(of_polygons(p, q, workers, watch)?, size, false, TINY, watch)
        }
        (Grid::Polygons(p), Grid::Rows(q)) => {
            let blocks = q.checked()?;
            gathered(
                with_rows(p, &blocks, workers, watch)?,
                size,
                false,
                TINY,
                watch,
            )
        }
        (Grid::Rows(p), Grid::Polygons(q)) => {
            let blocks = p.checked()?;
            gathered(
                with_rows(q, &blocks, workers, watch)?,
                size,
                true,
                TINY,
                watch,
            )
        }
        (Grid::Rows(p), Grid::Rows(q)) => {
            let (p, q) = (p.checked()?, q.checked()?);
            gathered(of_rows(&p, &q, workers, watch)?, size, false, TINY, watch)
        }
    }
}

/// Extents of cells in singles, rounded outward; inverted ones for cells without corners.
struct Extents {
    min: Vec<[f32; 3]>,
    max: Vec<[f32; 3]>,
}

impl Extents {
    fn of(cells: &Polygons, workers: usize, watch: &Watch) -> Result<Self> {
        let tasks: Vec<usize> = (0..cells.len()).step_by(LOT).collect();
        let parts = map_watched(workers, tasks, watch, |first| {
            let own = first..(first + LOT).min(cells.len());
            let mut part = with_room(own.len())?;
            for i in own {
                // Singles have 24 bits, and coordinates are at most 2.
                let extent = bounds(cells.corners(i));
                part.push((
                    extent.min.map(|x| (x.max(-2.0) - 2.5e-7) as f32),
                    extent.max.map(|x| (x.min(2.0) + 2.5e-7) as f32),
                ));
            }
            Ok(part)
        })?;
        let mut all = Self {
            min: with_room(cells.len())?,
            max: with_room(cells.len())?,
        };
        for (min, max) in parts.into_iter().flatten() {
            all.min.push(min);
            all.max.push(max);
        }
        Ok(all)
    }

    fn usable(&self, i: usize) -> bool {
        self.min[i][0] <= self.max[i][0]
    }

    fn extent(&self, i: usize) -> Extent<3> {
        Extent {
            min: self.min[i].map(f64::from),
            max: self.max[i].map(f64::from),
        }
    }

    fn meets(&self, i: usize, other: &Extent<3>) -> bool {
        (0..3).all(|k| {
            f64::from(self.min[i][k]) <= other.max[k] && other.min[k] <= f64::from(self.max[i][k])
        })
    }

    /// Usable cells along the curve.
    fn order(&self, watch: &Watch) -> Result<Vec<u32>> {
        let mut usable = with_room(self.min.len())?;
        usable.extend((0..self.min.len() as u32).filter(|&i| self.usable(i as usize)));
        let mut middles: Vec<[f64; 3]> = with_room(usable.len())?;
        for &i in &usable {
            let Extent { min, max } = self.extent(i as usize);
            middles.push([0, 1, 2].map(|k| 0.5 * (min[k] + max[k])));
        }
        if middles.is_empty() {
            return Ok(Vec::new());
        }
        let order = order_of::<3>(&middles, 1, watch)?.concat();
        Ok(order.into_iter().map(|k| usable[k as usize]).collect())
    }
}

/// Parts of polygons and polygons.
fn of_polygons(
    p: &Polygons,
    q: &Polygons,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Vec<Part>>> {
    p.check()?;
    q.check()?;
    let (of_p, of_q) = (
        Extents::of(p, workers, watch)?,
        Extents::of(q, workers, watch)?,
    );
    let (order, targets) = (of_p.order(watch)?, of_q.order(watch)?);
    let tree = Boxes::packed(targets, |i| of_q.extent(i), watch)?;
    let meets = |i: usize, j: usize| of_q.meets(j, &of_p.extent(i));
    let sides = (&|i| p.usable::<Cell>(i), &|j| q.usable::<Cell>(j));
    let boxes = (&|i: usize| of_p.extent(i), &meets);
    let shared = |p: &Cell, q: &Cell, work: &mut Work, pace: &mut Pace| {
        let area = meet::shared(p, q, work, pace)?;
        Ok(if area > TINY { area } else { 0.0 })
    };
    of_cells((order, tree), sides, boxes, shared, workers, watch)
}

/// Parts of cells of the plane.
pub fn overlaps_plane(
    p: &Polygons<2>,
    q: &Polygons<2>,
    workers: usize,
    watch: &Watch,
) -> Result<Shared> {
    p.check()?;
    q.check()?;
    let extents = |cells: &Polygons<2>| -> Result<(Vec<Extent<2>>, Vec<u32>)> {
        let mut all: Vec<Extent<2>> = with_room(cells.len())?;
        let mut usable: Vec<u32> = with_room(cells.len())?;
        let mut pace = Pace::new(watch, PACE);
        for i in 0..cells.len() {
            let corners = cells.corners(i);
            pace.spend(corners.len() + 1)?;
            all.push(Extent::of(corners.iter().copied()));
            if !corners.is_empty() {
                usable.push(i as u32);
            }
        }
        let mut middles: Vec<[f64; 2]> = with_room(usable.len())?;
        middles.extend(usable.iter().map(|&i| {
            let Extent { min, max } = all[i as usize];
            [0, 1].map(|k| 0.5 * min[k] + 0.5 * max[k])
        }));
        let order = if middles.is_empty() {
            Vec::new()
        } else {
            order_of::<2>(&middles, 1, watch)?.concat()
        };
        Ok((all, order.into_iter().map(|k| usable[k as usize]).collect()))
    };
    let ((of_p, order), (of_q, targets)) = (extents(p)?, extents(q)?);
    let tree = Boxes::packed(targets, |i| of_q[i], watch)?;
    let meets = |i: usize, j: usize| {
        let (a, b) = (&of_p[i], &of_q[j]);
        (0..2).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
    };
    let sides = (&|i| p.usable::<Region>(i), &|j| q.usable::<Region>(j));
    let boxes = (&|i: usize| of_p[i], &meets);
    let parts = of_cells((order, tree), sides, boxes, plane::shared, workers, watch)?;
    gathered(parts, (p.len(), q.len()), false, 0.0, watch)
}

/// Parts of the cells of an order and of a tree of boxes.
fn of_cells<C: Outline<D>, const D: usize>(
    (order, tree): (Vec<u32>, Boxes<D>),
    (first, second): (
        &(impl Fn(usize) -> Option<C> + Sync),
        &(impl Fn(usize) -> Option<C> + Sync),
    ),
    (extent, meets): (
        &(impl Fn(usize) -> Extent<D> + Sync),
        &(impl Fn(usize, usize) -> bool + Sync),
    ),
    shared: impl Fn(&C, &C, &mut Work, &mut Pace) -> Result<f64> + Sync,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Vec<Part>>> {
    map_watched(workers, order.chunks(LOT).collect(), watch, |own| {
        let (mut found, mut work) = (Vec::new(), Work::default());
        let mut kept: HashMap<usize, Option<C>> = HashMap::new();
        let mut pace = Pace::new(watch, PACE);
        let mut near = Vec::new();
        for &i in own {
            near.clear();
            tree.meeting(&extent(i as usize), |j| {
                if meets(i as usize, j) {
                    near.push(j);
                }
            });
            if near.is_empty() {
                continue;
            }
            let Some(cell) = first(i as usize) else {
                continue;
            };
            if kept.len() > KEPT {
                kept.clear();
            }
            for &j in &near {
                let other = kept.entry(j).or_insert_with(|| second(j));
                let Some(other) = other else { continue };
                pace.spend(cell.count() + other.count())?;
                let area = shared(&cell, other, &mut work, &mut pace)?;
                if area > 0.0 {
                    push(&mut found, (i, j as u32, area))?;
                }
            }
        }
        Ok(found)
    })
}

/// Parts of polygons and cells between meridians and parallels.
fn with_rows(
    p: &Polygons,
    blocks: &[Block],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Vec<Part>>> {
    p.check()?;
    let tasks: Vec<usize> = (0..p.len()).step_by(LOT).collect();
    map_watched(workers, tasks, watch, |first| {
        let (mut found, mut work) = (Vec::new(), walk::Work::default());
        let mut pace = Pace::new(watch, PACE / 64);
        for i in first..(first + LOT).min(p.len()) {
            let Some(cell) = p.usable::<Cell>(i) else {
                continue;
            };
            let [south, north] = walk::latitudes(&cell);
            for block in blocks {
                if block.phi[0] > north || block.phi[block.rows()] < south {
                    continue;
                }
                walk::shared(&cell, block, &mut work, &mut pace, &mut |j, area| {
                    push(&mut found, (i as u32, j as u32, area))
                })?;
            }
        }
        Ok(found)
    })
}

/// Parts of cells that are all between meridians and parallels.
fn of_rows(p: &[Block], q: &[Block], workers: usize, watch: &Watch) -> Result<Vec<Vec<Part>>> {
    map_watched(workers, p.iter().collect(), watch, |block: &Block| {
        let (mut found, mut pace) = (Vec::new(), Pace::new(watch, PACE));
        for other in q {
            let heights = rows::rows(block, other);
            if heights.is_empty() {
                continue;
            }
            let widths = rows::columns(block, other)?;
            for (r, s, height) in heights {
                pace.spend(widths.len())?;
                for &(c, d, width) in &widths {
                    let (i, j) = (block.number(r, c), other.number(s, d));
                    if i >= 0 && j >= 0 {
                        push(&mut found, (i as u32, j as u32, width * height))?;
                    }
                }
            }
        }
        Ok(found)
    })
}

/// Parts as compressed rows: sorted, and those of one pair added; those up to the least are dropped.
fn gathered(
    parts: Vec<Vec<Part>>,
    (p, q): (usize, usize),
    exchanged: bool,
    least: f64,
    watch: &Watch,
) -> Result<Shared> {
    let count = p.max(q);
    if count >= i32::MAX as usize {
        return Err(Error::Shape("a grid has more than 2^31 cells".into()));
    }
    let pair = |part: &Part| {
        if exchanged {
            (part.1, part.0)
        } else {
            (part.0, part.1)
        }
    };
    let mut pace = Pace::new(watch, PACE);
    // How many entries each row has, then where they start.
    let mut starts: Vec<i64> = filled(p + 1, 0)?;
    for part in parts.iter().flatten() {
        starts[pair(part).0 as usize + 1] += 1;
    }
    for i in 0..p {
        starts[i + 1] += starts[i];
    }
    let total = starts[p] as usize;
    let (mut entries, mut at) = (filled(total, (0_u32, 0.0))?, starts.clone());
    for list in parts {
        pace.spend(list.len())?;
        for part in list {
            let (i, j) = pair(&part);
            entries[at[i as usize] as usize] = (j, part.2);
            at[i as usize] += 1;
        }
    }
    let mut shared = Shared::default();
    make_room(&mut shared.starts, p + 1)?;
    make_room(&mut shared.cells, total)?;
    make_room(&mut shared.areas, total)?;
    shared.starts.push(0);
    make_room(&mut shared.first, p)?;
    let mut second = filled(q, Pair::from_double(0.0))?;
    for i in 0..p {
        let mut first = Pair::from_double(0.0);
        let row = &mut entries[starts[i] as usize..starts[i + 1] as usize];
        pace.spend(row.len() + 1)?;
        // A stable sort: parts of a pair are added in the order in which they were found.
        row.sort_by_key(|entry| entry.0);
        for run in row.chunk_by(|a, b| a.0 == b.0) {
            let area = run.iter().map(|entry| entry.1).sum::<f64>();
            if area > least {
                shared.cells.push(run[0].0 as i32);
                shared.areas.push(area);
                first = first + Pair::from_double(area);
                let other = &mut second[run[0].0 as usize];
                *other = *other + Pair::from_double(area);
            }
        }
        shared.first.push(first.hi);
        shared.starts.push(shared.cells.len() as i64);
    }
    make_room(&mut shared.second, q)?;
    shared.second.extend(second.iter().map(|sum| sum.hi));
    Ok(shared)
}
