//! The edges of triangles: which triangles meet at each, and in which directions they traverse it.

use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// Triangles between two checks for interruption.
const LOT: usize = 1 << 14;

/// No partner: an edge of one triangle only.
pub const BOUNDARY: u32 = u32::MAX;
/// No partner: an edge of three triangles or more.
pub const MANY: u32 = u32::MAX - 1;

/// The edges. A half-edge `3 f + k` goes from corner k of the triangle f to the next.
#[derive(Debug)]
pub struct Edges {
    /// The half-edges, those of one edge together; edges in the order of their vertices.
    halves: Vec<u32>,
    /// Where the half-edges of each edge start, and the end of the last.
    starts: Vec<u32>,
    /// For each half-edge, the other one of an edge of two triangles.
    pub partner: Vec<u32>,
}

/// Edges by what is wrong with them: their vertices, ascending.
#[derive(Debug, Default)]
pub struct EdgeFaults {
    /// Edges of one triangle.
    pub boundary: Vec<[u32; 2]>,
    /// Edges of three triangles or more.
    pub many: Vec<[u32; 2]>,
    /// Edges of two triangles or more that are not passed equally often in both directions.
    pub unbalanced: Vec<[u32; 2]>,
}

/// The ends of a half-edge.
#[inline]
pub fn ends(faces: &[[u32; 3]], half: u32) -> [u32; 2] {
    let face = faces[half as usize / 3];
    let k = half as usize % 3;
    [face[k], face[(k + 1) % 3]]
}

impl Edges {
    /// The edges of triangles with vertices below `n`.
    pub fn of(faces: &[[u32; 3]], n: usize, watch: &Watch) -> Result<Self> {
        let mut halves = by_lower_end(faces, n, watch)?;
        let mut pace = Pace::new(watch, LOT);
        let mut starts = with_room(halves.len() / 2 + 2)?;
        let mut partner = filled(halves.len(), BOUNDARY)?;
        let key = |half: u32| {
            let [a, b] = ends(faces, half);
            (a.min(b), a.max(b))
        };
        let mut from = 0;
        while from < halves.len() {
            let low = key(halves[from]).0;
            let length = halves[from..]
                .iter()
                .take_while(|&&h| key(h).0 == low)
                .count();
            pace.spend(length)?;
            let star = &mut halves[from..from + length];
            star.sort_unstable_by_key(|&h| (key(h).1, h));
            for edge in star.chunk_by(|&g, &h| key(g).1 == key(h).1) {
                push(&mut starts, from as u32)?;
                from += edge.len();
                match *edge {
                    [_] => {}
                    [g, h] => {
                        partner[g as usize] = h;
                        partner[h as usize] = g;
                    }
                    _ => edge.iter().for_each(|&h| partner[h as usize] = MANY),
                }
            }
        }
        push(&mut starts, halves.len() as u32)?;
        Ok(Self {
            halves,
            starts,
            partner,
        })
    }

    /// The half-edges of each edge.
    pub fn each(&self) -> impl Iterator<Item = &[u32]> {
        let range = |w: &[u32]| w[0] as usize..w[1] as usize;
        self.starts.windows(2).map(move |w| &self.halves[range(w)])
    }

    /// What is wrong with edges; `net` is how often each triangle counts.
    pub fn faults(&self, faces: &[[u32; 3]], net: &[i32], watch: &Watch) -> Result<EdgeFaults> {
        let mut found = EdgeFaults::default();
        let mut pace = Pace::new(watch, LOT);
        for edge in self.each() {
            pace.spend(1)?;
            let [a, b] = ends(faces, edge[0]);
            let both = [a.min(b), a.max(b)];
            match edge.len() {
                1 => {
                    push(&mut found.boundary, both)?;
                    continue;
                }
                2 => {}
                _ => push(&mut found.many, both)?,
            }
            let passed = |&h: &u32| {
                let net = i64::from(net[h as usize / 3]);
                if ends(faces, h)[0] == both[0] {
                    net
                } else {
                    -net
                }
            };
            if edge.iter().map(passed).sum::<i64>() != 0 {
                push(&mut found.unbalanced, both)?;
            }
        }
        Ok(found)
    }
}

/// The half-edges, sorted by the lower ends of their edges.
fn by_lower_end(faces: &[[u32; 3]], n: usize, watch: &Watch) -> Result<Vec<u32>> {
    let count = 3 * faces.len();
    let mut pace = Pace::new(watch, LOT);
    let mut next: Vec<u32> = filled(n + 1, 0)?;
    let lower = |half: u32| {
        let [a, b] = ends(faces, half);
        a.min(b) as usize
    };
    for half in 0..count as u32 {
        pace.spend(1)?;
        next[lower(half) + 1] += 1;
    }
    for v in 0..n {
        next[v + 1] += next[v];
    }
    let mut halves = filled(count, 0)?;
    for half in 0..count as u32 {
        pace.spend(1)?;
        let at = &mut next[lower(half)];
        halves[*at as usize] = half;
        *at += 1;
    }
    Ok(halves)
}
