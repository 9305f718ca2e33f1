//! Points with weights, and what the complexes of triangles and tetrahedra share.

use super::ball::{Kind, Site};
use crate::base::error::Result;
use crate::base::memory::{Zero, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Simplices per task.
pub(super) const SHARE: usize = 1 << 12;

/// Points, and their weights; empty without.
#[derive(Clone, Copy)]
pub struct Sites<'a, const D: usize> {
    /// Coordinates of all rows.
    pub points: &'a [[f64; D]],
    /// Weights of all rows, or none.
    pub weights: &'a [f64],
}

impl<const D: usize> Sites<'_, D> {
    /// Which parts are not zero.
    #[inline]
    pub(super) fn kind(&self) -> Kind {
        Kind {
            weighted: !self.weights.is_empty(),
            moved: false,
        }
    }

    /// The site of a row.
    #[inline]
    pub(super) fn at(&self, row: i32) -> Site<D> {
        let weight = self.weights.get(row as usize).copied();
        Site {
            at: self.points[row as usize],
            shift: [0.0; D],
            weight: weight.unwrap_or(0.0),
        }
    }
}

/// The results of `of` for each number below `count`.
pub(super) fn each<R: Zero + Send>(
    count: usize,
    workers: usize,
    watch: &Watch,
    of: impl Fn(usize) -> R + Sync,
) -> Result<Vec<R>> {
    let mut found = zeroed(count)?;
    let tasks = found.chunks_mut(SHARE).enumerate().collect();
    parallel::map_watched(
        workers,
        tasks,
        watch,
        |(share, found): (usize, &mut [R])| {
            for (i, found) in found.iter_mut().enumerate() {
                *found = of(share * SHARE + i);
            }
            Ok(())
        },
    )?;
    Ok(found)
}

/// The bits of a value, which order nothing: they travel with rows that differ.
#[inline]
pub(super) fn bits(value: f64) -> [u32; 2] {
    let bits = value.to_bits();
    [(bits >> 32) as u32, bits as u32]
}

/// The value of these bits.
#[inline]
pub(super) fn value([high, low]: [u32; 2]) -> f64 {
    f64::from_bits(u64::from(high) << 32 | u64::from(low))
}
