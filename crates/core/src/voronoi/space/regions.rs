//! 3-D Voronoi cells: the vertices and faces around each site.

use super::ridges::Ridges;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::voronoi::Given;

/// Cells per task.
const SHARE: usize = 1 << 12;

/// Cells, in the order in which their sites first occur in the tetrahedra.
#[derive(Debug, Default)]
pub struct Regions {
    /// The cell of each point, -1 if it has none.
    pub of_point: Vec<i32>,
    /// The point of each cell.
    pub site: Vec<i32>,
    /// The vertices of cell r are `vertices[starts[r]..starts[r + 1]]`.
    pub starts: Vec<i32>,
    /// Ascending; preceded by -1 if the cell is unbounded.
    pub vertices: Vec<i32>,
    /// The ridges of cell r are `ridges[ridge_starts[r]..ridge_starts[r + 1]]`.
    pub ridge_starts: Vec<i32>,
    /// Ascending.
    pub ridges: Vec<i32>,
}

/// The cells of all points that are corners of tetrahedra.
pub(super) fn regions(
    given: Given<3, 4>,
    vertex: &[i32],
    ridges: &Ridges,
    workers: usize,
    watch: &Watch,
) -> Result<Regions> {
    let mut of_point = filled(given.points.len(), -1)?;
    let mut site = with_room(given.points.len())?;
    for &v in given.simplices.as_flattened() {
        if of_point[v as usize] < 0 {
            of_point[v as usize] = site.len() as i32;
            site.push(v);
        }
    }
    let cells = site.len();
    let corners = || given.simplices.as_flattened().iter();
    let cell_of = |v: &i32| of_point[*v as usize] as usize;
    let around = gathered(cells, corners().map(cell_of), |i| vertex[i / 4].max(-1))?;
    let (mut starts, mut around) = around;
    watch.check()?;
    let open = open_cells(given, cells, cell_of);
    let kept = sorted(&starts, &mut around, workers, watch)?;
    let vertices = closed_up(&mut starts, &around, &kept, &open)?;
    let (ridge_starts, ridges) = gathered(
        cells,
        ridges.sites.as_flattened().iter().map(cell_of),
        |i| (i / 2) as i32,
    )?;
    Ok(Regions {
        of_point,
        site,
        starts,
        vertices,
        ridge_starts,
        ridges,
    })
}

/// Which cells are unbounded: those of the corners of boundary faces.
fn open_cells(given: Given<3, 4>, cells: usize, cell_of: impl Fn(&i32) -> usize) -> Vec<bool> {
    let mut open = vec![false; cells];
    for (t, row) in given.neighbors.iter().enumerate() {
        for k in (0..4).filter(|&k| row[k] < 0) {
            for i in (0..4).filter(|&i| i != k) {
                open[cell_of(&given.simplices[t][i])] = true;
            }
        }
    }
    open
}

/// The first `kept` vertices of each cell, without gaps, preceded by -1 for unbounded cells.
fn closed_up(
    starts: &mut [i32],
    around: &[i32],
    kept: &[usize],
    open: &[bool],
) -> Result<Vec<i32>> {
    let cells = kept.len();
    let mut vertices = with_room(kept.iter().sum::<usize>() + cells)?;
    for (cell, &kept) in kept.iter().enumerate() {
        let from = starts[cell] as usize;
        starts[cell] = vertices.len() as i32;
        let mine = &around[from..from + kept];
        if open[cell] && mine.first() != Some(&-1) {
            vertices.push(-1);
        }
        vertices.extend_from_slice(mine);
    }
    starts[cells] = vertices.len() as i32;
    Ok(vertices)
}

/// Compressed rows of the items of each owner, in order.
fn gathered(
    count: usize,
    owners: impl Iterator<Item = usize> + Clone,
    what: impl Fn(usize) -> i32,
) -> Result<(Vec<i32>, Vec<i32>)> {
    let mut starts = filled(count + 1, 0_i32)?;
    let mut total = 0_usize;
    for owner in owners.clone() {
        starts[owner + 1] += 1;
        total += 1;
    }
    if i32::try_from(total).is_err() {
        return Err(Error::Memory { bytes: 4 * total });
    }
    for i in 0..count {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut rows = filled(total, 0_i32)?;
    for (i, owner) in owners.enumerate() {
        rows[next[owner] as usize] = what(i);
        next[owner] += 1;
    }
    Ok((starts, rows))
}

/// Sorts each row and moves duplicates to its end; returns how many items are left.
fn sorted(starts: &[i32], rows: &mut [i32], workers: usize, watch: &Watch) -> Result<Vec<usize>> {
    let cells = starts.len() - 1;
    let mut tasks = Vec::new();
    let mut rest = rows;
    for from in (0..cells).step_by(SHARE) {
        let to = cells.min(from + SHARE);
        let (mine, others) = rest.split_at_mut((starts[to] - starts[from]) as usize);
        tasks.push((&starts[from..=to], mine));
        rest = others;
    }
    let kept = parallel::map_watched(workers, tasks, watch, |(starts, mine)| {
        let one = |w: &[i32], mine: &mut [i32]| {
            let row = &mut mine[(w[0] - starts[0]) as usize..(w[1] - starts[0]) as usize];
            row.sort_unstable();
            let mut kept = 0;
            for i in 0..row.len() {
                if i == 0 || row[i] != row[kept - 1] {
                    row[kept] = row[i];
                    kept += 1;
                }
            }
            kept
        };
        Ok(starts.windows(2).map(|w| one(w, mine)).collect::<Vec<_>>())
    })?;
    Ok(kept.into_iter().flatten().collect())
}
