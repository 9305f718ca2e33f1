//! Voronoi vertices: the centers of simplices, and which neighboring simplices share theirs.

use super::given::Given;
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, push, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::measure::center::{Center, Centered};

/// Simplices per task.
const SHARE: usize = 1 << 14;
/// Simplices numbered between two checks for interruption.
const LOT: usize = 1 << 16;
/// The number of simplices whose corners are loaded before the first of their centers is computed,
/// because the loads are independent.
const BATCH: usize = 64;
/// Two roundings of one number, each within 4 units in the last place, differ by less than this
/// share of it.
const NEAR: f64 = 16.0 * f64::EPSILON;

/// A simplex whose center is out of range, and its value as in `Center::Beyond`.
pub(crate) type Far<const D: usize> = (usize, [f64; D]);

/// The corners of simplex `t`, with their weights.
fn corners_of<C: Centered<D, N>, const D: usize, const N: usize>(
    given: Given<D, N>,
    t: usize,
) -> C {
    let s = given.simplices[t];
    C::new(s.map(|v| given.point(v)), s.map(|v| given.weight(v)))
}

/// The center of each simplex, NaN for those out of range, which are listed.
pub(crate) fn centers<C: Centered<D, N>, const D: usize, const N: usize>(
    given: Given<D, N>,
    workers: usize,
    watch: &Watch,
) -> Result<(Vec<[f64; D]>, Vec<Far<D>>)> {
    let mut centers = zeroed(given.simplices.len())?;
    let tasks = centers.chunks_mut(SHARE).enumerate().collect();
    let found = parallel::map_watched(
        workers,
        tasks,
        watch,
        |(i, part): (usize, &mut [[f64; D]])| {
            let mut beyond = Vec::new();
            let mut batch = [corners_of::<C, D, N>(given, i * SHARE); BATCH];
            for (j, part) in part.chunks_mut(BATCH).enumerate() {
                let from = i * SHARE + j * BATCH;
                for (t, corners) in (from..from + part.len()).zip(&mut batch) {
                    *corners = corners_of::<C, D, N>(given, t);
                }
                for (t, (slot, corners)) in (from..).zip(part.iter_mut().zip(&batch)) {
                    *slot = match corners.center() {
                        Center::At(at) => at,
                        Center::Beyond(at) => {
                            push(&mut beyond, (t, at))?;
                            [f64::NAN; D]
                        }
                    };
                }
            }
            Ok(beyond)
        },
    )?;
    let mut beyond = Vec::new();
    for part in found {
        make_room(&mut beyond, part.len())?;
        beyond.extend(part);
    }
    Ok((centers, beyond))
}

/// For each simplex a mask: bit k if it shares its center across the side opposite corner k, which
/// `tied` decides if the centers are near, and the bits that `others` adds, given the simplex and
/// its bits.
pub(crate) fn masks<const D: usize, const N: usize>(
    given: Given<D, N>,
    centers: &[[f64; D]],
    workers: usize,
    watch: &Watch,
    tied: impl Fn(usize, usize) -> Result<bool> + Sync,
    others: impl Fn(usize, u8) -> u8 + Sync,
) -> Result<Vec<u8>> {
    let mut masks = filled(given.simplices.len(), 0_u8)?;
    let tasks = masks.chunks_mut(SHARE).enumerate().collect();
    parallel::map_watched(workers, tasks, watch, |(i, part): (usize, &mut [u8])| {
        for (t, mask) in (i * SHARE..).zip(part) {
            for k in 0..N {
                let other = given.neighbors[t][k];
                let shared = other >= 0
                    && are_near(&centers[t], &centers[other as usize])
                    && tied(t, other as usize)?;
                *mask |= u8::from(shared) << k;
            }
            *mask |= others(t, *mask);
        }
        Ok(())
    })?;
    Ok(masks)
}

/// Whether two centers may be equal; NaN is near everything.
#[inline]
fn are_near<const D: usize>(here: &[f64; D], there: &[f64; D]) -> bool {
    let apart = |i: usize| {
        (here[i] - there[i]).abs() > NEAR * here[i].abs().max(there[i].abs()) + f64::MIN_POSITIVE
    };
    !(0..D).any(apart)
}

/// The vertex of each simplex: its number, or !i for number i of the out-of-range ones, whose
/// values are the second result. `centers` becomes the list of vertices.
pub(crate) fn number<C: Centered<D, N>, const D: usize, const N: usize>(
    given: Given<D, N>,
    masks: &[u8],
    centers: &mut Vec<[f64; D]>,
    beyond: &[Far<D>],
    watch: &Watch,
) -> Result<(Vec<i32>, Vec<[f64; D]>)> {
    const NONE: i32 = i32::MIN;
    let shares = |t: usize| masks[t] & ((1 << N) - 1);
    let mut vertex = filled(masks.len(), NONE)?;
    let mut far = Vec::new();
    let mut stack = Vec::new();
    let mut count = 0;
    for t in 0..masks.len() {
        if t.is_multiple_of(LOT) {
            watch.check()?;
        }
        if vertex[t] != NONE {
            continue;
        }
        let mut at = centers[t];
        let mut place = None;
        if at[0].is_nan() {
            let found = beyond.binary_search_by_key(&t, |&(t, _)| t);
            place = found.ok().map(|i| beyond[i].1);
        } else if shares(t) != 0
            && let Center::At(rounded) = corners_of::<C, D, N>(given, t).rounded()
        {
            // Correct rounding makes it independent of which simplex is first.
            at = rounded;
        }
        let number = if let Some(place) = place {
            push(&mut far, place)?;
            !(far.len() as i32 - 1)
        } else {
            centers[count] = at;
            count += 1;
            count as i32 - 1
        };
        vertex[t] = number;
        if shares(t) == 0 {
            continue;
        }
        push(&mut stack, t)?;
        // Each simplex is numbered once, and pushed when it is.
        while let Some(t) = stack.pop() {
            for k in (0..N).filter(|k| shares(t) >> k & 1 == 1) {
                let other = given.neighbors[t][k] as usize;
                if vertex[other] == NONE {
                    vertex[other] = number;
                    push(&mut stack, other)?;
                }
            }
        }
    }
    centers.truncate(count);
    Ok((vertex, far))
}
