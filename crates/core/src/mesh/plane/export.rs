//! Exports the mesh as arrays: ghosts are dropped, and triangles from the end take their records.
//!
//! The corners of triangles stay in the memory of the mesh, where they move together. So less memory
//! is touched for the first time, which takes longer than moving them, and less is in use.

use super::storage::{OPPOSITE, RECORD};
use super::{Code, Mesh2, triangle};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{signed, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Represents the other side of a hull edge after the ghosts are dropped; shifted like a code it
/// gives -1.
pub(super) const OUTSIDE: Code = Code::MAX;

/// Triangles per task.
const SHARE: usize = 1 << 12;
/// One in so many shares is packed first. With a fourth, 12 of 64 bytes per vertex are written
/// before 16 are returned, and the peak stays that of the build; with a second it would be higher.
const LAST: usize = 4;
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
    partial_marked_arrays(mesh, Some(ghost), all, rows, workers, watch)
}

/// The same for the first `all` records of a mesh, which may lack vertices, or ghosts.
pub fn partial_marked_arrays(
    mut mesh: Mesh2,
    ghost: Option<Code>,
    all: usize,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<(Arrays<3>, Vec<[bool; 3]>)> {
    let count = keep_triangles(&mut mesh, ghost, all)?;
    let patch = mesh.patch();
    let mut marks = with_room(count)?;
    for first in (0..count).step_by(LOT) {
        watch.check()?;
        let lot = first..count.min(first + LOT);
        marks.extend(lot.map(|t| patch.marks(t as u32)));
    }
    Ok((write(mesh, count, rows, workers, watch)?, marks))
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
    mut mesh: Mesh2,
    ghost: Option<Code>,
    all: usize,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<3>> {
    let count = keep_triangles(&mut mesh, ghost, all)?;
    write(mesh, count, rows, workers, watch)
}

/// The first `count` records as arrays.
fn write(
    mesh: Mesh2,
    count: usize,
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<3>> {
    let mut corners = mesh.into_words();
    let mut neighbors = zeroed(count)?;
    // The last records are packed first and their memory is returned, so that the array of
    // neighbors, which is filled at the same time, needs no more than the build did.
    let kept = match count / SHARE {
        shares if shares >= LAST => (shares - shares / LAST) * SHARE,
        _ => count,
    };
    let (first_neighbors, last_neighbors) = neighbors.split_at_mut(kept);
    let mut last: Vec<[u32; 3]> = with_room(count - kept)?;
    if kept < count {
        let records = &mut corners.as_flattened_mut()[RECORD * kept..RECORD * count];
        pack_all(records, last_neighbors, rows, workers, watch)?;
        for share in records.chunks(RECORD * SHARE) {
            watch.check()?;
            let packed = share.as_chunks::<3>().0;
            last.extend_from_slice(&packed[..share.len() / RECORD]);
        }
        corners.truncate((RECORD * kept).div_ceil(3));
        corners.shrink_to_fit();
    }
    let words = corners.as_flattened_mut();
    pack_all(
        &mut words[..RECORD * kept],
        first_neighbors,
        rows,
        workers,
        watch,
    )?;
    for first in (SHARE..kept).step_by(SHARE) {
        watch.check()?;
        let from = RECORD * first;
        words.copy_within(from..from + 3 * SHARE.min(kept - first), 3 * first);
    }
    corners.truncate(count);
    corners[kept..].copy_from_slice(&last);
    corners.shrink_to_fit();
    Ok(Arrays {
        simplices: signed(corners),
        neighbors,
    })
}

/// Packs each share of `records`.
fn pack_all(
    records: &mut [u32],
    neighbors: &mut [[i32; 3]],
    rows: &[u32],
    workers: usize,
    watch: &Watch,
) -> Result<()> {
    let tasks = records
        .chunks_mut(RECORD * SHARE)
        .zip(neighbors.chunks_mut(SHARE))
        .collect();
    parallel::map_watched(workers, tasks, watch, |(records, neighbors)| {
        pack(records, neighbors, rows);
        Ok(())
    })?;
    Ok(())
}

/// Writes the neighbors of the triangles in `records`, and moves their corners, as rows, to the front
/// of `records`: those of triangle i end before record i + 1 begins.
fn pack(records: &mut [u32], neighbors: &mut [[i32; 3]], rows: &[u32]) {
    for (i, n) in neighbors.iter_mut().enumerate() {
        let Some(&r) = records[RECORD * i..].first_chunk::<RECORD>() else {
            break;
        };
        let corners = [r[0], r[1], r[2]].map(|v| rows[v as usize]);
        records[3 * i..3 * i + 3].copy_from_slice(&corners);
        *n = [r[OPPOSITE], r[OPPOSITE + 1], r[OPPOSITE + 2]].map(|e| e as i32 >> 3);
    }
}

/// Drops the ghosts, where there are any, and returns the count of triangles.
fn keep_triangles(mesh: &mut Mesh2, ghost: Option<Code>, all: usize) -> Result<usize> {
    match ghost {
        Some(ghost) => drop_ghosts(mesh, ghost, all),
        None => Ok(all),
    }
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
