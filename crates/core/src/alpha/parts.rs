//! Connected components of simplices with common facets.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};

/// Simplices between two checks for interruption.
const LOT: usize = 1 << 16;

/// The number of components of the first simplices of `order`, for one simplex, two and so on; with
/// `outside`, facets without a neighbor connect a simplex to one more component, the outside.
pub fn counts<const N: usize>(
    order: &[i32],
    neighbors: &[[i32; N]],
    outside: bool,
    watch: &Watch,
) -> Result<Vec<i32>> {
    let everything = neighbors.len();
    let mut sets = Sets::of(everything + 1)?;
    let mut is_kept = filled(everything + 1, false)?;
    is_kept[everything] = outside;
    let mut found = with_room(order.len())?;
    let mut count = i32::from(outside);
    let mut pace = Pace::new(watch, LOT);
    for &t in order {
        pace.spend(1)?;
        is_kept[t as usize] = true;
        count += 1;
        for n in neighbors[t as usize] {
            let n = usize::try_from(n).unwrap_or(everything);
            if is_kept[n] && sets.join(t as u32, n as u32) {
                count -= 1;
            }
        }
        found.push(count);
    }
    Ok(found)
}

/// The component of each simplex that is kept, numbered by their first simplices, otherwise -1.
pub fn labels<const N: usize>(
    is_kept: &[bool],
    neighbors: &[[i32; N]],
    watch: &Watch,
) -> Result<Vec<i32>> {
    let mut sets = Sets::of(is_kept.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (t, beyond) in neighbors.iter().enumerate() {
        pace.spend(1)?;
        for n in beyond.iter().filter_map(|&n| usize::try_from(n).ok()) {
            if is_kept[t] && is_kept[n] {
                sets.join(t as u32, n as u32);
            }
        }
    }
    Ok(sets.numbered(|t| is_kept[t])?.0)
}
