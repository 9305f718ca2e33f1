//! The insertion loop, in rounds of falling strides.
//!
//! The order is a biased randomized one as in N. Amenta, S. Choi and G. Rote, "Incremental
//! constructions con BRIO" (2003), but without random choices: every 16th point along the curve,
//! then all. On 10^5 uniform points one round takes 954 ns per point, these two take 732 ns.

use delone_predicates::Point3;

use super::cavity::Kernel;
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::order::Rounds;

/// Strides of the rounds.
pub(super) const STRIDES: [u32; 2] = [16, 1];

/// Records visited between two checks for interruption.
const WATCH_EVERY: usize = 1 << 16;

/// Inserts all points except `first`; compiled for each processor by `dispatch`.
#[inline(always)]
pub(super) fn insert_all(
    kernel: &mut Kernel,
    points: &[Point3],
    first: [u32; 4],
    watch: &Watch,
) -> Result<()> {
    let mut order = Rounds::over(points.len() as u32 - 1, STRIDES).filter(|v| !first.contains(v));
    let mut near = 0;
    let mut look_at = WATCH_EVERY;
    let mut next = order.next();
    while let Some(p) = next {
        next = order.next();
        near = kernel.insert(p, near, points[next.unwrap_or(p) as usize])?;
        if kernel.work() > look_at {
            watch.check()?;
            look_at = kernel.work() + WATCH_EVERY;
        }
    }
    Ok(())
}
