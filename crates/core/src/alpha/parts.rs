//! Connected components of simplices that have facets in common.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// Simplices between two checks for interruption.
const LOT: usize = 1 << 16;
/// A simplex that is not kept.
const NONE: i32 = -1;

/// Disjoint sets.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Result<Self> {
        let mut parents = with_room(count)?;
        parents.extend(0..count as u32);
        Ok(Self(parents))
    }

    fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let up = self.0[self.0[of as usize] as usize];
            self.0[of as usize] = up;
            of = up;
        }
        of
    }

    /// Whether these were two sets.
    fn unite(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.root(a as u32), self.root(b as u32));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}

/// The number of components of the first simplices of `order`, for one simplex, two and so on; with
/// `outside`, facets without a neighbor connect a simplex to one more component, the outside.
pub fn counts<const N: usize>(
    order: &[i32],
    neighbors: &[[i32; N]],
    outside: bool,
    watch: &Watch,
) -> Result<Vec<i32>> {
    let everything = neighbors.len();
    let mut sets = Sets::new(everything + 1)?;
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
            if is_kept[n] && sets.unite(t as usize, n) {
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
    let mut sets = Sets::new(is_kept.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (t, beyond) in neighbors.iter().enumerate() {
        pace.spend(1)?;
        for n in beyond.iter().filter_map(|&n| usize::try_from(n).ok()) {
            if is_kept[t] && is_kept[n] {
                sets.unite(t, n);
            }
        }
    }
    let mut found = filled(is_kept.len(), NONE)?;
    let mut count = 0;
    for t in (0..is_kept.len()).filter(|&t| is_kept[t]) {
        // The root is the first simplex of its set.
        let root = sets.root(t as u32) as usize;
        if root == t {
            found[t] = count;
            count += 1;
        } else {
            found[t] = found[root];
        }
    }
    Ok(found)
}
