//! Insertion of a point: locate, remove the cells in conflict, and join the point to the rim.

use super::cell::{INFINITE, Mesh};
use crate::base::error::{Error, Result};
use crate::base::memory::{self, filled};
use crate::base::watch::Pace;

/// A facet of the rim: a removed cell, the number of the corner opposite, and the cell outside.
type Side = (u32, usize, u32);

/// A ridge that one new cell has: half of its hash, then `16 c + k` of the cell and the corner opposite, which
/// is not 0 as k is not.
type Entry = u64;

/// Room for insertions, kept between them.
pub struct Room {
    /// The cells that the last insertion has removed.
    pub hole: Vec<u32>,
    rim: Vec<Side>,
    /// The simplices that it has made, and the ghosts.
    simplices: Vec<u32>,
    pub ghosts: Vec<u32>,
    ridges: Vec<Entry>,
    stamp: u32,
}

impl Room {
    pub fn new() -> Self {
        Self {
            hole: Vec::new(),
            rim: Vec::new(),
            simplices: Vec::new(),
            ghosts: Vec::new(),
            ridges: Vec::new(),
            stamp: 0,
        }
    }
}

/// A word for a vertex; ridges have the sum of those of their vertices. (The finalizer of
/// splitmix64, whose words look random.)
#[inline(always)]
fn word(v: u32) -> u64 {
    let x = (u64::from(v) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

/// Inserts the points of `order` that are not `used`.
#[inline(always)]
pub fn insert_all<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    order: &[u32],
    used: &[bool],
    pace: &mut Pace,
) -> Result<()> {
    let mut room = Room::new();
    for &p in order {
        if !used[p as usize] {
            mesh.insert(p, &mut room, pace)?;
        }
    }
    Ok(())
}

impl<const D: usize, const V: usize, const P: usize> Mesh<D, V, P> {
    /// Adds a point that is not a vertex yet.
    #[inline(always)]
    pub fn insert(&mut self, p: u32, room: &mut Room, pace: &mut Pace) -> Result<()> {
        // A point with a weight can be hidden by others.
        let Some(start) = self.locate(p, pace)? else {
            return Ok(());
        };
        self.open(p, start, room, pace)?;
        self.fill(p, room, pace)
    }

    /// A cell in conflict with a point; `None` if there is none, because of weights.
    #[inline(always)]
    fn locate(&mut self, p: u32, pace: &mut Pace) -> Result<Option<u32>> {
        let mut here = self.last;
        if self.conflict(here, p)? {
            return Ok(Some(here));
        }
        if self.cells[here as usize].is_ghost() {
            here = self.cells[here as usize].neighbors[D];
        }
        // Descend the rounded power, which decreases with each step: no cell is visited twice.
        let mut value = self.value(here, p).0;
        loop {
            if value < 0.0 && self.conflict(here, p)? {
                return Ok(Some(here));
            }
            let (mut least, mut next) = (value, INFINITE);
            for t in self.cells[here as usize].neighbors {
                pace.spend(1)?;
                if self.cells[t as usize].is_ghost() {
                    if self.conflict(t, p)? {
                        return Ok(Some(t));
                    }
                    continue;
                }
                let there = self.value(t, p).0;
                if there < least {
                    (least, next) = (there, t);
                }
            }
            if next == INFINITE {
                break;
            }
            (value, here) = (least, next);
        }
        self.walk(p, here, pace)
    }

    /// The same by an exact visibility walk, where rounding or ties stop the descent. It ends, as the
    /// triangulation is regular (H. Edelsbrunner, "An acyclicity theorem for cell complexes in d
    /// dimensions", 1990).
    #[cold]
    #[inline(never)]
    fn walk(&mut self, p: u32, start: u32, pace: &mut Pace) -> Result<Option<u32>> {
        self.counts.walks += 1;
        let mut here = start;
        while !self.conflict(here, p)? {
            let mut next = None;
            for i in 0..V {
                pace.spend(1)?;
                if self.side(here, i, p)? < 0 {
                    next = Some(self.cells[here as usize].neighbors[i]);
                    break;
                }
            }
            match next {
                // The point is strictly beyond the facet.
                Some(t) if self.cells[t as usize].is_ghost() => return Ok(Some(t)),
                Some(t) => here = t,
                // Above the plane of the simplex, and so above that of every other one.
                None if !self.sites.weights.is_empty() => return Ok(None),
                // A point in a simplex that is none of its corners lies inside its sphere.
                None => {
                    return Err(Error::Internal(
                        "a point in a simplex is in no conflict".into(),
                    ));
                }
            }
        }
        Ok(Some(here))
    }

    /// Finds the cells in conflict, which are connected, and the facets around them.
    #[inline(always)]
    pub fn open(&mut self, p: u32, start: u32, room: &mut Room, pace: &mut Pace) -> Result<()> {
        room.stamp += 2;
        let (inside, outside) = (room.stamp, room.stamp + 1);
        room.hole.clear();
        room.rim.clear();
        memory::push(&mut room.hole, start)?;
        self.cells[start as usize].mark = inside;
        let mut next = 0;
        while next < room.hole.len() {
            let c = room.hole[next];
            next += 1;
            pace.spend(1)?;
            for (i, t) in self.cells[c as usize].neighbors.into_iter().enumerate() {
                let mark = self.cells[t as usize].mark;
                if mark == inside {
                    continue;
                }
                if mark != outside && self.conflict(t, p)? {
                    self.cells[t as usize].mark = inside;
                    memory::push(&mut room.hole, t)?;
                } else {
                    self.cells[t as usize].mark = outside;
                    memory::push(&mut room.rim, (c, i, t))?;
                }
            }
        }
        Ok(())
    }

    /// Replaces the cells in conflict by cells that join the point to the rim.
    #[inline(always)]
    pub fn fill(&mut self, p: u32, room: &mut Room, pace: &mut Pace) -> Result<()> {
        // Each ridge of the rim is in two of its facets, so the table is at most half full.
        let size = (room.rim.len() * D).next_power_of_two().max(16);
        if room.ridges.len() < size {
            room.ridges = Vec::new();
            room.ridges = filled(size, 0)?;
        }
        room.ridges[..size].fill(0);
        room.simplices.clear();
        room.ghosts.clear();
        let rim = std::mem::take(&mut room.rim);
        for &(old, i, outside) in &rim {
            pace.spend(1)?;
            let c = self.star(p, old, i, outside)?;
            if self.hull.is_some() {
                // Nothing is behind a facet; the facet itself represents that.
                self.cells[c as usize].neighbors[D] = c;
            }
            if self.cells[c as usize].is_ghost() {
                memory::push(&mut room.ghosts, c)?;
            } else {
                memory::push(&mut room.simplices, c)?;
                self.last = c;
            }
            self.join(c, &mut room.ridges[..size]);
        }
        room.rim = rim;
        self.measure_simplices(&room.simplices);
        for &ghost in &room.ghosts {
            self.measure_ghost(ghost);
        }
        for &c in &room.hole {
            self.discard(c)?;
        }
        Ok(())
    }

    /// The cell of a point and a facet of the rim, opposite corner `i` of a cell that is removed.
    #[inline(always)]
    fn star(&mut self, p: u32, old: u32, i: usize, outside: u32) -> Result<u32> {
        let cell = &self.cells[old as usize];
        let mut vertices = [p; V];
        for j in 0..D {
            vertices[j + 1] = cell.vertices[j + usize::from(j >= i)];
        }
        // The point is on the side of the facet where corner i is: in its place it has the same
        // orientation. Moving it to the front takes i exchanges.
        let positive = cell.is_positive() ^ (i % 2 == 1);
        let c = self.make(vertices, positive)?;
        self.cells[c as usize].neighbors[0] = outside;
        let back = &mut self.cells[outside as usize].neighbors;
        if let Some(k) = back.iter().position(|&n| n == old) {
            back[k] = c;
        }
        Ok(c)
    }

    /// Joins a new cell to those others that share a ridge of the rim with it.
    #[inline(always)]
    fn join(&mut self, c: u32, ridges: &mut [Entry]) {
        let v = self.cells[c as usize].vertices;
        let words = v.map(word);
        let sum = words[1..].iter().fold(0u64, |sum, &w| sum.wrapping_add(w));
        let (mask, shift) = (ridges.len() - 1, u64::BITS - ridges.len().trailing_zeros());
        for k in 1..V {
            let hash = sum.wrapping_sub(words[k]);
            let mut at = (hash >> shift) as usize;
            // The table is not full: the search ends.
            loop {
                let found = ridges[at];
                if found == 0 {
                    ridges[at] = hash << 32 | u64::from(c * 16 + k as u32);
                    break;
                }
                let corner = found as u32;
                let (other, opposite) = (corner / 16, corner as usize % 16);
                if (found >> 32) as u32 == hash as u32 && self.is_same_ridge(&v, k, other, opposite)
                {
                    self.cells[c as usize].neighbors[k] = other;
                    self.cells[other as usize].neighbors[opposite] = c;
                    break;
                }
                at = (at + 1) & mask;
            }
        }
    }

    /// Whether the vertices but 0 and `k` are those of another cell but 0 and `opposite`. New vertices come
    /// first and the others keep their places, so vertices of two cells are in the same order.
    #[inline(always)]
    fn is_same_ridge(&self, v: &[u32; V], k: usize, other: u32, opposite: usize) -> bool {
        let w = &self.cells[other as usize].vertices;
        (1..D).fold(true, |all, j| {
            all & (v[j + usize::from(j >= k)] == w[j + usize::from(j >= opposite)])
        })
    }
}
