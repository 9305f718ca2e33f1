//! Points outside a hull under construction, and their insertion.

use super::cavity::Room;
use super::cell::{INFINITE, Mesh};
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::Pace;

/// Points outside facets, as linked lists.
struct Waiting {
    /// The first point of each facet.
    head: Vec<u32>,
    /// The point after each.
    next: Vec<u32>,
    /// The point of each facet that is farthest away, and its rounded distance, which is negative.
    farthest: Vec<(f64, u32)>,
}

impl Waiting {
    /// Keeps a point with the first of some facets that it sees, if there is one.
    #[inline(always)]
    fn place<const D: usize, const V: usize, const P: usize>(
        &mut self,
        mesh: &mut Mesh<D, V, P>,
        p: u32,
        facets: &[u32],
        pace: &mut Pace,
    ) -> Result<()> {
        for &c in facets {
            pace.spend(1)?;
            if mesh.conflict(c, p)? {
                let (value, _) = mesh.value(c, p);
                let c = c as usize;
                self.next[p as usize] = self.head[c];
                self.head[c] = p;
                let (most, far) = self.farthest[c];
                if far == INFINITE || value < most {
                    self.farthest[c] = (value, p);
                }
                return Ok(());
            }
        }
        Ok(())
    }

    /// Room for the facets of a mesh.
    fn widen(&mut self, count: usize) {
        self.head.resize(count, INFINITE);
        self.farthest.resize(count, (0.0, INFINITE));
    }
}

/// Inserts all points that are outside into the hull of the first ones.
#[inline(always)]
pub fn wrap<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    points: &[u32],
    pace: &mut Pace,
) -> Result<()> {
    let mut room = Room::new();
    let mut waiting = Waiting {
        head: Vec::new(),
        next: filled(mesh.sites.len(), INFINITE)?,
        farthest: Vec::new(),
    };
    waiting.widen(mesh.cells.len());
    let mut work: Vec<u32> = (0..mesh.cells.len() as u32).collect();
    for &p in points {
        waiting.place(mesh, p, &work, pace)?;
    }
    let mut list = Vec::new();
    while let Some(c) = work.pop() {
        // A facet may have been removed, or have returned with a different number of points.
        if waiting.head[c as usize] == INFINITE {
            continue;
        }
        let (_, p) = waiting.farthest[c as usize];
        mesh.open(p, c, &mut room, pace)?;
        mesh.fill(p, &mut room, pace)?;
        waiting.widen(mesh.cells.len());
        // The points of the removed facets, without the new vertex.
        list.clear();
        for &gone in &room.hole {
            let mut q = waiting.head[gone as usize];
            while q != INFINITE {
                if q != p {
                    push(&mut list, q)?;
                }
                q = waiting.next[q as usize];
            }
            waiting.head[gone as usize] = INFINITE;
            waiting.farthest[gone as usize] = (0.0, INFINITE);
        }
        for &q in &list {
            waiting.place(mesh, q, &room.ghosts, pace)?;
        }
        for &born in &room.ghosts {
            if waiting.head[born as usize] != INFINITE {
                push(&mut work, born)?;
            }
        }
    }
    Ok(())
}
