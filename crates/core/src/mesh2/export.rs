//! Exports the mesh as arrays: ghosts are dropped, and triangles from the end take their records.
//!
//! The remaining records are then written in order, by all workers.

use super::storage::{OPPOSITE, RECORD};
use super::{Code, Mesh2, triangle};
use crate::arrays::Arrays;
use crate::error::{Error, Result};
use crate::memory::{with_room, zeroed};
use crate::parallel;
use crate::watch::Watch;

/// Stands for the other side of a hull edge after the ghosts are dropped; shifted like a code it
/// gives -1.
pub(super) const OUTSIDE: Code = Code::MAX;

/// Triangles per task.
const SHARE: usize = 1 << 14;
/// Triangles whose marks are read between two checks for interruption.
const LOT: usize = 1 << 16;

/// Like [`arrays`], and for each triangle and corner whether the opposite edge is marked.
pub fn marked_arrays(
    mesh: Mesh2,
    ghost: Code,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<(Arrays<3>, Vec<[bool; 3]>)> {
    let all = 2 * mesh.vertices() - 2;
    let (mut mesh, out) = write(mesh, Some(ghost), all, rows, workers, watch)?;
    let patch = mesh.patch();
    let count = out.simplices.len();
    let mut marks = with_room(count)?;
    for first in (0..count).step_by(LOT) {
        watch.check()?;
        let lot = first..count.min(first + LOT);
        marks.extend(lot.map(|t| patch.marks(t as u32)));
    }
    Ok((out, marks))
}

/// Exports `mesh`, one of whose ghosts is `ghost`; vertex v becomes `rows[v]`.
pub fn arrays(
    mesh: Mesh2,
    ghost: Code,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<3>> {
    let all = 2 * mesh.vertices() - 2;
    partial_arrays(mesh, Some(ghost), all, rows, workers, watch)
}

/// The same for the first `all` records of a mesh, which may lack vertices, or ghosts.
pub fn partial_arrays(
    mesh: Mesh2,
    ghost: Option<Code>,
    all: usize,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<3>> {
    write(mesh, ghost, all, rows, workers, watch).map(|(_, arrays)| arrays)
}

/// The arrays, and the mesh without ghosts.
fn write(
    mut mesh: Mesh2,
    ghost: Option<Code>,
    all: usize,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<(Mesh2, Arrays<3>)> {
    let count = match ghost {
        Some(ghost) => drop_ghosts(&mut mesh, ghost, all)?,
        None => all,
    };
    let mut out = Arrays {
        simplices: zeroed(count)?,
        neighbors: zeroed(count)?,
    };
    let shares = out
        .simplices
        .chunks_mut(SHARE)
        .zip(out.neighbors.chunks_mut(SHARE));
    let tasks = mesh.records[..RECORD * count]
        .chunks(RECORD * SHARE)
        .zip(shares)
        .collect();
    parallel::map_watched(
        workers,
        tasks,
        watch,
        |(records, (simplices, neighbors))| {
            for ((r, s), n) in records
                .as_chunks::<RECORD>()
                .0
                .iter()
                .zip(simplices)
                .zip(neighbors)
            {
                *s = [r[0], r[1], r[2]].map(|v| rows[v as usize] as i32);
                *n = [r[OPPOSITE], r[OPPOSITE + 1], r[OPPOSITE + 2]].map(|e| e as i32 >> 3);
            }
            Ok(())
        },
    )?;
    Ok((mesh, out))
}

/// Moves the finite triangles among the first `all` records of `mesh` to its first records and returns
/// their count.
fn drop_ghosts(mesh: &mut Mesh2, ghost: Code, all: usize) -> Result<usize> {
    let mut patch = mesh.patch();
    let mut ghosts = Vec::new();
    let mut g = ghost;
    loop {
        if ghosts.len() == all {
            return Err(Error::Internal("the hull does not close".into()));
        }
        ghosts.push(g);
        g = patch.after(g);
        if g == ghost {
            break;
        }
    }
    let count = all - ghosts.len();
    if count == 0 {
        return Ok(0); // A chain: ghosts on both sides of each edge, and no triangles.
    }
    for &g in &ghosts {
        patch.set_opposite(patch.opposite(g), OUTSIDE);
    }
    let mut ghosts: Vec<u32> = ghosts.into_iter().map(triangle).collect();
    ghosts.sort_unstable();
    let holes = ghosts.partition_point(|&t| (t as usize) < count);
    let (holes, tail) = ghosts.split_at(holes);
    let mut tail = tail.iter().copied().peekable();
    let mut moving = (count as u32..all as u32).filter(|&t| tail.next_if_eq(&t).is_none());
    for &hole in holes {
        let from = moving
            .next()
            .ok_or_else(|| Error::Internal("the hull is not a ring".into()))?;
        patch.relocate(from, hole);
    }
    Ok(count)
}
