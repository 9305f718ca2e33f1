//! The areas that segments separate: which of them are outside, inside rings or in holes, and the
//! triangles that are left without them.

use std::collections::HashSet;

use delone_core::arrays::Arrays;
use delone_core::constrained::components;
use delone_core::error::{Error, Result};
use delone_core::memory::{filled, push, with_room};
use delone_core::watch::{Pace, Watch};

use crate::arrays::Segments;

/// Triangles between two checks for interruption.
const LOT: usize = 1 << 16;

/// All triangles of a convex hull, and whether the edge opposite each corner is a segment.
#[derive(Debug, Clone, Copy)]
pub struct Hull<'a> {
    pub arrays: &'a Arrays<3>,
    pub walls: &'a [[bool; 3]],
}

impl Hull<'_> {
    /// The triangles that segments enclose, or all, without the areas around the triangles `seeds`.
    pub fn kept(&self, enclosed: bool, seeds: &[usize], watch: &Watch) -> Result<Vec<bool>> {
        let label = components(&self.arrays.neighbors, self.walls, watch)?;
        let count = label.iter().max().map_or(0, |last| *last as usize + 1);
        let mut gone = filled(count, false)?;
        let sides = || self.arrays.neighbors.iter().zip(self.walls);
        for ((across, walls), &area) in sides().zip(&label).filter(|_| enclosed) {
            gone[area as usize] |= (0..3).any(|k| across[k] < 0 && !walls[k]);
        }
        for &t in seeds {
            gone[label[t] as usize] = true;
        }
        let mut kept = with_room(label.len())?;
        kept.extend(label.iter().map(|&area| !gone[area as usize]));
        Ok(kept)
    }

    /// The triangles that closed rings wind around an odd number of times: a flood from outside of
    /// the hull, where each edge that an odd number of segments covers leads in or out. It visits
    /// each triangle once.
    pub fn odd(&self, segments: &Segments, watch: &Watch) -> Result<Vec<bool>> {
        let even = even(segments);
        let Arrays {
            simplices,
            neighbors,
        } = self.arrays;
        let turns = |t: usize, k: usize| {
            let ends = [1, 2].map(|j| simplices[t][(k + j) % 3]);
            self.walls[t][k] && !even.contains(&sorted(ends))
        };
        let mut inside = filled(simplices.len(), None)?;
        let mut pace = Pace::new(watch, LOT);
        let mut stack = with_room(64)?;
        let on_hull = |t: &usize| neighbors[*t].iter().any(|n| *n < 0);
        if let Some(t) = (0..simplices.len()).find(on_hull) {
            let k = neighbors[t].iter().position(|n| *n < 0).unwrap_or(0);
            inside[t] = Some(turns(t, k));
            push(&mut stack, t)?;
        }
        while let Some(t) = stack.pop() {
            pace.spend(1)?;
            let here = inside[t] == Some(true);
            for (k, &n) in neighbors[t].iter().enumerate().filter(|(_, n)| **n >= 0) {
                if inside[n as usize].is_none() {
                    inside[n as usize] = Some(here ^ turns(t, k));
                    push(&mut stack, n as usize)?;
                }
            }
        }
        let mut kept = with_room(inside.len())?;
        kept.extend(inside.iter().map(|found| *found == Some(true)));
        Ok(kept)
    }
}

fn sorted([u, v]: [i32; 2]) -> [i32; 2] {
    [u.min(v), u.max(v)]
}

/// The edges that an even number of segments covers, which are few.
fn even(segments: &Segments) -> HashSet<[i32; 2]> {
    let counts = segments.starts.windows(2).map(|w| w[1] - w[0]);
    let edges = segments.ends.iter().zip(counts);
    edges
        .filter(|(_, count)| count % 2 == 0)
        .map(|(ends, _)| sorted(*ends))
        .collect()
}

/// Some of the triangles, numbered from 0 in their order.
#[derive(Debug)]
pub struct Part {
    pub arrays: Arrays<3>,
    /// The triangle that each was.
    pub of: Vec<u32>,
}

impl Part {
    /// The triangles that are `kept`.
    pub fn of(all: &Arrays<3>, kept: &[bool], watch: &Watch) -> Result<Self> {
        if kept.len() != all.simplices.len() {
            return Err(Error::Internal("each triangle is kept or not".into()));
        }
        let count = kept.iter().filter(|kept| **kept).count();
        let mut of = with_room(count)?;
        let mut number = filled(kept.len(), -1)?;
        for (t, _) in (0u32..).zip(kept).filter(|(_, kept)| **kept) {
            number[t as usize] = of.len() as i32;
            of.push(t);
        }
        watch.check()?;
        let mut arrays = Arrays {
            simplices: with_room(count)?,
            neighbors: with_room(count)?,
        };
        let mut pace = Pace::new(watch, LOT);
        for &t in &of {
            pace.spend(1)?;
            arrays.simplices.push(all.simplices[t as usize]);
            let across = all.neighbors[t as usize];
            let across = across.map(|n| if n < 0 { -1 } else { number[n as usize] });
            arrays.neighbors.push(across);
        }
        Ok(Self { arrays, of })
    }
}
