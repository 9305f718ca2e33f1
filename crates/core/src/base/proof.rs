//! What exact validators share: verdicts on adjacent simplices, and which rows must be vertices.

use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::watch::Watch;

/// Simplices between two checks for interruption.
const LOT: usize = 1 << 16;

/// What a local test says about two simplices with a common facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They are locally Delaunay (with weights, locally regular), ties included.
    Right,
    /// The lifted apex of one lies below the lifted plane of the other.
    Wrong,
    /// Both lie in one lifted plane, but the canonical triangulation has another facet.
    Tie,
}

/// The rows that may be vertices.
#[derive(Debug, Clone, Copy)]
pub struct Expected<'a> {
    /// One row for each distinct point.
    pub rows: &'a [u32],
    /// `[row, row that represents it]` for all other rows.
    pub others: &'a [[u32; 2]],
    /// Whether some of `rows` may be hidden.
    pub may_hide: bool,
}

impl Expected<'_> {
    /// The rows that no simplex uses, in the order of `rows`. Rows that are used although another
    /// one represents them go to `repeats`.
    pub fn unused<const N: usize>(
        &self,
        simplices: &[[i32; N]],
        repeats: &mut Vec<u32>,
        watch: &Watch,
    ) -> Result<Vec<u32>> {
        let mut used = filled(self.rows.len() + self.others.len(), false)?;
        for lot in simplices.chunks(LOT) {
            watch.check()?;
            for &v in lot.as_flattened() {
                used[v as usize] = true;
            }
        }
        for &[row, standing] in self.others {
            if used[row as usize] {
                repeats.push(row);
                used[standing as usize] = true;
            }
        }
        let rows = self.rows.iter().copied();
        Ok(rows.filter(|&row| !used[row as usize]).collect())
    }
}
