//! Faults of single rows: points that repeat others, triangles that use a vertex twice, have no
//! area, or repeat others.

use delone_predicates::Point3;

use crate::base::error::Result;
use crate::base::memory::{copied, push, with_room};
use crate::base::points::{collinear, scan};
use crate::base::watch::{Pace, Watch};
use crate::order::{sort, space};

/// Rows between two checks for interruption.
const LOT: usize = 1 << 14;

/// Triangles of distinct points, and what is wrong with single rows.
#[derive(Debug)]
pub struct Clean {
    /// The triangles, their vertices replaced by the first rows with the same coordinates.
    pub faces: Vec<[u32; 3]>,
    /// The rows that remain: distinct triangles with an area, ascending.
    pub kept: Vec<u32>,
    /// `[row, first row of the same point]`, ascending.
    pub same_points: Vec<[u32; 2]>,
    /// The triangles that use a vertex twice, ascending.
    pub repeats: Vec<u32>,
    /// The other triangles whose corners are collinear, ascending.
    pub collinear: Vec<u32>,
    /// `[row, first row with the same vertices]` of the others, ascending.
    pub same_faces: Vec<[u32; 2]>,
}

/// Checks points and single triangles, whose vertices must be rows of `points`.
pub fn clean(points: &[Point3], faces: &[[i32; 3]], watch: &Watch) -> Result<Clean> {
    scan(points)?;
    let same_points = space::arrange(points, watch)?.duplicates;
    let mut first: Vec<u32> = with_room(points.len())?;
    first.extend(0..points.len() as u32);
    for &[row, original] in &same_points {
        first[row as usize] = original;
    }
    let mut made = Clean {
        faces: with_room(faces.len())?,
        kept: Vec::new(),
        same_points,
        repeats: Vec::new(),
        collinear: Vec::new(),
        same_faces: Vec::new(),
    };
    let mut keys = with_room(faces.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (row, face) in (0u32..).zip(faces) {
        pace.spend(1)?;
        let ids = face.map(|v| first[v as usize]);
        made.faces.push(ids);
        let [a, b, c] = ids;
        let [p, q, r] = ids.map(|v| points[v as usize]);
        if a == b || b == c || c == a {
            push(&mut made.repeats, row)?;
        } else if collinear(p, q, r) {
            push(&mut made.collinear, row)?;
        } else {
            keys.push((sorted(ids), row));
        }
    }
    made.separate(keys, watch)?;
    Ok(made)
}

impl Clean {
    /// Separates the first triangles with their vertices from those that repeat them.
    fn separate(&mut self, mut keys: Vec<([u32; 3], u32)>, watch: &Watch) -> Result<()> {
        sort(&mut keys, watch)?;
        self.kept = with_room(keys.len())?;
        for same in keys.chunk_by(|a, b| a.0 == b.0) {
            self.kept.push(same[0].1);
            for &(_, row) in &same[1..] {
                push(&mut self.same_faces, [row, same[0].1])?;
            }
        }
        sort(&mut self.kept, watch)?;
        sort(&mut self.same_faces, watch)
    }

    /// The rows that remain, and those without area: all that are chains of three edges.
    pub fn with_collinear(&self, watch: &Watch) -> Result<Vec<u32>> {
        let mut rows = copied(&self.kept)?;
        for &row in &self.collinear {
            push(&mut rows, row)?;
        }
        sort(&mut rows, watch)?;
        Ok(rows)
    }
}

/// The vertices in ascending order.
pub fn sorted(mut ids: [u32; 3]) -> [u32; 3] {
    ids.sort_unstable();
    ids
}

/// Whether the order of the vertices is an even permutation of the ascending one.
pub fn is_even([a, b, c]: [u32; 3]) -> bool {
    !((a < b) ^ (b < c) ^ (c < a))
}
