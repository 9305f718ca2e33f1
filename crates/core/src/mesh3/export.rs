//! The mesh as arrays. Ghosts and free records go, tetrahedra from the end take their places, and
//! what is left is renumbered where it lies: the arrays of the mesh are the arrays of the caller.

use super::storage::{Code, Mesh3, corner, tetrahedron};
use crate::error::Result;
use crate::memory::push;
use crate::parallel;

/// Tetrahedra that one task renumbers.
const SHARE: usize = 1 << 14;

/// Stands for the other side of a hull facet once the ghosts are gone; shifted like a code, with its
/// sign, it gives -1.
const OUTSIDE: i32 = -4;

/// The finite tetrahedra of a mesh.
#[derive(Debug, Default)]
pub struct Arrays {
    /// Four vertices a tetrahedron, positively oriented.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each vertex, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
}

/// Exports `mesh`; vertex v becomes `rows[v]`.
pub fn arrays(mut mesh: Mesh3, rows: &[u32], workers: usize) -> Result<Arrays> {
    let count = drop_ghosts(&mut mesh)?;
    let Mesh3 {
        mut corners,
        mut opposite,
        ..
    } = mesh;
    corners.truncate(count);
    opposite.truncate(count);
    let tasks = corners
        .chunks_mut(SHARE)
        .zip(opposite.chunks_mut(SHARE))
        .collect();
    parallel::map(
        workers,
        tasks,
        |(corners, opposite): (&mut [_], &mut [_])| {
            for (s, n) in corners.iter_mut().zip(opposite) {
                *s = <[i32; 4]>::map(*s, |v| rows[v as usize] as i32);
                *n = <[i32; 4]>::map(*n, |e| {
                    if e == OUTSIDE {
                        -1
                    } else {
                        tetrahedron(e as Code) as i32
                    }
                });
            }
        },
    );
    Ok(Arrays {
        simplices: corners,
        neighbors: opposite,
    })
}

/// Makes the finite tetrahedra of `mesh` its first records and returns their count.
fn drop_ghosts(mesh: &mut Mesh3) -> Result<usize> {
    let mut holes = std::mem::take(&mut mesh.free);
    for &t in &holes {
        mesh.corners[t as usize] = [mesh.infinite() as i32; 4];
    }
    let mut free = holes.clone();
    free.sort_unstable();
    let mut free = free.into_iter().peekable();
    for t in 0..mesh.records() as u32 {
        let Some(k) = mesh.infinite_corner(t) else {
            continue;
        };
        if free.next_if_eq(&t).is_none() {
            let inside = mesh.opposites(t)[k];
            mesh.opposite[tetrahedron(inside) as usize][corner(inside)] = OUTSIDE;
            push(&mut holes, t)?;
        }
    }
    holes.sort_unstable();
    let count = mesh.records() - holes.len();
    let inner = holes.partition_point(|&t| (t as usize) < count);
    let (holes, tail) = holes.split_at(inner);
    let mut tail = tail.iter().copied().peekable();
    let all = count as u32..mesh.records() as u32;
    let moving = all.filter(|&t| tail.next_if_eq(&t).is_none());
    for (from, &to) in moving.collect::<Vec<_>>().into_iter().zip(holes) {
        relocate(mesh, from, to);
    }
    Ok(count)
}

/// Moves tetrahedron `from` to the unused record `to`.
fn relocate(mesh: &mut Mesh3, from: u32, to: u32) {
    mesh.set(to, mesh.corners(from));
    for (k, e) in (0..).zip(mesh.opposites(from)) {
        if e as i32 == OUTSIDE {
            mesh.opposite[to as usize][k as usize] = OUTSIDE;
        } else {
            mesh.link(e, 4 * to + k);
        }
    }
}
