//! The row that represents each distinct point: the heaviest of coincident ones, in 2-D and 3-D.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};

/// Distinct points, each with the first of its heaviest rows.
pub struct Heaviest {
    /// That row for each distinct point.
    pub rows: Vec<u32>,
    /// Its weight.
    pub weights: Vec<f64>,
    /// For each row of the input, the row that represents it.
    pub stands_for: Vec<i32>,
}

/// For distinct points, given by their first rows, and `[row, first row of the same point]`.
pub fn heaviest(weights: &[f64], firsts: &[u32], duplicates: &[[u32; 2]]) -> Result<Heaviest> {
    let mut rows = firsts.to_vec();
    let mut place = filled(weights.len(), 0_u32)?;
    for (i, &row) in (0_u32..).zip(firsts) {
        place[row as usize] = i;
    }
    for &[row, first] in duplicates {
        let best = &mut rows[place[first as usize] as usize];
        if weights[row as usize] > weights[*best as usize] {
            *best = row;
        }
    }
    let mut stands_for = filled(weights.len(), 0)?;
    for &[row, first] in duplicates {
        stands_for[row as usize] = rows[place[first as usize] as usize] as i32;
    }
    for (&row, &best) in firsts.iter().zip(&rows) {
        stands_for[row as usize] = best as i32;
    }
    let mut own = with_room(rows.len())?;
    own.extend(rows.iter().map(|&row| weights[row as usize]));
    Ok(Heaviest {
        rows,
        weights: own,
        stands_for,
    })
}
