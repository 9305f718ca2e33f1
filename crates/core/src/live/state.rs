//! Snapshots of a live triangulation, and what has changed since the last call.

use delone_predicates::lexicographic;

use super::Live;
use super::chunks::Image;
use super::kernel::{Constraints, Kernel};
use super::rows::{NONE, RowsImage};
use super::store::{Counts, FREE, INFINITE, Record, Site, corners};
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::order::{sort, sort_by};

/// Records between two checks for interruption.
const LOT: usize = 1 << 16;

/// A snapshot. It never changes, and shares memory with others and with the triangulation.
#[derive(Debug)]
pub struct State<K: Kernel<D, N>, const D: usize, const N: usize> {
    records: Image<Record>,
    sites: Image<Site<D>>,
    rows: RowsImage,
    segments: <K::Segments as Constraints>::Image,
    counts: Counts,
}

// Not derived: that would require `Clone` of the mesh.
impl<K: Kernel<D, N>, const D: usize, const N: usize> Clone for State<K, D, N> {
    fn clone(&self) -> Self {
        Self {
            records: self.records.clone(),
            sites: self.sites.clone(),
            rows: self.rows.clone(),
            segments: self.segments.clone(),
            counts: self.counts,
        }
    }
}

/// Simplices, as rows, that were removed and added. Each begins with its smallest rows: a triangle with
/// one, a tetrahedron with two. Lists are ascending.
#[derive(Debug, Default)]
pub struct Changes<const N: usize> {
    /// Simplices that no longer exist.
    pub gone: Vec<[i64; N]>,
    /// Simplices that are new.
    pub new: Vec<[i64; N]>,
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> State<K, D, N> {
    /// Bytes that are not shared with `other`.
    pub fn own_bytes(&self, other: &Self) -> usize {
        self.records.own_bytes(&other.records)
            + self.sites.own_bytes(&other.sites)
            + self.rows.own_bytes(&other.rows)
            + K::Segments::own_bytes(&self.segments, &other.segments)
    }
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> Live<K, D, N> {
    /// The current state: the cost depends on what has changed since the last snapshot.
    pub fn state(&mut self, watch: &Watch) -> Result<State<K, D, N>> {
        Ok(State {
            records: self.mesh.records.image(watch)?,
            sites: self.mesh.sites.image(watch)?,
            rows: self.rows.image(watch)?,
            segments: self.segments.image(watch)?,
            counts: self.mesh.counts,
        })
    }

    /// Restores a state, of this triangulation or of any other. Rows and segments that were
    /// inserted since are removed, and their numbers are not used again.
    pub fn restore(&mut self, state: &State<K, D, N>, watch: &Watch) -> Result<()> {
        let (total, segments) = (self.rows.total(), self.segments.total());
        let mut flat = Vec::new();
        if state.counts.simplices == 0 {
            // All sites are in use: only edits among simplices free any, and what makes the last simplex
            // vanish is a rebuild.
            let sites = state.sites.to_vec()?;
            flat = with_room(sites.len())?;
            flat.extend(1..sites.len() as u32);
            let at = |v: u32| sites[v as usize].at;
            sort_by(&mut flat, watch, |&u, &v| lexicographic(at(u), at(v)))?;
        }
        self.segments.make_room(&state.segments, segments)?;
        self.mesh.records.make_room(&state.records)?;
        self.mesh.sites.make_room(&state.sites)?;
        self.rows.make_room(&state.rows)?;
        self.rows.reserve(total.saturating_sub(self.rows.total()))?;
        self.mesh.records.restore(&state.records)?;
        self.mesh.sites.restore(&state.sites)?;
        self.rows.restore(&state.rows)?;
        for _ in self.rows.total()..total {
            self.rows.push()?;
        }
        self.segments.restore(&state.segments, segments)?;
        self.mesh.follow(&self.segments);
        self.mesh.counts = state.counts;
        self.flat = flat;
        self.mesh.jump = None;
        let near = self.mesh.sites[INFINITE as usize].near;
        self.mesh.last = if near == NONE { 0 } else { K::record_at(near) };
        Ok(())
    }

    /// The simplices that were removed and added since the last call; in the first call all are new.
    pub fn changes(&mut self, watch: &Watch) -> Result<Changes<N>> {
        let state = self.state(watch)?;
        let found = match &self.seen {
            Some(seen) => self.since(seen, watch)?,
            None => Changes {
                gone: Vec::new(),
                new: self.named(watch)?,
            },
        };
        self.seen = Some(state);
        Ok(found)
    }

    /// All simplices as rows.
    fn named(&self, watch: &Watch) -> Result<Vec<[i64; N]>> {
        let mut all = with_room(self.simplices())?;
        let mut pace = Pace::new(watch, LOT);
        for &record in self.mesh.records.items() {
            pace.spend(1)?;
            all.extend(named::<K, D, N>(record, |v| {
                self.mesh.sites[v as usize].head
            }));
        }
        sort(&mut all, watch)?;
        Ok(all)
    }

    /// One bit for each site: whether its row is not that of a state.
    fn renamed(&self, seen: &State<K, D, N>, watch: &Watch) -> Result<Vec<u64>> {
        let sites = self.mesh.sites.items();
        let mut renamed = filled(sites.len() / 64 + 1, 0u64)?;
        let mut pace = Pace::new(watch, LOT);
        for i in self.mesh.sites.changed(&seen.sites).flatten() {
            pace.spend(1)?;
            let before = seen.sites.get(i).map(|site| site.head);
            if sites.get(i).is_some_and(|site| Some(site.head) != before) {
                renamed[i / 64] |= 1 << (i % 64);
            }
        }
        Ok(renamed)
    }

    /// What has changed since a state.
    fn since(&self, seen: &State<K, D, N>, watch: &Watch) -> Result<Changes<N>> {
        let (mut old, mut new) = (Vec::new(), Vec::new());
        let mut pace = Pace::new(watch, LOT);
        let renamed = self.renamed(seen, watch)?;
        let is_renamed = |v: &u32| renamed[*v as usize / 64] >> (v % 64) & 1 == 1;
        for i in self.mesh.records.changed(&seen.records).flatten() {
            pace.spend(1)?;
            let before = seen.records.get(i);
            let now = self.mesh.records.items().get(i).copied();
            // Most records of a chunk have not changed, and names need corners far away.
            if before == now && now.is_none_or(|r| r[3] == FREE || !r[..N].iter().any(is_renamed)) {
                continue;
            }
            let head = |v: u32| seen.sites.get(v as usize).map_or(NONE, |site| site.head);
            if let Some(t) = before.and_then(|record| named::<K, D, N>(record, head)) {
                push(&mut old, t)?;
            }
            if let Some(t) =
                now.and_then(|r| named::<K, D, N>(r, |v| self.mesh.sites[v as usize].head))
            {
                push(&mut new, t)?;
            }
        }
        sort(&mut old, watch)?;
        sort(&mut new, watch)?;
        Ok(Changes {
            gone: without(&old, &new)?,
            new: without(&new, &old)?,
        })
    }
}

/// A simplex by the rows of its vertices, the smallest first; `None` for ghosts and free records.
fn named<K: Kernel<D, N>, const D: usize, const N: usize>(
    record: Record,
    head: impl Fn(u32) -> u32,
) -> Option<[i64; N]> {
    let own: [u32; N] = corners(&record);
    if record[3] == FREE || own.contains(&INFINITE) {
        return None;
    }
    let mut rows = own.map(|v| i64::from(head(v)));
    K::arrange(&mut rows);
    Some(rows)
}

/// The items of one sorted list that are not in another one.
fn without<const N: usize>(list: &[[i64; N]], other: &[[i64; N]]) -> Result<Vec<[i64; N]>> {
    let mut left = Vec::new();
    let mut at = 0;
    for item in list {
        while other.get(at).is_some_and(|o| o < item) {
            at += 1;
        }
        if other.get(at) != Some(item) {
            push(&mut left, *item)?;
        }
    }
    Ok(left)
}
